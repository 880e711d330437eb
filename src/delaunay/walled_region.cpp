#include "delaunay/walled_region.h"

namespace delvox {
namespace {

using Wall = WalledRegion::Wall;

/// Walls found by their smallest vertex.
class WallIndex {
 public:
  WallIndex(const std::vector<Wall>& walls, std::size_t vertices) : first_(vertices + 1, 0), sorted_(walls.size()) {
    for (const Wall& wall : walls) ++first_[canonical(wall)[0] + 1];
    for (std::size_t v = 0; v < vertices; ++v) first_[v + 1] += first_[v];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (const Wall& wall : walls) sorted_[next[canonical(wall)[0]]++] = canonical(wall);
  }

  bool contains(const Wall& facet) const {
    const Wall sought = canonical(facet);
    for (std::uint32_t i = first_[sought[0]]; i < first_[sought[0] + 1]; ++i) {
      if (sorted_[i] == sought) return true;
    }
    return false;
  }

 private:
  std::vector<std::uint32_t> first_;
  std::vector<Wall> sorted_;
};

}  // namespace

bool WalledRegion::enclose(const Delaunay3& delaunay, const std::vector<Wall>& walls) {
  const WallIndex index(walls, delaunay.vertex_capacity());
  std::vector<std::uint8_t> on_wall(delaunay.vertex_capacity(), 0);
  for (const Wall& wall : walls) {
    for (VertexId v : wall) on_wall[v] = 1;
  }
  places_.assign(delaunay.cell_capacity(), kElsewhere);
  std::vector<CellId> stack;
  std::vector<FacetId> found;
  for (CellId cell = Delaunay3::kOutside + 1; cell < delaunay.cell_capacity(); ++cell) {
    const auto& v = delaunay.vertices(cell);
    if (delaunay.stamp(cell) == 0 || on_wall[v[0]] + on_wall[v[1]] + on_wall[v[2]] + on_wall[v[3]] < 3) continue;
    for (int i = 0; i < 4; ++i) {
      if (!index.contains(delaunay.vertices(FacetId{cell, i}))) continue;
      found.push_back({cell, i});
      if (places_[cell] == kElsewhere) stack.push_back(cell);
      places_[cell] = kInside;
    }
  }
  if (found.size() != walls.size()) {
    clear();
    return false;
  }
  while (!stack.empty()) {
    const CellId cell = stack.back();
    stack.pop_back();
    for (int i = 0; i < 4; ++i) {
      const CellId next = delaunay.neighbors(cell)[i];
      if (places_[next] == kInside || index.contains(delaunay.vertices(FacetId{cell, i}))) continue;
      places_[next] = kInside;
      stack.push_back(next);
    }
  }
  for (const FacetId& wall : found) {
    Place& beyond = places_[delaunay.neighbors(wall.cell)[wall.index]];
    if (beyond == kElsewhere) beyond = kGuard;
  }
  return true;
}

}  // namespace delvox
