#pragma once

#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include "delaunay/ids.h"
#include "delaunay/small_map.h"
#include "delaunay/star.h"

namespace delvox {

/// Finds the neighbours of a star's tets across the facets at its apex.
class EdgeMatcher {
 public:
  /// Sets Star::Tet::beside and Star::corners. pre: the tets' outer triangles form a closed surface.
  void match(Star& star) {
    name_vertices(star);
    if (star.corners.size() <= kFew) {
      match_by_table(star.tets);
    } else {
      match_by_lists(star.tets);
    }
  }

 private:
  static constexpr std::size_t kFew = 64;
  struct Edge {
    std::uint32_t to, tet;
  };

  /// Numbers the star's vertices from 0: these are its corners.
  void name_vertices(Star& star) {
    known_.clear();
    names_.resize(star.tets.size());
    for (std::uint32_t t = 0; t < star.tets.size(); ++t) {
      for (int i = 0; i < 3; ++i) {
        const VertexId v = star.tets[t].vertices[i];
        names_[t][i] = known_.find_or(v, [&] {
          star.corners.push_back({v, t});
          return static_cast<std::uint32_t>(star.corners.size() - 1);
        });
      }
    }
  }

  /// Every edge is met once in either direction, so that a table of all pairs needs no clearing.
  void match_by_table(std::vector<Star::Tet>& tets) {
    table_.resize(kFew * kFew);
    for (std::uint32_t t = 0; t < tets.size(); ++t) {
      const auto& v = names_[t];
      for (int i = 0; i < 3; ++i) table_[v[(i + 1) % 3] * kFew + v[(i + 2) % 3]] = t;
    }
    for (std::size_t t = 0; t < tets.size(); ++t) {
      const auto& v = names_[t];
      for (int i = 0; i < 3; ++i) tets[t].beside[i] = table_[v[(i + 2) % 3] * kFew + v[(i + 1) % 3]];
    }
  }

  void match_by_lists(std::vector<Star::Tet>& tets) {
    list_edges(tets);
    for (std::size_t t = 0; t < tets.size(); ++t) {
      const auto& v = names_[t];
      for (int i = 0; i < 3; ++i) {
        // The tet beside has the edge in the other direction.
        const Edge* edge = &edges_[first_[v[(i + 2) % 3]]];
        while (edge->to != v[(i + 1) % 3]) ++edge;
        tets[t].beside[i] = edge->tet;
      }
    }
  }

  /// The edges sorted by where they start: those of vertex v begin at first_[v].
  void list_edges(const std::vector<Star::Tet>& tets) {
    // As many edges leave a vertex as there are tets at it.
    first_.assign(1, 0);
    for (const auto& v : names_) {
      for (std::uint32_t name : v) {
        if (name + 2 > first_.size()) first_.resize(name + 2, 0);
        ++first_[name + 1];
      }
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    next_.assign(first_.begin(), first_.end());
    edges_.resize(3 * tets.size());
    for (std::uint32_t t = 0; t < tets.size(); ++t) {
      const auto& v = names_[t];
      for (int i = 0; i < 3; ++i) edges_[next_[v[i]]++] = {v[(i + 1) % 3], t};
    }
  }

  SmallMap known_;                                     // vertices' names
  std::vector<std::array<std::uint32_t, 3>> names_;    // per tet of the star
  std::vector<std::uint32_t> first_, next_;            // per vertex of the star
  std::vector<std::uint32_t> table_;                   // tet of each pair of the star's vertices
  std::vector<Edge> edges_;
};

}  // namespace delvox
