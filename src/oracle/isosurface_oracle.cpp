#include "delvox/oracle/isosurface_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "delvox/core/errors.h"
#include "delvox/volume/voxel_topology.h"
#include "oracle/brick_field.h"
#include "oracle/domain_patches.h"
#include "oracle/trilinear_cell.h"
#include "oracle/voxel_landmarks.h"
#include "oracle/voxel_seeds.h"

namespace delvox {
namespace {

/// From cell to cell along a segment a + t ab of the grid: on to the next plane of samples along whichever axis it comes
/// first. Without branches: which axis that is cannot be foreseen.
class CellWalk {
 public:
  /// pre: a is not negative.
  CellWalk(const Point3& a, const Vector3& ab) {
    for (int axis = 0; axis < 3; ++axis) {
      const double below = static_cast<int>(a[axis]);  // no floor(): that is a call
      const bool moves = ab[axis] != 0;
      per_plane_[axis] = moves ? 1 / ab[axis] : 0;
      step_[axis] = ab[axis] > 0 ? 1 : -1;
      ahead_[axis] = (ab[axis] > 0 ? below + 1 : a[axis] > below ? below : below - 1) - a[axis];
      reached_[axis] = moves ? ahead_[axis] * per_plane_[axis] : kNever;
    }
  }

  /// Where it leaves the cell in hand; 1 in the last.
  double end_of_cell() const { return std::min({reached_[0], reached_[1], reached_[2], 1.0}); }
  /// On from there.
  void next_cell(double end) {
    for (int axis = 0; axis < 3; ++axis) {
      const double passed = reached_[axis] <= end ? 1 : 0;
      ahead_[axis] += passed * step_[axis];
      reached_[axis] = per_plane_[axis] != 0 ? ahead_[axis] * per_plane_[axis] : kNever;
    }
  }

 private:
  static constexpr double kNever = 2;
  double ahead_[3], per_plane_[3], step_[3], reached_[3];  // the next plane's distance, and when the segment is there
};

class IsosurfaceOracle final : public SmoothOracle {
 public:
  IsosurfaceOracle(Volume volume, const Isosurface& surface, std::shared_ptr<const BrickField> field,
                   const Affine3& grid_to_world)
      : volume_(std::move(volume)),
        surface_(surface),
        field_(std::move(field)),
        to_world_(grid_to_world),
        to_grid_(grid_to_world.inverse()) {
    const auto& n = field_->size();
    for (int corner = 0; corner < 8; ++corner) {
      bounds_.extend(to_world_({corner & 1 ? n[0] - 1.0 : 0.0, corner & 2 ? n[1] - 1.0 : 0.0,
                                corner & 4 ? n[2] - 1.0 : 0.0}));
    }
  }

  Box3 bounds() const override { return bounds_; }

  Label label(const Point3& p) const override {
    const Point3 u = to_grid_(p);
    return field_->contains(u) && field_->inside(u) ? 1 : 0;
  }

  double value(const Point3& p) const override {
    const Point3 u = to_grid_(p);
    return field_->contains(u) ? field_->value(u) : -std::abs(field_->level()) - 1;
  }

  Vector3 gradient(const Point3& p) const override {
    const Point3 u = to_grid_(p);
    return field_->contains(u) ? to_grid_.linear_transposed(field_->gradient(u)) : Vector3{};
  }

  Point3 intersect(const Point3& a, const Point3& b) const override {
    Point3 low = to_grid_(a), high = to_grid_(b);
    clip(low, high);
    return to_world_(crossing_between(low, high));
  }

  std::vector<Point3> intersect_all(const Point3& a, const Point3& b) const override;

  Seeds seeds(const SizeField& size, const GoOn& go_on) const override {
    Seeds seeds = voxel_seeds(*field_, to_world_, size, go_on);
    for (Point3& p : seeds.points) p = to_world_(p);
    return seeds;
  }

  Landmarks landmarks(const SizeField& size, const GoOn& go_on) const override;

  std::optional<SurfaceTopology> topology() const override {
    const VoxelTopology counted = count_topology(volume_, surface_);
    return SurfaceTopology{counted.surface_components, counted.euler};
  }

  void for_each_patch(const std::function<void(const DomainPatch&)>& visit) const override {
    visit_patches(*field_, to_world_, visit);
  }

  std::unique_ptr<Oracle> clone() const override { return std::make_unique<IsosurfaceOracle>(*this); }

