// What the book's theorems promise, on surfaces whose local feature size is known. Samples of meshes and surfaces are
// looked at, so that what a theorem says of all points is seen at many.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "delaunay/restricted_delaunay.h"
#include "delvox/meshing/delsurf.h"
#include "delvox/meshing/deltetsurf.h"
#include "delvox/oracle/formula.h"
#include "mesh_expectations.h"
#include "support/random.h"

namespace delvox {
namespace {

constexpr double kPi = std::numbers::pi;
const Point3 kNorth{0, 0, 1};

/// A surface with all that is to be known of it.
struct KnownSurface {
  const char* name;
  std::string formula;
  long euler;
  Point3 (*nearest)(const Point3&);
  double (*feature)(const Point3&);       ///< at a point of the surface: the distance from the medial axis
  Point3 (*at)(double u, double v);       ///< u, v in [0, 1)
  double (*area_at)(double u, double v);  ///< of the parametrisation
  double least_feature, largest_feature;

  std::unique_ptr<SmoothOracle> oracle() const {
    return make_formula_oracle(Formula(formula), {{-2, -2, -2}, {2, 2, 2}}, 0.03);
  }
  Vector3 normal(const Point3& p) const {
    const Vector3 g = oracle_gradient(p);
    return (1 / norm(g)) * g;
  }
  Vector3 oracle_gradient(const Point3& p) const { return Formula(formula).gradient(p); }
  SizeField size(double epsilon) const {
    return SizeField([this, epsilon](const Point3& p) { return epsilon * feature(nearest(p)); },
                     epsilon * least_feature, epsilon * largest_feature);
  }
  friend void PrintTo(const KnownSurface& s, std::ostream* out) { *out << s.name; }
};

const KnownSurface kSphere{"sphere",
                           "x^2+y^2+z^2-1",
                           2,
                           [](const Point3& p) { return (1 / norm(p)) * p; },
                           [](const Point3&) { return 1.0; },
                           [](double u, double v) {
                             const double z = 2 * v - 1, r = std::sqrt(1 - z * z);
                             return Point3{r * std::cos(2 * kPi * u), r * std::sin(2 * kPi * u), z};
                           },
                           [](double, double) { return 4 * kPi; },
                           1,
                           1};

constexpr double kMajor = 1, kMinor = 0.6;
// The medial axis is the circle in its middle and the axis of rotation, which is nearer on the inner side.
const KnownSurface kTorus{
    "torus",
    "(sqrt(x^2+y^2)-1)^2+z^2-0.36",
    0,
    [](const Point3& p) {
      const double r = std::hypot(p.x, p.y);
      const Point3 c{kMajor * p.x / r, kMajor * p.y / r, 0};
      return c + (kMinor / norm(p - c)) * (p - c);
    },
    [](const Point3& p) { return std::min(kMinor, std::hypot(p.x, p.y)); },
    [](double u, double v) {
      const double r = kMajor + kMinor * std::cos(2 * kPi * v);
      return Point3{r * std::cos(2 * kPi * u), r * std::sin(2 * kPi * u), kMinor * std::sin(2 * kPi * v)};
    },
    [](double, double v) { return 4 * kPi * kPi * kMinor * (kMajor + kMinor * std::cos(2 * kPi * v)); },
    kMajor - kMinor,
    kMinor};

/// By how much a mesh keeps within the bounds of theorem 14.2: parts of them, at most 1 if it does.
struct Kept {
  double normals = 0, dihedrals = 0, distance = 0, sample = 0;
};

Kept measure(const KnownSurface& surface, const SurfaceMesh& mesh, double epsilon) {
  Kept kept;
  const double angle = 7 * epsilon / (1 - epsilon), far = 15 * epsilon * epsilon / ((1 - epsilon) * (1 - epsilon));
  std::vector<Vector3> normals;
  for (const Point3& p : mesh.points) normals.push_back(surface.normal(p));
  for (const Triangle& t : mesh.triangles) {
    const Vector3 n = cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]);
    for (std::uint32_t v : t) {
      const double between = std::acos(std::clamp(dot(n, normals[v]) / norm(n), -1.0, 1.0));
      kept.normals = std::max(kept.normals, between / angle);
    }
  }
  kept.dihedrals = test::largest_roughness_degrees(mesh) * kPi / 180 / (2 * angle);
  test::for_each_sample(mesh, 3, [&](const Point3& z) {
    const Point3 there = surface.nearest(z);
    kept.distance = std::max(kept.distance, distance(z, there) / (far * surface.feature(there)));
  });
  // Cells of a grid find the vertices near a point of the surface.
  const double reach = epsilon / (1 - 2 * epsilon) * surface.largest_feature;
  std::map<std::array<long, 3>, std::vector<Point3>> cells;
  const auto cell_of = [&](const Point3& p) {
    return std::array<long, 3>{std::lround(p.x / reach), std::lround(p.y / reach), std::lround(p.z / reach)};
  };
  for (const Point3& p : mesh.points) cells[cell_of(p)].push_back(p);
  test::Random random(5);
  for (int i = 0; i < 20000; ++i) {
    const Point3 x = surface.at(random.unit(), random.unit());
    double nearest = 2 * reach;
    const auto c = cell_of(x);
    for (int n = 0; n < 27; ++n) {
      const auto found = cells.find({c[0] + n % 3 - 1, c[1] + n / 3 % 3 - 1, c[2] + n / 9 - 1});
      if (found == cells.end()) continue;
      for (const Point3& p : found->second) nearest = std::min(nearest, distance(p, x));
    }
    kept.sample = std::max(kept.sample, nearest / (epsilon / (1 - 2 * epsilon) * surface.feature(x)));
  }
  return kept;
}

