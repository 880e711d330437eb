#include "meshing/interior_lattice.h"

#include <algorithm>
#include <cmath>

#include "core/hash.h"

namespace delvox {
namespace {

/// Edge of the lattice's cubes in units of the bound on circumradii, of which a tetrahedron then uses 0.81: with 1.78 it
/// would use all of it, but the lattice would be much coarser than what refinement makes of the rest.
constexpr double kCube = 1.45;
/// A tet's circumsphere reaches 0.654 cubes from its corners at most: no vertex that far from all sites disturbs it.
constexpr double kClearance = 0.68;
constexpr double kJitter = 0.01;
constexpr std::size_t kMostSites = std::size_t{1} << 28;

constexpr int next_axis(int axis) { return (axis + 1) % 3; }

}  // namespace

InteriorLattice::InteriorLattice(const Oracle& oracle, const RestrictedDelaunay& delaunay, double cell_size,
                                 const std::function<bool()>& go_on)
    : cube_(kCube * cell_size) {
  Box3 box;
  for (VertexId v = 0; v < delaunay.vertex_capacity(); ++v) {
    if (delaunay.kind(v) == VertexKind::kSurface) box.extend(delaunay.point(v));
  }
  if (box.empty()) return;
  // A rim of cubes all around, so that a site inside has all of its neighbours.
  double sites = 2;
  origin_ = box.min - Vector3{2 * cube_, 2 * cube_, 2 * cube_};
  for (int axis = 0; axis < 3; ++axis) {
    const double count = std::ceil((box.max[axis] - box.min[axis]) / cube_) + 4;
    counts_[axis] = static_cast<std::int32_t>(std::min(count, 1e9));
    sites *= count;
  }
  if (sites > kMostSites) return;  // refinement does without a lattice, as it does where a size field varies
  state_.assign(static_cast<std::size_t>(sites), kDeep);
  for (VertexId v = 0; v < delaunay.vertex_capacity(); ++v) {
    if (delaunay.kind(v) == VertexKind::kSurface) block_around(delaunay.point(v), kClearance * cube_);
  }
  for (CellId cell = 0; cell < delaunay.cell_capacity(); ++cell) {
    for (int i = 0; i < 4 && delaunay.has_balls(cell); ++i) {
      const SurfaceBall* ball = delaunay.ball({cell, i});
      if (ball != nullptr && delaunay.label(cell) != 0) block_around(ball->center, std::sqrt(ball->squared_radius));
    }
  }
  if (find_inside(oracle, go_on)) find_depths();
}

Point3 InteriorLattice::unjittered(const Cube& cube, int which) const {
  const double half = 0.5 * which;
  return origin_ + cube_ * Vector3{cube[0] + half, cube[1] + half, cube[2] + half};
}

InteriorLattice::Cube InteriorLattice::cube_of(Site site) const {
  const Site cube = site / 2;
  const Site row = cube / counts_[0];
  return {static_cast<std::int32_t>(cube % counts_[0]), static_cast<std::int32_t>(row % counts_[1]),
          static_cast<std::int32_t>(row / counts_[1])};
}

Point3 InteriorLattice::point(Site site) const {
  Point3 p = unjittered(cube_of(site), site % 2);
  std::uint64_t hash = mix_hash(site);
  for (int axis = 0; axis < 3; ++axis, hash = mix_hash(hash)) p[axis] += kJitter * cube_ * (2 * unit_interval(hash) - 1);
  return p;
}

void InteriorLattice::block_around(const Point3& p, double radius) {
  Cube low, high, at;
  const double reach = (radius + 2 * kJitter * cube_) / cube_;
  for (int axis = 0; axis < 3; ++axis) {
    const double u = (p[axis] - origin_[axis]) / cube_;
    low[axis] = std::max(0, static_cast<std::int32_t>(std::floor(u - reach - 0.5)));
    high[axis] = std::min(counts_[axis] - 1, static_cast<std::int32_t>(std::floor(u + reach)));
  }
  for (at[2] = low[2]; at[2] <= high[2]; ++at[2]) {
    for (at[1] = low[1]; at[1] <= high[1]; ++at[1]) {
      for (at[0] = low[0]; at[0] <= high[0]; ++at[0]) {
        for (int which = 0; which < 2; ++which) {
          const bool near = squared_distance(unjittered(at, which), p) < reach * reach * cube_ * cube_;
          if (near) state_[site(at, which)] = kBlocked;
        }
      }
    }
  }
}

bool InteriorLattice::find_inside(const Oracle& oracle, const std::function<bool()>& go_on) {
  constexpr Site kSitesPerLook = 1 << 12;
  for (Site s = 0; s < state_.size(); ++s) {
    if (s % kSitesPerLook == 0 && !go_on()) return false;
    if (state_[s] != kBlocked && oracle.label(point(s)) == 0) state_[s] = kBlocked;
  }
  return true;
}

/// Is one of the 14 sites around it in that state?
bool InteriorLattice::touches(int state, const Cube& c, int which) const {
  for (int axis = 0; axis < 3; ++axis) {
    for (int step : {-1, 1}) {
      Cube other = c;
      other[axis] += step;
      if (state_[site(other, which)] == state) return true;
    }
  }
  const int step = which == 0 ? -1 : 1;
  for (int corner = 0; corner < 8; ++corner) {
    const Cube other{c[0] + step * (corner & 1), c[1] + step * (corner >> 1 & 1), c[2] + step * (corner >> 2)};
    if (state_[site(other, 1 - which)] == state) return true;
  }
  return false;
}

void InteriorLattice::find_depths() {
  for (int depth = kBlocked; depth + 1 < kDeep; ++depth) {
    for (Site s = 0; s < state_.size(); ++s) {
      if (state_[s] == kDeep && touches(depth, cube_of(s), s % 2)) state_[s] = static_cast<std::uint8_t>(depth + 1);
    }
  }
  std::vector<ShellSite> known;
  known.swap(shell_);
  deep_.clear();
  auto next_known = known.begin();
  for (Site s = 0; s < state_.size(); ++s) {
    if (state_[s] == kDeep) deep_.push_back(s);
    if (state_[s] == kBlocked || state_[s] == kDeep) continue;
    while (next_known != known.end() && next_known->site < s) ++next_known;
    const bool is_known = next_known != known.end() && next_known->site == s;
    shell_.push_back({s, is_known ? next_known->vertex : kNone});
  }
}

bool InteriorLattice::block_removed(const RestrictedDelaunay& delaunay) {
  bool any = false;
  for (const ShellSite& shell : shell_) {
    const bool gone = delaunay.kind(shell.vertex) != VertexKind::kInterior;
    if (gone) state_[shell.site] = kBlocked;
    any |= gone;
  }
  if (!any) return false;
  for (std::uint8_t& state : state_) {
    if (state != kBlocked) state = kDeep;
  }
  find_depths();
  return true;
}

/// The tets along the edge from a site to the next of its kind: one for each pair of neighbours in the ring of four
/// sites of the other kind around the edge's middle.
std::array<std::array<InteriorLattice::Site, 4>, 4> InteriorLattice::tets_along(const Cube& cube, int which,
                                                                                int axis) const {
  const int u = next_axis(axis), v = next_axis(u);
  Cube other = cube;
  ++other[axis];
  Cube low = which == 1 ? other : cube;  // of the ring
  if (which == 0) --low[u], --low[v];
  Cube low_u = low, low_v = low, high = low;
  ++low_u[u], ++low_v[v], ++high[u], ++high[v];
  const std::array<Site, 4> ring{site(low, 1 - which), site(low_u, 1 - which), site(high, 1 - which),
                                 site(low_v, 1 - which)};
  std::array<Tet, 4> tets;
  for (int i = 0; i < 4; ++i) tets[i] = {site(cube, which), site(other, which), ring[i], ring[(i + 1) % 4]};
  return tets;
}

template <class Visit>
void InteriorLattice::for_each_deep_tet(const Visit& visit) const {
  for (Site s : deep_) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int back = 0; back < 2; ++back) {
        Cube start = cube_of(s);
        start[axis] -= back;
        for (const Tet& tet : tets_along(start, s % 2, axis)) {
          // Each is met from all of its deep corners.
          const bool first = std::none_of(tet.begin(), tet.end(), [&](Site c) { return c < s && is_deep(c); });
          if (first) visit(tet);
        }
      }
    }
  }
}

DeepLattice InteriorLattice::deep(const Oracle& oracle) const {
  DeepLattice result;
  std::vector<std::uint32_t> number(state_.size());
  for (const ShellSite& shell : shell_) {
    number[shell.site] = static_cast<std::uint32_t>(result.shell.size());
    result.shell.push_back(shell.vertex);
  }
  for (Site s : deep_) {
    number[s] = static_cast<std::uint32_t>(shell_.size() + result.points.size());
    result.points.push_back(point(s));
    result.labels.push_back(oracle.label(result.points.back()));
  }
  for_each_deep_tet([&](const Tet& tet) {
    result.tets.push_back({number[tet[0]], number[tet[1]], number[tet[2]], number[tet[3]]});
  });
  return result;
}

}  // namespace delvox
