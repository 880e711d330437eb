#include "meshing/deep_tets.h"

#include <utility>

#include "core/parallel.h"

namespace delvox {
namespace {

constexpr std::size_t kChunk = 4096;

}  // namespace

DeepTets::DeepTets(const RestrictedDelaunay& delaunay, const LatticeTets& lattice, const std::vector<Site>& corners,
                   std::vector<VertexId> vertex_of, std::vector<Label> labels)
    : lattice_(lattice),
      vertex_of_(std::move(vertex_of)),
      labels_(std::move(labels)),
      first_vertex_(static_cast<VertexId>(delaunay.vertex_capacity())),
      first_cell_(static_cast<CellId>(delaunay.cell_capacity())),
      at_corner_(vertex_of_.size() / 2) {
  const auto collect = [&](std::size_t begin, std::size_t end, std::vector<LatticeTets::Place>& places) {
    for (std::size_t c = begin; c < end; ++c) {
      for (LatticeTets::Place number = 0; number < LatticeTets::kPerCorner; ++number) {
        const LatticeTets::Place place = corners[c] * LatticeTets::kPerCorner + number;
        if (count_deep(lattice_.sites(place)) == 0) continue;
        at_corner_[corners[c]].there |= 1u << number;
        places.push_back(place);
      }
    }
  };
  places_ = gather_chunks<LatticeTets::Place>(corners.size(), kChunk, collect);
  std::uint32_t first = 0;
  for (Site corner : corners) {
    at_corner_[corner].first = first;
    first += static_cast<std::uint32_t>(std::popcount(at_corner_[corner].there));
  }
}

KnownTets::Tet DeepTets::tet(std::size_t number) const {
  KnownTets::Tet tet;
  const std::array<Site, 4> sites = lattice_.sites(places_[number]);
  for (int i = 0; i < 4; ++i) {
    tet.vertices[i] = vertex_of_[sites[i]];
    tet.neighbors[i] = cell_at(lattice_.across(places_[number], i));
    if (tet.vertices[i] >= first_vertex_) tet.label = labels_[tet.vertices[i] - first_vertex_];
  }
  return tet;
}

KnownTets DeepTets::known() const {
  KnownTets known;
  known.count = places_.size();
  known.tet = [this](std::size_t number) { return tet(number); };
  const auto collect = [&](std::size_t begin, std::size_t end, std::vector<FacetId>& inside) {
    for (std::size_t number = begin; number < end; ++number) {
      const std::array<Site, 4> sites = lattice_.sites(places_[number]);
      if (count_deep(sites) > 1) continue;  // beyond a face with a deep site lies another tet with that
      int face = 0;
      while (!is_deep(sites[face])) ++face;
      if (cell_at(lattice_.across(places_[number], face)) != kNone) continue;
      inside.push_back({first_cell_ + static_cast<CellId>(number), face});
    }
  };
  known.inside = gather_chunks<FacetId>(places_.size(), kChunk, collect);
  known.walls.resize(known.inside.size());
  for_each_chunk(known.walls.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t w = begin; w < end; ++w) {
      const std::array<VertexId, 4> vertices = tet(known.inside[w].cell - first_cell_).vertices;
      const auto& face = kTetFaces[known.inside[w].index];
      known.walls[w] = {vertices[face[0]], vertices[face[1]], vertices[face[2]]};
    }
  });
  return known;
}

}  // namespace delvox