/// The integral of 1 / lambda^2 over a surface.
double demand(const KnownSurface& surface, const SizeField& size) {
  constexpr int kSteps = 400;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double u = (i + 0.5) / kSteps, v = (j + 0.5) / kSteps, s = size(surface.at(u, v));
      sum += surface.area_at(u, v) / (s * s) / (kSteps * kSteps);
    }
  }
  return sum;
}

double largest_radius_edge(const SurfaceMesh& mesh) {
  double largest = 0;
  for (const Triangle& t : mesh.triangles) {
    const double angle =
        test::smallest_angle_degrees(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]) * kPi / 180;
    largest = std::max(largest, 1 / (2 * std::sin(angle)));
  }
  return largest;
}

/// Calls visit(p, length) for each edge of a triangle or tet at each of its ends.
template <class Mesh, class Cells, class Visit>
void for_each_edge(const Mesh& mesh, const Cells& cells, const Visit& visit) {
  for (const auto& cell : cells) {
    for (std::uint32_t a : cell) {
      for (std::uint32_t b : cell) {
        if (a != b) visit(mesh.points[a], distance(mesh.points[a], mesh.points[b]));
      }
    }
  }
}

DelSurfOptions options_for(const SizeField& size, Restricted restricted, double min_angle = 0) {
  DelSurfOptions options;
  options.surface.size = size;
  options.surface.min_angle_degrees = min_angle;
  options.variant = {Start::kPersistent, restricted, 11};
  return options;
}

class Theorems : public testing::TestWithParam<KnownSurface> {
 protected:
  void SetUp() override { oracle_ = GetParam().oracle(); }
  std::unique_ptr<SmoothOracle> oracle_;
};

INSTANTIATE_TEST_SUITE_P(Known, Theorems, testing::Values(kSphere, kTorus),
                         [](const auto& info) { return info.param.name; });

