#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "delaunay/restricted_delaunay.h"

namespace delvox {

/// The lazy queues of refinement (book, 14.1.3): entries are not withdrawn when the mesh changes, but tested when their
/// turn comes.
struct RefinementQueues {
  struct WaitingFacet {
    FacetId facet;
    std::uint32_t stamp;
  };
  struct WaitingTet {
    CellId cell;
    std::uint32_t stamp;
  };

  std::vector<WaitingFacet> facets;  ///< that may be restricted; first in, first out from next_facet
  std::size_t next_facet = 0;
  std::vector<WaitingTet> tets;  ///< that break a criterion; last in, first out

  std::size_t facets_waiting() const { return facets.size() - next_facet; }
  std::size_t waiting() const { return facets_waiting() + tets.size(); }
  void append(const RefinementQueues& from) {
    facets.insert(facets.end(), from.facets.begin() + static_cast<std::ptrdiff_t>(from.next_facet), from.facets.end());
    tets.insert(tets.end(), from.tets.begin(), from.tets.end());
  }
  void pop_facet() {
    if (++next_facet < facets.size()) return;
    facets.clear();
    next_facet = 0;
  }
};

/// Vertices, each once, in the order in which they came first.
class VertexList {
 public:
  void add(VertexId vertex) {
    if (vertex >= listed_.size()) listed_.resize(vertex + 1 + vertex / 2, false);
    if (listed_[vertex]) return;
    listed_[vertex] = true;
    list_.push_back(vertex);
  }
  void add(const std::array<VertexId, 3>& triangle) {
    for (VertexId vertex : triangle) add(vertex);
  }
  void clear() {
    for (VertexId vertex : list_) listed_[vertex] = false;
    list_.clear();
  }
  const std::vector<VertexId>& all() const { return list_; }

 private:
  std::vector<VertexId> list_;
  std::vector<bool> listed_;
};

/// The part of `all` that lane `lane` of so many gets.
template <class T>
void take_share(const std::vector<T>& all, std::size_t first, std::size_t lane, std::size_t lanes, std::vector<T>& share) {
  const std::size_t count = all.size() - first;
  const auto at = [&](std::size_t i) { return all.begin() + static_cast<std::ptrdiff_t>(first + count * i / lanes); };
  share.insert(share.end(), at(lane), at(lane + 1));
}

/// All that `from` holds.
template <class T>
void take_over(std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
  from.clear();
}

/// A lane of refinement: its share of the queues, what it is about to do, and what there is to tell of it.
struct RefinementLane {
  struct JudgedFacet {
    RefinementQueues::WaitingFacet waiting;
    SurfaceBall ball;
    bool too_deviant;
    std::array<VertexId, 3> vertices;  ///< its facet may be gone by the time that its ball is to be kept
  };
  struct Change {
    Box3 box;
    VertexId near;
  };

  /// What an insertion is for: the first facet waiting, the last tet, or the next umbrella.
  enum class Purpose { kFacet, kTet, kUmbrella };

  Lane lane;
  RefinementQueues queues;
  std::vector<VertexId> umbrellas;  ///< of these vertices, from next_umbrella on, that may be no disks
  std::size_t next_umbrella = 0;

  // Found by look(), to be done by conclude() if the claims hold.
  std::vector<JudgedFacet> judged;      ///< their balls are to be kept
  std::optional<VertexKind> insertion;  ///< the apex of lane.star is to be inserted as such
  Purpose purpose = Purpose::kFacet;
  double split_radius = 0;              ///< of the ball that is split for an umbrella
  Box3 changing;                        ///< what of the surface the insertion changes

  // For Refinement to collect.
  RefinementQueues aside;  ///< what can only be treated with no other lane beside
  std::vector<RefinementQueues::WaitingFacet> two_faced;
  VertexList dirty;
  std::vector<Change> changes;
  std::vector<VertexId> umbrellas_aside, umbrellas_deferred, umbrellas_unrepaired;
  std::vector<double> radii_for_umbrellas;  ///< of the balls that were split
  std::size_t surface_insertions = 0, interior_insertions = 0, too_deviant = 0, stuck = 0;
  Point3 deviant_place, stuck_place;
};

}  // namespace delvox
