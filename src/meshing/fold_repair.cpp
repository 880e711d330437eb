#include <utility>

#include "meshing/folds.h"
#include "meshing/refinement.h"

namespace delvox {

bool Refinement::repair_folds(double min_fold_degrees) {
  if (effort_.hopeless()) return false;  // rods and sheets as thin as a float step are all fold
  // A mesh finer than the voxels follows their creases, which are all fold too, and what goes in there can part or join
  // what it took landmarks to get right.
  if (!watch_.empty()) return false;
  bool inserted = false;
  const std::uint32_t new_from = std::exchange(folds_from_, delaunay_.next_stamp());
  for (const Fold& fold : sharp_folds(delaunay_, min_fold_degrees, new_from)) {
    if (!budget_left()) return inserted;
    const bool alive = delaunay_.alive(fold.sides[0].facet.cell, fold.sides[0].stamp) &&
                       delaunay_.alive(fold.sides[1].facet.cell, fold.sides[1].stamp);
    if (!alive || kept_edge(fold.sides[0].facet, fold.sides[1].facet)) continue;
    inserted |= split_fold(fold);
  }
  return inserted;
}

/// Inserts the centre of the larger of its two balls. What has changed since it was found is looked at another time.
bool Refinement::split_fold(const Fold& fold) {
  SurfaceBall larger;
  CellId cell = kNone;
  for (const Fold::Side& side : fold.sides) {
    const SurfaceBall* ball = delaunay_.alive(side.facet.cell, side.stamp) ? delaunay_.ball(side.facet) : nullptr;
    if (ball == nullptr) return false;
    if (ball->squared_radius <= larger.squared_radius) continue;
    larger = *ball;
    cell = side.facet.cell;
  }
  if (larger.squared_radius <= surface_.min_ball_radius * surface_.min_ball_radius) return false;
  if (!insert_surface_point(larger.center, cell)) return false;
  ++report_.surface_insertions;
  return true;
}

}  // namespace delvox
