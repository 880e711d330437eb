#include "volume/phantom_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace delvox {
namespace {

using std::numbers::pi;

double ball_volume(double radius) { return 4.0 / 3.0 * pi * radius * radius * radius; }
double ball_area(double radius) { return 4.0 * pi * radius * radius; }

Vector3 unit(const Vector3& v) {
  const double length = norm(v);
  return length > 0 ? (1.0 / length) * v : Vector3{};
}

/// The body of all points within `radius` of a core (a point, circle, segment, disc), as a signed distance.
void set_offset_body(PhantomTruth& truth, double radius, std::function<Point3(const Point3&)> nearest_on_core) {
  truth.value = [radius, nearest_on_core](const Point3& p) { return radius - distance(p, nearest_on_core(p)); };
  truth.gradient = [nearest_on_core](const Point3& p) { return unit(nearest_on_core(p) - p); };
}

PhantomTruth ball_truth(const Point3& center, double radius) {
  PhantomTruth truth;
  truth.components = 1;
  truth.bodies = 1;
  truth.euler = 2;
  truth.volume_mm3 = ball_volume(radius);
  truth.area_mm2 = ball_area(radius);
  truth.center = center;
  truth.radius = radius;
  set_offset_body(truth, radius, [center](const Point3&) { return center; });
  return truth;
}

/// p, relative to a center, split into its part along a unit axis and the rest.
struct Split {
  double along;
  Vector3 across;
};
Split split(const Point3& p, const Point3& center, const Vector3& axis) {
  const Vector3 u = p - center;
  const double along = dot(u, axis);
  return {along, u - along * axis};
}

// Directions oblique to every grid axis, so that no flat part of a shape falls onto a grid plane.
const Vector3 kTorusAxis{2.0 / 7, -3.0 / 7, 6.0 / 7};
const Vector3 kPlateNormal{2.0 / 7, 3.0 / 7, 6.0 / 7};
const Vector3 kRodAxis{6.0 / 7, 2.0 / 7, 3.0 / 7};

}  // namespace

PhantomSetting::PhantomSetting(const PhantomOptions& phantom_options) : options(phantom_options) {
  half_extent = Box3::kInfinity;
  largest_voxel = 0;
  for (int axis = 0; axis < 3; ++axis) {
    half_extent = std::min(half_extent, 0.5 * options.dims[axis] * options.spacing[axis]);
    largest_voxel = std::max(largest_voxel, options.spacing[axis]);
  }
}

PhantomTruth sphere_truth(const PhantomSetting& setting) {
  return ball_truth(setting.options.center, 0.625 * setting.half_extent);
}

PhantomTruth oblique_sphere_truth(const PhantomSetting& setting) {
  // Off the image's middle: else a mirrored or transposed affine would put the ball in the same place.
  const Vector3 offset = setting.half_extent * Vector3{0.125, -0.0625, 0.1875};
  return ball_truth(setting.options.center + offset, 0.625 * setting.half_extent);
}

PhantomTruth noisy_sphere_truth(const PhantomSetting& setting) {
  PhantomTruth truth = sphere_truth(setting);
  if (setting.options.noise > 0) truth.components = truth.bodies = truth.euler = std::nullopt;
  if (setting.options.noise > 0) truth.area_mm2 = std::nullopt;
  // Like a scan, which has contrast at the surface only; an unclamped distance would outgrow the noise near it and
  // leave no specks elsewhere.
  const double limit = 3 * setting.largest_voxel;
  truth.value = [distance = truth.value, limit](const Point3& p) { return std::clamp(distance(p), -limit, limit); };
  truth.gradient = [value = truth.value, gradient = truth.gradient, limit](const Point3& p) {
    return std::abs(value(p)) < limit ? gradient(p) : Vector3{};
  };
  return truth;
}

