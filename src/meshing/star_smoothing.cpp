#include "meshing/star_smoothing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "meshing/roughness_guard.h"

namespace delvox {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The shortest vector of the convex hull of some vectors, nearly: Gilbert's method.
Vector3 shortest_in_hull(const std::vector<Vector3>& vectors) {
  Vector3 m = vectors[0];
  for (int iteration = 0; iteration < 24; ++iteration) {
    const auto lowest = std::min_element(vectors.begin(), vectors.end(),
                                         [&](const Vector3& p, const Vector3& q) { return dot(m, p) < dot(m, q); });
    const Vector3 d = m - *lowest;
    const double gap = dot(m, d), dd = squared_norm(d);
    if (!(gap > 1e-3 * squared_norm(m)) || !(dd > 0)) break;
    m = m - std::min(1.0, gap / dd) * d;
  }
  return m;
}

// Of the cosine between faces with normals p and q (not of unit length), which change by e x dv with the vertex.
Vector3 gradient_of_cosine(const Vector3& p, const Vector3& ep, const Vector3& q, const Vector3& eq) {
  const double pp = squared_norm(p), qq = squared_norm(q), lengths = std::sqrt(pp * qq), pq = dot(p, q);
  return (-1 / lengths) * (cross(q, ep) + cross(p, eq)) +
         (pq / lengths) * ((1 / pp) * cross(p, ep) + (1 / qq) * cross(q, eq));
}

}  // namespace

// What is at a vertex; false if that must not move.
bool StarSmoothing::gather(std::uint32_t vertex) {
  if (mesh_.fixed(vertex)) return false;
  vertex_ = vertex;
  star_.clear();
  fan_.clear();
  near_boundary_ = false;
  const Point3 here = mesh_.point(vertex);
  double shortest = kInfinity;
  const auto star = mesh_.star(vertex);
  region_ = mesh_.region(star[0]);
  for (std::uint32_t t : star) {
    if (mesh_.region(t) != region_) return false;
    const Tet& tet = mesh_.tet(t);
    const int i = static_cast<int>(std::find(tet.begin(), tet.end(), vertex) - tet.begin());
    const auto& o = kTetFaces[i];
    const Corner corner{mesh_.point(tet[o[0]]), mesh_.point(tet[o[1]]), mesh_.point(tet[o[2]])};
    star_.push_back(corner);
    for (const Point3& p : {corner.a, corner.b, corner.c}) shortest = std::min(shortest, squared_distance(here, p));
    for (int k : o) near_boundary_ = near_boundary_ || mesh_.on_boundary(tet[k]);
  }
  shortest_ = std::sqrt(shortest);
  outward_ = {};
  for (std::uint32_t t : mesh_.fan(vertex)) {
    const Triangle& tri = mesh_.triangle(t);
    const int i = tri[0] == vertex ? 0 : tri[1] == vertex ? 1 : 2;
    const Side side{mesh_.point(tri[(i + 1) % 3]), mesh_.point(tri[(i + 2) % 3])};
    const Vector3 n = cross(side.a - here, side.b - here);
    outward_ = outward_ + (1 / norm(n)) * n;
    fan_.push_back(side);
  }
  if (fan_.empty()) return true;
  const double length = norm(outward_);
  outward_ = (1 / length) * outward_;
  return length > 0;
}

// False if a tet breaks a bound, or its cosine exceeds the limit: such a tet is put in front, as the first to try.
bool StarSmoothing::measure(const Point3& place, State& state, double limit) {
  state = {place, -1, 0};
  for (std::size_t i = 0; i < star_.size(); ++i) {
    const Corner& s = star_[i];
    const TetGeometry g = tet_geometry(place, s.a, s.b, s.c);
    const double cosine = g.largest_cosine();
    if (!(cosine < limit) || !tets_.allows(g)) {
      std::swap(star_[i], star_[0]);
      return false;
    }
    state.worst = std::max(state.worst, cosine);
    state.shortfall += tets_.shortfall_of(cosine);
  }
  return true;
}

void StarSmoothing::find_slopes(const State& state) {
  constexpr double kActive = 0.01;
  slopes_.clear();
  for (const Corner& s : star_) {
    const TetGeometry g = tet_geometry(state.place, s.a, s.b, s.c);
    const Vector3 turn[4] = {{}, s.b - s.c, s.c - s.a, s.a - s.b};
    for (int i = 0; i < 4; ++i) {
      for (int j = i + 1; j < 4; ++j) {
        const double cosine = g.cosine(i, j);
        if (cosine < state.worst - kActive) continue;
        slopes_.push_back({cosine, gradient_of_cosine(g.normal[i], turn[i], g.normal[j], turn[j])});
      }
    }
  }
}

