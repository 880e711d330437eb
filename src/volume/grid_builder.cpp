#include "volume/grid_builder.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "delvox/core/errors.h"
#include "delvox/volume/volume_source.h"

namespace delvox {
namespace {

using openvdb::Coord;
using Leaf = openvdb::FloatTree::LeafNodeType;
constexpr int kLeaf = 8;
static_assert(Leaf::DIM == kLeaf && kSlabSlices == kLeaf);
constexpr float kBackground = 0;

/// Of a leaf's samples, k is the fastest.
constexpr int leaf_offset(int i, int j, int k) { return (i * kLeaf + j) * kLeaf + k; }

/// Whether indices of brick b along an axis reach beyond the n voxels.
bool reaches_padding(int b, int n) { return b == 0 || b * kLeaf + kLeaf - 1 >= n; }

void widen(float* low, float* high, const float* row, int n) {
  for (int i = 0; i < n; ++i) {
    low[i] = row[i] < low[i] ? row[i] : low[i];
    high[i] = row[i] > high[i] ? row[i] : high[i];
  }
}

/// As tools::copyFromDense has it: what equals the background is inactive.
void activate(Leaf& leaf) {
  Leaf::NodeMaskType mask;
  const float* values = leaf.buffer().data();
  for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) {
    if (values[n] != kBackground) mask.setOn(n);
  }
  leaf.setValueMask(mask);
}

/// The voxels from `low` on, `size` of them, of a leaf's samples or all of a tile's value, into an array of the extents
/// `row` and `slice`, i fastest.
void copy_part(const float* values, float tile, const std::array<int, 3>& low, const std::array<int, 3>& size,
               std::size_t row, std::size_t slice, float* out) {
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      float* to = out + slice * k + row * j;
      if (values == nullptr) {
        std::fill_n(to, size[0], tile);
        continue;
      }
      const float* from = values + leaf_offset(low[0], low[1] + j, low[2] + k);
      if (size[0] == kLeaf) {  // as most are: unrolled
        for (int i = 0; i < kLeaf; ++i) to[i] = from[leaf_offset(i, 0, 0)];
      } else {
        for (int i = 0; i < size[0]; ++i) to[i] = from[leaf_offset(i, 0, 0)];
      }
    }
  }
}

}  // namespace

struct GridBuilder::Stored {
  std::unique_ptr<Leaf> leaf;
  float tile = kBackground;  // without a leaf
};

void check_header(const VolumeHeader& header) {
  for (int n : header.dims) {
    if (n < 1) throw InputError("volume: a dimension is below 1; check the header");
  }
  const Affine3& affine = header.index_to_world;
  for (const auto& row : affine.rows) {
    for (double entry : row) {
      if (!std::isfinite(entry)) throw InputError("volume: the affine is not finite; check spacing and origin");
    }
  }
  const double volume_of_unit_columns =
      affine.determinant() / (norm(affine.column(0)) * norm(affine.column(1)) * norm(affine.column(2)));
  if (!(std::abs(volume_of_unit_columns) > 1e-6)) {
    throw InputError("volume: the affine is singular; check spacing and direction");
  }
  try {
    to_openvdb_transform(affine);
  } catch (const openvdb::ArithmeticError&) {
    // OpenVDB calls every determinant below 3e-15 singular, whatever the shape.
    throw InputError("volume: the voxels are below 3e-15 mm^3, too small for OpenVDB; state lengths in a larger unit");
  }
}

GridBuilder::GridBuilder(VolumeHeader header, const std::optional<LevelSet>& level_set)
    : level_set_(level_set), impl_(std::make_shared<Volume::Impl>()), dims_(header.dims) {
  check_header(header);
  initialize_openvdb();
  for (int axis = 0; axis < 3; ++axis) {
    leaves_[axis] = (dims_[axis] - 1) / kLeaf + 1;
    bricks_[axis] = dims_[axis] / kLeaf + 1;
  }
  const std::size_t area = static_cast<std::size_t>(bricks_[0]) * bricks_[1];
  below_.assign(area, Brick::kMixed);
  above_.assign(area, Brick::kMixed);
  row_low_.assign(bricks_[1], std::numeric_limits<float>::infinity());
  row_high_.assign(bricks_[1], -std::numeric_limits<float>::infinity());
  impl_->header = std::move(header);
  impl_->grid = openvdb::FloatGrid::create(kBackground);
  impl_->grid->setName("density");
  impl_->grid->setTransform(to_openvdb_transform(impl_->header.index_to_world));
  if (!level_set_) return;
  // Where the background is outside, what lies far outside need not be stored at all.
  inside_value_ = level_set_->nearest(true);
  outside_value_ = level_set_->inside(kBackground) ? level_set_->nearest(false) : kBackground;
}

