#include <algorithm>

#include "meshing/refinement.h"

namespace delvox {
namespace {

double shortest_squared_edge(const RestrictedDelaunay& delaunay, CellId cell) {
  const auto& v = delaunay.vertices(cell);
  double shortest = squared_distance(delaunay.point(v[0]), delaunay.point(v[1]));
  for (int i = 0; i < 4; ++i) {
    for (int j = std::max(i + 1, 2); j < 4; ++j) {
      shortest = std::min(shortest, squared_distance(delaunay.point(v[i]), delaunay.point(v[j])));
    }
  }
  return shortest;
}

}  // namespace

void Refinement::watch_tets(const TetCriteria& criteria) {
  tet_criteria_ = &criteria;
  tets_.clear();
  for (CellId cell = 0; cell < delaunay_.cell_capacity(); ++cell) {
    const std::uint32_t stamp = delaunay_.stamp(cell);
    if (stamp != 0 && delaunay_.label(cell) != 0 && !delaunay_.placeholder(cell) && bad(cell)) {
      tets_.push_back({cell, stamp});
    }
  }
}

bool Refinement::bad(CellId cell) const {
  const Circumsphere& sphere = delaunay_.sphere(cell);
  const double size = tet_criteria_->cell_size(sphere.center);
  if (sphere.squared_radius > size * size * (1 - 1e-12)) return true;
  const double bound = tet_criteria_->radius_edge * tet_criteria_->radius_edge * (1 - 1e-9);
  return sphere.squared_radius > bound * shortest_squared_edge(delaunay_, cell);
}

void Refinement::refine_tets() {
  while (!tets_.empty()) {
    const WaitingTet waiting = tets_.back();
    tets_.pop_back();
    if (!delaunay_.alive(waiting.cell, waiting.stamp)) continue;
    if (!budget_left()) return;
    split_tet(waiting.cell);
    refine_surface();
    if (delaunay_.alive(waiting.cell, waiting.stamp)) tets_.push_back(waiting);
  }
}

void Refinement::split_tet(CellId cell) {
  const Point3 z = delaunay_.sphere(cell).center;
  const Star& star = evaluate(z, cell);
  SurfaceBall ball;
  // 7(a): z lies in a surface ball; 7(c): z would create a restricted triangle. The ball's centre goes in instead.
  if (star.duplicate || find_encroached_ball(star, ball) || find_new_ball(star, ball)) {
    if (!star.duplicate && insert_surface_point(ball.center, star.zone.front())) {
      ++report_.surface_insertions;
    } else {
      ++stuck_;
      stuck_place_ = z;
      tets_.clear();
    }
    return;
  }
  delaunay_.commit(VertexKind::kInterior);  // 7(b)
  enqueue_created();
  ++report_.interior_insertions;
}

/// A surface ball that contains z belongs to a facet of a cell whose circumsphere contains z.
bool Refinement::find_encroached_ball(const Star& star, SurfaceBall& largest) const {
  for (CellId cell : star.zone) {
    if (!delaunay_.has_balls(cell)) continue;
    for (int i = 0; i < 4; ++i) {
      const SurfaceBall* ball = delaunay_.ball({cell, i});
      if (ball == nullptr || ball->squared_radius <= largest.squared_radius) continue;
      if (squared_distance(ball->center, star.apex) < ball->squared_radius) largest = *ball;
    }
  }
  return largest.squared_radius > 0;
}

bool Refinement::find_new_ball(const Star& star, SurfaceBall& largest) const {
  const auto consider = [&](const Circumsphere& a, Label label_a, const Circumsphere& b, Label label_b,
                            const Point3& corner) {
    const Point3 center = delaunay_.dual_crossing(a.center, label_a, b.center, label_b);
    const double squared_radius = squared_distance(center, corner);
    if (squared_radius > largest.squared_radius) largest = {center, squared_radius};
  };
  bool uniform = true;
  for (const Star::Tet& tet : star.tets) {
    uniform &= tet.label == star.tets.front().label;
    const CellId outer = tet.outer.cell;
    if (delaunay_.label(outer) == tet.label || delaunay_.bipolar(tet.outer)) continue;
    consider(delaunay_.sphere(outer), delaunay_.label(outer), tet.sphere, tet.label, delaunay_.point(tet.vertices[0]));
  }
  if (!uniform) {
    for (std::uint32_t t = 0; t < star.tets.size(); ++t) {
      const Star::Tet& a = star.tets[t];
      for (std::uint32_t other : a.beside) {
        const Star::Tet& b = star.tets[other];
        if (t < other && a.label != b.label) consider(a.sphere, a.label, b.sphere, b.label, star.apex);
      }
    }
  }
  return largest.squared_radius > 0;
}

}  // namespace delvox
