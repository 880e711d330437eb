#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "delaunay/restricted_delaunay.h"
#include "meshing/lattice_tets.h"

namespace delvox {

/// The tets of a lattice that have a deep site, which is one that becomes a vertex along with them, as a triangulation
/// takes them: numbered along the lattice's corners.
class DeepTets {
 public:
  using Site = LatticeTets::Site;

  /// `corners`: in ascending order, all of which such tets lie at. `vertex_of`: of each site that is a corner of such a
  /// tet; deep ones are numbered from `delaunay.vertex_capacity()` on, `labels` are theirs.
  DeepTets(const RestrictedDelaunay& delaunay, const LatticeTets& lattice, const std::vector<Site>& corners,
           std::vector<VertexId> vertex_of, std::vector<Label> labels);

  /// All but the points. Valid as long as this is.
  KnownTets known() const;

 private:
  static constexpr std::uint32_t kAll = (1u << LatticeTets::kPerCorner) - 1;
  struct AtCorner {
    std::uint32_t first = 0;  ///< number of the first of its tets
    std::uint32_t there = 0;  ///< a bit for each that is one of these
  };

  bool is_deep(Site site) const { return vertex_of_[site] >= first_vertex_ && vertex_of_[site] != kNone; }
  int count_deep(const std::array<Site, 4>& sites) const {
    return is_deep(sites[0]) + is_deep(sites[1]) + is_deep(sites[2]) + is_deep(sites[3]);
  }
  KnownTets::Tet tet(std::size_t number) const;
  /// The cell of the tet there; kNone if it is none of these.
  CellId cell_at(LatticeTets::Place place) const {
    const std::uint32_t number = place % LatticeTets::kPerCorner;
    const AtCorner& at = at_corner_[place / LatticeTets::kPerCorner];
    if (at.there == kAll) return first_cell_ + at.first + number;
    if ((at.there >> number & 1) == 0) return kNone;
    return first_cell_ + at.first + static_cast<std::uint32_t>(std::popcount(at.there & ((1u << number) - 1)));
  }

  LatticeTets lattice_;
  std::vector<VertexId> vertex_of_;
  std::vector<Label> labels_;
  VertexId first_vertex_;
  CellId first_cell_;
  std::vector<AtCorner> at_corner_;
  std::vector<LatticeTets::Place> places_;
};

}  // namespace delvox
