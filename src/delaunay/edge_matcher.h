#pragma once

#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "delaunay/ids.h"
#include "delaunay/small_map.h"
#include "delaunay/star.h"

namespace delvox {

/// Finds the neighbours of a star's tets across the facets at its apex.
class EdgeMatcher {
 public:
  using Names = std::array<std::uint32_t, 3>;

  /// Sets Star::Tet::beside and Star::corners. pre: the tets' outer triangles form a closed surface.
  void match(Star& star) {
    name_vertices(star);
    if (star.corners.size() <= kFew) {
      match_by_table(star.tets);
    } else {
      match_by_lists(star.tets);
    }
  }

  /// Of each of the star's tets, which of Star::corners its other three vertices are.
  std::span<const Names> names() const { return {names_.begin(), names_.size()}; }

 private:
  static constexpr std::size_t kFew = 64;  // vertices, of at most 124 triangles
  struct Edge {
    std::uint32_t to, tet;
  };

  void name_vertices(Star& star) {
    known_.clear();
    names_.clear();
    names_.make_room(star.tets.size());
    star.corners.make_room(star.tets.size());  // of a closed surface there are never more
    SmallMap::Table known = known_.table_for(0);
    for (std::uint32_t t = 0; t < star.tets.size(); ++t) {
      Names& names = names_.push({});
      for (int i = 0; i < 3; ++i) {
        const VertexId v = star.tets[t].vertices[i];
        SmallMap::Entry& entry = known.place_of(v);
        if (known.known(entry)) {
          names[i] = SmallMap::Table::number(entry);
          continue;
        }
        names[i] = static_cast<std::uint32_t>(star.corners.size());
        entry = known.made(v, names[i]);
        star.corners.push({v, t});
        known = known_.table_for(1);
      }
    }
  }

  /// Every edge is met once in either direction, so that a table of all pairs needs no clearing.
  void match_by_table(Scratch<Star::Tet>& tets) {
    for (std::size_t t = 0; t < tets.size(); ++t) {
      const auto [a, b, c] = names_[t];
      const auto tet = static_cast<std::uint8_t>(t);
      table_[b * kFew + c] = tet;
      table_[c * kFew + a] = tet;
      table_[a * kFew + b] = tet;
    }
    for (std::size_t t = 0; t < tets.size(); ++t) {
      const auto [a, b, c] = names_[t];
      tets[t].beside = {table_[c * kFew + b], table_[a * kFew + c], table_[b * kFew + a]};
    }
  }

  void match_by_lists(Scratch<Star::Tet>& tets) {
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
  void list_edges(const Scratch<Star::Tet>& tets) {
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

  SmallMap known_;            // vertices' names
  Scratch<Names> names_;  // per tet of the star
  std::vector<std::uint32_t> first_, next_;        // per vertex of the star
  std::array<std::uint8_t, kFew * kFew> table_{};  // tet of each pair of the star's vertices
  std::vector<Edge> edges_;
};

}  // namespace delvox
