#include "delaunay/delaunay3.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "delaunay/hole_filling.h"
#include "delaunay/predicates.h"
#include "delvox/core/mesh.h"

namespace delvox {
namespace {

constexpr VertexId kFirstCorner = 0;

}  // namespace

Delaunay3::Delaunay3(const Box3& bounds) : bounds_(bounds), several_threads_(thread_count() > 1) {
  const Point3 c = bounds.center();
  // Far enough that no circumcentre of a cell with a corner can lie in `bounds`; odd factors keep the corners off the
  // planes and spheres of the data.
  const double far = 7.31 * bounds.diagonal();
  for (const Point3& corner :
       {Point3{1.01, 1.02, 1.03}, Point3{-1.07, 1.08, -1.09}, Point3{1.04, -1.05, -1.06}, Point3{-1.1, -1.11, 1.12}}) {
    vertices_[new_vertex()] = {c + far * corner, kOutside};
  }
  // Below this radius the rounding of a circumcentre, which grows with its coordinates, is no longer far below the
  // filter's margin.
  const double smallest_trusted = std::max(1e-6 * bounds.diagonal(), 1e-8 * (norm(bounds.min) + norm(bounds.max)));
  trusted_squared_radius_ = smallest_trusted * smallest_trusted;
  // The determinant is a sum of six products of three differences, none larger than the box: some 50 roundings in all.
  const Vector3 extent = bounds.max - bounds.min;
  orientation_error_ = 1e-14 * extent.x * extent.y * extent.z;
  vertex_count_ = kCorners;
  make_first_cell();
}

Delaunay3::~Delaunay3() = default;

void Delaunay3::clear() {
  vertices_.clear();
  vertices_.grow_to(kCorners);  // the corners are still there
  claims_.clear();
  claims_.grow_to(kCorners);
  vertex_count_ = kCorners;
  free_vertices_.clear();
  free_cells_.clear();
  room_ = {};
  cells_.clear();
  stamps_.clear();
  make_first_cell();
}

void Delaunay3::make_first_cell() {
  grow_cells(1);
  cells_[kOutside] = {{kNone, kNone, kNone, kNone}, {kOutside, kOutside, kOutside, kOutside}, {{}, -1}};
  stamps_[kOutside] = next_stamp_++;
  const CellId first = new_cell();
  const auto p = [this](VertexId v) { return point(v); };
  set_cell(first, {0, 1, 2, 3}, circumsphere(p(0), p(1), p(2), p(3)));
  cells_[first].neighbors = {kOutside, kOutside, kOutside, kOutside};
}

/// The visibility walk: through any facet that has p on its far side. It ends in every Delaunay triangulation.
CellId Delaunay3::locate(const Point3& p, CellId hint) const {
  CellId cell = hint, came_from = kNone;
  for (bool moved = true; moved;) {
    moved = false;
    prefetch_neighbors(cell);
    for (int i = 0; i < 4 && !moved; ++i) {
      const CellId next = cells_[cell].neighbors[i];
      if (next == came_from || next == kOutside) continue;
      if (!is_beyond({cell, i}, p)) continue;
      came_from = cell;
      cell = next;
      moved = true;
    }
  }
  return cell;
}

bool Delaunay3::is_beyond(FacetId facet, const Point3& p) const {
  const auto v = vertices(facet);
  const Point3 &a = point(v[0]), &b = point(v[1]), &c = point(v[2]);
  if (std::min({v[0], v[1], v[2]}) >= kCorners) {
    const double six_volumes = dot(cross(b - a, c - a), p - a);
    if (std::abs(six_volumes) > orientation_error_) return six_volumes > 0;
  }
  return orientation(a, b, c, p) > 0;
}

void Delaunay3::find_incident_cells(VertexId vertex, std::vector<CellId>& around, SmallMap& met) const {
  met.clear();
  around.clear();
  const auto add = [&](CellId cell) {
    met.find_or(cell, [&] {
      around.push_back(cell);
      cells_.prefetch(cell);
      return 1u;
    });
  };
  add(cell_of(vertex));
  for (std::size_t next = 0; next < around.size(); ++next) {
    const Cell& cell = cells_[around[next]];
    for (int i = 0; i < 4; ++i) {
      if (cell.vertices[i] != vertex) add(cell.neighbors[i]);
    }
  }
}

inline bool Delaunay3::in_conflict(CellId cell, const Point3& p) const {
  const Circumsphere& sphere = cells_[cell].sphere;
  if (sphere.squared_radius > trusted_squared_radius_) {
    // The cached sphere decides unless p is near it: circumsphere() keeps nine digits, the margin asks for six.
    const double squared = squared_distance(p, sphere.center);
    const double margin = 1e-6 * (squared + sphere.squared_radius);
    if (squared < sphere.squared_radius - margin) return true;
    if (squared > sphere.squared_radius + margin) return false;
  }
  return in_conflict_exactly(cell, p);
}

bool Delaunay3::in_conflict_exactly(CellId cell, const Point3& p) const {
  if (cell == kOutside) return false;
  const auto& v = cells_[cell].vertices;
  return in_sphere(point(v[0]), point(v[1]), point(v[2]), point(v[3]), p);
}

bool Delaunay3::is_vertex_of(CellId cell, const Point3& p) const {
  const auto& v = cells_[cell].vertices;
  return std::any_of(v.begin(), v.end(), [&](VertexId vertex) { return point(vertex) == p; });
}

void Delaunay3::grow_zone(const Point3& p, CellId start, Star& star, StarSearch& search) const {
  constexpr std::uint32_t kOuter = 0, kInZone = 1;
  search.met.clear();
  search.entered.clear();
  const auto add = [&](CellId cell, int facet) {
    star.zone.push(cell);
    search.entered.push(static_cast<std::uint8_t>(facet));
    prefetch_neighbors(cell);
  };
  star.zone.make_room(1);
  search.entered.make_room(1);
  search.met.find_or(start, [] { return kInZone; });
  add(start, 0);
  for (std::size_t next = 0; next < star.zone.size(); ++next) {
    const CellId cell = star.zone[next];
    const int first = search.entered[next];
    const int facets = next == 0 ? 4 : 3;  // the one by which the cell was entered has been seen to
    star.zone.make_room(4);
    star.tets.make_room(4);
    search.entered.make_room(4);
    const SmallMap::Table met = search.met.table_for(4);
    for (int step = 1; step <= facets; ++step) {
      const FacetId inner{cell, (first + step) & 3}, outer = mirror(inner);
      SmallMap::Entry& entry = met.place_of(outer.cell);
      if (!met.known(entry)) {
        const bool conflict = in_conflict(outer.cell, p);
        entry = met.made(outer.cell, conflict ? kInZone : kOuter);
        if (conflict) {
          add(outer.cell, outer.index);
          continue;
        }
      } else if (SmallMap::Table::number(entry) == kInZone) {
        continue;
      }
      Star::Tet& tet = star.tets.push_raw();
      tet.outer = outer;
      tet.vertices = vertices(inner);
    }
  }
}

CellId Delaunay3::nearest_hint(const Point3& p, const std::vector<CellId>& hints) const {
  CellId living = kNone;
  for (CellId cell : hints) {
    if (stamp(cell) == 0) continue;
    if (in_conflict(cell, p)) return cell;
    if (living == kNone) living = cell;
  }
  return living != kNone ? living : cell_of(0);
}

void Delaunay3::find_zone(const Point3& p, CellId hint, Star& star, StarSearch& search) const {
  star.apex = p;
  star.duplicate = false;
  star.zone.clear();
  star.tets.clear();
  star.corners.clear();
  if (!in_conflict(hint, p)) hint = locate(p, hint);
  if (is_vertex_of(hint, p)) {
    star.duplicate = true;
    return;
  }
  grow_zone(p, hint, star, search);
}

void Delaunay3::find_tets(Star& star, StarSearch& search) const {
  search.edges.match(star);
  search.spheres.find(star, search.edges.names(), [this](VertexId v) -> const Point3& { return point(v); });
}

void Delaunay3::join(FacetId facet, FacetId outer) {
  cells_[facet.cell].neighbors[facet.index] = outer.cell;
  if (outer.cell != kOutside) cells_[outer.cell].neighbors[outer.index] = facet.cell;
}

VertexId Delaunay3::new_vertex() {
  if (free_vertices_.empty()) {
    vertices_.grow_to(vertices_.size() + 1);
    claims_.grow_to(vertices_.size());
    return static_cast<VertexId>(vertices_.size() - 1);
  }
  const VertexId vertex = free_vertices_.back();
  free_vertices_.pop_back();
  return vertex;
}

void Delaunay3::grow_cells(std::size_t count) {
  cells_.grow_to(count);
  stamps_.grow_to(count);
}

CellId Delaunay3::new_cell() {
  if (free_cells_.empty()) {
    const std::size_t cell = cells_.size();
    grow_cells(cell + 1);
    stamps_[cell] = 0;
    return static_cast<CellId>(cell);
  }
  const CellId cell = free_cells_.back();
  free_cells_.pop_back();
  return cell;
}

void Delaunay3::set_cell(CellId cell, const std::array<VertexId, 4>& vertices, const Circumsphere& sphere) {
  cells_[cell].vertices = vertices;
  cells_[cell].sphere = sphere;
  stamps_[cell] = next_stamp_++;
  for (VertexId v : vertices) vertices_[v].cell = cell;
}

void Delaunay3::claim(VertexId vertex, std::uint32_t number) const {
  const auto mine = static_cast<std::uint16_t>(number);
  std::uint16_t& held = claims_[vertex];
  const auto gives_way = [mine](std::uint16_t to) { return to / kMostClaims != mine / kMostClaims || to < mine; };
  if (!several_threads_) {
    if (gives_way(held)) held = mine;
    return;
  }
  std::atomic_ref<std::uint16_t> holder(held);
  std::uint16_t known = holder.load(std::memory_order_relaxed);
  while (gives_way(known) && !holder.compare_exchange_weak(known, mine, std::memory_order_relaxed)) {
  }
}

void Delaunay3::claim(const Star& star, std::uint32_t number) const {
  bool any = false;
  for (const Star::Corner& corner : star.corners) {
    if (corner.vertex < kCorners) continue;
    claim(corner.vertex, number);
    any = true;
  }
  if (!any) claim(kFirstCorner, number);  // the first star of all
}

bool Delaunay3::holds(const Star& star, std::uint32_t number) const {
  bool any = false;
  for (const Star::Corner& corner : star.corners) {
    if (corner.vertex < kCorners) continue;
    if (!holds(corner.vertex, number)) return false;
    any = true;
  }
  return any || holds(kFirstCorner, number);
}

void Delaunay3::furnish(Room& room, const Star& star, std::size_t spare_cells) {
  if (room.vertex == kNone) room.vertex = new_vertex();
  if (room.cells.size() + star.zone.size() >= star.tets.size()) return;
  const std::size_t wanted = star.tets.size() - star.zone.size() + spare_cells;
  while (room.cells.size() < wanted) room.cells.push_back(new_cell());
}

void Delaunay3::clear_out(Room& room) {
  if (room.vertex != kNone) free_vertices_.push_back(room.vertex);
  free_cells_.insert(free_cells_.end(), room.cells.begin(), room.cells.end());
  room = {};
}

VertexId Delaunay3::commit(const Star& star, std::vector<CellId>& created) {
  furnish(room_, star);
  return commit(star, new_claim(), room_, created);
}

/// Gives the star's vertices new cells. The far corners may be those of other stars, too, that are committed at the
/// same time, but the cell that each has is in the zone of one of these only.
void Delaunay3::repoint(const Star& star, const std::vector<CellId>& created) {
  for (const Star::Corner& corner : star.corners) {
    CellId& cell = vertices_[corner.vertex].cell;
    if (corner.vertex >= kCorners) {
      cell = created[corner.tet];
      continue;
    }
    const std::atomic_ref<CellId> known(cell);
    if (star.in_zone(known.load(std::memory_order_relaxed))) known.store(created[corner.tet], std::memory_order_relaxed);
  }
}

VertexId Delaunay3::commit(const Star& star, std::uint32_t number, Room& room, std::vector<CellId>& created) {
  const VertexId apex = std::exchange(room.vertex, kNone);
  // The zone's numbers are used again at once: neighbours stay near in memory.
  created.assign(star.zone.begin(), star.zone.begin() + std::min(star.zone.size(), star.tets.size()));
  for (std::size_t i = star.tets.size(); i < star.zone.size(); ++i) {
    stamps_[star.zone[i]] = 0;
    room.cells.push_back(star.zone[i]);
  }
  while (created.size() < star.tets.size()) {
    created.push_back(room.cells.back());
    room.cells.pop_back();
  }
  for (std::size_t t = 0; t < star.tets.size(); ++t) {
    const Star::Tet& tet = star.tets[t];
    const CellId cell = created[t];
    cells_[cell].vertices = {apex, tet.vertices[0], tet.vertices[1], tet.vertices[2]};
    cells_[cell].sphere = tet.sphere;
    stamps_[cell] = number;
    for (int i = 0; i < 3; ++i) cells_[cell].neighbors[i + 1] = created[tet.beside[i]];
    join({cell, 0}, tet.outer);
  }
  repoint(star, created);
  vertices_[apex] = {star.apex, created.front()};
  vertex_count_.fetch_add(1, std::memory_order_relaxed);
  return apex;
}

void Delaunay3::remove(VertexId vertex, std::vector<CellId>& destroyed, std::vector<CellId>& created) {
  find_incident_cells(vertex, destroyed);
  if (!hole_filling_) hole_filling_ = std::make_unique<HoleFilling>(bounds_);
  hole_filling_->find(*this, vertex, destroyed);
  created.clear();
  for (std::size_t i = 0; i < hole_filling_->tets().size(); ++i) {
    created.push_back(i < destroyed.size() ? destroyed[i] : new_cell());
  }
  for (std::size_t i = created.size(); i < destroyed.size(); ++i) {
    stamps_[destroyed[i]] = 0;
    free_cells_.push_back(destroyed[i]);
  }
  for (std::size_t i = 0; i < created.size(); ++i) {
    const HoleFilling::Tet& tet = hole_filling_->tets()[i];
    set_cell(created[i], tet.vertices, tet.sphere);
    for (int f = 0; f < 4; ++f) {
      const HoleFilling::Side& side = tet.sides[f];
      if (side.tet != kNone) {
        cells_[created[i]].neighbors[f] = created[side.tet];
      } else {
        join({created[i], f}, side.outer);
      }
    }
  }
  free_vertices_.push_back(vertex);
  vertex_count_.fetch_sub(1, std::memory_order_relaxed);
}

}  // namespace delvox
