#include <cmath>
#include <numbers>

#include "volume/phantom_shapes.h"

namespace delvox {
namespace {

using std::numbers::pi;

struct Ellipsoid {
  Ellipsoid(double added, const Vector3& axes, const Vector3& middle, double turn_degrees)
      : value(added), semi_axes(axes), center(middle),
        cosine(std::cos(turn_degrees * pi / 180)), sine(std::sin(turn_degrees * pi / 180)) {}

  double value;
  Vector3 semi_axes, center;
  double cosine, sine;  // of its turn about z, counter-clockwise, around its own center

  bool contains(const Vector3& u) const {
    const Vector3 v = u - center;
    return squared_norm({(cosine * v.x + sine * v.y) / semi_axes.x, (cosine * v.y - sine * v.x) / semi_axes.y,
                         v.z / semi_axes.z}) <= 1;
  }
  double volume() const { return 4.0 / 3.0 * pi * semi_axes.x * semi_axes.y * semi_axes.z; }
};

// The modified 3D Shepp-Logan head as in M. Schabel's phantom3d (contrast after Toft, 1996): skull, brain, right and
// left ventricle, and six small ones. Its two turns of -18 + 10 and 18 + 10 degrees are about the same axis.
const Ellipsoid kEllipsoids[] = {
    {1.0, {0.6900, 0.920, 0.810}, {0, 0, 0}, 0},         {-0.8, {0.6624, 0.874, 0.780}, {0, -0.0184, 0}, 0},
    {-0.2, {0.1100, 0.310, 0.220}, {0.22, 0, 0}, -8},    {-0.2, {0.1600, 0.410, 0.280}, {-0.22, 0, 0}, 28},
    {0.1, {0.2100, 0.250, 0.410}, {0, 0.35, -0.15}, 0},  {0.1, {0.0460, 0.046, 0.050}, {0, 0.1, 0.25}, 0},
    {0.1, {0.0460, 0.046, 0.050}, {0, -0.1, 0.25}, 0},   {0.1, {0.0460, 0.023, 0.050}, {-0.08, -0.605, 0}, 0},
    {0.1, {0.0230, 0.023, 0.020}, {0, -0.606, 0}, 0},    {0.1, {0.0230, 0.046, 0.020}, {0.06, -0.605, 0}, 0}};

}  // namespace

PhantomTruth shepp_logan_truth(const PhantomSetting& setting) {
  PhantomTruth truth;
  // Between the ventricles (0, or 0.1 where another ellipsoid overlaps them) and the brain (0.2): the head with two
  // cavities.
  truth.isovalue = 0.15;
  truth.components = 3;
  truth.bodies = 1;
  truth.euler = 6;
  const double scale = setting.half_extent;
  truth.volume_mm3 =
      scale * scale * scale * (kEllipsoids[0].volume() - kEllipsoids[2].volume() - kEllipsoids[3].volume());
  truth.value = [scale, center = setting.options.center](const Point3& p) {
    const Vector3 u = (1 / scale) * (p - center);
    double sum = 0;
    for (const Ellipsoid& ellipsoid : kEllipsoids) {
      if (ellipsoid.contains(u)) sum += ellipsoid.value;
    }
    return sum;
  };
  return truth;
}

}  // namespace delvox
