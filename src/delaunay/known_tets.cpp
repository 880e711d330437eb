#include "delaunay/known_tets.h"

#include <algorithm>
#include <atomic>

#include "core/parallel.h"
#include "delaunay/restricted_delaunay.h"

namespace delvox {
namespace {

constexpr std::size_t kChunk = 4096;

}  // namespace

/// The points become vertices without cells, the tets' cells are not in use yet.
void Delaunay3::make_room_for(const KnownTets& known) {
  grow_cells(cell_capacity() + known.count);
  const std::size_t first = vertex_capacity();
  vertices_.grow_to(first + known.points.size());
  claims_.grow_to(vertices_.size());
  for_each_chunk(known.points.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) vertices_[first + i] = {known.points[i], kNone};
  });
  vertex_count_ += known.points.size();
}

/// Of the new cells that several threads bring, a vertex gets the smallest, whatever their order, instead of a larger
/// one or one that is gone.
template <class Gone>
void Delaunay3::offer_cell(VertexId vertex, CellId cell, const Gone& gone) {
  const std::atomic_ref<CellId> known(vertices_[vertex].cell);
  CellId current = known.load(std::memory_order_relaxed);
  while ((cell < current || gone(current)) && !known.compare_exchange_weak(current, cell, std::memory_order_relaxed)) {
  }
}

void Delaunay3::set_known(CellId cell, const KnownTets::Tet& tet, VertexId first_vertex, std::uint32_t stamp) {
  const auto& v = tet.vertices;
  cells_[cell] = {v, tet.neighbors, circumsphere(point(v[0]), point(v[1]), point(v[2]), point(v[3]))};
  stamps_[cell] = stamp;
  for (VertexId vertex : v) {
    if (vertex >= first_vertex) offer_cell(vertex, cell, [](CellId) { return false; });
  }
}

void Delaunay3::put_in_place(const KnownTets& known, const WalledRegion& region) {
  for_each_chunk(region.cells.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) stamps_[region.cells[i]] = 0;
  });
  free_cells_.insert(free_cells_.end(), region.cells.begin(), region.cells.end());
  const auto gone = [&](CellId cell) { return stamps_[cell] == 0; };
  for_each_chunk(known.walls.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t w = begin; w < end; ++w) {
      join(known.inside[w], region.outside[w]);
      for (VertexId v : known.walls[w]) offer_cell(v, known.inside[w].cell, gone);
    }
  });
}

std::optional<std::uint32_t> RestrictedDelaunay::replace(const KnownTets& known) {
  const std::optional<WalledRegion> region = find_walled_region(delaunay_, known.walls);
  if (!region) return std::nullopt;
  lane_.lost.clear();
  for (CellId cell : region->cells) {
    for (int i = 0; i < 4 && balls_.any(cell); ++i) lose_ball({cell, i}, lane_);
  }
  const auto first_cell = static_cast<CellId>(cell_capacity());
  const auto first_vertex = static_cast<VertexId>(vertex_capacity());
  delaunay_.make_room_for(known);
  grow();
  std::fill(kinds_.begin() + first_vertex, kinds_.end(), VertexKind::kInterior);
  const std::uint32_t stamp = new_claim();
  for_each_chunk(known.count, kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const KnownTets::Tet tet = known.tet(t);
      const CellId cell = first_cell + static_cast<CellId>(t);
      delaunay_.set_known(cell, tet, first_vertex, stamp);
      set_label(cell, tet.label);
    }
  });
  delaunay_.put_in_place(known, *region);
  created_.clear();
  for (FacetId facet : known.inside) created_.push_back(facet.cell);
  give_back_room();
  return stamp;
}

}  // namespace delvox
