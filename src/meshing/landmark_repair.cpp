#include <algorithm>
#include <optional>

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
  return inserted || repair_links() || repair_pieces();
}

bool Refinement::repair_landmark(std::size_t index, CellId hint) {
  const Point3& landmark = landmarks_.points[index];
  LandmarkPlace& place = landmark_places_[index];
  place.cell = delaunay_.locate(landmark, hint);
  place.lost = false;
  place.moved = true;
  const auto p = crossing_beside(landmark, place.cell);
  const bool inserted = p && insert_for_landmark(*p, place.cell);
  if (inserted) {
    place.cell = delaunay_.created().front();
    place.stamp = 0;  // to be looked for again
  } else {
    place.stamp = delaunay_.stamp(place.cell);
    place.lost = p.has_value();
  }
  return inserted;
}

/// If the cell that holds the landmark has the other label: a point of the surface inside the cell's circumball, between
/// the landmark and the circumcentre. Inserting it destroys the cell.
std::optional<Point3> Refinement::crossing_beside(const Point3& landmark, CellId cell) const {
  const Label label = oracle_.label(landmark);
  if (label == delaunay_.label(cell)) return std::nullopt;
  return delaunay_.dual_crossing(landmark, label, delaunay_.sphere(cell).center, delaunay_.label(cell));
}

bool Refinement::insert_for_landmark(const Point3& p, CellId hint) {
  // A landmark that lies on the surface itself, as ties and symmetric volumes have them, asks for points ever nearer to
  // it: even without a smallest ball that must end.
  const double smallest = std::max(surface_.min_ball_radius, 1e-7 * oracle_.bounds().diagonal());
  const Star& star = evaluate(p, hint);
  bool too_near = star.duplicate;
  for (const Star::Tet& tet : star.tets) {
    for (VertexId vertex : tet.vertices) too_near |= squared_distance(p, delaunay_.point(vertex)) <= smallest * smallest;
  }
  if (too_near) return false;
  if (!insert_surface_point(p, hint)) return false;
  ++report_.topology_insertions;
  return true;
}

/// With every landmark on its side: each link must run through cells of its label, so that necks and tunnels are there
/// too. What to insert is found before anything is inserted; what an earlier insertion has cured is left out.
bool Refinement::repair_links() {
  std::vector<MisplacedCell> misplaced;
  link_paths_.resize(landmarks_.links.size());
  for (std::size_t i = 0; i < landmarks_.links.size(); ++i) {
    if (unchanged(i)) continue;
    const auto& [a, b] = landmarks_.links[i];
    link_paths_[i] = {};
    const auto place = misplaced_on_link(landmarks_.points[a], landmark_places_[a].cell, landmarks_.points[b],
                                         landmark_places_[b].cell, link_paths_[i]);
    if (place) misplaced.push_back(*place);
    link_paths_[i].clear = !place;
  }
  for (LandmarkPlace& place : landmark_places_) place.moved = false;
  bool inserted = false;
  for (const MisplacedCell& place : misplaced) {
    if (delaunay_.alive(place.cell, place.stamp)) inserted |= insert_for_landmark(place.crossing, place.cell);
  }
  return inserted;
}

/// Was the link clear when last looked at, and are the cells that it was found to run through still there?
bool Refinement::unchanged(std::size_t link) const {
  const auto& [a, b] = landmarks_.links[link];
  const LinkPath& path = link_paths_[link];
  if (!path.clear || path.length > path.cells.size()) return false;
  if (landmark_places_[a].moved || landmark_places_[b].moved) return false;
  return std::all_of(path.cells.begin(), path.cells.begin() + path.length,
                     [this](const WaitingTet& known) { return delaunay_.alive(known.cell, known.stamp); });
}

/// A cell of the other label on the link from a in one cell to b in another: halves the link until its ends lie in one
/// cell or in neighbours. Adds the cells between to the path.
std::optional<Refinement::MisplacedCell> Refinement::misplaced_on_link(const Point3& a, CellId cell_a, const Point3& b,
                                                                       CellId cell_b, LinkPath& path) const {
  constexpr std::uint32_t kLongest = 1000;
  const auto& near = delaunay_.neighbors(cell_a);
  if (cell_a == cell_b || std::count(near.begin(), near.end(), cell_b) > 0 || path.length > kLongest) return std::nullopt;
  const Point3 middle = midpoint(a, b);
  if (middle == a || middle == b) return std::nullopt;
  const CellId cell = delaunay_.locate(middle, cell_a);
  if (const auto p = crossing_beside(middle, cell)) return MisplacedCell{*p, cell, delaunay_.stamp(cell)};
  if (path.length < path.cells.size()) path.cells[path.length] = {cell, delaunay_.stamp(cell)};
  ++path.length;
  if (const auto found = misplaced_on_link(a, cell_a, middle, cell, path)) return found;
  return misplaced_on_link(middle, cell, b, cell_b, path);
}

/// With every link in place: splits the balls of pieces without landmarks, which are not real, one for each piece.
bool Refinement::repair_pieces() {
  std::vector<CellId> landmark_cells;
  for (const LandmarkPlace& place : landmark_places_) landmark_cells.push_back(place.cell);
  bool inserted = false;
  for (const SurfaceBall& ball : largest_balls(find_pieces(delaunay_, landmark_cells))) {
    if (ball.squared_radius <= surface_.min_ball_radius * surface_.min_ball_radius) continue;
    inserted |= insert_for_landmark(ball.center, delaunay_.created().front());
  }
  return inserted;
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
