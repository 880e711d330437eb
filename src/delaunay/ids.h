#pragma once

#include <algorithm>
#include <array>
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

/// The same oriented triangle, its smallest vertex first.
inline std::array<VertexId, 3> canonical(std::array<VertexId, 3> triangle) {
  std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  return triangle;
}

}  // namespace delvox
