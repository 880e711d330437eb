#include "check/trilinear_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace delvox::check {
namespace {

// Regula falsi with the Illinois rule; bisection's guarantee, a handful of evaluations.
template <class Function>
double monotone_root(const Function& f, double low, double f_low, double high, double f_high) {
  const double width = high - low;
  for (int step = 0, kept = 0; step < 100 && std::abs(high - low) > 1e-13 * (width + std::abs(high)); ++step) {
    const double middle = f_low == f_high ? 0.5 * (low + high) : high - f_high * (high - low) / (f_high - f_low);
    const double value = f(middle);
    if (value == 0 || middle == high || middle == low) return middle;
    if ((value > 0) == (f_high > 0)) {
      high = middle;
      f_high = value;
      if (kept == 1) f_low *= 0.5;
      kept = 1;
    } else {
      low = middle;
      f_low = value;
      if (kept == -1) f_high *= 0.5;
      kept = -1;
    }
  }
  return 0.5 * (low + high);
}

}  // namespace

TrilinearField::TrilinearField(const Volume& volume, const Isosurface& surface) {
  const LevelSet level_set(surface);
  level_ = level_set.level;
  std::array<int, 3> size;
  for (int axis = 0; axis < 3; ++axis) {
    size[axis] = volume.dims()[axis] + 2;
    n_[axis] = static_cast<std::size_t>(size[axis]);
  }
  samples_.resize(n_[0] * n_[1] * n_[2]);
  copy_padded_block(volume, level_set, {-1, -1, -1}, size, samples_.data());
}

TrilinearField::Cell TrilinearField::locate(const Point3& index) const {
  std::size_t cell[3];
  Cell result;
  for (int axis = 0; axis < 3; ++axis) {
    const double x = std::clamp(index[axis] + 1, 0.0, static_cast<double>(n_[axis] - 1));
    cell[axis] = std::min(static_cast<std::size_t>(x), n_[axis] - 2);
    result.local[axis] = x - static_cast<double>(cell[axis]);
  }
  result.base = (cell[2] * n_[1] + cell[1]) * n_[0] + cell[0];
  return result;
}

double TrilinearField::value(const Point3& index) const {
  const auto [base, t] = locate(index);
  double slice[2];
  for (int k = 0; k < 2; ++k) {
    const float* s = &samples_[base + k * n_[0] * n_[1]];
    const double low = (1 - t.x) * s[0] + t.x * s[1], high = (1 - t.x) * s[n_[0]] + t.x * s[n_[0] + 1];
    slice[k] = (1 - t.y) * low + t.y * high;
  }
  return (1 - t.z) * slice[0] + t.z * slice[1] - level_;
}

Vector3 TrilinearField::gradient(const Point3& index) const {
  const auto [base, t] = locate(index);
  Vector3 g;
  for (int c = 0; c < 8; ++c) {
    const double s = samples_[base + (c & 1) + (c >> 1 & 1) * n_[0] + (c >> 2) * n_[0] * n_[1]];
    const double wx = c & 1 ? t.x : 1 - t.x, wy = c & 2 ? t.y : 1 - t.y, wz = c & 4 ? t.z : 1 - t.z;
    g.x += (c & 1 ? s : -s) * wy * wz;
    g.y += (c & 2 ? s : -s) * wx * wz;
    g.z += (c & 4 ? s : -s) * wx * wy;
  }
  return g;
}

double TrilinearField::distance_outside(const Point3& index) const {
  double squared = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double beyond = std::max({0.0, -1 - index[axis], index[axis] - (static_cast<double>(n_[axis]) - 2)});
    squared += beyond * beyond;
  }
  return std::sqrt(squared);
}

std::optional<double> TrilinearField::crossing_in_voxel(const Point3& origin, const Vector3& direction, double begin,
                                                        double end) const {
  const auto f = [&](double t) { return value(origin + t * direction); };
  // The cubic through four points of [0, 1], then its turning points: between those it is monotone.
  const double h = end - begin, f0 = f(begin), f1 = f(begin + h / 3), f2 = f(begin + 2 * h / 3), f3 = f(end);
  const double c1 = -5.5 * f0 + 9 * f1 - 4.5 * f2 + f3, c2 = 9 * f0 - 22.5 * f1 + 18 * f2 - 4.5 * f3,
               c3 = -4.5 * f0 + 13.5 * f1 - 13.5 * f2 + 4.5 * f3;
  double stops[4] = {begin, end, end, end};
  int count = 1;
  const double discriminant = c2 * c2 - 3 * c1 * c3;
  if (discriminant > 0) {
    const double q = -(c2 + std::copysign(std::sqrt(discriminant), c2));
    double roots[2] = {q != 0 ? c1 / q : -1, c3 != 0 ? q / (3 * c3) : -1};
    if (roots[0] > roots[1]) std::swap(roots[0], roots[1]);
    for (double r : roots) {
      if (r > 0 && r < 1) stops[count++] = begin + r * h;
    }
  }
  double low = begin, f_low = f0;
  for (int i = 1; i <= count; ++i) {
    const double high = stops[i == count ? 3 : i], f_high = i == count ? f3 : f(high);
    if ((f_high > 0) != (f_low > 0)) return monotone_root(f, low, f_low, high, f_high);
    low = high;
    f_low = f_high;
  }
  return std::nullopt;
}

std::optional<double> TrilinearField::first_crossing(const Point3& origin, const Vector3& direction,
                                                     double t_max) const {
  double next[3], step[3];  // t of the next grid plane per axis, and from plane to plane
  for (int axis = 0; axis < 3; ++axis) {
    const double d = direction[axis];
    step[axis] = d != 0 ? 1 / std::abs(d) : std::numeric_limits<double>::infinity();
    const double plane = d > 0 ? std::floor(origin[axis]) + 1 : std::ceil(origin[axis]) - 1;
    next[axis] = d != 0 ? (plane - origin[axis]) / d : std::numeric_limits<double>::infinity();
  }
  for (double t = 0; t < t_max;) {
    const int axis = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    const double end = std::min(next[axis], t_max);
    if (const auto crossing = crossing_in_voxel(origin, direction, t, end)) return crossing;
    t = end;
    next[axis] += step[axis];
  }
  return std::nullopt;
}

}  // namespace delvox::check
