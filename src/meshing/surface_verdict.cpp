#include "meshing/surface_verdict.h"

#include <cmath>
#include <numbers>

#include "meshing/triangle_shape.h"

namespace delvox {

SurfaceVerdict judge(const SurfaceCriteria& criteria, const Point3& a, const Point3& b, const Point3& c,
                     const SurfaceBall& ball) {
  const double size = criteria.size(ball.center);
  if (ball.squared_radius > size * size) return SurfaceVerdict::kSplit;
  const TriangleShape shape = triangle_shape(a, b, c);
  // sin(smallest angle) = shortest edge / (2 circumradius); a hair stricter, so that what is written still holds.
  const double sine = std::sin(criteria.min_angle_degrees * std::numbers::pi / 180);
  if (shape.shortest_squared_edge < 4 * sine * sine * shape.squared_circumradius * (1 + 1e-9)) {
    return SurfaceVerdict::kSplit;
  }
  if (!std::isfinite(criteria.max_deviation)) return SurfaceVerdict::kGood;
  const double squared_deviation = ball.squared_radius - shape.squared_circumradius;
  if (squared_deviation <= criteria.max_deviation * criteria.max_deviation) return SurfaceVerdict::kGood;
  const double smallest = criteria.min_ball_radius;
  return ball.squared_radius <= smallest * smallest ? SurfaceVerdict::kTooDeviant : SurfaceVerdict::kSplit;
}

bool dense_at(const Point3& a, const Point3& b, const Point3& c, const SurfaceBall& ball) {
  const double squared_offset = ball.squared_radius - triangle_shape(a, b, c).squared_circumradius;
  return squared_offset <= kDenseOffset * kDenseOffset * ball.squared_radius;
}

}  // namespace delvox
