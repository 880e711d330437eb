#include "meshing/reconnection.h"

#include <algorithm>
#include <limits>

#include "delaunay/predicates.h"
#include "meshing/roughness_guard.h"

namespace delvox {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

// The corners around edge ab, counter-clockwise seen from b.
bool Reconnection::find_ring(std::uint32_t a, std::uint32_t b) {
  sides_.clear();
  for (std::uint32_t t : mesh_.star(a)) {
    const Tet& tet = mesh_.tet(t);
    const int at_b = static_cast<int>(std::find(tet.begin(), tet.end(), b) - tet.begin());
    if (at_b == 4) continue;
    if (sides_.size() == kLargestRing) return false;
    const int at_a = static_cast<int>(std::find(tet.begin(), tet.end(), a) - tet.begin());
    // Of face at_b, outward, the corners that follow a: seen from b they run clockwise.
    const auto& f = kTetFaces[at_b];
    const int k = f[0] == at_a ? 0 : f[1] == at_a ? 1 : 2;
    sides_.push_back({t, tet[f[(k + 2) % 3]], tet[f[(k + 1) % 3]]});
  }
  // Chain them, from the side that none leads to if the ring is open.
  std::size_t first = 0;
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const auto leads_to_i = [&](const Side& side) { return side.to == sides_[i].from; };
    if (std::none_of(sides_.begin(), sides_.end(), leads_to_i)) first = i;
  }
  ring_.assign(1, sides_[first].from);
  ring_tets_.clear();
  std::uint32_t corner = ring_[0];
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const auto next = std::find_if(sides_.begin(), sides_.end(), [&](const Side& side) { return side.from == corner; });
    if (next == sides_.end()) return false;
    ring_tets_.push_back(next->tet);
    corner = next->to;
    ring_.push_back(corner);
  }
  open_ = ring_.back() != ring_.front();
  if (!open_) ring_.pop_back();
  const Label region = mesh_.region(ring_tets_[0]);
  return ring_.size() <= kLargestRing &&
         std::all_of(ring_tets_.begin(), ring_tets_.end(), [&](std::uint32_t t) { return mesh_.region(t) == region; });
}

// The triangles at edge ab of the boundary give way to two at the edge between the ends of the open ring.
bool Reconnection::flip_boundary(std::uint32_t a, std::uint32_t b, Change& change) {
  if (mesh_.fixed_edge(a, b)) return false;
  const std::uint32_t first = ring_.front(), last = ring_.back();
  if (mesh_.fan(a).size() < 4 || mesh_.fan(b).size() < 4 || mesh_.has_boundary_edge(first, last)) return false;
  change.old_triangles = {mesh_.boundary_triangle(a, b, first), mesh_.boundary_triangle(a, b, last)};
  for (std::uint32_t t : change.old_triangles) {
    if (t == RepairMesh::kNone) return false;
  }
  const Point3 &at_a = mesh_.point(a), &at_b = mesh_.point(b), &p = mesh_.point(first), &q = mesh_.point(last);
  if (!surface_.allows(p, at_b, q) || !surface_.allows(p, q, at_a)) return false;
  change.new_triangles = {{first, b, last}, {first, last, a}};
  if (RoughnessGuard(mesh_, surface_.max_roughness_degrees()).too_rough(change.new_triangles, change.old_triangles)) {
    return false;
  }
  // At a convex edge the new triangles lie within the tets that were there.
  if (orientation(at_a, at_b, p, q) > 0) return true;
  return !guard_.crosses(change.new_triangles[0], change.old_triangles) &&
         !guard_.crosses(change.new_triangles[1], change.old_triangles);
}

// cost_[i][j]: of the best triangulation of the corners i to j. Those dearer than `worth` are not looked into.
double Reconnection::triangulate(std::uint32_t a, std::uint32_t b, double worth) {
  const int n = static_cast<int>(ring_.size());
  for (int i = 0; i + 1 < n; ++i) cost_[i][i + 1] = 0;
  for (int length = 2; length < n; ++length) {
    for (int i = 0; i + length < n; ++i) {
      const int j = i + length;
      double best = kInfinity;
      for (int k = i + 1; k < j; ++k) {
        double cost = cost_[i][k] + cost_[k][j];
        if (cost < std::min(best, worth)) cost += price(ring_[i], ring_[k], ring_[j], b);
        if (cost < std::min(best, worth)) cost += price(ring_[k], ring_[i], ring_[j], a);
        if (cost < std::min(best, worth)) {
          best = cost;
          apex_[i][j] = k;
        }
      }
      cost_[i][j] = best;
    }
  }
  return cost_[0][n - 1];
}

