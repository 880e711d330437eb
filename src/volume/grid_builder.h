#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "delvox/volume/level_set.h"
#include "volume/volume_impl.h"

namespace delvox {

/// Fills the grid of a volume with slabs of slices as they come. Blocks of one value become tiles. With a level set,
/// leaves away from its surface do too: a leaf keeps its samples if it touches a mixed brick, bricks being those that
/// BrickField cuts the padded grid into (brick b has voxels 8 b - 1 to 8 b + 7 along each axis).
class GridBuilder {
 public:
  /// Throws InputError: a header that check_header refuses.
  GridBuilder(VolumeHeader header, const std::optional<LevelSet>& level_set);

  /// Adds the next slab: kSlabSlices slices, fewer only if they are the last. The samples must stay in place until the
  /// next add has returned.
  void add(const float* samples, int slices);
  /// pre: all slices were added.
  std::shared_ptr<Volume::Impl> finish();

 private:
  struct Stored;
  struct Slab {
    const float* samples = nullptr;
    int slices = 0;
  };
  enum class Brick : std::uint8_t { kOutside, kInside, kMixed };

  void survey(const Slab& slab);
  void survey_row(const Slab& slab, int brick_j);
  Brick classify(float low, float high, bool in_padding) const;
  void store(const Slab& slab);
  void store_top();
  Stored make_leaf(const Slab& slab, int leaf_i, int leaf_j) const;
  Brick of_leaf(int leaf_i, int leaf_j) const;

  std::optional<LevelSet> level_set_;
  std::shared_ptr<Volume::Impl> impl_;
  std::array<int, 3> dims_, leaves_, bricks_;
  Slab last_;                              // not yet stored: the bricks above decide
  int layer_ = 0;                          // of leaves, of the slab in hand
  std::vector<Brick> below_, above_;       // bricks of the layer of last_ and of the one above it
  std::vector<float> row_low_, row_high_;  // range of the samples of each row of bricks
  float inside_value_ = 0, outside_value_ = 0;
};

/// Throws InputError "volume: ..." unless the dims are positive and the affine is finite, regular and not too small.
void check_header(const VolumeHeader& header);

/// Copies voxels [begin, begin + size) of a grid into out, i fastest.
void copy_voxels(const openvdb::FloatGrid& grid, const std::array<int, 3>& begin, const std::array<int, 3>& size,
                 float* out);

}  // namespace delvox
