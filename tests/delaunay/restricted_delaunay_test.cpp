#include "delaunay/restricted_delaunay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <stdexcept>

#include "delaunay/restricted_triangles.h"
#include "delaunay_checks.h"
#include "support/random.h"
#include "support/shapes.h"

namespace delvox {
namespace {

using test::Random;

const Box3 kBox{{-1, -1, -1}, {1, 1, 1}};

/// Two intersecting balls in the box, at any place and scale: both labels occur everywhere, dual edges cross up to
/// four times.
std::unique_ptr<SmoothOracle> two_balls(double scale = 1, const Point3& shift = {}) {
  const std::array<Point3, 2> centers{shift + scale * Point3{0.3, 0.1, -0.2}, shift + scale * Point3{-0.4, -0.3, 0.25}};
  ImplicitFunction function;
  const auto nearest = [=](const Point3& p) {
    return squared_distance(p, centers[0]) < squared_distance(p, centers[1]) ? centers[0] : centers[1];
  };
  function.value = [=](const Point3& p) { return distance(p, nearest(p)) - 0.45 * scale; };
  function.gradient = [=](const Point3& p) { return (1 / distance(p, nearest(p))) * (p - nearest(p)); };
  function.box = {shift + scale * kBox.min, shift + scale * kBox.max};
  function.resolution = 0.1 * scale;
  return make_implicit_oracle(function);
}

/// How the points of a test are placed.
struct Placement {
  const char* name;
  Point3 (*next)(Random& random);
};

Point3 anywhere(Random& random) {
  return random.in(kBox);
}
/// Points of a 9^3 lattice: any cube of it is cospherical, any plane coplanar.
Point3 on_lattice(Random& random) {
  const auto coordinate = [&] { return 0.1875 * random.below(9) - 0.75; };
  return {coordinate(), coordinate(), coordinate()};
}
Point3 in_one_plane(Random& random) {
  Point3 p = random.in(kBox);
  p.z = random.below(10) == 0 ? p.z : 0.125;
  return p;
}
Point3 on_one_sphere(Random& random) {
  return 0.7 * random.direction();
}
/// Dense clusters down to 1e-7 of the box, whose circumspheres the filter must not trust.
Point3 clustered(Random& random) {
  static const Point3 centers[3] = {{0.5, 0.5, 0.5}, {-0.3, 0.2, 0.1}, {0.1, -0.6, -0.2}};
  return centers[random.below(3)] + (0.3 * std::pow(10, -7 * random.unit())) * random.direction();
}

class RestrictedDelaunaySuite : public testing::TestWithParam<Placement> {};

INSTANTIATE_TEST_SUITE_P(Placements, RestrictedDelaunaySuite,
                         testing::Values(Placement{"Random", anywhere}, Placement{"Lattice", on_lattice},
                                         Placement{"Coplanar", in_one_plane}, Placement{"Cospherical", on_one_sphere},
                                         Placement{"Clustered", clustered}),
                         [](const auto& info) { return std::string(info.param.name); });

/// Inserts and removes at random, keeping a list of what should be there.
class Workout {
 public:
  Workout(const Oracle& oracle, Point3 (*place)(Random&), std::uint64_t seed)
      : delaunay_(oracle), place_(place), random_(seed) {
    std::set<std::array<double, 3>> distinct;
    std::vector<Point3> seeds;
    for (int n = 0; n < 30; ++n) {
      const Point3 p = place_(random_);
      if (distinct.insert({p.x, p.y, p.z}).second) seeds.push_back(p);
    }
    delaunay_.insert_seeds(seeds);
    for (VertexId v = 4; v < 4 + seeds.size(); ++v) present_.push_back(v);
  }

  void step(double removals) {
    if (present_.size() > 20 && random_.unit() < removals) {
      remove();
    } else {
      insert();
    }
  }

  void insert() {
    const Point3 p = place_(random_);
    const Star& star = delaunay_.evaluate(p, delaunay_.created()[random_.below(int(delaunay_.created().size()))]);
    const bool known =
        std::any_of(present_.begin(), present_.end(), [&](VertexId v) { return delaunay_.point(v) == p; });
    ASSERT_EQ(star.duplicate, known);
    if (known) {
      EXPECT_TRUE(star.zone.empty());
      EXPECT_TRUE(star.tets.empty());
      return;
    }
    const VertexId vertex = delaunay_.commit(random_.below(2) ? VertexKind::kSurface : VertexKind::kInterior);
    present_.push_back(vertex);
    expect_star_came_true(star, vertex);
  }

