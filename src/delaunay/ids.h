#pragma once

#include <cstdint>

namespace delvox {

using CellId = std::uint32_t;
using VertexId = std::uint32_t;
inline constexpr std::uint32_t kNone = 0xffffffffu;

/// The facet of `cell` opposite its vertex `index`.
struct FacetId {
  CellId cell = kNone;
  int index = 0;
};

}  // namespace delvox