 private:
  /// Moves the ends of a segment to the padded box; false if it misses the box.
  bool clip(Point3& a, Point3& b) const;
  Point3 crossing_between(Point3 a, Point3 b) const;
  Point3 crossing_within_voxel(const Point3& a, double at_a, const Point3& b, double at_b) const;
  double root_in_cell(const Point3& a, const Vector3& ab, double t0, double before, double t1, double after) const;
  /// Value less level along p + t d, inside the cell.
  Cubic cubic_in_cell(const BrickField::CellSamples& samples, const std::array<int, 3>& cell, const Point3& p,
                      const Vector3& d) const {
    const Point3 corner{static_cast<double>(cell[0]), static_cast<double>(cell[1]), static_cast<double>(cell[2])};
    return cubic_along(samples.value, field_->level(), p - corner, d);
  }
  void crossings_in_cell(const std::array<int, 3>& cell, const Point3& a, const Vector3& ab, double t0, double t1,
                         double& value_at_t0, std::vector<Point3>& out) const;

  Volume volume_;
  Isosurface surface_;
  std::shared_ptr<const BrickField> field_;
  Affine3 to_world_, to_grid_;
  Box3 bounds_;
};

Landmarks IsosurfaceOracle::landmarks(const SizeField& size, const GoOn& go_on) const {
  // A mesh much coarser than half a voxel cannot follow every voxel; nor is it asked to.
  const double voxel = std::min({norm(to_world_.column(0)), norm(to_world_.column(1)), norm(to_world_.column(2))});
  const double fine_enough = 0.6 * voxel;
  if (size.minimum() > fine_enough) return {};
  const auto wanted = [&](const Point3& u) { return size.constant() || size(to_world_(u)) <= fine_enough; };
  Landmarks landmarks = voxel_landmarks(*field_, wanted, go_on);
  for (Point3& p : landmarks.points) p = to_world_(p);
  return landmarks;
}

bool IsosurfaceOracle::clip(Point3& a, Point3& b) const {
  double enter = 0, leave = 1;
  const Vector3 ab = b - a;
  for (int axis = 0; axis < 3; ++axis) {
    const double last = field_->size()[axis] - 1;
    if (ab[axis] == 0) {
      if (a[axis] < 0 || a[axis] > last) return false;
      continue;
    }
    const double t0 = -a[axis] / ab[axis], t1 = (last - a[axis]) / ab[axis];
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  if (!(enter <= leave)) return false;
  const auto clamped = [&](Point3 p) {
    for (int axis = 0; axis < 3; ++axis) p[axis] = std::clamp(p[axis], 0.0, field_->size()[axis] - 1.0);
    return p;
  };
  const Point3 start = a;
  if (leave < 1) b = clamped(start + leave * ab);
  if (enter > 0) a = clamped(start + enter * ab);
  return true;
}

Point3 IsosurfaceOracle::crossing_between(Point3 a, Point3 b) const {
  const bool a_inside = field_->inside(a);
  // Bisect on labels until both ends are within a voxel and have known values (pure bricks only know their side).
  while (squared_distance(a, b) > 1 || !field_->in_mixed_brick(a) || !field_->in_mixed_brick(b)) {
    const Point3 middle = midpoint(a, b);
    if (middle == a || middle == b) break;
    (field_->inside(middle) == a_inside ? a : b) = middle;
  }
  return crossing_within_voxel(a, field_->value(a), b, field_->value(b));
}

/// Between the planes of samples that the segment crosses, one along each axis at most, it is in one cell.
Point3 IsosurfaceOracle::crossing_within_voxel(const Point3& a, double at_a, const Point3& b, double at_b) const {
  const Vector3 ab = b - a;
  std::array<double, 4> stops{1, 1, 1, 1};
  int count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double plane = static_cast<int>(std::max(a[axis], b[axis])), t = (plane - a[axis]) / ab[axis];
    if (t > 0 && t < 1) stops[count++] = t;
  }
  std::sort(stops.begin(), stops.begin() + count);
  double t0 = 0, before = at_a;
  for (int stop = 0; stop <= count; ++stop) {
    const double t1 = stop == count ? 1 : stops[stop], after = stop == count ? at_b : field_->value(a + t1 * ab);
    if ((before > 0) != (after > 0)) return a + root_in_cell(a, ab, t0, before, t1, after) * ab;
    t0 = t1;
    before = after;
  }
  return b;
}

/// Where along a + t ab the sign changes. The ends of the piece may be on the other side for the cell than they were
/// for its neighbour: by rounding only, then they are roots.
double IsosurfaceOracle::root_in_cell(const Point3& a, const Vector3& ab, double t0, double before, double t1,
                                      double after) const {
  const std::array<int, 3> cell = field_->cell_of(a + (0.5 * (t0 + t1)) * ab);
  const BrickField::CellSamples samples = field_->cell_samples(cell);
  if (!samples.mixed_brick) return std::abs(before) < std::abs(after) ? t0 : t1;
  const Cubic cubic = cubic_in_cell(samples, cell, a + t0 * ab, (t1 - t0) * ab);
  const bool start_above = cubic(0) > 0, end_above = cubic(1) > 0;
  if (start_above == end_above) return start_above == (before > 0) ? t1 : t0;
  return t0 + (t1 - t0) * cubic.root_between(0, 1);
}

/// The roots of a cubic lie between its critical points.
void IsosurfaceOracle::crossings_in_cell(const std::array<int, 3>& cell, const Point3& a, const Vector3& ab, double t0,
                                         double t1, double& value_at_t0, std::vector<Point3>& out) const {
  const double dt = t1 - t0;
  const Cubic cubic = cubic_in_cell(field_->cell_samples(cell), cell, a + t0 * ab, dt * ab);
  const auto& c = cubic.c;
  // Its Bezier ordinates enclose it: of one sign, they leave no root.
  const double b1 = c[0] + c[1] / 3, b2 = c[0] + (2 * c[1] + c[2]) / 3, b3 = cubic(1);
  const auto [least, most] = std::minmax({value_at_t0, c[0], b1, b2, b3});
  if (most < 0 || least > 0) {
    value_at_t0 = b3;
    return;
  }
  std::array<double, 4> stops{0, 1, 1, 1};
  int count = 1;
  const double discriminant = c[2] * c[2] - 3 * c[1] * c[3];
  if (discriminant > 0) {
    const double q = -(c[2] + std::copysign(std::sqrt(discriminant), c[2]));
    double r0 = c[3] != 0 ? q / (3 * c[3]) : -1, r1 = q != 0 ? c[1] / q : -1;
    if (r0 > r1) std::swap(r0, r1);
    for (double r : {r0, r1}) {
      if (r > 0 && r < 1) stops[count++] = r;
    }
  }
  stops[count] = 1;
  double before = value_at_t0;
  for (int stop = 1; stop <= count; ++stop) {
    const double after = cubic(stops[stop]);
    if ((before > 0) != (after > 0)) {
      // The value at the start is that of the cell before: where rounding puts it on the other side, it is the root.
      const bool changes = (cubic(stops[stop - 1]) > 0) != (after > 0);
      const double root = changes ? cubic.root_between(stops[stop - 1], stops[stop]) : stops[stop - 1];
      out.push_back(to_world_(a + (t0 + root * dt) * ab));
    }
    before = after;
  }
  value_at_t0 = before;
}

std::vector<Point3> IsosurfaceOracle::intersect_all(const Point3& world_a, const Point3& world_b) const {
  std::vector<Point3> result;
  Point3 a = to_grid_(world_a), b = to_grid_(world_b);
  if (!(field_->contains(a) && field_->contains(b)) && !clip(a, b)) return result;
  if (!field_->may_be_mixed(field_->cell_of(a), field_->cell_of(b))) return result;
  const Vector3 ab = b - a;
  CellWalk walk(a, ab);
  double value = std::numeric_limits<double>::quiet_NaN();  // nobody asks for it before a cell is crossed
  for (double t0 = 0; t0 < 1;) {
    const double t1 = walk.end_of_cell();
    if (t0 < t1) {
      const std::array<int, 3> cell = field_->cell_of(a + (0.5 * (t0 + t1)) * ab);
      const BrickField::State state = field_->cell_state(cell);
      if (state == BrickField::State::kMixed) {
        if (t0 == 0) value = field_->value(a);
        crossings_in_cell(cell, a, ab, t0, t1, value, result);
      } else {
        value = state == BrickField::State::kInside ? 1 : -1;
      }
    }
    walk.next_cell(t1);
    t0 = t1;
  }
  return result;
}

}  // namespace

std::unique_ptr<SmoothOracle> make_isosurface_oracle(const Volume& volume, const Isosurface& surface) {
  const LevelSet level_set(surface);
  const float highest = level_set.sign > 0 ? volume.max() : -volume.min();
  if (!level_set.inside(highest)) {
    throw NothingToMesh("isovalue " + std::to_string(surface.isovalue) + ": no voxel is " +
                        (surface.below ? "at or below" : "at or above") + " it (the volume's range is " +
                        std::to_string(volume.min()) + " to " + std::to_string(volume.max()) +
                        "); choose one inside the range, see delvox info");
  }
  auto field = std::make_shared<const BrickField>(volume, level_set);
  Affine3 padding;  // grid coordinates start one sample before the image
  for (int axis = 0; axis < 3; ++axis) padding.rows[axis][3] = -1;
  return std::make_unique<IsosurfaceOracle>(volume, surface, std::move(field),
                                            compose(volume.header().index_to_world, padding));
}

}  // namespace delvox