// Angles of triangles that are near their bound must not become smaller.
void StarSmoothing::add_surface_slopes(const State& state) {
  constexpr double kNear = 0.01;
  const auto add = [&](const Point3& apex, const Point3& p, const Point3& q, bool apex_moves) {
    const Vector3 u = p - apex, v = q - apex;
    const double lu = norm(u), lv = norm(v), cosine = dot(u, v) / (lu * lv);
    if (cosine < surface_.largest_cosine() - kNear) return;
    const Vector3 by_p = (1 / (lu * lv)) * v - (cosine / (lu * lu)) * u;
    const Vector3 by_q = (1 / (lu * lv)) * u - (cosine / (lv * lv)) * v;
    slopes_.push_back({cosine, apex_moves ? -1.0 * (by_p + by_q) : by_p});
  };
  for (const Side& side : fan_) {
    add(state.place, side.a, side.b, true);
    add(side.a, state.place, side.b, false);
    add(side.b, state.place, side.a, false);
  }
}

Vector3 StarSmoothing::descent() const {
  std::vector<Vector3> gradients;
  for (const Slope& slope : slopes_) {
    Vector3 g = slope.gradient;
    if (!fan_.empty()) g = g - dot(g, outward_) * outward_;
    gradients.push_back(g);
  }
  return shortest_in_hull(gradients);
}

bool StarSmoothing::triangles_allow(const Point3& place) {
  for (const Side& side : fan_) {
    const Vector3 n = cross(side.a - place, side.b - place);
    if (!(dot(n, outward_) > 0.5 * norm(n)) || !surface_.allows_angles(place, side.a, side.b)) return false;
  }
  for (const Side& side : fan_) {
    if (!surface_.allows(place, side.a, side.b)) return false;
  }
  const auto fan = mesh_.fan(vertex_);
  std::vector<Triangle> triangles;
  for (std::uint32_t t : fan) triangles.push_back(mesh_.triangle(t));
  if (RoughnessGuard(mesh_, surface_.max_roughness_degrees()).too_rough(triangles, vertex_, place, fan)) return false;
  return std::none_of(fan.begin(), fan.end(),
                      [&](std::uint32_t t) { return guard_.crosses(mesh_.triangle(t), vertex_, place, fan); });
}

std::optional<Point3> StarSmoothing::reach(const Point3& from, const Vector3& step) const {
  const Point3 target = from + step;
  if (fan_.empty()) return near_boundary_ && !surface_.inside(target, region_) ? std::nullopt : std::optional(target);
  return surface_.project(target, outward_, norm(step), region_);
}

bool StarSmoothing::step_down(State& state, const Vector3& direction, double length) {
  for (int halving = 0; halving < 5; ++halving, length *= 0.5) {
    const auto place = reach(state.place, length * direction);
    State next;
    if (!place || !measure(*place, next, state.worst)) continue;
    if (!fan_.empty() && !triangles_allow(*place)) continue;
    state = next;
    return true;
  }
  return false;
}

double StarSmoothing::displace(std::uint32_t vertex, const Vector3& step, Point3& place) {
  State here, there;
  if (!gather(vertex) || !measure(mesh_.point(vertex), here, kInfinity)) return -kInfinity;
  const Vector3 along = fan_.empty() ? step : step - dot(step, outward_) * outward_;
  const auto reached = reach(here.place, along);
  if (!reached || !measure(*reached, there, kInfinity)) return -kInfinity;
  if (!fan_.empty() && !triangles_allow(*reached)) return -kInfinity;
  place = *reached;
  return here.shortfall - there.shortfall;
}

double StarSmoothing::improve(std::uint32_t vertex, Point3& place) {
  if (!gather(vertex)) return 0;
  State state;
  if (!measure(mesh_.point(vertex), state, kInfinity)) return 0;
  const double before = state.shortfall;
  constexpr int kSteps = 8;
  for (int step = 0; step < kSteps && state.worst > tets_.goal_cosine(); ++step) {
    const double worst = state.worst;
    find_slopes(state);
    add_surface_slopes(state);
    const Vector3 m = descent();
    const double slope = norm(m);
    if (!(slope * shortest_ > 1e-3)) break;
    const double length = std::min(0.3 * shortest_, 1.5 * (worst - tets_.goal_cosine()) / slope + 0.02 * shortest_);
    if (!step_down(state, (-1 / slope) * m, length)) break;
  }
  place = state.place;
  return before - state.shortfall;
}

}  // namespace delvox
