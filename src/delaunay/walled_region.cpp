#include "delaunay/walled_region.h"

#include <algorithm>
#include <bit>

#include "core/parallel.h"
#include "delaunay/delaunay3.h"

namespace delvox {
namespace {

/// Walls found by their smallest vertex.
class WallIndex {
 public:
  WallIndex(const std::vector<Wall>& walls, std::size_t vertices)
      : at_wall_(vertices, 0), first_(vertices + 1, 0), sorted_(walls.size()) {
    for (const Wall& wall : walls) {
      for (VertexId v : wall) at_wall_[v] = 1;
      ++first_[key(wall).smallest + 1];
    }
    for (std::size_t v = 0; v < vertices; ++v) first_[v + 1] += first_[v];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t w = 0; w < walls.size(); ++w) {
      const Key sought = key(walls[w]);
      sorted_[next[sought.smallest]++] = {sought.others, w};
    }
  }

  /// A bit for each facet of the cell that has only vertices of walls.
  unsigned between_walls(const std::array<VertexId, 4>& v) const {
    const int a = at_wall_[v[0]], b = at_wall_[v[1]], c = at_wall_[v[2]], d = at_wall_[v[3]];
    return static_cast<unsigned>((b & c & d) | (a & c & d) << 1 | (a & b & d) << 2 | (a & b & c) << 3);
  }
  /// The wall's number; kNone if it is none.
  std::uint32_t find(const Wall& facet) const {
    const Key sought = key(facet);
    for (std::uint32_t i = first_[sought.smallest]; i < first_[sought.smallest + 1]; ++i) {
      if (sorted_[i].others == sought.others) return sorted_[i].number;
    }
    return kNone;
  }

 private:
  struct Key {
    VertexId smallest;
    std::uint64_t others;  // the two that follow it
  };
  struct Entry {
    std::uint64_t others;
    std::uint32_t number;
  };
  static Key key(const Wall& wall) {
    const int first = wall[0] < wall[1] ? (wall[0] < wall[2] ? 0 : 2) : (wall[1] < wall[2] ? 1 : 2);
    return {wall[first], std::uint64_t{wall[(first + 1) % 3]} << 32 | wall[(first + 2) % 3]};
  }

  std::vector<std::uint8_t> at_wall_;
  std::vector<std::uint32_t> first_;
  std::vector<Entry> sorted_;
};

}  // namespace

std::optional<WalledRegion> find_walled_region(const Delaunay3& delaunay, const std::vector<Wall>& walls) {
  constexpr std::size_t kChunk = 1 << 12;
  struct Found {
    FacetId inside, outside;
    std::uint32_t wall;
  };
  const WallIndex index(walls, delaunay.vertex_capacity());
  const auto collect = [&](std::size_t begin, std::size_t end, std::vector<Found>& found) {
    for (auto cell = std::max(static_cast<CellId>(begin), Delaunay3::kOutside + 1); cell < end; ++cell) {
      if (delaunay.stamp(cell) == 0) continue;
      for (unsigned facets = index.between_walls(delaunay.vertices(cell)); facets != 0; facets &= facets - 1) {
        const FacetId facet{cell, std::countr_zero(facets)};
        const std::uint32_t wall = index.find(delaunay.vertices(facet));
        if (wall == kNone) continue;
        delaunay.prefetch(delaunay.neighbors(cell)[facet.index]);
        found.push_back({facet, {}, wall});
      }
    }
    for (Found& each : found) each.outside = delaunay.mirror(each.inside);
  };
  const std::vector<Found> found = gather_chunks<Found>(delaunay.cell_capacity(), kChunk, collect);
  if (found.size() != walls.size()) return std::nullopt;

  WalledRegion region;
  region.outside.resize(walls.size());
  constexpr std::uint8_t kInside = 1 << 4;  // beside a bit for each facet that is a wall
  std::vector<std::uint8_t> known(delaunay.cell_capacity(), 0);
  const auto add = [&](CellId cell) {
    if ((known[cell] & kInside) != 0) return;
    known[cell] |= kInside;
    region.cells.push_back(cell);
    delaunay.prefetch(cell);
  };
  for (const auto& [facet, outside, wall] : found) {
    region.outside[wall] = outside;
    known[facet.cell] |= static_cast<std::uint8_t>(1 << facet.index);
    add(facet.cell);
  }
  for (std::size_t next = 0; next < region.cells.size(); ++next) {
    const CellId cell = region.cells[next];
    for (int i = 0; i < 4; ++i) {
      if ((known[cell] >> i & 1) == 0) add(delaunay.neighbors(cell)[i]);
    }
  }
  return region;
}

}  // namespace delvox
