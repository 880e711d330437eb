#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "delaunay/ids.h"
#include "delaunay/star.h"

namespace delvox {

/// Finds the neighbours of a star's tets across the facets at its apex.
class EdgeMatcher {
 public:
  /// Sets Star::Tet::beside. pre: the tets' outer triangles form a closed surface.
  void match(std::vector<Star::Tet>& tets) {
    name_vertices(tets);
    if (degrees_.size() <= kFew) {
      match_by_table(tets);
    } else {
      match_by_lists(tets);
    }
  }

 private:
  static constexpr std::size_t kFew = 64;
  struct Known {
    std::uint32_t round = 0, name = 0;
  };
  struct Edge {
    std::uint32_t to, tet;
  };

  /// Numbers the star's vertices from 0, and counts the edges that leave each.
  void name_vertices(const std::vector<Star::Tet>& tets) {
    if (++round_ == 0) known_.assign(known_.size(), {}), round_ = 1;
    names_.resize(tets.size());
    degrees_.clear();
    for (std::size_t t = 0; t < tets.size(); ++t) {
      for (int i = 0; i < 3; ++i) {
        const VertexId v = tets[t].vertices[i];
        if (v >= known_.size()) known_.resize(v + v / 2 + 1);
        if (known_[v].round != round_) {
          known_[v] = {round_, static_cast<std::uint32_t>(degrees_.size())};
          degrees_.push_back(0);
        }
        names_[t][i] = known_[v].name;
        ++degrees_[known_[v].name];
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
    first_.assign(1, 0);
    for (std::uint32_t degree : degrees_) first_.push_back(first_.back() + degree);
    next_.assign(first_.begin(), first_.end());
    edges_.resize(3 * tets.size());
    for (std::uint32_t t = 0; t < tets.size(); ++t) {
      const auto& v = names_[t];
      for (int i = 0; i < 3; ++i) edges_[next_[v[i]]++] = {v[(i + 1) % 3], t};
    }
  }

  std::vector<Known> known_;                           // per vertex of the triangulation
  std::vector<std::array<std::uint32_t, 3>> names_;    // per tet of the star
  std::vector<std::uint32_t> degrees_, first_, next_;  // per vertex of the star
  std::vector<std::uint32_t> table_;                   // tet of each pair of the star's vertices
  std::vector<Edge> edges_;
  std::uint32_t round_ = 0;
};

}  // namespace delvox
