#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "delaunay/restricted_delaunay.h"
#include "delvox/core/geometry.h"
#include "delvox/oracle/oracle.h"
#include "meshing/lattice_tets.h"

namespace delvox {

/// A body-centred cubic lattice inside the restricted triangles, clear of their vertices and balls, jittered by a
/// hundredth of its spacing. Its Delaunay tetrahedra have dihedral angles of 60 and 90 degrees, and no other lattice
/// site comes near their circumspheres: most of a body needs neither refinement nor insertion. Not in the book.
///
/// Sites near the surface, and those beside one that is, or that is blocked or outside, are to be inserted (the shell).
/// Around the others, the deep ones, all tets are the lattice's: these are Delaunay whatever lies beyond the shell, and
/// go into the triangulation as they are.
class InteriorLattice {
 public:
  using Site = LatticeTets::Site;

  /// A site to be inserted, and its vertex, kNone until it is.
  struct ShellSite {
    Site site;
    VertexId vertex = kNone;
  };

  /// About how many deep sites there would be, at a fraction of what laying them out takes.
  static double expected_deep(const RestrictedDelaunay& delaunay, double cell_size);

  /// pre: delaunay has the balls of all its restricted triangles. `cell_size`: bound on circumradii. Has no sites if
  /// the box around the surface would hold too many, or if go_on() says to end.
  InteriorLattice(const RestrictedDelaunay& delaunay, double cell_size, const GoOn& go_on);

  /// All of them; nothing but their number is known until find_depths().
  std::size_t site_count() const { return inside_.size(); }
  /// Which sites are shell, which deep. To be called once, before any of the following: adapt() does so itself.
  void find_depths();
  Point3 point(Site site) const;
  std::vector<ShellSite>& shell() { return shell_; }
  /// Inserts those of the shell that have no vertex yet, until go_on() says to end; how many were.
  std::size_t insert_shell(RestrictedDelaunay& delaunay, const GoOn& go_on);
  /// Blocks the sites whose vertices are gone and those near surface vertices and balls of cells made since the shell was
  /// inserted, and moves the shell inward there. False if there is none.
  bool adapt(const RestrictedDelaunay& delaunay);
  const std::vector<Site>& deep() const { return deep_; }
  /// Adds the deep sites and their tets to the triangulation; returns the tets' stamp, 0 if they have none of their
  /// own. pre: all of shell() have their vertices.
  std::uint32_t add_deep(RestrictedDelaunay& delaunay) const;

 private:
  /// kBlocked: not to be a vertex, or outside; kNear and kShell: to be inserted, kNear with tets that are none of the
  /// lattice's.
  enum State : std::uint8_t { kBlocked, kNear, kShell, kDeep };

  bool lay_out(const RestrictedDelaunay& delaunay);
  bool find_inside(const RestrictedDelaunay& delaunay, const GoOn& go_on);
  bool block_near_surface(const RestrictedDelaunay& delaunay);
  bool block_near_new_cells(const RestrictedDelaunay& delaunay);
  bool block_near_balls(const RestrictedDelaunay& delaunay, CellId cell);
  bool block_around_vertex(const Point3& p);
  bool block_around(const Point3& p, double blocked, double near);
  bool lower(Site site, State to);
  bool block_removed(const RestrictedDelaunay& delaunay);
  bool touches_surface(Site site) const;

  /// As others may be changing it.
  std::uint8_t state_of(Site site) const {
    return std::atomic_ref(state_[site]).load(std::memory_order_relaxed);
  }
  /// Sites are numbered along x, y, z: first the corners of all cubes, then their centres.
  bool is_centre(Site site) const { return site >= cubes_; }
  double coordinate(int axis, std::int64_t index, bool centre) const {
    return origin_[axis] + (static_cast<double>(index) + (centre ? 0.5 : 0.0)) * cube_;
  }

  Point3 origin_;
  double cube_;
  std::array<std::int32_t, 3> counts_{};
  std::array<Site, 3> stride_{};
  Site cubes_ = 0;
  std::uint32_t after_shell_ = 0;            // the stamp of cells made since, or a smaller one
  std::vector<std::uint8_t> has_blocked_;    // of each vertex: whether the sites near it have been blocked
  mutable std::vector<std::uint8_t> state_;  // mutable for std::atomic_ref, which takes no const
  std::vector<Site> inside_;      // ascending
  std::vector<Label> labels_;     // of inside_
  std::vector<ShellSite> shell_;  // ascending
  std::vector<Site> deep_;        // ascending
};

}  // namespace delvox
