#include "oracle/surface_crossings.h"

#include <algorithm>
#include <cassert>

#include "core/parallel.h"

namespace delvox {
namespace {

using Index3 = std::array<int, 3>;
using Word = BrickEdges::Word;
constexpr int kBrick = BrickField::kBrick, kBlock = BrickField::kBlock, kBlockSize = BrickField::kBlockSize;
constexpr auto& kStride = BrickField::kBlockStride;

/// Beginnings of edges that lie in the first (last) plane of samples of a word, across axes 0 and 1.
constexpr Word kFirst[2] = {0x0101010101010101ull, 0xffull}, kLast[2] = {kFirst[0] << 7, kFirst[1] << 56};

/// Place of a bit of a layer among the samples of a block.
int place_of(int layer, int bit) {
  return layer * kBlock * kBlock + bit + bit / kBrick;
}

/// A union-find whose roots are the smallest of their sets.
template <class Number>
Number find_root(Number* parent, Number i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}
template <class Number>
void unite(Number* parent, Number a, Number b) {
  a = find_root(parent, a);
  b = find_root(parent, b);
  if (a < b) {
    parent[b] = a;
  } else {
    parent[a] = b;
  }
}

/// The pieces of the isosurface in one layer of bricks.
struct LayerPieces {
  std::vector<std::uint32_t> in_brick, of_crossing;  ///< as SurfaceComponents has them, pieces for components
  std::vector<std::uint32_t> parent;                 ///< union-find over the pieces
  std::vector<SurfaceComponents::Component> extents;
  std::vector<std::uint32_t> lower, upper;  ///< pieces of the crossed edges in the planes below and above, in one order
};

/// Joins crossings to pieces within each brick, then pieces across brick faces. A face of the grid, like an edge,
/// belongs to the brick of its lowest sample; edges that it borrows of the next brick get pieces here as well, which
/// are handed on to that brick, or, above, to whoever joins layers.
class LayerFinder {
 public:
  explicit LayerFinder(const BrickField& field) : field_(field), level_(field.level()) {
    handed_[0].resize(1);
    handed_[1].resize(static_cast<std::size_t>(field.brick_counts()[0]));
  }

  LayerPieces run(int layer) {
    field_.for_each_mixed_brick(layer, [&](const Index3& brick) { visit_brick(brick); });
    return std::move(result_);
  }

 private:
  using Local = std::uint16_t;
  /// Pieces of the edges along the two other axes in a plane between bricks.
  using Plane = std::array<std::uint32_t, 2 * kBrick * kBrick>;

  void visit_brick(const Index3& brick) {
    const BrickEdges edges(field_, brick);
    const float* block = field_.block(brick);
    count_ = 0;
    edges.for_each_crossed([&](int layer, int axis, int bit) { add_edge(axis, place_of(layer, bit)); });
    const Local own = count_;
    for (int side = 0; side < 3; ++side) {
      for_each_on_side<true>(edges, side, [&](int axis, int place, int) { add_edge(axis, place); });
    }
    for (int normal = 0; normal < 3; ++normal) {
      for (int layer = 0; layer < kBrick; ++layer) join_layer(edges, block, normal, layer);
    }
    number_pieces(own);
    add_extents(brick, edges);
    exchange_planes(brick, edges);
  }

  void add_edge(int axis, int place) {
    edge_at_[axis][place] = count_;
    parent_[count_] = count_;
    ++count_;
  }

  /// Calls visit(axis, place, number in the plane) for the crossed edges in the lower or upper plane of the brick
  /// across an axis.
  template <bool kUpper, class Visit>
  static void for_each_on_side(const BrickEdges& edges, int side, const Visit& visit) {
    const int first = side == 2 && kUpper ? kBrick - 1 : 0, end = side == 2 && !kUpper ? 1 : kBrick;
    const Word mask = side == 2 ? ~Word{0} : kUpper ? kLast[side] : kFirst[side];
    for (int turn = 0; turn < 2; ++turn) {
      const int axis = (side + 1 + turn) % 3;
      for (int layer = first; layer < end; ++layer) {
        BrickEdges::for_each_bit(edges.crossed(axis, kUpper ? 1 << side : 0, layer) & mask, [&](int bit) {
          const int i = bit % kBrick, j = bit / kBrick;
          const int number = side == 0 ? layer * kBrick + j : side == 1 ? layer * kBrick + i : bit;
          visit(axis, place_of(layer, bit) + (kUpper ? kStride[side] : 0), turn * kBrick * kBrick + number);
        });
      }
    }
  }

