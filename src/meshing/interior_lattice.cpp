#include "meshing/interior_lattice.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "core/hash.h"
#include "core/parallel.h"
#include "core/round.h"
#include "meshing/deep_tets.h"
#include "meshing/lattice_rows.h"

namespace delvox {
namespace {

/// Edge of the lattice's cubes in units of the bound on circumradii, of which a tetrahedron then uses 0.81: with 1.78
/// it would use all of it, but the lattice would be much coarser than what refinement makes of the rest.
constexpr double kCube = 1.45;
/// A tet's circumsphere reaches 0.654 cubes from its corners at most: no vertex that far from all sites disturbs it.
constexpr double kClearance = 0.68;
/// Sites nearer to the surface than that, but no nearer than this, have tets of other shapes around them. They stand
/// where refinement would else put vertices of its own, one by one.
constexpr double kNearest = 0.5;
constexpr double kJitter = 0.01;
constexpr double kMostSites = 1 << 28;
/// Cubes all around, so that a site inside has all of its neighbours.
constexpr int kRim = 2;
constexpr std::size_t kChunk = 4096;

}  // namespace

// Deep sites have no vertex of the surface within `depth`: between two plates 2 R apart, where empty spheres have
// radius R, theirs is 1 - depth / R of the volume. (In a ball of radius R it is the third power of that.)
double InteriorLattice::expected_deep(const RestrictedDelaunay& delaunay, double cell_size) {
  const double cube = kCube * cell_size, depth = (1 + kClearance) * cube;
  const auto six_volumes = map_chunks(delaunay.cell_capacity(), kChunk, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (auto cell = static_cast<CellId>(begin); cell < end; ++cell) {
      if (delaunay.stamp(cell) == 0 || delaunay.label(cell) == 0) continue;
      const double squared_radius = delaunay.sphere(cell).squared_radius;
      if (squared_radius <= depth * depth) continue;
      const auto& v = delaunay.vertices(cell);
      const Point3& a = delaunay.point(v[0]);
      const Vector3 normal = cross(delaunay.point(v[1]) - a, delaunay.point(v[2]) - a);
      sum += std::abs(dot(normal, delaunay.point(v[3]) - a)) * (1 - depth / std::sqrt(squared_radius));
    }
    return sum;
  });
  constexpr double kPerCube = 2;
  return kPerCube / (cube * cube * cube) * std::accumulate(six_volumes.begin(), six_volumes.end(), 0.0) / 6;
}

InteriorLattice::InteriorLattice(const RestrictedDelaunay& delaunay, double cell_size, const GoOn& go_on)
    : cube_(kCube * cell_size) {
  if (lay_out(delaunay) && find_inside(delaunay, go_on)) block_near_surface(delaunay);
}

bool InteriorLattice::lay_out(const RestrictedDelaunay& delaunay) {
  Box3 box;
  for (VertexId v = 0; v < delaunay.vertex_capacity(); ++v) {
    if (delaunay.kind(v) == VertexKind::kSurface) box.extend(delaunay.point(v));
  }
  if (box.empty()) return false;
  origin_ = box.min - Vector3{kRim * cube_, kRim * cube_, kRim * cube_};
  double sites = 2;
  for (int axis = 0; axis < 3; ++axis) {
    const double count = std::ceil((box.max[axis] - box.min[axis]) / cube_) + 2 * kRim;
    sites *= count;
    if (sites > kMostSites) return false;
    counts_[axis] = static_cast<std::int32_t>(count);
  }
  stride_ = {1, static_cast<Site>(counts_[0]), static_cast<Site>(counts_[0] * counts_[1])};
  cubes_ = stride_[2] * counts_[2];
  state_.assign(2 * std::size_t{cubes_}, kBlocked);
  return true;
}

bool InteriorLattice::find_inside(const RestrictedDelaunay& delaunay, const GoOn& go_on) {
  const RowCrossings found = find_row_crossings(delaunay, {origin_, cube_, counts_[1], counts_[2]});
  for (Site row = 0; row + 1 < found.first.size(); ++row) {
    if (!go_on()) {
      inside_.clear();
      return false;
    }
    const Site row_start = row * stride_[1];
    const double shift = is_centre(row_start) ? 0.5 : 0.0;
    const auto place = [&](double x) { return static_cast<Site>(ceil_to_int((x - origin_.x) / cube_ - shift)); };
    for (std::uint32_t c = found.first[row]; c + 1 < found.first[row + 1]; ++c) {
      if (found.crossings[c].label == 0) continue;
      const Site end = place(found.crossings[c + 1].x);
      for (Site i = place(found.crossings[c].x); i < end; ++i) {
        inside_.push_back(row_start + i);
        labels_.push_back(found.crossings[c].label);
        state_[row_start + i] = kDeep;
      }
    }
  }
  return true;
}

