#pragma once

#include "delvox/volume/volume.h"

namespace delvox {

/// Which isosurface of a volume: inside is value >= isovalue, or with `below` value <= isovalue.
struct Isosurface {
  double isovalue = 0;
  bool below = false;
};

/// The isosurface as every room computes with it, so that oracle, seeds, component count and check agree.
///
/// Signed samples g = sign * value; inside is g > level. Ties: `level` is half a float step below the smallest float
/// that counts as inside, so no sample equals it, label stays value >= isovalue, and plateaus lie wholly inside.
struct LevelSet {
  float sign = 1;
  double level = 0;

  explicit LevelSet(const Isosurface& surface);
  bool inside(float signed_sample) const { return signed_sample > level; }
  /// The sample, sign not applied, that is closest to the level on one side.
  float nearest(bool on_inside) const;
};

/// One row of the padded grid, n + 2 signed samples, from a row of n samples of the image: the nearest one, if the whole
/// row is in the padding.
void pad_row(const LevelSet& level_set, const float* samples, int n, bool in_padding, float* out);

/// Copies signed samples of the padded grid into out, i fastest. Indices run from -1 to dims (inclusive): the image
/// is padded by one layer that is outside by construction (2 level - g of the nearest voxel if that is inside, else
/// g), so an organ cut by the image edge closes half a voxel outside the last voxel centres.
/// pre: begin >= -1, begin + size <= dims + 1 in each direction.
void copy_padded_block(const Volume& volume, const LevelSet& level_set, const std::array<int, 3>& begin,
                       const std::array<int, 3>& size, float* out);

}  // namespace delvox