PhantomTruth border_truth(const PhantomSetting& setting) {
  const PhantomOptions& options = setting.options;
  const double radius = 0.625 * setting.half_extent;
  const double last_voxel = 0.5 * (options.dims[0] - 1) * options.spacing[0];
  const double cut = 0.5 * radius;  // distance from the ball's center to the plane of the last voxel centers
  PhantomTruth truth = ball_truth(options.center + (last_voxel - cut) * options.direction[0], radius);
  const double cap_height = radius - cut;
  const double cap = pi * cap_height * cap_height * (3 * radius - cap_height) / 3;
  // The padding closes the body half a voxel outside the last voxel centers.
  const double slab = pi * (radius * radius - cut * cut) * 0.5 * options.spacing[0];
  truth.volume_mm3 = ball_volume(radius) - cap + slab;
  truth.area_mm2 = std::nullopt;
  return truth;
}

PhantomTruth ellipsoid_truth(const PhantomSetting& setting) {
  const Point3 center = setting.options.center;
  const double a = 0.75 * setting.half_extent, b = 0.55 * setting.half_extent, c = 0.4 * setting.half_extent;
  PhantomTruth truth;
  truth.components = truth.bodies = 1;
  truth.euler = 2;
  truth.volume_mm3 = 4.0 / 3.0 * pi * a * b * c;
  // Legendre's formula, a > b > c.
  const double angle = std::acos(c / a), sine = std::sin(angle), cosine = c / a;
  const double modulus = std::sqrt(a * a * (b * b - c * c) / (b * b * (a * a - c * c)));
  truth.area_mm2 = 2 * pi * c * c + 2 * pi * a * b / sine *
                                        (std::ellint_2(modulus, angle) * sine * sine +
                                         std::ellint_1(modulus, angle) * cosine * cosine);
  truth.value = [=](const Point3& p) {
    const Vector3 u = p - center;
    return c * (1 - norm({u.x / a, u.y / b, u.z / c}));
  };
  truth.gradient = [=](const Point3& p) {
    const Vector3 u = p - center;
    const double level = norm({u.x / a, u.y / b, u.z / c});
    if (level == 0) return Vector3{};
    return (-c / level) * Vector3{u.x / (a * a), u.y / (b * b), u.z / (c * c)};
  };
  return truth;
}

PhantomTruth torus_truth(const PhantomSetting& setting) {
  const Point3 center = setting.options.center;
  const double major = 0.55 * setting.half_extent, minor = 0.2 * setting.half_extent;
  PhantomTruth truth;
  truth.components = truth.bodies = 1;
  truth.euler = 0;
  truth.volume_mm3 = 2 * pi * pi * major * minor * minor;
  truth.area_mm2 = 4 * pi * pi * major * minor;
  set_offset_body(truth, minor, [=](const Point3& p) {
    return center + major * unit(split(p, center, kTorusAxis).across);
  });
  return truth;
}

PhantomTruth shells_truth(const PhantomSetting& setting) {
  const Point3 center = setting.options.center;
  const double outer = 0.8 * setting.half_extent, wall = 0.5 * setting.half_extent, core = 0.25 * setting.half_extent;
  PhantomTruth truth;
  truth.components = 3;
  truth.bodies = 2;
  truth.euler = 6;
  truth.volume_mm3 = ball_volume(outer) - ball_volume(wall) + ball_volume(core);
  truth.area_mm2 = ball_area(outer) + ball_area(wall) + ball_area(core);
  truth.value = [=](const Point3& p) {
    const double r = distance(p, center);
    return std::max(std::min(outer - r, r - wall), core - r);
  };
  truth.gradient = [=](const Point3& p) {
    const double r = distance(p, center);
    const bool cavity_wall = r > 0.5 * (core + wall) && r < 0.5 * (wall + outer);
    return (cavity_wall ? 1.0 : -1.0) * unit(p - center);
  };
  return truth;
}

PhantomTruth touching_balls_truth(const PhantomSetting& setting) {
  const PhantomOptions& options = setting.options;
  const double radius = 0.45 * setting.half_extent;
  const Point3 middle = options.center;
  const Vector3 axis = options.direction[0];
  PhantomTruth truth;
  truth.volume_mm3 = 2 * ball_volume(radius);
  truth.area_mm2 = 2 * ball_area(radius);
  if (options.dims[0] % 2 == 0) {
    // No sample lies on the plane between the balls: trilinearly they are joined by a neck of radius sqrt(R spacing).
    truth.components = truth.bodies = 1;
    truth.euler = 2;
  }
  set_offset_body(truth, radius, [=](const Point3& p) {
    return middle + (dot(p - middle, axis) < 0 ? -radius : radius) * axis;
  });
  return truth;
}

