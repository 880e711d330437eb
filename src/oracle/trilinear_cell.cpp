#include "oracle/trilinear_cell.h"

#include <algorithm>
#include <cmath>

namespace delvox {
namespace {

bool strictly_inside(const Point3& p) {
  return p.x > 0 && p.x < 1 && p.y > 0 && p.y < 1 && p.z > 0 && p.z < 1;
}

}  // namespace

// With f = ... + b x + c y + d z + e xy + g yz + k zx + m xyz, the shift x = u - g/m, y = v - k/m, z = w - e/m leaves
// f = m uvw + b' u + c' v + d' w + const. At a critical point m vw = -b', m uw = -c', m uv = -d', so
// P = uvw satisfies m^3 P^2 = -b' c' d', and u = -m P / b' and so on.
std::vector<Point3> body_saddles(const std::array<float, 8>& s) {
  const double b = double(s[1]) - s[0], c = double(s[2]) - s[0], d = double(s[4]) - s[0];
  const double e = double(s[3]) - s[2] - s[1] + s[0], g = double(s[6]) - s[4] - s[2] + s[0];
  const double k = double(s[5]) - s[4] - s[1] + s[0];
  const double m = double(s[7]) - s[6] - s[5] - s[3] + s[4] + s[2] + s[1] - s[0];
  std::vector<Point3> result;
  if (m == 0) {
    // Linear: e y + k z = -b, e x + g z = -c, k x + g y = -d.
    const double determinant = 2 * e * g * k;
    if (determinant == 0) return result;
    const Point3 p{g * (b * g - c * k - d * e) / determinant, k * (c * k - b * g - d * e) / determinant,
                   e * (d * e - b * g - c * k) / determinant};
    if (strictly_inside(p)) result.push_back(p);
    return result;
  }
  const double bs = b - e * k / m, cs = c - e * g / m, ds = d - g * k / m;
  const double squared_product = -bs * cs * ds / (m * m * m);
  if (!(squared_product > 0)) return result;
  for (const double product : {std::sqrt(squared_product), -std::sqrt(squared_product)}) {
    const Point3 p{-m * product / bs - g / m, -m * product / cs - k / m, -m * product / ds - e / m};
    if (strictly_inside(p)) result.push_back(p);
  }
  return result;
}

std::optional<std::array<double, 2>> face_saddle(double a, double b, double c, double d) {
  const double twist = a - b + c - d;
  if (twist == 0) return std::nullopt;
  const double x = (a - d) / twist, y = (a - b) / twist;
  if (!(x > 0 && x < 1 && y > 0 && y < 1)) return std::nullopt;
  return std::array<double, 2>{x, y};
}

// The function is k + x kx + y ky + z kz + yz kyz + zx kzx + xy kxy + xyz kxyz; x = p.x + t d.x and so on.
Cubic cubic_along(const std::array<float, 8>& s, double level, const Point3& p, const Vector3& d) {
  const double kx = double(s[1]) - s[0], ky = double(s[2]) - s[0], kz = double(s[4]) - s[0];
  const double kxy = double(s[3]) - s[2] - kx, kyz = double(s[6]) - s[4] - ky, kzx = double(s[5]) - s[4] - kx;
  const double kxyz = double(s[7]) - s[6] - s[5] + s[4] - kxy;
  // Of the partial derivatives: those that p fixes.
  const double fxy = kxy + p.z * kxyz, fyz = kyz + p.x * kxyz, fzx = kzx + p.y * kxyz;
  const double fx = kx + p.y * kxy + p.z * fzx, fy = ky + p.z * kyz + p.x * fxy, fz = kz + p.x * kzx + p.y * fyz;
  return {{s[0] - level + p.x * (kx + p.z * kzx) + p.y * (ky + p.x * fxy) + p.z * (kz + p.y * kyz),
           d.x * fx + d.y * fy + d.z * fz, d.x * d.y * fxy + d.y * d.z * fyz + d.z * d.x * fzx,
           d.x * d.y * d.z * kxyz}};
}

/// Newton's method, with a bisection where that would leave the bracket or does not halve it in three steps.
double Cubic::root_between(double low, double high) const {
  constexpr double kRounding = 4e-16;
  const bool above_at_low = (*this)(low) > 0;
  const double at_low = (*this)(low), at_high = (*this)(high);
  double t = (low * at_high - high * at_low) / (at_high - at_low), width = high - low;
  for (int step = 0; step < 200 && high - low > kRounding; ++step) {
    if (!(t > low && t < high)) t = 0.5 * (low + high);
    const double at_t = (*this)(t);
    if (at_t == 0) return t;
    ((at_t > 0) == above_at_low ? low : high) = t;
    const double next = t - at_t / slope(t);
    if (std::abs(next - t) <= kRounding) return t;
    t = next;
    if (step % 3 != 2) continue;
    if (high - low > 0.5 * width) t = 0.5 * (low + high);
    width = high - low;
  }
  return std::clamp(t, low, high);
}

}  // namespace delvox
