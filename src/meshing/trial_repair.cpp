#include "meshing/trial_repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/hash.h"
#include "meshing/roughness_guard.h"

namespace delvox {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// How much worse a change may make things at first, in shortfalls of flat tets.
constexpr double kAllowance = 2;

}  // namespace

bool TrialRepair::repair(std::uint32_t tet) {
  least_gain_ = local_.least_gain(tet);
  return reconnect(tet) || remove_vertices(tet) || insert_vertices(tet) || split_surface_edges(tet);
}

// `gain` is that of the change alone.
bool TrialRepair::attempt(const Change& change, double gain, std::optional<NewVertex> vertex) {
  std::vector<std::uint32_t> waited = begin_trial();
  if (vertex) mesh_.add_vertex(vertex->place, vertex->on_surface);
  local_.apply(change);
  return end_trial(gain, std::move(waited));
}

// Returns what waited before.
std::vector<std::uint32_t> TrialRepair::begin_trial() {
  mesh_.begin_trial();
  return std::exchange(local_.waiting(), {});
}

// Repairs what came to wait since a trial began, and keeps all if there is a gain in the end.
bool TrialRepair::end_trial(double gain, std::vector<std::uint32_t> waited) {
  constexpr int kSteps = 12;
  std::vector<std::uint32_t>& waiting = local_.waiting();
  std::vector<std::uint32_t> resisting;
  for (int step = 0; step < kSteps && !waiting.empty(); ++step) {
    const std::uint32_t tet = waiting.back();
    waiting.pop_back();
    if (!local_.is_sliver(tet)) continue;
    gain += local_.repair(tet);
    if (local_.is_sliver(tet)) resisting.push_back(tet);
  }
  const bool better = gain > least_gain_;
  if (better) {
    mesh_.keep_trial();
    waited.insert(waited.end(), waiting.begin(), waiting.end());
    waited.insert(waited.end(), resisting.begin(), resisting.end());
  } else {
    mesh_.undo_trial();
  }
  waiting.swap(waited);
  return better;
}

bool TrialRepair::shake(std::uint32_t tet) {
  constexpr int kShakes = 48;
  least_gain_ = local_.least_gain(tet);
  const Tet corners = mesh_.tet(tet);
  const std::vector<std::uint32_t> around = neighborhood(corners);
  double shortest = kInfinity;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < i; ++j) shortest = std::min(shortest, distance(mesh_.point(corners[i]), mesh_.point(corners[j])));
  }
  for (int k = 0; k < kShakes; ++k) {
    const double reach = shortest * (0.05 + 0.3 * k / kShakes);
    std::vector<std::uint32_t> waited = begin_trial();
    local_.waiting().push_back(tet);
    const double gain = disturb(k % 2 == 0 ? std::span(corners) : std::span(around), reach, mix_hash(++shakes_));
    if (end_trial(gain, std::move(waited))) return true;
  }
  return false;
}

// Moves vertices by up to `reach`. Returns the gain, most often a loss.
double TrialRepair::disturb(std::span<const std::uint32_t> vertices, double reach, std::uint64_t seed) {
  double gain = 0;
  const auto random = [&] { return 2 * unit_interval(seed = mix_hash(seed)) - 1; };
  for (std::uint32_t v : vertices) {
    const double x = random(), y = random(), z = random();
    gain += local_.displace(v, {reach * x, reach * y, reach * z});
  }
  return gain;
}

// Vertices that share tets with these, and these.
std::vector<std::uint32_t> TrialRepair::neighborhood(std::span<const std::uint32_t> vertices) const {
  std::vector<std::uint32_t> all;
  for (std::uint32_t v : vertices) {
    for (std::uint32_t t : mesh_.star(v)) all.insert(all.end(), mesh_.tet(t).begin(), mesh_.tet(t).end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

bool TrialRepair::reconnect(std::uint32_t tet) {
  const Tet corners = mesh_.tet(tet);
  const auto worth_trying = [](double gain) { return gain > -kAllowance; };
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      const double gain = local_.reconnection().remove_edge(corners[i], corners[j], kAllowance, change_);
      if (worth_trying(gain) && attempt(change_, gain)) return true;
    }
  }
  for (int i = 0; i < 4; ++i) {
    const double gain = local_.reconnection().remove_faces(tet, i, kAllowance, change_);
    if (worth_trying(gain) && attempt(change_, gain)) return true;
  }
  return false;
}

double TrialRepair::price(const Tet& t) const {
  return tets_.price(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), mesh_.point(t[3]));
}

// The same with a vertex that is to be made.
double TrialRepair::price(const Tet& t, const Point3& new_vertex) const {
  std::array<Point3, 4> p;
  for (int i = 0; i < 4; ++i) p[i] = t[i] == mesh_.point_count() ? new_vertex : mesh_.point(t[i]);
  return tets_.price(p[0], p[1], p[2], p[3]);
}

