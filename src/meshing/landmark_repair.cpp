#include <algorithm>
#include <optional>

#include "core/parallel.h"
#include "core/take_turns.h"
#include "meshing/link_walk.h"
#include "meshing/pieces.h"
#include "meshing/refinement.h"

namespace delvox {

bool Refinement::repair_landmarks() {
  if (watch_.empty()) return false;
  landmark_places_.resize(watch_.size());
  const std::vector<LandmarkWatch::Due> due = watch_.take_due();
  watch_.await_links_of(due);
  bool inserted = false;
  for (const LandmarkWatch::Due& landmark : find_misplaced(due)) {
    if (!budget_left()) return inserted;
    inserted |= repair_landmark(landmark);
  }
  return inserted || repair_links() || repair_deferred_umbrellas() || repair_voronoi_edges(false) || repair_pieces() ||
         look_closer();
}

/// Finds the cells of landmarks; those that are lost, or whose cell has the other label, are returned. In chunks, of
/// which each walks from landmark to landmark.
std::vector<LandmarkWatch::Due> Refinement::find_misplaced(const std::vector<LandmarkWatch::Due>& due) {
  constexpr std::size_t kChunk = 1024;
  const auto collect = [&](std::size_t begin, std::size_t end, std::vector<LandmarkWatch::Due>& misplaced) {
    const Oracle& oracle = *delaunay_.worker().oracle;
    CellId hint = delaunay_.some_cell();
    for (std::size_t i = begin; i < end; ++i) {
      LandmarkPlace& place = landmark_places_[due[i].landmark];
      hint = cell_of_landmark(due[i], hint);
      place.cell = hint;
      place.stamp = delaunay_.stamp(hint);
      const bool right = oracle.label(watch_.point(due[i].landmark)) == delaunay_.label(hint);
      if (place.lost || !right) misplaced.push_back(due[i]);
    }
  };
  return gather_chunks<LandmarkWatch::Due>(due.size(), kChunk, collect);
}

/// The cell that holds a landmark, looked for only if the one known is gone. `hint`: a cell to walk from if there is no
/// better one.
CellId Refinement::cell_of_landmark(const LandmarkWatch::Due& due, CellId hint) const {
  const LandmarkPlace& place = landmark_places_[due.landmark];
  if (place.cell != kNone && delaunay_.alive(place.cell, place.stamp)) return place.cell;
  const bool vertex_known = due.near != kNone && delaunay_.kind(due.near) != VertexKind::kRemoved;
  if (vertex_known) hint = delaunay_.cell_of(due.near);
  const bool known = hint != RestrictedDelaunay::kBeyond && delaunay_.stamp(hint) != 0;
  return delaunay_.locate(watch_.point(due.landmark), known ? hint : delaunay_.some_cell());
}

bool Refinement::repair_landmark(const LandmarkWatch::Due& due) {
  const CellId cell = cell_of_landmark(due, delaunay_.some_cell());
  const auto p = crossing_beside(watch_.point(due.landmark), cell, oracle_);
  const bool inserted = p && insert_for_landmark(*p, cell);
  LandmarkPlace& place = landmark_places_[due.landmark];
  lost_landmarks_ -= place.lost;
  place.lost = p && !inserted;
  lost_landmarks_ += place.lost;
  if (place.lost) lost_place_ = watch_.point(due.landmark);
  return inserted;
}

/// If the cell that holds the landmark has the other label: a point of the surface inside the cell's circumball,
/// between the landmark and the circumcentre. Inserting it destroys the cell.
std::optional<Point3> Refinement::crossing_beside(const Point3& landmark, CellId cell, const Oracle& oracle) const {
  const Label label = oracle.label(landmark);
  if (label == delaunay_.label(cell)) return std::nullopt;
  return RestrictedDelaunay::dual_crossing(landmark, label, delaunay_.sphere(cell).center, delaunay_.label(cell), oracle);
}

bool Refinement::insert_for_landmark(const Point3& p, CellId hint) {
  // A landmark that lies on the surface itself, as ties and symmetric volumes have them, asks for points ever nearer to
  // it.
  const double smallest = surface_.min_ball_radius;
  const Star& star = delaunay_.evaluate(p, hint);
  bool too_near = star.duplicate;
  for (const Star::Tet& tet : star.tets) {
    for (VertexId vertex : tet.vertices)
      too_near |= squared_distance(p, delaunay_.point(vertex)) <= smallest * smallest;
  }
  if (too_near || !insert_apex_on_surface()) return false;
  ++report_.topology_insertions;
  return true;
}

/// With every landmark on its side: each link must run through cells of its label, so that necks and tunnels are there
/// too. What to insert is found before anything is inserted; what an earlier insertion has cured is left out.
bool Refinement::repair_links() {
  constexpr std::size_t kChunk = 1024;
  const std::vector<std::uint32_t> links = watch_.take_links();
  const auto collect = [&](std::size_t begin, std::size_t end, std::vector<MisplacedCell>& misplaced) {
    follow_links({links.data() + begin, links.data() + end}, misplaced);
  };
  return insert_where_misplaced(gather_chunks<MisplacedCell>(links.size(), kChunk, collect));
}

/// The first cell of the other label on each link that runs through one.
void Refinement::follow_links(std::span<const std::uint32_t> links, std::vector<MisplacedCell>& misplaced) const {
  constexpr int kMostCells = 1000;  // a walk that rounding leads astray finds nothing
  struct Walk {
    LinkWalk on_link;
    CellId last;
    Label label;
    std::size_t number;
    int cells = 0;
    bool has_asked = false;
  };
  const Oracle& oracle = *delaunay_.worker().oracle;
  std::vector<std::optional<MisplacedCell>> found(links.size());
  CellId hint = delaunay_.some_cell();
  const auto start = [&](std::size_t n) -> std::optional<Walk> {
    const auto [a, b] = watch_.link(links[n]);
    const CellId first = cell_of_landmark({a}, hint), last = cell_of_landmark({b}, first);
    hint = last;
    if (first == last || watch_.point(a) == watch_.point(b)) return std::nullopt;
    const LinkWalk on_link(delaunay_, watch_.point(a), watch_.point(b), first);
    return Walk{on_link, last, delaunay_.label(first), n};
  };
  const auto step = [&](Walk& walk) {
    const CellId cell = walk.on_link.cell();
    walk.has_asked = !walk.has_asked;
    if (walk.has_asked) {
      delaunay_.prefetch_vertices(cell);
      return true;
    }
    if (delaunay_.label(cell) != walk.label) {
      const auto middle = walk.on_link.middle();
      const auto p = middle ? crossing_beside(*middle, cell, oracle) : std::nullopt;
      if (p) found[walk.number] = MisplacedCell{*p, cell, delaunay_.stamp(cell)};
      if (p || !middle) return false;
    }
    if (!walk.on_link.next() || walk.on_link.cell() == walk.last) return false;
    delaunay_.prefetch(walk.on_link.cell());
    return ++walk.cells < kMostCells;
  };
  take_turns(links.size(), start, step);
  for (const auto& place : found) {
    if (place) misplaced.push_back(*place);
  }
}

bool Refinement::insert_where_misplaced(const std::vector<MisplacedCell>& misplaced) {
  bool inserted = false;
  for (const MisplacedCell& place : misplaced) {
    if (!budget_left()) return inserted;
    if (delaunay_.alive(place.cell, place.stamp)) inserted |= insert_for_landmark(place.crossing, place.cell);
  }
  return inserted;
}

/// With every link in place: splits the balls of pieces without landmarks, which are not real, one for each piece.
bool Refinement::repair_pieces() {
  if (!pieces_changed_) return false;
  pieces_changed_ = false;
  Pieces pieces(delaunay_);
  std::vector<bool> real(pieces.count(), false);
  std::uint32_t unknown = pieces.count();
  CellId hint = delaunay_.some_cell();
  for (std::uint32_t i = 0; i < watch_.size() && unknown > 0; ++i) {
    const std::uint32_t piece = pieces.of(hint = cell_of_landmark({i}, hint));
    unknown -= !real[piece];
    real[piece] = true;
  }
  if (unknown == 0) return false;
  bool inserted = false;
  for (const SurfaceBall& ball : largest_balls(pieces, real)) {
    if (ball.squared_radius <= surface_.min_ball_radius * surface_.min_ball_radius) continue;
    inserted |= insert_for_landmark(ball.center, delaunay_.some_cell());
  }
  return inserted;
}

/// The largest ball of each piece that is not real, the others' being empty.
std::vector<SurfaceBall> Refinement::largest_balls(Pieces& pieces, const std::vector<bool>& real) const {
  std::vector<SurfaceBall> largest(pieces.count());
  for (CellId cell = 0; cell < delaunay_.cell_capacity(); ++cell) {
    if (!delaunay_.has_balls(cell)) continue;
    const std::uint32_t piece = pieces.of(cell);
    if (real[piece]) continue;
    for (int i = 0; i < 4; ++i) {
      const SurfaceBall* ball = delaunay_.ball({cell, i});
      if (ball != nullptr && ball->squared_radius > largest[piece].squared_radius) largest[piece] = *ball;
    }
  }
  return largest;
}

void Refinement::note_change(const Box3& box, VertexId near) {
  watch_.note_change(box, near);
  if (edges_looked_at_) since_edges_.push_back(near);
  pieces_changed_ = true;
}

/// What changes its label lies between restricted triangles that go and others that come.
Box3 Refinement::box_of_change(const Star& star) const {
  Box3 box;
  box.extend(star.apex);
  const auto extend = [&](const std::array<VertexId, 3>& triangle) {
    for (VertexId v : triangle) box.extend(delaunay_.point(v));
  };
  for (CellId cell : star.zone) {
    for (int i = 0; i < 4; ++i) {
      const bool goes = delaunay_.bipolar({cell, i}) && star.in_zone(delaunay_.neighbors(cell)[i]);
      if (goes) extend(delaunay_.vertices(FacetId{cell, i}));
    }
  }
  for (const Star::Tet& tet : star.tets) {
    const bool at_beyond = tet.outer.cell == RestrictedDelaunay::kBeyond;
    if (!at_beyond && delaunay_.label(delaunay_.mirror(tet.outer).cell) != tet.label) extend(tet.vertices);
    for (int i = 0; i < 3; ++i) {
      if (star.tets[tet.beside[i]].label == tet.label) continue;
      box.extend(delaunay_.point(tet.vertices[(i + 1) % 3]));
      box.extend(delaunay_.point(tet.vertices[(i + 2) % 3]));
    }
  }
  return box;
}

/// After a change that was not meant for the surface: where new triangles wait, it has changed all the same.
void Refinement::note_new_facets() {
  if (watch_.empty()) return;
  constexpr std::size_t kChunk = 4096, kAhead = 8;
  const std::vector<CellId>& created = delaunay_.created();
  const auto collect = [&](std::size_t begin, std::size_t end, std::vector<FacetId>& waiting) {
    for (std::size_t n = begin; n < end; ++n) {
      if (n + kAhead < end) delaunay_.prefetch_labels_around(created[n + kAhead]);
      for (int i = 0; i < 4; ++i) {
        const FacetId facet{created[n], i};
        if (delaunay_.bipolar(facet) && delaunay_.ball(facet) == nullptr) waiting.push_back(facet);
      }
    }
  };
  for (FacetId facet : gather_chunks<FacetId>(created.size(), kChunk, collect)) {
    const auto corners = delaunay_.vertices(facet);
    Box3 box;
    for (VertexId v : corners) box.extend(delaunay_.point(v));
    note_change(box, corners[0]);
  }
}

}  // namespace delvox