void GridBuilder::add(const float* samples, int slices) {
  const Slab slab{samples, slices};
  survey(slab);
  if (last_.samples != nullptr) store(last_);
  below_.swap(above_);
  last_ = slab;
  ++layer_;
  if (layer_ == leaves_[2]) store_top();
}

void GridBuilder::store_top() {
  if (bricks_[2] > leaves_[2]) {
    survey({});  // bricks of the last slice and padding
  } else {
    above_ = below_;
  }
  store(last_);
}

std::shared_ptr<Volume::Impl> GridBuilder::finish() {
  impl_->min = *std::min_element(row_low_.begin(), row_low_.end());
  impl_->max = *std::max_element(row_high_.begin(), row_high_.end());
  return std::move(impl_);
}

void GridBuilder::survey(const Slab& slab) {
  tbb::parallel_for(0, bricks_[1], [&](int brick_j) { survey_row(slab, brick_j); });
}

void GridBuilder::survey_row(const Slab& slab, int brick_j) {
  const int n = dims_[0];
  std::vector<float> low(n, std::numeric_limits<float>::infinity()), high(n, -std::numeric_limits<float>::infinity());
  const int begin_j = std::max(brick_j * kLeaf - 1, 0), end_j = std::min((brick_j + 1) * kLeaf, dims_[1]);
  const auto widen_slice = [&](const float* slice) {
    for (int j = begin_j; j < end_j; ++j) {
      widen(low.data(), high.data(), slice + static_cast<std::size_t>(j) * n, n);
    }
  };
  const std::size_t area = static_cast<std::size_t>(n) * dims_[1];
  if (last_.samples != nullptr) widen_slice(last_.samples + (last_.slices - 1) * area);
  for (int k = 0; k < slab.slices; ++k) widen_slice(slab.samples + k * area);
  row_low_[brick_j] = std::min(row_low_[brick_j], *std::min_element(low.begin(), low.end()));
  row_high_[brick_j] = std::max(row_high_[brick_j], *std::max_element(high.begin(), high.end()));
  if (!level_set_) return;  // all bricks stay mixed
  const bool row_in_padding = reaches_padding(brick_j, dims_[1]) || reaches_padding(layer_, dims_[2]);
  for (int brick_i = 0; brick_i < bricks_[0]; ++brick_i) {
    const int begin_i = std::max(brick_i * kLeaf - 1, 0), end_i = std::min((brick_i + 1) * kLeaf, n);
    above_[static_cast<std::size_t>(brick_j) * bricks_[0] + brick_i] =
        classify(*std::min_element(&low[begin_i], low.data() + end_i),
                 *std::max_element(&high[begin_i], high.data() + end_i), row_in_padding || reaches_padding(brick_i, n));
  }
}

GridBuilder::Brick GridBuilder::classify(float low, float high, bool in_padding) const {
  const float most = level_set_->sign > 0 ? high : -low, least = level_set_->sign > 0 ? low : -high;
  if (!level_set_->inside(most)) return Brick::kOutside;
  return level_set_->inside(least) && !in_padding ? Brick::kInside : Brick::kMixed;  // padding is outside
}

/// Mixed if one of the bricks that the leaf touches is: those from its own upwards along each axis.
GridBuilder::Brick GridBuilder::of_leaf(int leaf_i, int leaf_j) const {
  const Brick first = below_[static_cast<std::size_t>(leaf_j) * bricks_[0] + leaf_i];
  for (int j = leaf_j; j <= std::min(leaf_j + 1, bricks_[1] - 1); ++j) {
    for (int i = leaf_i; i <= std::min(leaf_i + 1, bricks_[0] - 1); ++i) {
      const std::size_t brick = static_cast<std::size_t>(j) * bricks_[0] + i;
      if (below_[brick] != first || above_[brick] != first) return Brick::kMixed;
    }
  }
  return first;
}

