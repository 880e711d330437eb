#include "meshing/umbrella.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>
#include <span>
#include <utility>

#include "core/page_array.h"
#include "core/parallel.h"
#include "core/take_turns.h"
#include "delaunay/restricted_triangles.h"

namespace delvox {
namespace {

using LinkEdge = std::array<VertexId, 2>;

/// The edge of a triangle that lies opposite a corner, directed as the triangle is.
LinkEdge opposite(const std::array<VertexId, 3>& triangle, int corner) {
  return {triangle[(corner + 1) % 3], triangle[(corner + 2) % 3]};
}

/// Do the edges, each directed as its triangle is, form exactly one cycle? There are few: looking through all for the
/// next is faster than sorting them.
bool is_one_cycle(std::span<const LinkEdge> edges) {
  if (edges.empty()) return true;
  VertexId current = edges[0][0];
  std::size_t length = 0;
  do {
    const LinkEdge* next = nullptr;
    for (const LinkEdge& edge : edges) {
      if (edge[0] != current) continue;
      if (next != nullptr) return false;
      next = &edge;
    }
    if (next == nullptr || ++length > edges.size()) return false;
    current = (*next)[1];
  } while (current != edges[0][0]);
  return length == edges.size();
}

/// visit(facet, link edge) for each restricted triangle at a vertex, once.
template <class Visit>
void for_each_triangle_at(const RestrictedDelaunay& delaunay, VertexId vertex, const Visit& visit) {
  for (CellId cell : delaunay.incident_cells(vertex)) {
    const Label label = delaunay.label(cell);
    if (label == 0) continue;
    const auto& corners = delaunay.vertices(cell);
    for (int i = 0; i < 4; ++i) {
      // Each facet is met from both of its cells: take it from the one with the larger label.
      if (corners[i] == vertex || label <= delaunay.label(delaunay.neighbors(cell)[i])) continue;
      const auto triangle = delaunay.vertices(FacetId{cell, i});
      const auto own = std::find(triangle.begin(), triangle.end(), vertex) - triangle.begin();
      visit(FacetId{cell, i}, opposite(triangle, static_cast<int>(own)));
    }
  }
}

/// The restricted triangles at each vertex, in any order: of their corners, each knows the next at the same vertex. Held
/// by their vertices: to ask the cells again would be to wait for memory.
class TrianglesAt {
 public:
  explicit TrianglesAt(const RestrictedDelaunay& delaunay) : first_(delaunay.vertex_capacity(), kNone) {
    constexpr std::size_t kChunk = 1 << 13;
    const auto collect = [&](std::size_t begin, std::size_t end, std::vector<Corners>& found) {
      for_each_triangle_with_ball(delaunay, begin, end, [&](FacetId f) { found.push_back(delaunay.vertices(f)); });
    };
    triangles_ = gather_chunks<Corners>(delaunay.cell_capacity(), kChunk, collect);
    next_.grow_to(3 * triangles_.size());
    const bool alone = works_alone();  // the processor has to be asked for nothing special then
    for_each_chunk(triangles_.size(), kChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
          const auto corner = static_cast<std::uint32_t>(3 * t + k);
          std::uint32_t& first = first_[triangles_[t][k]];
          next_[corner] = alone ? std::exchange(first, corner)
                                : std::atomic_ref(first).exchange(corner, std::memory_order_relaxed);
        }
      }
    });
  }

  /// Gathers the link of a vertex, a triangle at a time.
  class Walk {
   public:
    static constexpr std::size_t kMost = 24;

    Walk(const TrianglesAt& all, VertexId vertex) : all_(&all), corner_(all.first_[vertex]) { look_ahead(); }
    /// False if there are no more triangles, or too many.
    bool next() {
      if (corner_ == kNone || count_ == kMost) return false;
      link_[count_++] = opposite(all_->triangles_[corner_ / 3], static_cast<int>(corner_ % 3));
      corner_ = all_->next_[corner_];
      look_ahead();
      return true;
    }
    bool too_many() const { return corner_ != kNone; }
    std::span<const LinkEdge> link() const { return {link_.data(), count_}; }

   private:
    void look_ahead() const {
      if (corner_ == kNone) return;
      __builtin_prefetch(&all_->triangles_[corner_ / 3]);
      all_->next_.prefetch(corner_);
    }
    const TrianglesAt* all_;
    std::uint32_t corner_;
    std::size_t count_ = 0;
    std::array<LinkEdge, kMost> link_;
  };

 private:
  using Corners = std::array<VertexId, 3>;
  std::vector<Corners> triangles_;
  std::vector<std::uint32_t> first_;
  PageArray<std::uint32_t> next_;  // PageArray: its pages go back at once
};

std::vector<VertexId> by_walks_around(const RestrictedDelaunay& delaunay, const std::vector<VertexId>& vertices) {
  constexpr std::size_t kChunk = 256, kVertices = 8, kCells = 4;
  return gather_chunks<VertexId>(vertices.size(), kChunk, [&](std::size_t begin, std::size_t end, auto& found) {
    std::vector<LinkEdge> link;
    for (std::size_t i = begin; i < end; ++i) {
      if (i + kVertices < end) delaunay.prefetch_vertex(vertices[i + kVertices]);
      if (i + kCells < end) delaunay.prefetch(delaunay.cell_of(vertices[i + kCells]));
      link.clear();
      for_each_triangle_at(delaunay, vertices[i], [&](FacetId, const LinkEdge& edge) { link.push_back(edge); });
      if (!is_one_cycle(link)) found.push_back(vertices[i]);
    }
  });
}

std::vector<VertexId> by_a_sweep(const RestrictedDelaunay& delaunay, const std::vector<VertexId>& vertices) {
  constexpr std::size_t kChunk = 1024;
  struct Turn {
    std::size_t number;
    TrianglesAt::Walk walk;
  };
  const TrianglesAt triangles(delaunay);
  return gather_chunks<VertexId>(vertices.size(), kChunk, [&](std::size_t begin, std::size_t end, auto& found) {
    std::vector<std::size_t> broken;
    const auto start = [&](std::size_t n) {
      return std::optional(Turn{begin + n, TrianglesAt::Walk(triangles, vertices[begin + n])});
    };
    const auto step = [&](Turn& turn) {
      if (turn.walk.next()) return true;
      const bool disk = turn.walk.too_many() ? find_umbrella(delaunay, vertices[turn.number]).disk
                                             : is_one_cycle(turn.walk.link());
      if (!disk) broken.push_back(turn.number);
      return false;
    };
    take_turns(end - begin, start, step);
    std::sort(broken.begin(), broken.end());
    for (std::size_t number : broken) found.push_back(vertices[number]);
  });
}

}  // namespace

Umbrella find_umbrella(const RestrictedDelaunay& delaunay, VertexId vertex) {
  Umbrella umbrella;
  std::vector<LinkEdge> link;
  for_each_triangle_at(delaunay, vertex, [&](FacetId facet, const LinkEdge& edge) {
    umbrella.facets.push_back(facet);
    link.push_back(edge);
  });
  umbrella.disk = is_one_cycle(link);
  return umbrella;
}

std::vector<VertexId> without_disk(const RestrictedDelaunay& delaunay, const std::vector<VertexId>& vertices) {
  constexpr std::size_t kSweepPays = 14;  // a sweep costs about as much as walking around a vertex in so many
  return vertices.size() * kSweepPays < delaunay.vertex_capacity() ? by_walks_around(delaunay, vertices)
                                                                   : by_a_sweep(delaunay, vertices);
}

}  // namespace delvox