  void remove() {
    const std::size_t which = static_cast<std::size_t>(random_.below(int(present_.size())));
    delaunay_.remove(present_[which]);
    present_[which] = present_.back();
    present_.pop_back();
  }

  RestrictedDelaunay& delaunay() { return delaunay_; }
  const std::vector<VertexId>& present() const { return present_; }

 private:
  /// The star as evaluated is what the triangulation holds after commit, down to the last bit.
  void expect_star_came_true(const Star& star, VertexId vertex) {
    const auto& created = delaunay_.created();
    ASSERT_EQ(created.size(), star.tets.size());
    for (std::size_t i = 0; i < created.size(); ++i) {
      const Star::Tet& tet = star.tets[i];
      std::array<VertexId, 4> expected{vertex, tet.vertices[0], tet.vertices[1], tet.vertices[2]};
      std::array<VertexId, 4> found = delaunay_.vertices(created[i]);
      const auto apex = std::find(found.begin(), found.end(), vertex) - found.begin();
      ASSERT_LT(apex, 4);
      EXPECT_EQ(delaunay_.neighbors(created[i])[apex], tet.outer.cell);
      if (tet.outer.cell != RestrictedDelaunay::kBeyond) {
        EXPECT_EQ(delaunay_.neighbors(tet.outer.cell)[tet.outer.index], created[i]);
      }
      std::sort(expected.begin(), expected.end());
      std::sort(found.begin(), found.end());
      ASSERT_EQ(found, expected);
      EXPECT_EQ(delaunay_.sphere(created[i]).center, tet.sphere.center);
      EXPECT_EQ(delaunay_.sphere(created[i]).squared_radius, tet.sphere.squared_radius);
      EXPECT_EQ(delaunay_.label(created[i]), tet.label);
      EXPECT_GT(test::signed_volume(star.apex, delaunay_.point(tet.vertices[0]), delaunay_.point(tet.vertices[1]),
                                    delaunay_.point(tet.vertices[2])),
                0);
    }
  }