PhantomTruth plate_truth(const PhantomSetting& setting) {
  const Point3 center = setting.options.center;
  const double disc = 0.7 * setting.half_extent;
  const double r = setting.largest_voxel;  // half of the thickness
  PhantomTruth truth;
  truth.components = truth.bodies = 1;
  truth.euler = 2;
  truth.volume_mm3 = 2 * pi * disc * disc * r + pi * pi * disc * r * r + ball_volume(r);
  truth.area_mm2 = 2 * pi * disc * disc + 2 * pi * pi * disc * r + ball_area(r);
  set_offset_body(truth, r, [=](const Point3& p) {
    const Vector3 across = split(p, center, kPlateNormal).across;
    return center + (norm(across) <= disc ? across : disc * unit(across));
  });
  return truth;
}

PhantomTruth rod_truth(const PhantomSetting& setting) {
  const Point3 center = setting.options.center;
  const double half_length = 0.75 * setting.half_extent;
  const double r = 1.25 * setting.largest_voxel;
  PhantomTruth truth;
  truth.components = truth.bodies = 1;
  truth.euler = 2;
  truth.volume_mm3 = 2 * half_length * pi * r * r + ball_volume(r);
  truth.area_mm2 = 4 * half_length * pi * r + ball_area(r);
  set_offset_body(truth, r, [=](const Point3& p) {
    return center + std::clamp(dot(p - center, kRodAxis), -half_length, half_length) * kRodAxis;
  });
  return truth;
}

PhantomTruth gyroid_truth(const PhantomSetting& setting) {
  const Point3 center = setting.options.center;
  const double radius = 0.85 * setting.half_extent;
  const double k = 2 * pi / setting.half_extent;
  PhantomTruth truth;
  // The gyroid function is odd about the center: exactly half of the ball is inside.
  truth.volume_mm3 = 0.5 * ball_volume(radius);
  const auto gyroid = [=](const Point3& p) {
    const Vector3 u = k * (p - center);
    return (std::sin(u.x) * std::cos(u.y) + std::sin(u.y) * std::cos(u.z) + std::sin(u.z) * std::cos(u.x)) / k;
  };
  truth.value = [=](const Point3& p) { return std::min(gyroid(p), radius - distance(p, center)); };
  truth.gradient = [=](const Point3& p) {
    if (radius - distance(p, center) < gyroid(p)) return unit(center - p);
    const Vector3 u = k * (p - center);
    return Vector3{std::cos(u.x) * std::cos(u.y) - std::sin(u.z) * std::sin(u.x),
                   std::cos(u.y) * std::cos(u.z) - std::sin(u.x) * std::sin(u.y),
                   std::cos(u.z) * std::cos(u.x) - std::sin(u.y) * std::sin(u.z)};
  };
  return truth;
}

PhantomTruth ramp_truth(const PhantomSetting& setting) {
  const Point3 center = setting.options.center;
  // Integers, so that float samples on a dyadic grid are exact; a value is 7 times the distance to the plane.
  const Vector3 normal{2, 3, 6};
  PhantomTruth truth;
  truth.components = truth.bodies = 1;
  truth.euler = 2;
  double image = 1;
  for (int axis = 0; axis < 3; ++axis) image *= setting.options.dims[axis] * setting.options.spacing[axis];
  truth.volume_mm3 = 0.5 * image;  // closed by the padding, half a voxel outside the last voxel centers
  truth.value = [=](const Point3& p) { return dot(normal, p - center); };
  truth.gradient = [=](const Point3&) { return normal; };
  return truth;
}

PhantomTruth random_truth(const PhantomSetting&) {
  PhantomTruth truth;
  truth.isovalue = 2;
  return truth;
}

}  // namespace delvox
