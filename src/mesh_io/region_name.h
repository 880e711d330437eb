#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "mesh_io/source.h"

namespace delvox::mesh_io {

/// The number in a name like "region_3", in any case.
std::optional<std::int64_t> region_number(const Source& source, const std::string& name);

/// Regions of blocks of cells that have names: our own names carry the number, others are counted as they come.
class NamedRegions {
 public:
  explicit NamedRegions(const Source& source) : source_(source) {}
  std::int64_t number(const std::string& name) {
    if (const auto own = region_number(source_, name)) return *own;
    return numbers_.try_emplace(name, static_cast<std::int64_t>(numbers_.size()) + 1).first->second;
  }

 private:
  const Source& source_;
  std::map<std::string, std::int64_t> numbers_;
};

}  // namespace delvox::mesh_io
