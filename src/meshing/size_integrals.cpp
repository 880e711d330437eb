#include "meshing/size_integrals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/flat_hash.h"

namespace delvox {
namespace {

/// Sheets face each other where the sum of their area vectors is less than this part of their area.
constexpr double kFacing = 0.5;
/// No part is thinner than half a voxel, patches with surface being four voxels wide.
constexpr double kVoxelsPerPatch = 4, kLeastThickness = 0.5 / kVoxelsPerPatch;

/// Depth below which an interior lattice is not inserted, in cell sizes: a shell of five or six layers of sites.
constexpr double kShellDepth = 5;

/// What several patches hold, and the sizes wanted there; a cell size of 0 is none.
struct Cube {
  Cube(double size_here, double cell_size_here) : size(size_here), cell_size(cell_size_here) {}
  void add(const DomainPatch& patch) {
    narrowest_patch = std::min(narrowest_patch, patch.width);
    inside_mm3 += patch.inside_mm3;
    up = up + patch.area_up;
    down = down + patch.area_down;
  }
  double area() const { return norm(up + down); }

  double size, cell_size;
  double inside_mm3 = 0, narrowest_patch = std::numeric_limits<double>::infinity();
  Vector3 up, down;
};

void add_to(SizeIntegrals& sums, double area, double inside_mm3, double size, double cell_size) {
  sums.surface += area / (size * size);
  if (!(cell_size > 0)) return;
  if (size < cell_size) sums.graded += (1 - size / cell_size) * area / (size * size);
  const double volume = inside_mm3 / (cell_size * cell_size * cell_size);
  sums.volume += volume;
  sums.deep += volume - kShellDepth * area / (cell_size * cell_size);  // all of the shell is subtracted in the end
}

class Measurer {
 public:
  Measurer(const SizeField& size, const SizeField* cell_size) : size_(size), cell_size_(cell_size) {}

  void add(const DomainPatch& patch) {
    const double wanted = size_(patch.center), cell_size = cell_size_ != nullptr ? (*cell_size_)(patch.center) : 0;
    Cube cube(cell_size > 0 ? std::min(wanted, cell_size) : wanted, cell_size);
    cube.add(patch);
    add_to(result_.wanted, cube.area(), patch.inside_mm3, cube.size, cell_size);
    if (cube.area() > 0)
      result_.samples += cube.area() * (kVoxelsPerPatch * kVoxelsPerPatch) / (patch.width * patch.width);
    if (cube.size > patch.width) {
      cube_around(patch.center, cube).add(patch);
    } else {
      resolve(cube);
    }
  }

  MeasuredDomain finish() {
    for (const Cube& cube : cubes_) resolve(cube);
    for (SizeIntegrals* sums : {&result_.wanted, &result_.resolved}) sums->deep = std::max(0.0, sums->deep);
    return result_;
  }

 private:
  /// The cube about as wide as the size that holds a point: sheets that face each other in it are closer than that.
  Cube& cube_around(const Point3& p, const Cube& sizes) {
    if (sizes.size != last_size_) {  // few sizes come often
      constexpr int kWidthsPerOctave = 4;
      last_size_ = sizes.size;
      step_ = static_cast<std::int64_t>(std::round(kWidthsPerOctave * std::log2(sizes.size)));
      per_mm_ = std::exp2(-static_cast<double>(step_) / kWidthsPerOctave);
    }
    std::uint64_t key = static_cast<std::uint64_t>(step_) & 0x3ff;
    for (int axis = 0; axis < 3; ++axis) {
      const auto place = static_cast<std::int64_t>(std::floor(p[axis] * per_mm_));
      key = key << 18 | (static_cast<std::uint64_t>(place) & 0x3ffff);
    }
    std::uint32_t& number = numbers_[key];
    if (number == FlatHash::kAbsent) {
      number = static_cast<std::uint32_t>(cubes_.size());
      cubes_.emplace_back(sizes.size, sizes.cell_size);
    }
    return cubes_[number];
  }

  void resolve(const Cube& cube) {
    const double area = cube.area();
    double size = cube.size, cell_size = cube.cell_size;
    if (area > 0 && norm(cube.up - cube.down) < kFacing * area) {
      const double thickness = std::max(2 * cube.inside_mm3 / area, kLeastThickness * cube.narrowest_patch);
      size = std::min(size, thickness);
      cell_size = std::min(cell_size, thickness);
    }
    add_to(result_.resolved, area, cube.inside_mm3, size, cell_size);
  }

  const SizeField& size_;
  const SizeField* cell_size_;
  double last_size_ = 0, per_mm_ = 1;
  std::int64_t step_ = 0;
  FlatHash numbers_;
  std::vector<Cube> cubes_;
  MeasuredDomain result_;
};

}  // namespace

MeasuredDomain measure_domain(const Oracle& oracle, const SizeField& size, const SizeField* cell_size) {
  Measurer measurer(size, cell_size);
  oracle.for_each_patch([&](const DomainPatch& patch) { measurer.add(patch); });
  return measurer.finish();
}

}  // namespace delvox
