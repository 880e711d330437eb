#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace delvox {

/// A point or vector of three doubles. World coordinates are millimetres.
struct Point3 {
  double x = 0, y = 0, z = 0;

  double& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  friend bool operator==(const Point3&, const Point3&) = default;
};
/// A difference of points.
using Vector3 = Point3;

inline Point3 operator+(const Point3& a, const Point3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point3 operator-(const Point3& a, const Point3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Point3 operator*(double s, const Point3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(const Vector3& a, const Vector3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double squared_norm(const Vector3& a) { return dot(a, a); }
inline double norm(const Vector3& a) { return std::sqrt(squared_norm(a)); }
inline double squared_distance(const Point3& a, const Point3& b) { return squared_norm(a - b); }
inline double distance(const Point3& a, const Point3& b) { return norm(a - b); }
inline Point3 midpoint(const Point3& a, const Point3& b) { return 0.5 * (a + b); }
inline bool is_finite(const Point3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// An axis-aligned box; default-constructed it is empty and grows by extend().
struct Box3 {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Point3 min{kInfinity, kInfinity, kInfinity};
  Point3 max{-kInfinity, -kInfinity, -kInfinity};

  bool empty() const { return min.x > max.x || min.y > max.y || min.z > max.z; }
  bool contains(const Point3& p) const {
    return p.x >= min.x && p.x <= max.x && p.y >= min.y && p.y <= max.y && p.z >= min.z && p.z <= max.z;
  }
  void extend(const Point3& p) {
    for (int axis = 0; axis < 3; ++axis) {
      if (p[axis] < min[axis]) min[axis] = p[axis];
      if (p[axis] > max[axis]) max[axis] = p[axis];
    }
  }
  Point3 center() const { return midpoint(min, max); }
  double diagonal() const { return empty() ? 0.0 : distance(min, max); }
};

/// x -> linear * x + translation, stored as three rows of four (column vectors, as in NIfTI).
struct Affine3 {
  std::array<std::array<double, 4>, 3> rows{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  /// Image of a point.
  Point3 operator()(const Point3& p) const {
    Point3 q = linear(p);
    return {q.x + rows[0][3], q.y + rows[1][3], q.z + rows[2][3]};
  }
  /// Image of a vector: the translation does not act.
  Vector3 linear(const Vector3& v) const {
    return {rows[0][0] * v.x + rows[0][1] * v.y + rows[0][2] * v.z,
            rows[1][0] * v.x + rows[1][1] * v.y + rows[1][2] * v.z,
            rows[2][0] * v.x + rows[2][1] * v.y + rows[2][2] * v.z};
  }
  /// linear^T * v: carries a gradient in the source space of the inverse map.
  Vector3 linear_transposed(const Vector3& v) const {
    return {rows[0][0] * v.x + rows[1][0] * v.y + rows[2][0] * v.z,
            rows[0][1] * v.x + rows[1][1] * v.y + rows[2][1] * v.z,
            rows[0][2] * v.x + rows[1][2] * v.y + rows[2][2] * v.z};
  }
  /// Column `axis` of the linear part: the world step of one voxel along that axis.
  Vector3 column(int axis) const { return {rows[0][axis], rows[1][axis], rows[2][axis]}; }
  double determinant() const { return dot(column(0), cross(column(1), column(2))); }
  /// The inverse map. pre: determinant() != 0.
  Affine3 inverse() const;
  friend bool operator==(const Affine3&, const Affine3&) = default;
};

/// this-after-that composition: compose(a, b)(p) == a(b(p)).
Affine3 compose(const Affine3& outer, const Affine3& inner);

/// The patient frame that world coordinates are stated in.
/// RAS: +x right, +y anterior, +z superior (NIfTI). LPS: +x left, +y posterior (DICOM).
enum class Frame { kUnknown, kRas, kLps };
/// "RAS", "LPS" or "unknown".
const char* to_string(Frame frame);

/// Region of space as an oracle sees it: 0 is outside, for an isosurface 1 is inside.
using Label = std::int32_t;
/// The largest that an oracle may give. Meshes read from files may have any.
inline constexpr Label kLargestLabel = 0xffff;

}  // namespace delvox
