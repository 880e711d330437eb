#include "volume/volume_impl.h"

#include <openvdb/tools/Dense.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "delvox/core/errors.h"

namespace delvox {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using XyzDense = openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ>;

void check_header(const VolumeHeader& header, std::size_t sample_count) {
  std::size_t expected = 1;
  for (int n : header.dims) {
    if (n < 1) throw InputError("volume: a dimension is below 1; check the header");
    expected *= static_cast<std::size_t>(n);
  }
  if (expected != sample_count) throw InputError("volume: the number of samples is not the product of the dimensions");
  for (const auto& row : header.index_to_world.rows) {
    for (double entry : row) {
      if (!std::isfinite(entry)) throw InputError("volume: the affine is not finite; check spacing and origin");
    }
  }
  const Affine3& affine = header.index_to_world;
  const double volume_of_unit_columns =
      affine.determinant() / (norm(affine.column(0)) * norm(affine.column(1)) * norm(affine.column(2)));
  if (!(std::abs(volume_of_unit_columns) > 1e-6)) {
    throw InputError("volume: the affine is singular; check spacing and direction");
  }
}

}  // namespace

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
  check_header(header, samples.size());
  initialize_openvdb();
  auto impl = std::make_shared<Impl>();
  impl->header = std::move(header);
  const std::array<int, 3> dims = impl->header.dims;
  float low = samples.front(), high = samples.front();
  for (float sample : samples) {
    if (!std::isfinite(sample)) throw InputError("volume: a sample is not a finite number; mask NaN and infinity first");
    low = std::min(low, sample);
    high = std::max(high, sample);
  }
  impl->min = low;
  impl->max = high;
  impl->grid = openvdb::FloatGrid::create(0.0f);
  impl->grid->setName("density");
  try {
    impl->grid->setTransform(to_openvdb_transform(impl->header.index_to_world));
  } catch (const openvdb::ArithmeticError&) {
    // OpenVDB calls every determinant below 3e-15 singular, whatever the shape.
    throw InputError("volume: the voxels are below 3e-15 mm^3, too small for OpenVDB; state lengths in a larger unit");
  }
  const CoordBBox box(Coord(0), Coord(dims[0] - 1, dims[1] - 1, dims[2] - 1));
  const XyzDense dense(box, const_cast<float*>(samples.data()));
  openvdb::tools::copyFromDense(dense, *impl->grid, 0.0f, /*serial=*/true);
  impl_ = std::move(impl);
}

const VolumeHeader& Volume::header() const { return impl_->header; }

std::size_t Volume::voxel_count() const {
  const auto& n = dims();
  return static_cast<std::size_t>(n[0]) * n[1] * n[2];
}

float Volume::value(int i, int j, int k) const { return impl_->grid->tree().getValue(Coord(i, j, k)); }

void Volume::copy_block(const std::array<int, 3>& begin, const std::array<int, 3>& size, float* out) const {
  const Coord low(begin[0], begin[1], begin[2]);
  XyzDense dense(CoordBBox(low, low.offsetBy(size[0] - 1, size[1] - 1, size[2] - 1)), out);
  openvdb::tools::copyToDense(*impl_->grid, dense, /*serial=*/true);
}

std::vector<float> Volume::samples() const {
  std::vector<float> result(voxel_count());
  copy_block({0, 0, 0}, dims(), result.data());
  return result;
}

float Volume::min() const { return impl_->min; }
float Volume::max() const { return impl_->max; }

}  // namespace delvox
