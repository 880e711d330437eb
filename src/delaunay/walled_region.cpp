#include "delaunay/walled_region.h"

#include <algorithm>
#include <atomic>
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

/// A wall and what lies on its two sides.
struct WallPlace {
  FacetId inside, outside;
  std::uint32_t wall;
};

constexpr std::size_t kChunk = 1 << 12;

std::vector<WallPlace> find_places(const Delaunay3& delaunay, const std::vector<Wall>& walls) {
  const WallIndex index(walls, delaunay.vertex_capacity());
  return gather_chunks<WallPlace>(
      delaunay.cell_capacity(), kChunk, [&](std::size_t begin, std::size_t end, auto& found) {
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
        for (WallPlace& each : found) each.outside = delaunay.mirror(each.inside);
      });
}

/// The cells between walls, by several threads, each of which floods its part from the walls on.
class Flood {
 public:
  Flood(const Delaunay3& delaunay, const std::vector<WallPlace>& places)
      : delaunay_(delaunay), places_(places), known_(delaunay.cell_capacity(), 0) {}

  std::vector<CellId> run() {
    constexpr std::size_t kWalls = 256;
    for_each_chunk(places_.size(), kChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const FacetId facet = places_[i].inside;
        of(facet.cell).fetch_or(static_cast<std::uint8_t>(1 << facet.index), std::memory_order_relaxed);
      }
    });
    for_each_chunk(places_.size(), kWalls, [&](std::size_t begin, std::size_t end) { flood_from(begin, end); });
    return gather_chunks<CellId>(known_.size(), kChunk, [&](std::size_t begin, std::size_t end, auto& cells) {
      for (auto cell = static_cast<CellId>(begin); cell < end; ++cell) {
        if ((known_[cell] & kInside) != 0) cells.push_back(cell);
      }
    });
  }

 private:
  static constexpr std::uint8_t kInside = 1 << 4;  // beside a bit for each facet that is a wall

  void flood_from(std::size_t begin, std::size_t end) {
    std::vector<CellId> entered;
    const auto enter = [&](CellId cell) {
      if ((of(cell).load(std::memory_order_relaxed) & kInside) != 0) return;
      if ((of(cell).fetch_or(kInside, std::memory_order_relaxed) & kInside) != 0) return;
      entered.push_back(cell);
      delaunay_.prefetch(cell);
    };
    for (std::size_t i = begin; i < end; ++i) enter(places_[i].inside.cell);
    for (std::size_t next = 0; next < entered.size(); ++next) {
      const CellId cell = entered[next];
      const std::uint8_t walls = of(cell).load(std::memory_order_relaxed);
      for (int i = 0; i < 4; ++i) {
        if ((walls >> i & 1) == 0) enter(delaunay_.neighbors(cell)[i]);
      }
    }
  }

  std::atomic_ref<std::uint8_t> of(CellId cell) { return std::atomic_ref(known_[cell]); }

  const Delaunay3& delaunay_;
  const std::vector<WallPlace>& places_;
  std::vector<std::uint8_t> known_;
};

}  // namespace

std::optional<WalledRegion> find_walled_region(const Delaunay3& delaunay, const std::vector<Wall>& walls) {
  const std::vector<WallPlace> places = find_places(delaunay, walls);
  if (places.size() != walls.size()) return std::nullopt;
  WalledRegion region;
  region.outside.resize(walls.size());
  for (const WallPlace& place : places) region.outside[place.wall] = place.outside;
  region.cells = Flood(delaunay, places).run();
  return region;
}

}  // namespace delvox