void Reconnection::collect(std::uint32_t a, std::uint32_t b, int from, int to, Change& change) const {
  if (to - from < 2) return;
  const int k = apex_[from][to];
  change.new_tets.push_back({ring_[from], ring_[k], ring_[to], b});
  change.new_tets.push_back({ring_[k], ring_[from], ring_[to], a});
  collect(a, b, from, k, change);
  collect(a, b, k, to, change);
}

double Reconnection::remove_edge(std::uint32_t a, std::uint32_t b, double allowance, Change& change) {
  if (!find_ring(a, b) || (ring_.size() < 3 && !open_)) return -kInfinity;
  double worth = 0;
  for (std::uint32_t t : ring_tets_) worth += shortfall(t);
  const double cost = triangulate(a, b, worth + allowance);
  change.clear();
  if (!(cost < worth + allowance) || (open_ && !flip_boundary(a, b, change))) return -kInfinity;
  change.old_tets = ring_tets_;
  collect(a, b, 0, static_cast<int>(ring_.size()) - 1, change);
  return worth - cost;
}

// The tet across the face of u, v and the apex; kNone at the boundary and where another region begins.
std::uint32_t Reconnection::beyond(std::uint32_t tet, std::uint32_t u, std::uint32_t v, std::uint32_t apex) const {
  const std::uint32_t next = mesh_.across(tet, corner_beside(tet, u, v, apex));
  return next == RepairMesh::kNone || mesh_.region(next) != mesh_.region(tet) ? RepairMesh::kNone : next;
}

// Which corner of a tet is none of these three.
int Reconnection::corner_beside(std::uint32_t tet, std::uint32_t u, std::uint32_t v, std::uint32_t w) const {
  const Tet& corners = mesh_.tet(tet);
  int i = 0;
  while (corners[i] == u || corners[i] == v || corners[i] == w) ++i;
  return i;
}

// The cheaper of a tet at edge uv, and of going on to the face beyond it. Seen from above_, the faces lie to the left
// of uv. Returns the cost less the shortfall of the tets that go with the face beyond.
double Reconnection::beyond_edge(std::uint32_t u, std::uint32_t v, std::uint32_t tet_below, std::uint32_t tet_above,
                                 int depth, Change& change) {
  const double here = price(u, v, below_, above_);
  const std::size_t old_count = change.old_tets.size(), new_count = change.new_tets.size();
  if (here > 0 && depth > 0) {
    const std::uint32_t below = beyond(tet_below, u, v, below_), above = beyond(tet_above, u, v, above_);
    const bool both = below != RepairMesh::kNone && above != RepairMesh::kNone && below != above;
    const bool known = std::find(change.old_tets.begin(), change.old_tets.end(), below) != change.old_tets.end();
    if (both && !known) {
      const std::uint32_t w = mesh_.tet(below)[corner_beside(below, u, v, below_)];
      double cost = -shortfall(below) - shortfall(above);
      change.old_tets.insert(change.old_tets.end(), {below, above});
      const bool same_face = w == mesh_.tet(above)[corner_beside(above, u, v, above_)];
      if (same_face) cost += beyond_edge(u, w, below, above, depth - 1, change);
      if (same_face && cost < here) cost += beyond_edge(w, v, below, above, depth - 1, change);
      if (same_face && cost < here) return cost;
    }
  }
  change.old_tets.resize(old_count);
  change.new_tets.resize(new_count);
  change.new_tets.push_back({u, v, below_, above_});
  return here;
}

double Reconnection::remove_faces(std::uint32_t tet, int face, double allowance, Change& change) {
  const Tet& corners = mesh_.tet(tet);
  const auto& f = kTetFaces[face];
  const std::uint32_t p = corners[f[0]], q = corners[f[1]], r = corners[f[2]];  // seen from outside
  below_ = corners[face];
  const std::uint32_t other = mesh_.across(tet, face);
  if (other == RepairMesh::kNone || mesh_.region(other) != mesh_.region(tet)) return -kInfinity;
  for (std::uint32_t w : mesh_.tet(other)) {
    if (w != p && w != q && w != r) above_ = w;
  }
  change.clear();
  change.old_tets = {tet, other};
  const double worth = shortfall(tet) + shortfall(other);
  constexpr int kDepth = 2;
  double cost = 0;
  const std::uint32_t edge[3] = {p, q, r};
  for (int i = 0; i < 3 && cost < kInfinity; ++i) {
    cost += beyond_edge(edge[i], edge[(i + 1) % 3], tet, other, kDepth, change);
  }
  return cost < worth + allowance ? worth - cost : -kInfinity;
}

}  // namespace delvox