/// By all of its vertices and balls. True if that blocked any site.
bool InteriorLattice::block_near_surface(const RestrictedDelaunay& delaunay) {
  const auto any_of_chunks = [](std::size_t count, const auto& block) {
    const auto blocked = map_chunks(count, kChunk, [&](std::size_t begin, std::size_t end) {
      bool any = false;
      for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) any |= block(i);
      return std::uint8_t{any};
    });
    return std::any_of(blocked.begin(), blocked.end(), [](std::uint8_t any) { return any != 0; });
  };
  has_blocked_.resize(delaunay.vertex_capacity(), 0);
  const bool any = any_of_chunks(delaunay.vertex_capacity(), [&](VertexId v) {
    if (delaunay.kind(v) != VertexKind::kSurface) return false;
    has_blocked_[v] = 1;
    return block_around_vertex(delaunay.point(v));
  });
  constexpr CellId kAhead = 16;
  const auto cells = static_cast<CellId>(delaunay.cell_capacity());
  return any_of_chunks(cells, [&](CellId c) {
           if (c + kAhead < cells) delaunay.prefetch_balls(c + kAhead);
           return block_near_balls(delaunay, c);
         }) || any;
}

/// By the vertices and balls of cells made since the shell was inserted.
bool InteriorLattice::block_near_new_cells(const RestrictedDelaunay& delaunay) {
  bool any = false;
  has_blocked_.resize(delaunay.vertex_capacity(), 0);
  for (CellId cell = RestrictedDelaunay::kBeyond + 1; cell < delaunay.cell_capacity(); ++cell) {
    if (delaunay.stamp(cell) < after_shell_) continue;
    any |= block_near_balls(delaunay, cell);
    for (VertexId v : delaunay.vertices(cell)) {
      if (delaunay.kind(v) != VertexKind::kSurface || has_blocked_[v] != 0) continue;
      has_blocked_[v] = 1;
      any |= block_around_vertex(delaunay.point(v));
    }
  }
  return any;
}

/// Every ball is met from a cell inside, those between two regions from both of theirs.
bool InteriorLattice::block_near_balls(const RestrictedDelaunay& delaunay, CellId cell) {
  bool any = false;
  if (!delaunay.has_balls(cell) || delaunay.label(cell) == 0) return false;
  for (int i = 0; i < 4; ++i) {
    const SurfaceBall* ball = delaunay.ball({cell, i});
    if (ball == nullptr) continue;
    const double radius = std::sqrt(ball->squared_radius) / cube_;
    any |= block_around(ball->center, radius, radius);
  }
  return any;
}

bool InteriorLattice::block_around_vertex(const Point3& p) { return block_around(p, kNearest, kClearance); }

/// Sites at up to one distance are blocked, those at up to the other are near, both in cubes. True if that changed any.
/// Beside others of its kind.
bool InteriorLattice::block_around(const Point3& p, double blocked, double near) {
  bool any = false;
  const double reach = near + 2 * kJitter, block = blocked + 2 * kJitter;
  const Point3 at = (1 / cube_) * (p - origin_);
  for (const bool centre : {false, true}) {
    const Point3 u = centre ? at - Vector3{0.5, 0.5, 0.5} : at;
    std::array<std::int64_t, 3> first, last;
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = std::max(std::int64_t{0}, ceil_to_int(u[axis] - reach));
      last[axis] = std::min<std::int64_t>(counts_[axis] - 1, floor_to_int(u[axis] + reach));
    }
    for (std::int64_t k = first[2]; k <= last[2]; ++k) {
      const double dz = static_cast<double>(k) - u.z;
      for (std::int64_t j = first[1]; j <= last[1]; ++j) {
        const double dy = static_cast<double>(j) - u.y;
        const Site row = (centre ? cubes_ : 0) + static_cast<Site>(k * stride_[2] + j * stride_[1]);
        for (std::int64_t i = first[0]; i <= last[0]; ++i) {
          const double dx = static_cast<double>(i) - u.x, squared = dx * dx + dy * dy + dz * dz;
          if (squared > reach * reach) continue;
          any |= lower(row + static_cast<Site>(i), squared <= block * block ? kBlocked : kNear);
        }
      }
    }
  }
  return any;
}

/// Where others may do the same: the lowest wins.
bool InteriorLattice::lower(Site site, State to) {
  const std::atomic_ref<std::uint8_t> state(state_[site]);
  std::uint8_t known = state.load(std::memory_order_relaxed);
  while (known > to) {
    if (state.compare_exchange_weak(known, to, std::memory_order_relaxed)) return true;
  }
  return false;
}

