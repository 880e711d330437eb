#pragma once

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "delaunay/delaunay3.h"
#include "delaunay_checks.h"
#include "support/random.h"

namespace delvox::test {

inline const Box3 kUnitBox{{-1, -1, -1}, {1, 1, 1}};

/// How the points of a test are placed, in kUnitBox.
struct Placement {
  const char* name;
  Point3 (*next)(Random& random);
};

inline Point3 anywhere(Random& random) {
  return random.in(kUnitBox);
}
/// Of a 7^3 lattice: any cube of it is cospherical, any plane coplanar.
inline Point3 on_lattice(Random& random) {
  const auto coordinate = [&] { return 0.25 * random.below(7) - 0.75; };
  return {coordinate(), coordinate(), coordinate()};
}
inline Point3 in_one_plane(Random& random) {
  return {random.between(-1, 1), random.between(-1, 1), random.below(20) == 0 ? random.between(-1, 1) : 0.125};
}
/// Oblique, so that their points are nearly collinear only, or along an axis, where they are exactly.
inline Point3 on_lines(Random& random) {
  const double t = random.between(-0.9, 0.9);
  switch (random.below(12)) {
    case 0: return random.in(kUnitBox);
    case 1: return {t, 0.5 * t, -0.3 * t};
    default: return {t, 0.25, -0.5};
  }
}
/// Exactly cospherical: integer points with x^2 + y^2 + z^2 = 101, 168 of them, and a few within.
inline Point3 on_one_sphere(Random& random) {
  static const std::array<std::array<double, 3>, 6> kinds{
      {{10, 1, 0}, {9, 4, 2}, {8, 6, 1}, {7, 6, 4}, {6, 8, 1}, {4, 7, 6}}};
  if (random.below(20) == 0) return 0.5 * random.direction();
  std::array<double, 3> p = kinds[random.below(6)];
  for (int i = 2; i > 0; --i) std::swap(p[i], p[random.below(i + 1)]);
  for (double& x : p) x *= random.below(2) ? 0.0625 : -0.0625;
  return {p[0], p[1], p[2]};
}
inline Point3 near_one_sphere(Random& random) {
  return 0.7 * random.direction();
}
/// Dense clusters down to 1e-7 of the box, whose circumspheres the filter must not trust.
inline Point3 clustered(Random& random) {
  static const Point3 centers[3] = {{0.5, 0.5, 0.5}, {-0.3, 0.2, 0.1}, {0.1, -0.6, -0.2}};
  return centers[random.below(3)] + (0.3 * std::pow(10, -7 * random.unit())) * random.direction();
}
/// Body-centred lattice sites, jittered as deltetsurf's.
inline Point3 on_jittered_lattice(Random& random) {
  Point3 p = on_lattice(random);
  if (random.below(2)) p = p + Point3{0.125, 0.125, 0.125};
  return p + 0.0025 * random.in(kUnitBox);
}

inline constexpr Placement kPlacements[] = {
    {"Random", anywhere},           {"Lattice", on_lattice},        {"Coplanar", in_one_plane},
    {"Collinear", on_lines},        {"Cospherical", on_one_sphere}, {"NearlyCospherical", near_one_sphere},
    {"Clustered", clustered},       {"JitteredLattice", on_jittered_lattice}};

/// Delaunay3 and CGAL's triangulation, fed the same points; CGAL first gets our four corners.
class AgainstCgal {
 public:
  /// Corner coordinates, sorted.
  using TetPoints = std::array<std::array<double, 3>, 4>;

  AgainstCgal(const Box3& bounds, std::uint64_t seed) : delaunay_(bounds), random_(seed) {
    for (VertexId corner = 0; corner < 4; ++corner) theirs_.insert(cgal(delaunay_.point(corner)));
  }

  /// Removes one of the points present with the given chance, else inserts another.
  void step(Point3 (*place)(Random&), double removals) {
    if (present_.size() > 10 && random_.unit() < removals) {
      remove_one();
    } else {
      insert(place(random_));
    }
  }

  /// The number of cells that were replaced; 0 if the point was there already.
  std::size_t insert(const Point3& p) {
    delaunay_.evaluate(p, any_cell(), star_);
    const std::size_t before = theirs_.number_of_vertices();
    const auto theirs = theirs_.insert(cgal(p));
    EXPECT_EQ(star_.duplicate, theirs_.number_of_vertices() == before);
    if (star_.duplicate) return 0;
    present_.push_back({delaunay_.commit(star_, created_), theirs});
    EXPECT_EQ(delaunay_.vertex_count(), theirs_.number_of_vertices());
    return star_.zone.size();
  }

