#include "meshing/surface_triangulation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "meshing/triangle_shape.h"

namespace delvox {
namespace {

constexpr int next(int i) { return (i + 1) % 3; }
constexpr int before(int i) { return (i + 2) % 3; }

/// The surface ball of a triangle that has its centre near the circumcentre, on a line along the normal, where that
/// leaves the inside. With a surface ball of radius r, where the radius of curvature is R, it is r^2 / 2R away: none is
/// looked for beyond the circumradius.
std::optional<SurfaceBall> ball_nearby(const Point3& a, const Point3& b, const Point3& c, const Oracle& oracle) {
  const Circumcircle circle = circumcircle(a, b, c);
  if (!std::isfinite(circle.squared_radius)) return std::nullopt;
  const Vector3 along = std::sqrt(circle.squared_radius / squared_norm(circle.normal)) * circle.normal;
  for (double reach : {0.25, 0.5, 1.0}) {
    const Point3 below = circle.center - reach * along, above = circle.center + reach * along;
    if (oracle.label(below) == 0 || oracle.label(above) != 0) continue;
    const Point3 center = oracle.intersect(below, above);
    return SurfaceBall{center, squared_distance(center, a)};
  }
  return std::nullopt;
}

}  // namespace

std::optional<SurfaceTriangulation> SurfaceTriangulation::make(std::vector<Point3> points,
                                                               std::span<const Triangle> triangles,
                                                               std::span<const SurfaceBall> balls) {
  SurfaceTriangulation made;
  made.points_ = std::move(points);
  made.faces_.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    made.faces_.push_back({triangles[t], {kNone, kNone, kNone}, balls[t].center, balls[t].squared_radius, 0, 0});
  }
  if (!made.join_neighbors() || !made.has_disks()) return std::nullopt;
  return made;
}

/// False if an edge has other than two triangles, one for each direction.
bool SurfaceTriangulation::join_neighbors() {
  struct Side {
    std::uint32_t to;
    TriangleId triangle;
    int opposite;
  };
  std::vector<std::uint32_t> first(points_.size() + 1, 0);
  for (const Face& face : faces_) {
    for (std::uint32_t v : face.corners) ++first[v + 1];
  }
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<Side> sides(3 * faces_.size());
  std::vector<std::uint32_t> end(first.begin(), first.end() - 1);
  for (TriangleId t = 0; t < faces_.size(); ++t) {
    const Triangle& v = faces_[t].corners;
    for (int i = 0; i < 3; ++i) sides[end[v[next(i)]]++] = {v[before(i)], t, i};
  }
  for (TriangleId t = 0; t < faces_.size(); ++t) {
    const Triangle& v = faces_[t].corners;
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t from = v[before(i)], to = v[next(i)];
      for (std::uint32_t s = first[from]; s < first[from + 1]; ++s) {
        if (sides[s].to != to) continue;
        if (faces_[t].neighbors[i] != kNone) return false;
        faces_[t].neighbors[i] = sides[s].triangle;
      }
      if (faces_[t].neighbors[i] == kNone) return false;
    }
  }
  for (TriangleId t = 0; t < faces_.size(); ++t) {  // a direction taken twice is the neighbour of one only
    for (TriangleId neighbor : faces_[t].neighbors) {
      const auto& back = faces_[neighbor].neighbors;
      if (std::find(back.begin(), back.end(), t) == back.end()) return false;
    }
  }
  return true;
}

/// Do the triangles at each vertex form one disk? pre: every edge has two triangles.
bool SurfaceTriangulation::has_disks() const {
  std::vector<std::uint32_t> count(points_.size(), 0);
  std::vector<TriangleId> some(points_.size(), kNone);
  for (TriangleId t = 0; t < faces_.size(); ++t) {
    for (std::uint32_t v : faces_[t].corners) {
      ++count[v];
      some[v] = t;
    }
  }
  for (std::uint32_t v = 0; v < points_.size(); ++v) {
    if (some[v] == kNone) continue;
    std::uint32_t around = 0;
    TriangleId t = some[v];
    do {
      const auto& corners = faces_[t].corners;
      const auto own = std::find(corners.begin(), corners.end(), v) - corners.begin();
      t = faces_[t].neighbors[next(static_cast<int>(own))];
      ++around;
    } while (t != some[v]);
    if (around != count[v]) return false;
  }
  return true;
}

bool SurfaceTriangulation::in_ball(const Point3& p, const Face& face) const {
  return squared_distance(p, face.ball_center) < kAHairLess * face.squared_radius;
}

bool SurfaceTriangulation::insert_ball_center(TriangleId t, const Oracle& oracle) {
  const Point3 p = faces_[t].ball_center;
  find_zone(p, t);
  if (!order_rim() || !find_balls(p, oracle)) return false;
  commit(p);
  return true;
}