  /// Faces of one direction whose lowest samples lie in one layer: corners a, b = a + u, c = a + u + v, d = a + v.
  void join_layer(const BrickEdges& edges, const float* block, int normal, int layer) {
    const int u = (normal + 1) % 3, v = (normal + 2) % 3;
    const Word a = edges.inside(0, layer), b = edges.inside(1 << u, layer);
    const Word c = edges.inside(1 << u | 1 << v, layer), d = edges.inside(1 << v, layer);
    const std::array<Word, 4> crossed{a ^ b, b ^ c, c ^ d, d ^ a};
    const Word all_four = crossed[0] & crossed[1] & crossed[2];
    const std::array<Local*, 4> edge{edge_at_[u].data(), edge_at_[v].data() + kStride[u],
                                     edge_at_[u].data() + kStride[v], edge_at_[v].data()};
    // Elsewhere none are crossed, or two.
    BrickEdges::for_each_bit((crossed[0] | crossed[1] | crossed[2]) & ~all_four, [&](int bit) {
      const int place = place_of(layer, bit);
      std::array<Local, 3> two;  // and one to write to; without branches, as which they are cannot be foreseen
      std::size_t found = 0;
      for (int i = 0; i < 4; ++i) {
        two[found] = edge[i][place];
        found += crossed[i] >> bit & 1;
      }
      unite(parent_.data(), two[0], two[1]);
    });
    BrickEdges::for_each_bit(all_four, [&](int bit) {
      const int place = place_of(layer, bit);
      const float* p = block + place;
      // Corner i lies between edges i-1 and i. The curves cut off the corners of the side that the saddle is not on.
      const double saddle = (p[0] - level_) * (p[kStride[u] + kStride[v]] - level_) -
                            (p[kStride[u]] - level_) * (p[kStride[v]] - level_);  // > 0: on the side of a and c
      const bool cut_off_even = saddle < 0 || (saddle == 0 && p[0] > level_);     // at the level counts as outside
      for (int corner = cut_off_even ? 0 : 1; corner < 4; corner += 2) {
        unite(parent_.data(), edge[(corner + 3) % 4][place], edge[corner][place]);
      }
    });
  }

  /// Numbers the pieces of the brick behind those of all bricks before.
  void number_pieces(Local own) {
    std::vector<std::uint32_t>& pieces = result_.parent;
    for (Local edge = 0; edge < count_; ++edge) {
      const Local root = find_root(parent_.data(), edge);
      if (root == edge) pieces.push_back(static_cast<std::uint32_t>(pieces.size()));
      piece_of_[edge] = root == edge ? pieces.back() : piece_of_[root];
    }
    result_.in_brick.push_back(own);
    result_.of_crossing.insert(result_.of_crossing.end(), piece_of_.begin(), piece_of_.begin() + own);
    result_.extents.resize(pieces.size());
  }

  void add_extents(const Index3& brick, const BrickEdges& edges) {
    const std::uint32_t* piece = piece_of_.data();
    for_each_crossed_edge(field_, brick, edges, [&](const CrossedEdge& edge) {
      SurfaceComponents::Component& extent = result_.extents[*piece++];
      extent.box.extend(edge.point(level_));
      ++extent.crossings;
    });
  }

  /// Joins the pieces to those that the bricks before found of the same edges, and leaves word for the bricks to come.
  void exchange_planes(const Index3& brick, const BrickEdges& edges) {
    const std::array<Plane*, 2> planes{&handed_[0][0], &handed_[1][brick[0]]};
    for (int side = 0; side < 2; ++side) {
      Plane& plane = *planes[side];
      for_each_on_side<false>(edges, side, [&](int axis, int place, int number) {
        unite(result_.parent.data(), piece_of_[edge_at_[axis][place]], plane[number]);
      });
      for_each_on_side<true>(
          edges, side, [&](int axis, int place, int number) { plane[number] = piece_of_[edge_at_[axis][place]]; });
    }
    for_each_on_side<false>(
        edges, 2, [&](int axis, int place, int) { result_.lower.push_back(piece_of_[edge_at_[axis][place]]); });
    for_each_on_side<true>(
        edges, 2, [&](int axis, int place, int) { result_.upper.push_back(piece_of_[edge_at_[axis][place]]); });
  }

