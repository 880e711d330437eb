#include <algorithm>
#include <cmath>
#include <mutex>

#include "delvox/core/errors.h"
#include "delvox/volume/volume_source.h"
#include "volume/grid_builder.h"
#include "volume/volume_impl.h"

namespace delvox {
Vector3 VolumeHeader::spacing() const {
  return {norm(index_to_world.column(0)), norm(index_to_world.column(1)), norm(index_to_world.column(2))};
}

std::string VolumeHeader::orientation() const {
  // The letters name the direction in which each index grows; the permutation with the largest product of
  // direction cosines decides (as nibabel's aff2axcodes does for non-degenerate affines).
  static constexpr int kPermutations[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  const int* best = kPermutations[0];
  double best_score = -1;
  for (const auto& permutation : kPermutations) {
    double score = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3 column = index_to_world.column(axis);
      score *= std::abs(column[permutation[axis]]) / norm(column);
    }
    if (score > best_score) {
      best_score = score;
      best = permutation;
    }
  }
  static const char* kRas[3][2] = {{"L", "R"}, {"P", "A"}, {"I", "S"}};
  static const char* kLps[3][2] = {{"R", "L"}, {"A", "P"}, {"I", "S"}};
  static const char* kPlain[3][2] = {{"-x", "+x"}, {"-y", "+y"}, {"-z", "+z"}};
  const auto& letters = frame == Frame::kRas ? kRas : frame == Frame::kLps ? kLps : kPlain;
  std::string result;
  for (int axis = 0; axis < 3; ++axis) {
    result += letters[best[axis]][index_to_world.column(axis)[best[axis]] > 0 ? 1 : 0];
  }
  return result;
}

void initialize_openvdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

openvdb::math::Transform::Ptr to_openvdb_transform(const Affine3& affine) {
  openvdb::math::Mat4d matrix = openvdb::math::Mat4d::identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) matrix(column, row) = affine.rows[row][column];
  }
  return openvdb::math::Transform::createLinearTransform(matrix);
}

Volume::Volume(VolumeHeader header, const std::vector<float>& samples) {
  check_header(header);
  const std::array<int, 3> dims = header.dims;
  const std::size_t area = static_cast<std::size_t>(dims[0]) * dims[1];
  if (area * dims[2] != samples.size()) {
    throw InputError("volume: the number of samples is not the product of the dimensions");
  }
  if (!std::all_of(samples.begin(), samples.end(), [](float sample) { return std::isfinite(sample); })) {
    throw InputError("volume: a sample is not a finite number; mask NaN and infinity first");
  }
  GridBuilder builder(std::move(header), std::nullopt);
  for (int k = 0; k < dims[2]; k += kSlabSlices) {
    builder.add(samples.data() + k * area, std::min(kSlabSlices, dims[2] - k));
  }
  impl_ = builder.finish();
}

Volume::Volume(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

const VolumeHeader& Volume::header() const { return impl_->header; }

std::size_t Volume::voxel_count() const {
  const auto& n = dims();
  return static_cast<std::size_t>(n[0]) * n[1] * n[2];
}

float Volume::value(int i, int j, int k) const { return impl_->grid->tree().getValue(openvdb::Coord(i, j, k)); }

void Volume::copy_block(const std::array<int, 3>& begin, const std::array<int, 3>& size, float* out) const {
  copy_voxels(*impl_->grid, begin, size, out);
}

std::vector<float> Volume::samples() const {
  std::vector<float> result(voxel_count());
  copy_block({0, 0, 0}, dims(), result.data());
  return result;
}

float Volume::min() const { return impl_->min; }
float Volume::max() const { return impl_->max; }

}  // namespace delvox