  RestrictedDelaunay delaunay_;
  Point3 (*place_)(Random&);
  Random random_;
  std::vector<VertexId> present_;
};

TEST_P(RestrictedDelaunaySuite, StaysDelaunayThroughThousandsOfInsertionsAndRemovals) {
  const auto oracle = two_balls();
  Workout workout(*oracle, GetParam().next, 1);
  for (int n = 0; n < 3000; ++n) {
    workout.step(n < 1500 ? 0.2 : 0.5);
    ASSERT_FALSE(HasFatalFailure());
    if (n % 300 == 299) {
      test::expect_delaunay(workout.delaunay());
      EXPECT_EQ(workout.delaunay().vertex_count(), workout.present().size());
      EXPECT_EQ(test::used_vertices(workout.delaunay()), workout.present().size());
    }
  }
}

TEST_P(RestrictedDelaunaySuite, KeepsSpheresAndLabelsThatRecomputingGives) {
  const auto oracle = two_balls();
  Workout workout(*oracle, GetParam().next, 2);
  for (int n = 0; n < 800; ++n) workout.step(0.3);
  test::expect_true_cells(workout.delaunay(), *oracle);
}

TEST_P(RestrictedDelaunaySuite, KeptBallsStayOnTheirDualEdgesAndEmpty) {
  const auto oracle = two_balls();
  Workout workout(*oracle, GetParam().next, 3);
  std::size_t kept = 0;
  for (int n = 0; n < 600; ++n) {
    test::compute_all_balls(workout.delaunay());
    workout.step(0.25);
    kept += test::expect_true_balls(workout.delaunay(), *oracle, n % 50 == 0);
    ASSERT_FALSE(HasFailure()) << n;
  }
  EXPECT_GT(kept, 1000u);  // the test saw balls that outlived a change
}

TEST_P(RestrictedDelaunaySuite, IsTheSameOnASecondRun) {
  const auto oracle = two_balls();
  Workout first(*oracle, GetParam().next, 4), second(*oracle, GetParam().next, 4);
  for (int n = 0; n < 500; ++n) {
    first.step(0.4);
    second.step(0.4);
    ASSERT_EQ(first.delaunay().created(), second.delaunay().created());
  }
  ASSERT_EQ(first.delaunay().cell_capacity(), second.delaunay().cell_capacity());
  for (CellId c = 0; c < first.delaunay().cell_capacity(); ++c) {
    ASSERT_EQ(first.delaunay().stamp(c), second.delaunay().stamp(c));
    if (first.delaunay().stamp(c) == 0) continue;
    ASSERT_EQ(first.delaunay().vertices(c), second.delaunay().vertices(c));
    ASSERT_EQ(first.delaunay().neighbors(c), second.delaunay().neighbors(c));
  }
}

TEST(RestrictedDelaunay, StaysDelaunayFarFromTheOriginAndAtTinyAndHugeScales) {
  for (const auto& [scale, shift] : {std::pair{1.0, Point3{1e5, -3e5, 2e5}},
                                     {1e-3, Point3{10, 20, 30}},
                                     {1e5, Point3{}},
                                     {1.0, Point3{1e8, 1e8, -1e8}},
                                     {1e-3, Point3{}}}) {
    const auto oracle = two_balls(scale, shift);
    RestrictedDelaunay delaunay(*oracle);
    Random random(5);
    std::vector<Point3> seeds;
    for (int n = 0; n < 20; ++n) seeds.push_back(shift + scale * clustered(random));
    delaunay.insert_seeds(seeds);
    for (int n = 0; n < 800; ++n) {
      const Point3 p = shift + scale * (n % 2 ? clustered(random) : anywhere(random));
      if (!delaunay.evaluate(p, delaunay.created().front()).duplicate) delaunay.commit(VertexKind::kInterior);
    }
    test::expect_delaunay(delaunay);
  }
}

// The rounding of a circumcentre grows with its coordinates, not with the box: a filter that forgets this trusts
// spheres that are too small.
TEST(RestrictedDelaunay, StaysDelaunayInAClusterFarFromTheOrigin) {
  const Point3 shift{1e8, -1e8, 1e8};
  const auto oracle = two_balls(1, shift);
  RestrictedDelaunay delaunay(*oracle);
  Random random(16);
  const auto next = [&] { return shift + 2e-5 * random.in(kBox); };
  delaunay.insert_seeds({next(), next(), next(), next()});
  for (int n = 0; n < 2000; ++n) {
    if (!delaunay.evaluate(next(), delaunay.created().front()).duplicate) delaunay.commit(VertexKind::kInterior);
  }
  test::expect_delaunay(delaunay);
}

TEST(RestrictedDelaunay, EvaluatingChangesNothing) {
  const auto oracle = two_balls();
  Workout workout(*oracle, anywhere, 6);
  for (int n = 0; n < 200; ++n) workout.insert();
  RestrictedDelaunay& delaunay = workout.delaunay();
  test::compute_all_balls(delaunay);
  const std::vector<CellId> created = delaunay.created();
  Random random(7);
  for (int n = 0; n < 200; ++n) delaunay.evaluate(random.in(kBox), delaunay.created().front());
  EXPECT_EQ(delaunay.created(), created);
  test::expect_delaunay(delaunay);
  test::expect_true_balls(delaunay, *oracle, true);
}

/// Two balls whose inside has any label.
class Labelled final : public Oracle {
 public:
  explicit Labelled(Label inside) : inside_(inside) {}
  Box3 bounds() const override { return balls_->bounds(); }
  Label label(const Point3& p) const override { return balls_->label(p) != 0 ? inside_ : 0; }
  Point3 intersect(const Point3& a, const Point3& b) const override { return balls_->intersect(a, b); }
  std::vector<Point3> intersect_all(const Point3& a, const Point3& b) const override {
    return balls_->intersect_all(a, b);
  }
  Seeds seeds(const SizeField& size, const GoOn& go_on) const override { return balls_->seeds(size, go_on); }
  std::unique_ptr<Oracle> clone() const override { return std::make_unique<Labelled>(inside_); }