GridBuilder::Stored GridBuilder::make_leaf(const Slab& slab, int leaf_i, int leaf_j) const {
  const Brick brick = of_leaf(leaf_i, leaf_j);
  if (brick != Brick::kMixed) return {nullptr, brick == Brick::kInside ? inside_value_ : outside_value_};
  const int i0 = leaf_i * kLeaf, j0 = leaf_j * kLeaf;
  const int size_i = std::min(kLeaf, dims_[0] - i0), size_j = std::min(kLeaf, dims_[1] - j0);
  const std::size_t row = dims_[0], area = row * dims_[1];
  const float* corner = slab.samples + j0 * row + i0;
  bool uniform = size_i * size_j * slab.slices == static_cast<int>(Leaf::SIZE);
  for (int k = 0; uniform && k < kLeaf; ++k) {
    for (int j = 0; uniform && j < kLeaf; ++j) {
      const float* from = corner + k * area + j * row;
      uniform = std::all_of(from, from + kLeaf, [corner](float sample) { return sample == *corner; });
    }
  }
  if (uniform) return {nullptr, *corner};
  auto leaf = std::make_unique<Leaf>(Coord(i0, j0, (layer_ - 1) * kLeaf), kBackground, false);
  float* values = leaf->buffer().data();
  for (int k = 0; k < slab.slices; ++k) {
    for (int j = 0; j < size_j; ++j) {
      const float* from = corner + k * area + j * row;
      for (int i = 0; i < size_i; ++i) values[leaf_offset(i, j, k)] = from[i];
    }
  }
  activate(*leaf);
  return {std::move(leaf), 0};
}

void GridBuilder::store(const Slab& slab) {
  std::vector<Stored> stored(static_cast<std::size_t>(leaves_[0]) * leaves_[1]);
  tbb::parallel_for(0, leaves_[1], [&](int j) {
    for (int i = 0; i < leaves_[0]; ++i) {
      stored[static_cast<std::size_t>(j) * leaves_[0] + i] = make_leaf(slab, i, j);
    }
  });
  auto accessor = impl_->grid->getAccessor();
  for (std::size_t n = 0; n < stored.size(); ++n) {
    if (stored[n].leaf) {
      accessor.addLeaf(stored[n].leaf.release());
    } else if (stored[n].tile != kBackground) {
      const int i = static_cast<int>(n % leaves_[0]), j = static_cast<int>(n / leaves_[0]);
      accessor.addTile(1, Coord(i * kLeaf, j * kLeaf, (layer_ - 1) * kLeaf), stored[n].tile, true);
    }
  }
}

void copy_voxels(const openvdb::FloatGrid& grid, const std::array<int, 3>& begin, const std::array<int, 3>& size,
                 float* out) {
  const std::array<int, 3> end{begin[0] + size[0], begin[1] + size[1], begin[2] + size[2]};
  const std::size_t row = static_cast<std::size_t>(size[0]), slice = row * size[1];
  const int first_j = begin[1] / kLeaf, rows = (end[1] - 1) / kLeaf + 1 - first_j;
  const int first_k = begin[2] / kLeaf, layers = (end[2] - 1) / kLeaf + 1 - first_k;
  const auto copy_leaf_row = [&](int n) {
    // The tree is not told of the accessor, which would take longer than copying a brick: nobody changes it meanwhile.
    const auto accessor = grid.getConstUnsafeAccessor();
    std::array<int, 3> leaf{begin[0] & ~(kLeaf - 1), (first_j + n % rows) * kLeaf, (first_k + n / rows) * kLeaf};
    for (; leaf[0] < end[0]; leaf[0] += kLeaf) {
      std::array<int, 3> low, extent;  // in the leaf
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::max(begin[axis] - leaf[axis], 0);
        extent[axis] = std::min(end[axis] - leaf[axis], kLeaf) - low[axis];
      }
      const Coord origin(leaf[0], leaf[1], leaf[2]);
      const Leaf* found = accessor.probeConstLeaf(origin);
      copy_part(found != nullptr ? found->buffer().data() : nullptr, found != nullptr ? 0 : accessor.getValue(origin), low,
                extent, row, slice,
                out + (slice * (leaf[2] + low[2] - begin[2]) + row * (leaf[1] + low[1] - begin[1]) +
                       (leaf[0] + low[0] - begin[0])));
    }
  };
  constexpr std::size_t kWorthThreads = std::size_t{1} << 16;
  if (slice * size[2] < kWorthThreads) {
    for (int n = 0; n < rows * layers; ++n) copy_leaf_row(n);
  } else {
    tbb::parallel_for(0, rows * layers, copy_leaf_row);
  }
}

}  // namespace delvox
