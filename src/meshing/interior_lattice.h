#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "delaunay/restricted_delaunay.h"
#include "delvox/core/geometry.h"
#include "delvox/oracle/oracle.h"
#include "meshing/deep_lattice.h"

namespace delvox {

/// A body-centred cubic lattice inside a domain, clear of the surface's vertices and balls, jittered by a hundredth of
/// its spacing. Its Delaunay tetrahedra have dihedral angles of 60 and 90 degrees, and no other lattice site comes near
/// their circumspheres: most of a body needs neither refinement nor insertion. Not in the book.
///
/// Sites near the surface (the shell) are to be inserted. Deep ones, at least four steps from the nearest site that is
/// blocked or outside, can be written down: the tets with a deep corner are Delaunay whatever lies beyond the shell.
class InteriorLattice {
 public:
  using Site = std::uint32_t;

  /// A site to be inserted, and its vertex, kNone until it is.
  struct ShellSite {
    Site site;
    VertexId vertex = kNone;
  };

  /// pre: delaunay has the balls of all its restricted triangles. `cell_size`: bound on circumradii. Has no sites if
  /// there would be too many, or if go_on() says to end.
  InteriorLattice(const Oracle& oracle, const RestrictedDelaunay& delaunay, double cell_size,
                  const std::function<bool()>& go_on);

  std::size_t site_count() const { return shell_.size() + deep_.size(); }
  Point3 point(Site site) const;
  std::vector<ShellSite>& shell() { return shell_; }
  /// Blocks the sites whose vertices are gone, and moves the shell inward there. False if there is none.
  bool block_removed(const RestrictedDelaunay& delaunay);
  /// The tets with at least one deep corner. pre: all of shell() have their vertices.
  DeepLattice deep(const Oracle& oracle) const;

 private:
  /// State of a site: steps from the nearest that is blocked or outside. With a shell of three, step 2 of DelTetSurf can
  /// remove a site beside the surface without touching the tets that have deep neighbours.
  enum Depth : std::uint8_t { kBlocked = 0, kDeep = 4 };
  using Tet = std::array<Site, 4>;
  using Cube = std::array<std::int32_t, 3>;

  void block_around(const Point3& p, double radius);
  bool is_deep(Site site) const { return state_[site] == kDeep; }
  template <class Visit>
  void for_each_deep_tet(const Visit& visit) const;
  bool find_inside(const Oracle& oracle, const std::function<bool()>& go_on);
  void find_depths();
  bool touches(int state, const Cube& cube, int which) const;
  Site site(const Cube& cube, int which) const {
    return 2 * static_cast<Site>((static_cast<std::size_t>(cube[2]) * counts_[1] + cube[1]) * counts_[0] + cube[0]) + which;
  }
  Cube cube_of(Site site) const;
  std::array<Tet, 4> tets_along(const Cube& cube, int which, int axis) const;
  Point3 unjittered(const Cube& cube, int which) const;

  Point3 origin_;
  double cube_;
  Cube counts_{};
  std::vector<std::uint8_t> state_;
  std::vector<ShellSite> shell_;  // ascending
  std::vector<Site> deep_;        // ascending
};

}  // namespace delvox