/// The connected triangles whose balls contain p, and the edges that bound them.
void SurfaceTriangulation::find_zone(const Point3& p, TriangleId start) {
  const std::uint32_t in_zone = ++searches_;
  zone_.assign(1, start);
  rim_.clear();
  faces_[start].met = in_zone;
  for (std::size_t i = 0; i < zone_.size(); ++i) {
    for (TriangleId neighbor : faces_[zone_[i]].neighbors) {
      Face& face = faces_[neighbor];
      if (face.met == in_zone || !in_ball(p, face)) continue;
      face.met = in_zone;
      zone_.push_back(neighbor);
    }
  }
  for (TriangleId t : zone_) {
    const Face& face = faces_[t];
    for (int i = 0; i < 3; ++i) {
      if (faces_[face.neighbors[i]].met == in_zone) continue;
      rim_.push_back({face.corners[next(i)], face.corners[before(i)], face.neighbors[i]});
    }
  }
}

/// Puts the rim's edges in the order of a cycle. False if they form none, or enclose a vertex: then the zone, which is
/// joined by edges, is no disk with all its vertices on the rim.
bool SurfaceTriangulation::order_rim() {
  if (rim_.size() != zone_.size() + 2) return false;
  for (std::size_t i = 1; i < rim_.size(); ++i) {
    const auto rest = rim_.begin() + static_cast<std::ptrdiff_t>(i);
    const auto follows = [&](const RimEdge& edge) { return edge.from == rim_[i - 1].to; };
    const auto found = std::find_if(rest, rim_.end(), follows);
    if (found == rim_.end()) return false;
    std::swap(*rest, *found);
  }
  if (rim_.back().to != rim_.front().from) return false;
  for (std::size_t i = 1; i < rim_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (rim_[i].from == rim_[j].from) return false;
    }
  }
  return true;
}

/// False if one of the triangles that join p to the rim has no ball, or none that is empty. In the plane, its circle
/// lies between those of the triangles on both sides of its edge, before, and is no larger than the larger: so it is
/// here, nearly, or the surface is not what it seems.
bool SurfaceTriangulation::find_balls(const Point3& p, const Oracle& oracle) {
  constexpr double kMostGrowth = 2;  // of squared radii
  balls_.clear();
  double largest = 0;
  for (TriangleId t : zone_) largest = std::max(largest, faces_[t].squared_radius);
  for (std::size_t i = 0; i < rim_.size(); ++i) {
    const auto ball = ball_nearby(points_[rim_[i].from], points_[rim_[i].to], p, oracle);
    if (!ball || !empty_nearby(*ball, i)) return false;
    const double known = std::max(largest, faces_[rim_[i].outer].squared_radius);
    if (!(ball->squared_radius <= kMostGrowth * known)) return false;
    balls_.push_back(*ball);
  }
  return true;
}

/// Is the ball of the triangle at a rim's edge empty of the other vertices of the rim, and of the one beyond the edge?
bool SurfaceTriangulation::empty_nearby(const SurfaceBall& ball, std::size_t edge) const {
  const RimEdge& own = rim_[edge];
  const auto contains = [&](std::uint32_t vertex) {
    return squared_distance(points_[vertex], ball.center) < kAHairLess * ball.squared_radius;
  };
  for (std::uint32_t v : faces_[own.outer].corners) {
    if (v != own.from && v != own.to && contains(v)) return false;
  }
  return std::none_of(rim_.begin(), rim_.end(), [&](const RimEdge& other) {
    return other.from != own.from && other.from != own.to && contains(other.from);
  });
}

void SurfaceTriangulation::commit(const Point3& p) {
  const auto apex = static_cast<std::uint32_t>(points_.size());
  points_.push_back(p);
  created_.assign(zone_.begin(), zone_.end());
  while (created_.size() < rim_.size()) {
    created_.push_back(static_cast<TriangleId>(faces_.size()));
    faces_.push_back({});
  }
  const std::uint32_t stamp = next_stamp_++;
  const std::size_t count = rim_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const RimEdge& edge = rim_[i];
    const TriangleId ahead = created_[(i + 1) % count], behind = created_[(i + count - 1) % count];
    faces_[created_[i]] = {{edge.from, edge.to, apex}, {ahead, behind, edge.outer}, balls_[i].center,
                           balls_[i].squared_radius, stamp, 0};
    Face& outer = faces_[edge.outer];
    for (int k = 0; k < 3; ++k) {
      if (outer.corners[next(k)] == edge.to && outer.corners[before(k)] == edge.from) outer.neighbors[k] = created_[i];
    }
  }
}

}  // namespace delvox