  void remove_one() { remove(static_cast<std::size_t>(random_.below(static_cast<int>(present_.size())))); }
  void remove_last() { remove(present_.size() - 1); }

  const Delaunay3& delaunay() const { return delaunay_; }
  std::vector<Point3> points() const {
    std::vector<Point3> points;
    for (const Both& both : present_) points.push_back(delaunay_.point(both.ours));
    return points;
  }

  std::vector<TetPoints> ours() const {
    std::vector<TetPoints> tets;
    for_each_cell([&](CellId cell) {
      TetPoints tet;
      for (int i = 0; i < 4; ++i) {
        const Point3& p = delaunay_.point(delaunay_.vertices(cell)[i]);
        tet[i] = {p.x, p.y, p.z};
      }
      add(tets, tet);
    });
    std::sort(tets.begin(), tets.end());
    return tets;
  }

  void expect_equal() const {
    std::vector<TetPoints> theirs;
    for (const auto& cell : theirs_.finite_cell_handles()) {
      TetPoints tet;
      for (int i = 0; i < 4; ++i) {
        const auto& p = cell->vertex(i)->point();
        tet[i] = {p.x(), p.y(), p.z()};
      }
      add(theirs, tet);
    }
    std::sort(theirs.begin(), theirs.end());
    EXPECT_TRUE(ours() == theirs) << ours().size() << " tets, CGAL has " << theirs.size();
  }

  /// Neighbours know each other, tets are positive, and no facet's opposite vertex is inside: by Delaunay's lemma all is
  /// Delaunay.
  void expect_locally_delaunay() const {
    std::size_t broken = 0, flat = 0, violations = 0;
    for_each_cell([&](CellId cell) {
      std::array<Point3, 4> p;
      for (int i = 0; i < 4; ++i) p[i] = delaunay_.point(delaunay_.vertices(cell)[i]);
      flat += signed_volume(p[0], p[1], p[2], p[3]) <= 0;
      for (int i = 0; i < 4; ++i) {
        if (delaunay_.neighbors(cell)[i] == Delaunay3::kOutside) continue;
        const FacetId mirror = delaunay_.mirror({cell, i});
        auto own = delaunay_.vertices(FacetId{cell, i}), other = delaunay_.vertices(mirror);
        std::reverse(other.begin(), other.end());
        broken += delaunay_.stamp(mirror.cell) == 0 || delaunay_.neighbors(mirror.cell)[mirror.index] != cell ||
                  canonical(own) != canonical(other);
        const Point3& opposite = delaunay_.point(delaunay_.vertices(mirror.cell)[mirror.index]);
        violations += CGAL::side_of_oriented_sphere(cgal(p[0]), cgal(p[1]), cgal(p[2]), cgal(p[3]), cgal(opposite)) ==
                      CGAL::ON_POSITIVE_SIDE;
      }
    });
    EXPECT_EQ(broken, 0u);
    EXPECT_EQ(flat, 0u);
    EXPECT_EQ(violations, 0u);
  }

 private:
  using Theirs = CGAL::Delaunay_triangulation_3<ExactKernel>;
  struct Both {
    VertexId ours;
    Theirs::Vertex_handle theirs;
  };

  template <class Visit>
  void for_each_cell(const Visit& visit) const {
    for (CellId cell = Delaunay3::kOutside + 1; cell < delaunay_.cell_capacity(); ++cell) {
      if (delaunay_.stamp(cell) != 0) visit(cell);
    }
  }
  static void add(std::vector<TetPoints>& tets, TetPoints tet) {
    for (auto& p : tet) {
      for (double& x : p) x += 0.0;  // minus zero is zero
    }
    std::sort(tet.begin(), tet.end());
    tets.push_back(tet);
  }
  /// Near or far from what comes next.
  CellId any_cell() {
    const VertexId near = present_.empty() ? 0 : present_[random_.bits() % present_.size()].ours;
    return delaunay_.cell_of(near);
  }

  void remove(std::size_t which) {
    const Both gone = present_[which];
    delaunay_.remove(gone.ours, destroyed_, created_);
    theirs_.remove(gone.theirs);
    present_[which] = present_.back();
    present_.pop_back();
  }

  Delaunay3 delaunay_;
  Theirs theirs_;
  Random random_;
  std::vector<Both> present_;
  Star star_;
  std::vector<CellId> created_, destroyed_;
};

}  // namespace delvox::test