TEST_P(Theorems, T14_2_DelSurf1KeepsNormalsDihedralsDistanceAndSample) {
  for (double epsilon : {0.08, 0.05}) {
    for (Restricted restricted : {Restricted::kBipolar, Restricted::kAll}) {
      RunReport report;
      const SurfaceMesh mesh = delsurf1(*oracle_, options_for(GetParam().size(epsilon), restricted), report);
      test::expect_finished(report);
      test::expect_closed_manifold(mesh);
      EXPECT_EQ(test::topology_of(mesh).components, 1u);
      EXPECT_EQ(test::topology_of(mesh).euler, GetParam().euler);
      const Kept kept = measure(GetParam(), mesh, epsilon);
      EXPECT_LT(kept.normals, 1);
      EXPECT_LT(kept.dihedrals, 1);
      EXPECT_LT(kept.distance, 1);
      EXPECT_LE(kept.sample, 1);
    }
  }
}

// The bounds are such that a mesh can miss them: one much coarser than they are for does.
TEST_P(Theorems, T14_2_IsMissedByAMeshTooCoarse) {
  RunReport report;
  const SurfaceMesh mesh = delsurf(*oracle_, options_for(GetParam().size(0.9), Restricted::kAll), report);
  const Kept kept = measure(GetParam(), mesh, 0.08);
  EXPECT_GT(kept.normals, 1);
  EXPECT_GT(kept.distance, 1);
  EXPECT_GT(kept.sample, 1);
}

TEST_P(Theorems, T14_9_DelSurfHasFewerVerticesThanEightTimesTheIntegral) {
  for (double epsilon : {0.08, 0.05}) {
    const SizeField size = GetParam().size(epsilon);
    RunReport report;
    const SurfaceMesh mesh = delsurf(*oracle_, options_for(size, Restricted::kBipolar), report);
    test::expect_finished(report);
    test::expect_closed_manifold(mesh);
    EXPECT_EQ(test::topology_of(mesh).euler, GetParam().euler);
    EXPECT_LT(measure(GetParam(), mesh, epsilon).distance, 1);
    const double share = static_cast<double>(mesh.points.size()) / demand(GetParam(), size);
    RecordProperty("vertices_per_integral", std::to_string(share));
    EXPECT_LT(share, 8);
    EXPECT_GT(share, 0.3);  // no sample with balls of that size has much fewer
  }
}

/// From 0.02 near the north pole up to 0.08, `slope`-Lipschitz; on the unit sphere only.
SizeField sloping_size(double slope) {
  return SizeField([slope](const Point3& p) { return std::min(0.08, 0.02 + slope * distance(p, kNorth)); }, 0.02, 0.08);
}

TEST(TheoremsOnTheSphere, P14_10_SlowSizesGiveGoodTrianglesByThemselves) {
  const auto oracle = kSphere.oracle();
  for (double slope : {0.0, 0.2, 0.5}) {
    for (Restricted restricted : {Restricted::kBipolar, Restricted::kAll}) {
      RunReport report;
      const SurfaceMesh mesh = delsurf(*oracle, options_for(sloping_size(slope), restricted), report);
      test::expect_finished(report);
      test::expect_closed_manifold(mesh);
      EXPECT_LE(largest_radius_edge(mesh), 1 / (1 - slope) + 1e-9);
    }
  }
}

TEST(TheoremsOnTheSphere, T14_11_QualityKeepsVerticesApart) {
  const auto oracle = kSphere.oracle();
  for (double min_angle : {30.0, 20.0}) {
    const double ratio = 1 / (2 * std::sin(min_angle * kPi / 180)), slope = (ratio - 1) / ratio;
    RunReport report;
    const SurfaceMesh mesh = delsurf(*oracle, options_for(sloping_size(0.95), Restricted::kBipolar, min_angle), report);
    test::expect_finished(report);
    EXPECT_LE(largest_radius_edge(mesh), ratio * (1 + 1e-9));
    const SizeField regular = sloping_size(slope);
    for_each_edge(mesh, mesh.triangles, [&](const Point3& p, double length) {
      EXPECT_GT(length, regular(p) * ratio / (2 * ratio - 1) * (1 - 1e-9));
    });
  }
}

using CornerPoints = std::array<std::array<double, 3>, 3>;