Point3 InteriorLattice::point(Site site) const {
  const bool centre = is_centre(site);
  const Site cube = centre ? site - cubes_ : site;
  std::uint64_t hash = site;
  Point3 p;
  for (int axis = 0; axis < 3; ++axis) {
    hash = mix_hash(hash);
    p[axis] = coordinate(axis, cube / stride_[axis] % counts_[axis], centre) +
              kJitter * cube_ * (2 * unit_interval(hash) - 1);
  }
  return p;
}

/// Is one of the 14 sites around it, with which it shares tets, near the surface or outside?
bool InteriorLattice::touches_surface(Site site) const {
  for (Site step : stride_) {
    if (state_of(site - step) <= kNear || state_of(site + step) <= kNear) return true;
  }
  // The other kind's sites around a centre are its cube's corners, those around a corner lie the other way.
  const Site low = is_centre(site) ? site - cubes_ : site + cubes_ - stride_[0] - stride_[1] - stride_[2];
  for (int corner = 0; corner < 8; ++corner) {
    const Site other = low + (corner & 1) * stride_[0] + (corner >> 1 & 1) * stride_[1] + (corner >> 2) * stride_[2];
    if (state_of(other) <= kNear) return true;
  }
  return false;
}

void InteriorLattice::find_depths() {
  for_each_chunk(inside_.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::uint8_t& state = state_[inside_[i]];
      if (state != kDeep || !touches_surface(inside_[i])) continue;
      std::atomic_ref(state).store(kShell, std::memory_order_relaxed);  // others only ask whether it is lower
    }
  });
  std::vector<ShellSite> known;
  known.swap(shell_);
  deep_.clear();
  auto next_known = known.begin();
  for (Site s : inside_) {
    if (state_[s] == kDeep) deep_.push_back(s);
    if (state_[s] != kShell && state_[s] != kNear) continue;
    while (next_known != known.end() && next_known->site < s) ++next_known;
    const bool is_known = next_known != known.end() && next_known->site == s;
    shell_.push_back({s, is_known ? next_known->vertex : kNone});
  }
}

bool InteriorLattice::block_removed(const RestrictedDelaunay& delaunay) {
  bool any = false;
  for (const ShellSite& shell : shell_) {
    const bool gone = shell.vertex == kNone || delaunay.kind(shell.vertex) != VertexKind::kInterior;
    if (gone) state_[shell.site] = kBlocked;
    any |= gone;
  }
  return any;
}

std::size_t InteriorLattice::insert_shell(RestrictedDelaunay& delaunay, const GoOn& go_on) {
  std::vector<Point3> points;
  std::vector<VertexId*> vertices;
  for (ShellSite& shell : shell_) {
    if (shell.vertex != kNone) continue;
    points.push_back(point(shell.site));
    vertices.push_back(&shell.vertex);
  }
  const std::vector<VertexId> inserted = delaunay.insert_interior(points, go_on);
  for (std::size_t i = 0; i < inserted.size(); ++i) *vertices[i] = inserted[i];
  after_shell_ = delaunay.next_stamp();
  return inserted.size() - static_cast<std::size_t>(std::count(inserted.begin(), inserted.end(), kNone));
}

bool InteriorLattice::adapt(const RestrictedDelaunay& delaunay) {
  const bool removed = block_removed(delaunay), nearer = block_near_new_cells(delaunay);
  if (!removed && !nearer) return false;
  for (Site s : inside_) {
    if (state_[s] == kShell) state_[s] = kDeep;
  }
  find_depths();
  return true;
}

std::uint32_t InteriorLattice::add_deep(RestrictedDelaunay& delaunay) const {
  std::vector<Site> corners;
  std::copy_if(inside_.begin(), inside_.end(), std::back_inserter(corners),
               [this](Site site) { return !is_centre(site) && state_[site] >= kShell; });
  auto next_vertex = static_cast<VertexId>(delaunay.vertex_capacity());
  std::vector<VertexId> vertex_of(state_.size(), kNone);
  std::vector<Label> labels;
  for (const ShellSite& shell : shell_) vertex_of[shell.site] = shell.vertex;
  for (std::size_t i = 0; i < inside_.size(); ++i) {
    if (state_[inside_[i]] != kDeep) continue;
    vertex_of[inside_[i]] = next_vertex++;
    labels.push_back(labels_[i]);
  }
  const DeepTets tets(delaunay, LatticeTets(counts_), corners, std::move(vertex_of), std::move(labels));
  KnownTets known = tets.known();
  known.points.resize(deep_.size());
  for_each_chunk(deep_.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) known.points[i] = point(deep_[i]);
  });
  // Their spheres are empty, so that the walls are facets whatever else there is; if not, there is nothing to rely on.
  const auto stamp = delaunay.replace(known);
  if (!stamp) delaunay.insert_interior(known.points, always_go_on);
  return stamp.value_or(0);
}

}  // namespace delvox
