#include "delvox/core/geometry.h"

namespace delvox {

Affine3 Affine3::inverse() const {
  const Vector3 a = column(0), b = column(1), c = column(2);
  const double scale = 1.0 / determinant();
  const std::array<Vector3, 3> inverse_rows{scale * cross(b, c), scale * cross(c, a), scale * cross(a, b)};
  const Point3 translation{rows[0][3], rows[1][3], rows[2][3]};
  Affine3 result;
  for (int i = 0; i < 3; ++i) {
    result.rows[i] = {inverse_rows[i].x, inverse_rows[i].y, inverse_rows[i].z, -dot(inverse_rows[i], translation)};
  }
  return result;
}

Affine3 compose(const Affine3& outer, const Affine3& inner) {
  Affine3 result;
  for (int column = 0; column < 3; ++column) {
    const Vector3 image = outer.linear(inner.column(column));
    for (int row = 0; row < 3; ++row) result.rows[row][column] = image[row];
  }
  const Point3 translation = outer({inner.rows[0][3], inner.rows[1][3], inner.rows[2][3]});
  for (int row = 0; row < 3; ++row) result.rows[row][3] = translation[row];
  return result;
}

const char* to_string(Frame frame) {
  switch (frame) {
    case Frame::kRas: return "RAS";
    case Frame::kLps: return "LPS";
    case Frame::kUnknown: break;
  }
  return "unknown";
}

}  // namespace delvox
