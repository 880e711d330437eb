#pragma once

#include <string>
#include <string_view>

namespace delvox::mesh_io {

/// What the tets and the nodes of a set are called where all groups share one list of names; its faces have the plain
/// name.
inline constexpr const char *kTetsSuffix = "_tets", *kNodesSuffix = "_nodes";

/// The name of the set, from that of a group.
inline std::string without_suffix(std::string name, std::string_view suffix) {
  if (name.size() > suffix.size() && name.ends_with(suffix)) name.resize(name.size() - suffix.size());
  return name;
}

}  // namespace delvox::mesh_io