// The tets at a vertex shrink to nothing, or get another vertex in its place. The gain; less infinity if it cannot be.
double TrialRepair::merge(std::uint32_t vertex, std::uint32_t into, Change& change) const {
  change.clear();
  double gain = 0;
  const auto star = mesh_.star(vertex);
  for (std::uint32_t t : star) {
    Tet tet = mesh_.tet(t);
    if (mesh_.region(t) != mesh_.region(star[0])) return -kInfinity;
    change.old_tets.push_back(t);
    gain += local_.shortfall(t);
    if (has_corner(tet, into)) continue;
    *std::find(tet.begin(), tet.end(), vertex) = into;
    gain -= price(tet);
    if (!(gain > -kAllowance - static_cast<double>(star.size()))) return -kInfinity;
    change.new_tets.push_back(tet);
  }
  return gain;
}

bool TrialRepair::remove_vertices(std::uint32_t tet) {
  const Tet corners = mesh_.tet(tet);
  Change best_change;
  double best = -kAllowance;
  for (std::uint32_t v : corners) {
    if (mesh_.on_boundary(v)) continue;
    for (std::uint32_t into : neighborhood({&v, 1})) {
      if (into == v) continue;
      const double gain = merge(v, into, change_);
      if (!(gain > best)) continue;
      best = gain;
      std::swap(best_change, change_);
    }
  }
  if (best_change.old_tets.empty() || !attempt(best_change, best)) return false;
  ++removals_;
  return true;
}

// On both sides of a flat tet, and in it.
std::vector<Point3> TrialRepair::places_for(std::uint32_t tet) const {
  const Tet& t = mesh_.tet(tet);
  const std::array<Point3, 4> p{mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), mesh_.point(t[3])};
  const Point3 middle = 0.25 * ((p[0] + p[1]) + (p[2] + p[3]));
  double longest = 0;
  Vector3 normal{};
  for (const auto& f : kTetFaces) {
    const Vector3 n = cross(p[f[1]] - p[f[0]], p[f[2]] - p[f[0]]);
    if (squared_norm(n) > squared_norm(normal)) normal = n;
    longest = std::max({longest, distance(p[f[0]], p[f[1]]), distance(p[f[0]], p[f[2]])});
  }
  const Vector3 step = (longest / norm(normal)) * normal;
  std::vector<Point3> places{middle};
  for (double share : {0.1, 0.2, 0.3, 0.45, 0.6}) {
    places.push_back(middle + share * step);
    places.push_back(middle - share * step);
  }
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < i; ++j) places.push_back(midpoint(p[i], p[j]));
  }
  return places;
}

// Tets joined with `tet` by faces whose circumspheres hold the place.
std::vector<std::uint32_t> TrialRepair::cavity_around(std::uint32_t tet, const Point3& place) const {
  constexpr std::size_t kLargest = 60;
  std::vector<std::uint32_t> cavity{tet};
  for (std::size_t i = 0; i < cavity.size() && cavity.size() < kLargest; ++i) {
    for (int face = 0; face < 4; ++face) {
      const std::uint32_t next = mesh_.across(cavity[i], face);
      if (next == RepairMesh::kNone || mesh_.region(next) != mesh_.region(tet)) continue;
      if (std::find(cavity.begin(), cavity.end(), next) != cavity.end()) continue;
      const Tet& t = mesh_.tet(next);
      const TetGeometry g = tet_geometry(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), mesh_.point(t[3]));
      if (squared_distance(g.circumcenter, place) < g.squared_circumradius) cavity.push_back(next);
    }
  }
  return cavity;
}

// A cavity with a new vertex in it. Tets whose faces the vertex cannot be joined to stay out of the cavity.
std::optional<TrialRepair::Insertion> TrialRepair::insert(std::uint32_t tet, const Point3& place) const {
  if (!surface_.inside(place, mesh_.region(tet))) return std::nullopt;
  std::vector<std::uint32_t> cavity = cavity_around(tet, place);
  while (true) {
    Insertion insertion{0, place, {}};
    const std::size_t misfit = fill(cavity, insertion);
    if (misfit == cavity.size()) return insertion;
    if (misfit == 0) return std::nullopt;  // the sliver itself
    cavity.erase(cavity.begin() + static_cast<std::ptrdiff_t>(misfit));
  }
}

