#pragma once

#include <algorithm>
#include <cmath>

#include "delvox/core/geometry.h"

namespace delvox {

/// The angles and radii of a tet abcd.
struct TetGeometry {
  /// Of the face opposite corner i: outward if the tet is positive, its length twice the area.
  Vector3 normal[4];
  double squared_length[4];  ///< of the normals
  double six_volumes = 0;
  double squared_circumradius = 0;  ///< infinite if the tet is flat
  double shortest_squared_edge = 0;
  Point3 circumcenter;

  /// Of the dihedral angle between faces i and j.
  double cosine(int i, int j) const {
    return -dot(normal[i], normal[j]) / std::sqrt(squared_length[i] * squared_length[j]);
  }
  /// Of the smallest dihedral angle.
  double largest_cosine() const {
    double inverse[4];
    for (int i = 0; i < 4; ++i) inverse[i] = 1 / std::sqrt(squared_length[i]);
    double largest = -1;
    for (int i = 0; i < 4; ++i) {
      for (int j = i + 1; j < 4; ++j) {
        largest = std::max(largest, -dot(normal[i], normal[j]) * (inverse[i] * inverse[j]));
      }
    }
    return largest;
  }
};

inline TetGeometry tet_geometry(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  const Vector3 u = b - a, v = c - a, w = d - a, bc = c - b, bd = d - b;
  TetGeometry g;
  g.normal[0] = cross(bc, bd);
  g.normal[1] = cross(w, v);
  g.normal[2] = cross(u, w);
  g.normal[3] = cross(v, u);
  for (int i = 0; i < 4; ++i) g.squared_length[i] = squared_norm(g.normal[i]);
  g.six_volumes = -dot(u, g.normal[1]);
  const double uu = squared_norm(u), vv = squared_norm(v), ww = squared_norm(w);
  g.shortest_squared_edge = std::min({uu, vv, ww, squared_norm(bc), squared_norm(bd), squared_norm(d - c)});
  const Vector3 offset = (-0.5 / g.six_volumes) * (uu * g.normal[1] + vv * g.normal[2] + ww * g.normal[3]);
  g.squared_circumradius = squared_norm(offset);
  g.circumcenter = a + offset;
  return g;
}

}  // namespace delvox