 private:
  std::unique_ptr<Oracle> balls_ = two_balls();
  Label inside_;
};

TEST(RestrictedDelaunay, LabelsAreKeptUpToTheLargestAndOthersRefused) {
  const std::vector<Point3> points = two_balls()->seeds(0.2).points;
  const Labelled largest(kLargestLabel), beyond(kLargestLabel + 1), negative(-1);
  RestrictedDelaunay delaunay(largest);
  delaunay.insert_seeds(points);
  std::set<Label> labels;
  for (CellId cell : delaunay.created()) labels.insert(delaunay.label(cell));
  EXPECT_EQ(labels, (std::set<Label>{0, kLargestLabel}));
  for (const Labelled* oracle : {&beyond, &negative}) {
    RestrictedDelaunay refuses(*oracle);
    EXPECT_THROW(refuses.insert_seeds(points), std::out_of_range);
  }
}

TEST(RestrictedDelaunay, TheZoneHoldsExactlyTheCellsWhoseSphereContainsTheApex) {
  const auto oracle = two_balls();
  Workout workout(*oracle, anywhere, 8);
  for (int n = 0; n < 300; ++n) workout.insert();
  const RestrictedDelaunay& delaunay = workout.delaunay();
  Random random(9);
  for (int n = 0; n < 100; ++n) {
    const Point3 p = random.in(kBox);
    const Star& star = workout.delaunay().evaluate(p, delaunay.created().front());
    std::set<CellId> expected;
    for (CellId c = 0; c < delaunay.cell_capacity(); ++c) {
      if (delaunay.stamp(c) == 0 || !test::finite(delaunay, c)) continue;
      const Circumsphere& sphere = delaunay.sphere(c);
      if (squared_distance(sphere.center, p) < sphere.squared_radius) expected.insert(c);
    }
    EXPECT_EQ(std::set<CellId>(star.zone.begin(), star.zone.end()), expected);
  }
}

TEST(RestrictedDelaunay, EveryVertexIsFoundAgainAsADuplicateFromAnyHint) {
  for (auto place : {anywhere, on_lattice, on_one_sphere}) {
    const auto oracle = two_balls();
    Workout workout(*oracle, place, 10);
    for (int n = 0; n < 300; ++n) workout.step(0.2);
    Random random(11);
    std::vector<CellId> living;
    for (CellId c = 0; c < workout.delaunay().cell_capacity(); ++c) {
      if (workout.delaunay().stamp(c) != 0) living.push_back(c);
    }
    for (VertexId v : workout.present()) {
      const CellId hint = living[static_cast<std::size_t>(random.below(int(living.size())))];
      EXPECT_TRUE(workout.delaunay().evaluate(workout.delaunay().point(v), hint).duplicate);
    }
  }
}

TEST(RestrictedDelaunay, AStampTellsAReusedNumberFromTheCellThatWasMeant) {
  const auto oracle = two_balls();
  Workout workout(*oracle, anywhere, 12);
  for (int n = 0; n < 100; ++n) workout.insert();
  RestrictedDelaunay& delaunay = workout.delaunay();
  Random random(13);
  for (int n = 0; n < 200; ++n) {
    std::vector<std::pair<CellId, std::uint32_t>> zone, others;
    const Star& star = delaunay.evaluate(random.in(kBox), delaunay.created().front());
    ASSERT_FALSE(star.duplicate);
    for (CellId c : star.zone) zone.push_back({c, delaunay.stamp(c)});
    for (const Star::Tet& tet : star.tets) others.push_back({tet.outer.cell, delaunay.stamp(tet.outer.cell)});
    delaunay.commit(VertexKind::kInterior);
    for (const auto& [cell, stamp] : zone) EXPECT_FALSE(delaunay.alive(cell, stamp));
    for (const auto& [cell, stamp] : others) EXPECT_TRUE(delaunay.alive(cell, stamp));
    for (CellId c : delaunay.created()) EXPECT_NE(delaunay.stamp(c), 0u);
  }
}

TEST(RestrictedDelaunay, IncidentCellsAreThoseWithTheVertex) {
  const auto oracle = two_balls();
  Workout workout(*oracle, on_lattice, 14);
  for (int n = 0; n < 200; ++n) workout.step(0.3);
  const RestrictedDelaunay& delaunay = workout.delaunay();
  for (VertexId v : workout.present()) {
    std::set<CellId> expected;
    for (CellId c = 0; c < delaunay.cell_capacity(); ++c) {
      const auto& corners = delaunay.vertices(c);
      if (delaunay.stamp(c) != 0 && std::count(corners.begin(), corners.end(), v)) expected.insert(c);
    }
    const auto& found = delaunay.incident_cells(v);
    EXPECT_EQ(std::set<CellId>(found.begin(), found.end()), expected);
    EXPECT_EQ(found.size(), expected.size());
  }
}

TEST(RestrictedDelaunay, ABallIsTheSameFromBothSidesAndSharedByThem) {
  const auto oracle = two_balls();
  Workout workout(*oracle, anywhere, 15);
  for (int n = 0; n < 200; ++n) workout.insert();
  RestrictedDelaunay& delaunay = workout.delaunay();
  int tested = 0;
  for (CellId c = 0; c < delaunay.cell_capacity(); ++c) {
    for (int i = 0; delaunay.stamp(c) != 0 && test::finite(delaunay, c) && i < 4; ++i) {
      if (!test::finite(delaunay, delaunay.neighbors(c)[i])) continue;
      const FacetId facet{c, i}, other = delaunay.mirror(facet);
      ASSERT_EQ(delaunay.mirror(other).cell, c);
      if (!delaunay.bipolar(facet) || delaunay.ball(facet) != nullptr) continue;
      const Circumsphere &a = delaunay.sphere(c), &b = delaunay.sphere(other.cell);
      const SurfaceBall ball = delaunay.compute_ball(facet);
      EXPECT_EQ(delaunay.dual_crossing(b.center, delaunay.label(other.cell), a.center, delaunay.label(c)), ball.center);
      ASSERT_NE(delaunay.ball(other), nullptr);
      EXPECT_EQ(delaunay.ball(other)->center, ball.center);
      ++tested;
    }
  }
  EXPECT_GT(tested, 50);
}

/// The triangles that have a ball, each from the smallest vertex on, however it is turned.
std::set<std::array<VertexId, 3>> triangles_with_balls(const RestrictedDelaunay& delaunay) {
  std::set<std::array<VertexId, 3>> triangles;
  test::for_each_cell(delaunay, [&](CellId cell) {
    for (int i = 0; i < 4; ++i) {
      if (delaunay.ball({cell, i}) == nullptr) continue;
      auto triangle = delaunay.vertices(FacetId{cell, i});
      std::sort(triangle.begin(), triangle.end());
      triangles.insert(triangle);
    }
  });
  return triangles;
}

TEST_P(RestrictedDelaunaySuite, RestrictedTrianglesAreFoundByTheirBalls) {
  const auto oracle = two_balls();
  RestrictedDelaunay delaunay(*oracle);
  Random random(6);
  std::vector<Point3> points;
  for (int n = 0; n < 400; ++n) points.push_back(GetParam().next(random));
  delaunay.insert_seeds(points);
  test::compute_all_balls(delaunay);
  std::vector<FacetId> found;
  for_each_triangle_with_ball(delaunay, 0, delaunay.cell_capacity(), [&](FacetId facet) { found.push_back(facet); });
  const std::vector<FacetId> all = restricted_triangles(delaunay);
  ASSERT_EQ(found.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(found[i].cell, all[i].cell);
    EXPECT_EQ(found[i].index, all[i].index);
  }
  EXPECT_GT(all.size(), 20u);
}

// Umbrellas are looked at again where these were, and where new balls come to be.
TEST_P(RestrictedDelaunaySuite, LostAreTheTrianglesWhoseBallsAnInsertionDropped) {
  const auto oracle = two_balls();
  RestrictedDelaunay delaunay(*oracle);
  Random random(4);
  delaunay.insert_seeds({GetParam().next(random), {0.8, 0.7, 0.6}});
  std::size_t lost_in_all = 0, kept_in_all = 0;
  for (int n = 0; n < 150; ++n) {
    if (delaunay.evaluate(GetParam().next(random), delaunay.some_cell()).duplicate) continue;
    test::compute_all_balls(delaunay);
    const auto before = triangles_with_balls(delaunay);
    delaunay.commit(VertexKind::kSurface);
    const auto after = triangles_with_balls(delaunay);
    std::set<std::array<VertexId, 3>> gone, lost;
    std::set_difference(before.begin(), before.end(), after.begin(), after.end(), std::inserter(gone, gone.end()));
    for (auto triangle : delaunay.lost()) {
      std::sort(triangle.begin(), triangle.end());
      lost.insert(triangle);
    }
    EXPECT_EQ(lost, gone);
    EXPECT_EQ(lost.size(), delaunay.lost().size()) << "each once";
    lost_in_all += lost.size();
    kept_in_all += after.size();
  }
  EXPECT_GT(lost_in_all, 20u);
  EXPECT_GT(kept_in_all, 20u);
}

}  // namespace
}  // namespace delvox
