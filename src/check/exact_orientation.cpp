#include "check/exact_orientation.h"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>

namespace delvox::check {
namespace {

using Integer = boost::multiprecision::cpp_int;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon() / 2;  // Shewchuk's: 2^-53

// Every double is an integer times a power of two: scaled by the smallest of the powers, all coordinates are integers
// and the sign of the determinant stays.
template <std::size_t N>
std::array<Integer, N> to_common_integers(const std::array<double, N>& values, int* power = nullptr) {
  constexpr int kMantissaBits = 53;
  std::array<long long, N> mantissas;
  std::array<int, N> exponents;
  int lowest = std::numeric_limits<int>::max();
  for (std::size_t i = 0; i < N; ++i) {
    int exponent = 0;
    mantissas[i] = static_cast<long long>(std::ldexp(std::frexp(values[i], &exponent), kMantissaBits));
    exponents[i] = exponent;
    if (mantissas[i] != 0) lowest = std::min(lowest, exponent);
  }
  if (power != nullptr) *power = lowest - kMantissaBits;
  std::array<Integer, N> result;
  for (std::size_t i = 0; i < N; ++i) {
    result[i] = mantissas[i];
    if (mantissas[i] != 0) result[i] <<= exponents[i] - lowest;
  }
  return result;
}

int exact_orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  const auto v = to_common_integers<12>({a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, d.x, d.y, d.z});
  std::array<Integer, 9> m;
  for (int i = 0; i < 9; ++i) m[i] = v[i + 3] - v[i % 3];
  const Integer determinant = m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
                              m[2] * (m[3] * m[7] - m[4] * m[6]);
  return determinant.sign();
}

int exact_planar_orientation(const std::array<double, 6>& coordinates) {
  const auto v = to_common_integers<6>(coordinates);
  const Integer determinant = (v[2] - v[0]) * (v[5] - v[1]) - (v[3] - v[1]) * (v[4] - v[0]);
  return determinant.sign();
}

/// The quotient of a non-negative and a positive number.
double quotient(const Integer& numerator, const Integer& denominator) {
  if (numerator == 0) return 0;
  // Both brought to a double's range by shifts: 64 leading bits are more than enough.
  const auto leading = [](const Integer& x, int& shift) {
    shift = std::max(0, static_cast<int>(msb(x)) - 63);
    return Integer(x >> shift).convert_to<double>();
  };
  int up = 0, down = 0;
  const double above = leading(numerator, up), below = leading(denominator, down);
  return std::ldexp(above / below, up - down);
}

int sign_of(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

}  // namespace

int orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  // The bound covers rounding only; products this small could have lost bits to underflow as well.
  constexpr double kUnderflowGuard = 1e-250;
  const Vector3 u = b - a, v = c - a, w = d - a;
  const double vw_x = v.y * w.z - v.z * w.y, vw_y = v.z * w.x - v.x * w.z, vw_z = v.x * w.y - v.y * w.x;
  const double determinant = u.x * vw_x + u.y * vw_y + u.z * vw_z;
  const double permanent = std::abs(u.x) * (std::abs(v.y * w.z) + std::abs(v.z * w.y)) +
                           std::abs(u.y) * (std::abs(v.z * w.x) + std::abs(v.x * w.z)) +
                           std::abs(u.z) * (std::abs(v.x * w.y) + std::abs(v.y * w.x));
  const double error = (7 + 56 * kEpsilon) * kEpsilon * permanent;
  if (std::abs(determinant) > error && error > kUnderflowGuard) return sign_of(determinant);
  return exact_orientation(a, b, c, d);
}

double exact_circumradius(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  int power = 0;
  const auto p = to_common_integers<12>({a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, d.x, d.y, d.z}, &power);
  std::array<Integer, 9> m;  // rows u, v, w from a
  for (int i = 0; i < 9; ++i) m[i] = p[i + 3] - p[i % 3];
  std::array<Integer, 9> cofactors;  // rows v x w, w x u, u x v
  for (int row = 0; row < 3; ++row) {
    const int next = (row + 1) % 3, last = (row + 2) % 3;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      cofactors[3 * row + i] = m[3 * next + j] * m[3 * last + k] - m[3 * next + k] * m[3 * last + j];
    }
  }
  const Integer volume = m[0] * cofactors[0] + m[1] * cofactors[1] + m[2] * cofactors[2];
  if (volume == 0) return std::numeric_limits<double>::infinity();
  // Of |u|^2 v x w + |v|^2 w x u + |w|^2 u x v, which is twice the volume times the centre as seen from a.
  Integer squared_sum = 0;
  for (int i = 0; i < 3; ++i) {
    Integer sum = 0;
    for (int row = 0; row < 3; ++row) {
      const Integer &x = m[3 * row], &y = m[3 * row + 1], &z = m[3 * row + 2];
      sum += (x * x + y * y + z * z) * cofactors[3 * row + i];
    }
    squared_sum += sum * sum;
  }
  return std::ldexp(std::sqrt(quotient(squared_sum, 4 * volume * volume)), power);
}

int planar_orientation(const Point3& a, const Point3& b, const Point3& c, int u, int v) {
  constexpr double kUnderflowGuard = 1e-250;
  const double left = (b[u] - a[u]) * (c[v] - a[v]), right = (b[v] - a[v]) * (c[u] - a[u]);
  const double determinant = left - right;
  const double error = (3 + 16 * kEpsilon) * kEpsilon * (std::abs(left) + std::abs(right));
  if (std::abs(determinant) > error && error > kUnderflowGuard) return sign_of(determinant);
  return exact_planar_orientation({a[u], a[v], b[u], b[v], c[u], c[v]});
}

}  // namespace delvox::check