CornerPoints corners_of(Point3 a, Point3 b, Point3 c) {
  CornerPoints corners{{{a.x, a.y, a.z}, {b.x, b.y, b.z}, {c.x, c.y, c.z}}};
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// Del|Sigma of points of the surface, by every crossing of every dual edge.
std::set<CornerPoints> restricted_triangulation(const Oracle& oracle, const std::vector<Point3>& points) {
  RestrictedDelaunay delaunay(oracle);
  delaunay.insert_seeds(points);
  std::set<CornerPoints> triangles;
  for (CellId cell = 1; cell < delaunay.cell_capacity(); ++cell) {
    for (int i = 0; i < 4 && delaunay.stamp(cell) != 0; ++i) {
      if (!delaunay.proper({cell, i}) || delaunay.dual_crossings({cell, i}, oracle).empty()) continue;
      const auto v = delaunay.vertices(FacetId{cell, i});
      triangles.insert(corners_of(delaunay.point(v[0]), delaunay.point(v[1]), delaunay.point(v[2])));
    }
  }
  return triangles;
}

class TetTheorems : public testing::TestWithParam<std::tuple<KnownSurface, Restricted>> {};

INSTANTIATE_TEST_SUITE_P(Known, TetTheorems,
                         testing::Combine(testing::Values(kSphere, kTorus),
                                          testing::Values(Restricted::kBipolar, Restricted::kAll)),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param).name) +
                                  (std::get<1>(info.param) == Restricted::kAll ? "_all" : "_bipolar");
                         });

TEST_P(TetTheorems, T14_15_Hold) {
  const auto& [surface, restricted] = GetParam();
  const auto oracle = surface.oracle();
  const double epsilon = 0.08;
  const SizeField size = surface.size(epsilon);
  for (double ratio : {2.0, 3.0}) {
    DelTetSurfOptions options;
    options.surface = options_for(size, restricted).surface;
    options.tets.radius_edge = ratio;
    options.tets.cell_size = 100;
    options.variant = {Start::kPersistent, restricted, 11};
    RunReport report;
    const TetMesh mesh = deltetsurf(*oracle, options, report);
    test::expect_finished(report);
    const SurfaceMesh boundary = boundary_surface(mesh);
    test::expect_closed_manifold(boundary);  // (i), with positive tets that fit together:
    test::expect_all_checks_hold(mesh);
    double largest = 0;
    for (const Tet& tet : mesh.tets) {
      const test::TetShape shape = test::shape_of(mesh, tet);
      largest = std::max(largest, shape.circumradius / shape.shortest_edge);
    }
    EXPECT_LE(largest, ratio * (1 + 1e-7));  // (ii)
    // (iii): mu is at least the least size, and at most that plus what its slope adds; the first is what is tested.
    double least = Box3::kInfinity;
    for (int i = 0; i < 1000; ++i) least = std::min(least, size(surface.at(0.3, i / 1000.0)));
    for_each_edge(mesh, mesh.tets, [&](const Point3&, double length) {
      EXPECT_GT(length, least * 3 * ratio / (4 * ratio - 2) * (1 - 1e-3));
    });

    const bool homeomorphic =
        test::topology_of(boundary).components == 1 && test::topology_of(boundary).euler == surface.euler;  // (iv)
    std::set<CornerPoints> triangles;
    std::vector<Point3> on_surface;
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      if (mesh.on_surface[v] != 0) on_surface.push_back(mesh.points[v]);
    }
    for (const Triangle& t : mesh.boundary) {
      triangles.insert(corners_of(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]));
    }
    const bool same = triangles == restricted_triangulation(*oracle, on_surface);  // (v)
    const double part = measure(surface, boundary, epsilon).distance;              // (vi)
    const std::string at = "_at_radius_edge_" + std::to_string(static_cast<int>(ratio));
    RecordProperty("iv" + at, homeomorphic);
    RecordProperty("v" + at, same);
    RecordProperty("vi" + at, std::to_string(part));
    if (restricted == Restricted::kBipolar) continue;  // an open question (exercise 9): observed
    EXPECT_TRUE(homeomorphic);
    EXPECT_TRUE(same);
    EXPECT_LT(part, 1);
  }
}

}  // namespace
}  // namespace delvox