// Joins the faces of a cavity to the new vertex. Returns which tet of the cavity has a face that it cannot be joined
// to, or their number.
std::size_t TrialRepair::fill(const std::vector<std::uint32_t>& cavity, Insertion& insertion) const {
  for (std::size_t i = 0; i < cavity.size(); ++i) {
    insertion.gain += local_.shortfall(cavity[i]);
    const Tet& corners = mesh_.tet(cavity[i]);
    for (int face = 0; face < 4; ++face) {
      if (std::find(cavity.begin(), cavity.end(), mesh_.across(cavity[i], face)) != cavity.end()) continue;
      const auto& f = kTetFaces[face];
      const Tet joined{corners[f[0]], corners[f[2]], corners[f[1]], mesh_.point_count()};
      const double cost = price(joined, insertion.place);
      if (cost == kInfinity) return i;
      insertion.gain -= cost;
      insertion.change.new_tets.push_back(joined);
    }
  }
  insertion.change.old_tets = cavity;
  return cavity.size();
}

bool TrialRepair::insert_vertices(std::uint32_t tet) {
  constexpr std::size_t kTries = 4;
  std::vector<Insertion> insertions;
  for (const Point3& place : places_for(tet)) {
    auto insertion = insert(tet, place);
    if (insertion && insertion->gain > -kAllowance) insertions.push_back(std::move(*insertion));
  }
  std::stable_sort(insertions.begin(), insertions.end(),
                   [](const Insertion& a, const Insertion& b) { return a.gain > b.gain; });
  for (std::size_t i = 0; i < std::min(kTries, insertions.size()); ++i) {
    if (!attempt(insertions[i].change, insertions[i].gain, NewVertex{insertions[i].place, false})) continue;
    ++insertions_;
    return true;
  }
  return false;
}

// An edge of the boundary gets a vertex on the surface near its middle: the place, the change and its gain; none if a
// bound would break.
std::optional<Point3> TrialRepair::split(const Edge& edge, Change& change, double& gain) const {
  change.clear();
  gain = 0;
  if (mesh_.fixed_edge(edge[0], edge[1])) return std::nullopt;
  Vector3 outward{};
  for (std::uint32_t t : mesh_.fan(edge[0])) {
    const Triangle& tri = mesh_.triangle(t);
    if (!has_corner(tri, edge[1])) continue;
    const Vector3 n = cross(mesh_.point(tri[1]) - mesh_.point(tri[0]), mesh_.point(tri[2]) - mesh_.point(tri[0]));
    outward = outward + (1 / norm(n)) * n;
    change.old_triangles.push_back(t);
  }
  if (change.old_triangles.empty() || !(norm(outward) > 0.1)) return std::nullopt;
  const Point3 &a = mesh_.point(edge[0]), &b = mesh_.point(edge[1]);
  const Label region = mesh_.region(mesh_.star(edge[0])[0]);
  const auto place = surface_.nearest(midpoint(a, b), (1 / norm(outward)) * outward, distance(a, b), region);
  if (!place) return std::nullopt;
  const std::uint32_t vertex = mesh_.point_count();
  for (std::uint32_t t : change.old_triangles) {
    for (std::uint32_t end : edge) {
      Triangle half = mesh_.triangle(t);
      std::replace(half.begin(), half.end(), end, vertex);
      const auto at = [&](int i) { return half[i] == vertex ? *place : mesh_.point(half[i]); };
      if (!surface_.allows(at(0), at(1), at(2))) return std::nullopt;
      change.new_triangles.push_back(half);
    }
  }
  const RoughnessGuard roughness(mesh_, surface_.max_roughness_degrees());
  if (roughness.too_rough(change.new_triangles, vertex, *place, change.old_triangles)) return std::nullopt;
  for (std::uint32_t t : mesh_.star(edge[0])) {
    if (!has_corner(mesh_.tet(t), edge[1])) continue;
    if (mesh_.region(t) != region) return std::nullopt;
    change.old_tets.push_back(t);
    gain += local_.shortfall(t);
    for (std::uint32_t end : edge) {
      Tet half = mesh_.tet(t);
      std::replace(half.begin(), half.end(), end, vertex);
      gain -= price(half, *place);
      change.new_tets.push_back(half);
    }
  }
  return place;
}

bool TrialRepair::split_surface_edges(std::uint32_t tet) {
  const Tet corners = mesh_.tet(tet);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < i; ++j) {
      double gain = 0;
      const auto place = split({corners[i], corners[j]}, change_, gain);
      if (!place || !(gain > -kAllowance)) continue;
      const auto crosses = [&](const Triangle& triangle) {
        return local_.guard().crosses(triangle, mesh_.point_count(), *place, change_.old_triangles);
      };
      if (std::any_of(change_.new_triangles.begin(), change_.new_triangles.end(), crosses)) continue;
      if (!attempt(change_, gain, NewVertex{*place, true})) continue;
      ++insertions_;
      return true;
    }
  }
  return false;
}

}  // namespace delvox
