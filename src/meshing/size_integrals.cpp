#include "meshing/size_integrals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/flat_hash.h"
#include "core/round.h"

namespace delvox {
namespace {

/// Sheets face each other where the sum of their area vectors is less than this part of their area.
constexpr double kFacing = 0.5;
/// No part is thinner than half a voxel, patches with surface being four voxels wide.
constexpr double kVoxelsPerPatch = 4, kLeastThickness = 0.5 / kVoxelsPerPatch;

/// Depth, in cell sizes, below which cells are lattice tets that cost next to no time: the tets that refinement leaves
/// and the shell lie above.
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
  bool graded = false;  ///< at the surface the cell size is the size then, however large it is in the middle
  double inside_mm3 = 0, narrowest_patch = std::numeric_limits<double>::infinity();
  Vector3 up, down;
};

void add_to(SizeIntegrals& sums, const Cube& cube, double size, double cell_size) {
  const double area = cube.area();
  sums.surface += area / (size * size);
  if (!(cell_size > 0)) return;
  if (size < cell_size && !cube.graded) sums.graded += (1 - size / cell_size) * area / (size * size);
  const double volume = cube.inside_mm3 / (cell_size * cell_size * cell_size);
  sums.volume += volume;
  sums.deep += volume - kShellDepth * area / (cell_size * cell_size);  // all of the shell is subtracted in the end
}

class Measurer {
 public:
  Measurer(const Oracle& oracle, const SizeField& size, const TetCriteria* tets)
      : oracle_(oracle), size_(size), tets_(tets) {}

  void add(const DomainPatch& patch) {
    const double wanted = size_(patch.center), cell_size = cell_size_in(patch);
    Cube cube(cell_size > 0 ? std::min(wanted, cell_size) : wanted, cell_size);
    cube.add(patch);
    cube.graded = tets_ != nullptr && tets_->grade > 0;
    add_to(result_.wanted, cube, cube.size, cell_size);
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
  /// The one that gives as many cells as those in the inside of the patch do; 0 if there are none.
  double cell_size_in(const DomainPatch& patch) const {
    if (tets_ == nullptr) return 0;
    const SizeField& cell_size = tets_->cell_size;
    if (cell_size.constant()) return cell_size.maximum();
    double density = 0;
    int samples = 0;
    for (int octant = 0; octant < 8; ++octant) {
      const double quarter = 0.25 * patch.width;
      const Vector3 step{octant & 1 ? quarter : -quarter, octant & 2 ? quarter : -quarter,
                         octant & 4 ? quarter : -quarter};
      const Point3 p = patch.center + step;
      if (oracle_.label(p) == 0) continue;
      density += std::pow(cell_size(p), -3);
      ++samples;
    }
    return samples > 0 ? std::cbrt(samples / density) : cell_size(patch.center);
  }

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
      const auto place = floor_to_int(p[axis] * per_mm_);
      key = key << 18 | (static_cast<std::uint64_t>(place) & 0x3ffff);
    }
    std::uint32_t& number = numbers_[key];
    if (number == FlatHash::kAbsent) {
      number = static_cast<std::uint32_t>(cubes_.size());
      cubes_.emplace_back(sizes.size, sizes.cell_size);
      cubes_.back().graded = sizes.graded;
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
    add_to(result_.resolved, cube, size, cell_size);
  }

  const Oracle& oracle_;
  const SizeField& size_;
  const TetCriteria* tets_;
  double last_size_ = 0, per_mm_ = 1;
  std::int64_t step_ = 0;
  FlatHash numbers_;
  std::vector<Cube> cubes_;
  MeasuredDomain result_;
};

}  // namespace

MeasuredDomain measure_domain(const Oracle& oracle, const SizeField& size, const TetCriteria* tets) {
  Measurer measurer(oracle, size, tets);
  oracle.for_each_patch([&](const DomainPatch& patch) { measurer.add(patch); });
  return measurer.finish();
}

}  // namespace delvox