  const BrickField& field_;
  double level_;
  LayerPieces result_;

  // Of the brick under way.
  Local count_ = 0;
  std::array<std::array<Local, kBlockSize>, 3> edge_at_{};  // by axis and beginning; read only where crossed
  std::array<Local, 3 * kBlockSize> parent_{};
  std::array<std::uint32_t, 3 * kBlockSize> piece_of_{};

  std::array<std::vector<Plane>, 2> handed_;  // across an axis, to the next brick along it
};

/// Joins the layers' pieces to components.
class LayerJoiner {
 public:
  /// The next layer up.
  void add(const LayerPieces& layer) {
    const auto first = static_cast<std::uint32_t>(parent_.size());
    for (std::uint32_t parent : layer.parent) parent_.push_back(first + parent);
    for (std::uint32_t piece : layer.of_crossing) result_.of_crossing.push_back(first + piece);
    result_.in_brick.insert(result_.in_brick.end(), layer.in_brick.begin(), layer.in_brick.end());
    extents_.insert(extents_.end(), layer.extents.begin(), layer.extents.end());
    // Of edges in the plane between, which the bricks on both sides have.
    assert(layer.lower.size() == below_.size());
    for (std::size_t edge = 0; edge < layer.lower.size(); ++edge) {
      unite(parent_.data(), first + layer.lower[edge], below_[edge]);
    }
    below_.clear();
    for (std::uint32_t piece : layer.upper) below_.push_back(first + piece);
  }

  SurfaceComponents finish() {
    std::vector<std::uint32_t> number(parent_.size());
    for (std::uint32_t piece = 0; piece < parent_.size(); ++piece) {
      const std::uint32_t root = find_root(parent_.data(), piece);
      if (root == piece) {
        number[piece] = static_cast<std::uint32_t>(result_.components.size());
        result_.components.push_back(extents_[piece]);
        continue;
      }
      number[piece] = number[root];
      SurfaceComponents::Component& whole = result_.components[number[root]];
      const SurfaceComponents::Component& part = extents_[piece];
      whole.crossings += part.crossings;
      if (part.box.empty()) continue;
      whole.box.extend(part.box.min);
      whole.box.extend(part.box.max);
    }
    for (std::uint32_t& component : result_.of_crossing) component = number[component];
    return std::move(result_);
  }

 private:
  SurfaceComponents result_;
  std::vector<std::uint32_t> parent_;  // union-find over the pieces of all layers
  std::vector<SurfaceComponents::Component> extents_;
  std::vector<std::uint32_t> below_;  // pieces of the crossed edges in the plane above the last layer
};

}  // namespace

SurfaceComponents find_components(const BrickField& field, const GoOn& go_on) {
  // Few layers at a time where they are large: it is asked between batches, by this thread.
  constexpr std::size_t kBricksPerBatch = 1 << 15, kFewest = 2, kMost = 8;
  const auto& counts = field.brick_counts();
  const auto layers = static_cast<std::size_t>(counts[2]), in_layer = static_cast<std::size_t>(counts[0]) * counts[1];
  const std::size_t at_a_time = std::clamp(kBricksPerBatch / in_layer, kFewest, kMost);
  LayerJoiner joiner;
  for (std::size_t first = 0; first < layers; first += at_a_time) {
    const auto batch = map_chunks(std::min(at_a_time, layers - first), 1, [&](std::size_t n, std::size_t) {
      return LayerFinder(field).run(static_cast<int>(first + n));
    });
    for (const LayerPieces& layer : batch) {
      for (std::size_t brick = 0; brick < layer.in_brick.size(); ++brick) go_on();
      joiner.add(layer);
    }
  }
  return joiner.finish();
}

}  // namespace delvox
