#include <algorithm>
#include <optional>
#include <set>

#include "meshing/pieces.h"
#include "meshing/refinement.h"

namespace delvox {

bool Refinement::repair_landmarks() {
  if (landmarks_.points.empty()) return false;
  landmark_places_.resize(landmarks_.points.size());
  bool inserted = false;
  lost_landmarks_ = 0;
  CellId hint = delaunay_.created().front();
  for (std::size_t i = 0; i < landmarks_.points.size(); ++i) {
    if (!budget_left()) return inserted;
    LandmarkPlace& place = landmark_places_[i];
    // Most cells outlive a round of repairs, and with them what was found of their landmarks.
    if (place.cell == kNone || !delaunay_.alive(place.cell, place.stamp)) inserted |= repair_landmark(i, hint);
    if (place.lost) {
      ++lost_landmarks_;
      lost_place_ = landmarks_.points[i];
    }
    hint = place.cell;
  }
  return inserted || repair_pieces();
}

bool Refinement::repair_landmark(std::size_t index, CellId hint) {
  const Point3& landmark = landmarks_.points[index];
  LandmarkPlace& place = landmark_places_[index];
  place.cell = delaunay_.locate(landmark, hint);
  place.lost = false;
  const auto p = crossing_beside(landmark, place.cell);
  const bool inserted = p && insert_for_landmark(*p, place.cell);
  if (inserted) {
    place.cell = delaunay_.created().front();
    place.stamp = 0;  // to be looked for again
  } else {
    place.stamp = delaunay_.cell(place.cell).stamp;
    place.lost = p.has_value();
  }
  return inserted;
}

/// If the cell that holds the landmark has the other label: a point of the surface inside the cell's circumball, between
/// the landmark and the circumcentre. Inserting it destroys the cell.
std::optional<Point3> Refinement::crossing_beside(const Point3& landmark, CellId cell) const {
  const Cell& data = delaunay_.cell(cell);
  const Label label = oracle_.label(landmark);
  if (label == data.label) return std::nullopt;
  return delaunay_.dual_crossing(landmark, label, data.sphere.center, data.label);
}

bool Refinement::insert_for_landmark(const Point3& p, CellId hint) {
  // A landmark that lies on the surface itself, as ties and symmetric volumes have them, asks for points ever nearer to
  // it: even without a smallest ball that must end.
  const double smallest = std::max(surface_.min_ball_radius, 1e-7 * oracle_.bounds().diagonal());
  const Star& star = delaunay_.evaluate(p, hint);
  bool too_near = star.duplicate;
  for (const Star::Tet& tet : star.tets) {
    for (VertexId vertex : tet.vertices) too_near |= squared_distance(p, delaunay_.point(vertex)) <= smallest * smallest;
  }
  if (too_near) return false;
  if (!insert_surface_point(p, hint)) return false;
  ++report_.topology_insertions;
  return true;
}

/// With every landmark on its side: joins pieces that a link says are one, and splits balls of pieces without landmarks,
/// which are not real. What to insert is found before anything is inserted, one point for each pair of pieces.
bool Refinement::repair_pieces() {
  std::vector<CellId> landmark_cells;
  for (const LandmarkPlace& place : landmark_places_) landmark_cells.push_back(place.cell);
  const Pieces pieces = find_pieces(delaunay_, landmark_cells);
  std::vector<Point3> points;
  std::set<std::pair<std::uint32_t, std::uint32_t>> treated;
  for (const auto& [a, b] : landmarks_.links) {
    const std::uint32_t piece_a = pieces.of_cell[landmark_cells[a]], piece_b = pieces.of_cell[landmark_cells[b]];
    if (piece_a == piece_b || !treated.insert(std::minmax(piece_a, piece_b)).second) continue;
    const auto p = crossing_on_link(landmarks_.points[a], landmarks_.points[b], landmark_cells[a], pieces);
    if (p) points.push_back(*p);
  }
  for (const SurfaceBall& ball : largest_balls(pieces)) {
    if (ball.squared_radius > surface_.min_ball_radius * surface_.min_ball_radius) points.push_back(ball.center);
  }
  bool inserted = false;
  for (const Point3& p : points) inserted |= insert_for_landmark(p, delaunay_.created().front());
  return inserted;
}

/// Halves a link whose ends lie in different pieces until a point of it lies in a cell of the other label.
std::optional<Point3> Refinement::crossing_on_link(Point3 a, Point3 b, CellId cell_a, const Pieces& pieces) const {
  const std::uint32_t piece_a = pieces.of_cell[cell_a];
  CellId hint = cell_a;
  constexpr int kHalvings = 40;
  for (int i = 0; i < kHalvings; ++i) {
    const Point3 middle = midpoint(a, b);
    hint = delaunay_.locate(middle, hint);
    if (const auto p = crossing_beside(middle, hint)) return p;
    (pieces.of_cell[hint] == piece_a ? a : b) = middle;
  }
  return std::nullopt;
}

std::vector<SurfaceBall> Refinement::largest_balls(const Pieces& pieces) const {
  std::vector<SurfaceBall> largest(pieces.count - pieces.reached);
  for (CellId cell = 0; cell < delaunay_.cell_capacity(); ++cell) {
    const std::uint32_t piece = pieces.of_cell[cell];
    if (piece == kNone || piece < pieces.reached) continue;
    for (int i = 0; i < 4; ++i) {
      const SurfaceBall* ball = delaunay_.ball({cell, i});
      SurfaceBall& best = largest[piece - pieces.reached];
      if (ball != nullptr && ball->squared_radius > best.squared_radius) best = *ball;
    }
  }
  return largest;
}

}  // namespace delvox
