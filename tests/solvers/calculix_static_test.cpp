// What CalculiX makes of our meshes and decks: patch tests, pressure, tension with and without a crack, Lame's sphere.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>

#include "delvox/core/mesh_sets.h"
#include "delvox/mesh_io/write_deck.h"
#include "delvox/mesh_io/write_mesh.h"
#include "delvox/meshing/second_order.h"
#include "delvox/oracle/implicit_oracle.h"
#include "solvers/calculix.h"

namespace delvox::test {
namespace {

constexpr double kModulus = 1000, kPoisson = 0.3;

enum class Order { kFirst, kStraight, kCurved };

const Material kStuff{"stuff", 1, kModulus, kPoisson, 0};

TetMesh ball_mesh(double size, Order order) {
  const auto oracle = ball(1);
  TetMesh mesh = tets_of(*oracle, size);
  if (order != Order::kFirst) make_second_order(mesh, order == Order::kCurved ? oracle.get() : nullptr);
  mesh.materials = {kStuff};
  return mesh;
}

/// 0.8 x 0.8 x 3, along z, its edges rounded: {(x / 0.4)^6 + (y / 0.4)^6 + (z / 1.5)^20 < 1}.
TetMesh bar_mesh(double size) {
  const auto power = [](double base, int exponent) { return std::pow(base, exponent); };
  const auto oracle = make_implicit_oracle(
      {[power](const Point3& p) { return power(p.x / 0.4, 6) + power(p.y / 0.4, 6) + power(p.z / 1.5, 20) - 1; },
       [power](const Point3& p) {
         return Vector3{15 * power(p.x / 0.4, 5), 15 * power(p.y / 0.4, 5), 40.0 / 3 * power(p.z / 1.5, 19)};
       },
       {{-0.6, -0.6, -1.8}, {0.6, 0.6, 1.8}},
       0.05});
  TetMesh mesh = tets_of(*oracle, size);
  mesh.materials = {kStuff};
  return mesh;
}

std::vector<std::uint32_t> boundary_nodes(const TetMesh& mesh) {
  return select_sets(mesh, {{"skin", NormalRule{{0, 0, 1}, 180}}})[0].nodes;
}

std::string boundary_line(std::uint32_t node, int axis, double value) {
  std::ostringstream line;
  line.precision(12);
  line << number_of(node) << ", " << axis + 1 << ", " << axis + 1 << ", " << value << '\n';
  return line.str();
}

/// Largest difference between computed displacements and `expected`, over the largest of these.
double displacement_error(const Calculix& ccx, const TetMesh& mesh, const auto& expected) {
  double worst = 0, largest = 0;
  const auto rows = ccx.rows(4);
  EXPECT_EQ(rows.size(), mesh.points.size());
  for (const auto& row : rows) {
    const Vector3 u = expected(mesh.points[static_cast<std::size_t>(row[0]) - 1]);
    worst = std::max(worst, distance({row[1], row[2], row[3]}, u));
    largest = std::max(largest, norm(u));
  }
  return worst / largest;
}

Vector3 linear(const Point3& p) {
  return {1e-3 * (2 * p.x + p.y - p.z), 1e-3 * (p.x - p.y + 0.5 * p.z), 1e-3 * (0.3 * p.x - p.y + p.z)};
}

/// Prescribes a linear displacement of all boundary nodes: that of all others must be linear too.
double patch_error(double size, Order order) {
  const TetMesh mesh = ball_mesh(size, order);
  const Calculix ccx;
  write_mesh(mesh, ccx.deck());
  ccx.append("*STEP\n*STATIC\n*BOUNDARY\n");
  std::string lines;
  for (std::uint32_t node : boundary_nodes(mesh)) {
    for (int axis = 0; axis < 3; ++axis) lines += boundary_line(node, axis, linear(mesh.points[node])[axis]);
  }
  ccx.append(lines + "*NODE PRINT, NSET=NALL\nU\n*END STEP\n");
  EXPECT_EQ(ccx.run(), "");
  return displacement_error(ccx, mesh, linear);
}

class CalculixTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_calculix()) GTEST_SKIP() << "no ccx";
  }
};

TEST_F(CalculixTest, ALinearDisplacementIsReproduced) {
  EXPECT_LT(patch_error(0.4, Order::kFirst), 1e-6);
  EXPECT_LT(patch_error(0.4, Order::kStraight), 1e-6);
}

TEST_F(CalculixTest, OnCurvedTetsTheErrorFallsWithTheSize) {
  const double coarse = patch_error(0.4, Order::kCurved), fine = patch_error(0.2, Order::kCurved);
  RecordProperty("coarse", std::to_string(coarse));
  RecordProperty("order", std::to_string(std::log2(coarse / fine)));
  EXPECT_LT(coarse, 1e-2);
  EXPECT_LT(fine, 0.5 * coarse);
}

std::uint32_t extreme(const TetMesh& mesh, const Vector3& direction) {
  const auto corner_count = 1 + std::max_element(mesh.tets.begin(), mesh.tets.end(), [](const Tet& a, const Tet& b) {
                                  return *std::max_element(a.begin(), a.end()) < *std::max_element(b.begin(), b.end());
                                })->at(0);
  std::uint32_t best = 0;
  for (std::uint32_t v = 0; v < corner_count; ++v) {
    if (dot(mesh.points[v], direction) > dot(mesh.points[best], direction)) best = v;
  }
  return best;
}

/// Six supports that leave no rigid motion and take no force: three nodes, by name. `value`: displacement there.
void hold(TetMesh& mesh, StaticDeck& deck, const auto& value) {
  const std::uint32_t a = extreme(mesh, {-1, 0, 0}), b = extreme(mesh, {1, 0, 0}), c = extreme(mesh, {0, 1, 0});
  const auto add = [&](const char* name, std::uint32_t node, std::initializer_list<std::size_t> axes) {
    mesh.sets.push_back({name, {node}, {}, {}});
    StaticDeck::Displacement support{name, {}};
    for (std::size_t axis : axes) support.mm[axis] = value(mesh.points[node])[static_cast<int>(axis)];
    deck.displacements.push_back(support);
  };
  add("HOLD_A", a, {0, 1, 2});
  add("HOLD_B", b, {1, 2});
  add("HOLD_C", c, {2});
}

Vector3 still(const Point3&) {
  return {};
}

/// Largest difference of printed stresses from `expected` (xx, yy, zz, xy, xz, yz).
double stress_error(const Calculix& ccx, const std::array<double, 6>& expected) {
  double worst = 0;
  const auto rows = ccx.rows(8);
  EXPECT_FALSE(rows.empty());
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < 6; ++i) worst = std::max(worst, std::abs(row[2 + i] - expected[i]));
  }
  return worst;
}

double pressure_error(double size, Order order, LengthUnit unit = LengthUnit::kMillimetre) {
  TetMesh mesh = ball_mesh(size, order);
  mesh.info.unit = unit;
  mesh.sets = select_sets(mesh, {{"SKIN", AllRule{}}});
  StaticDeck deck;
  deck.pressures = {{"SKIN", 1}};
  hold(mesh, deck, still);
  const Calculix ccx;
  write_deck(mesh, deck, ccx.deck());
  ccx.request("*EL PRINT, ELSET=EALL\nS\n");
  EXPECT_EQ(ccx.run(), "");
  const double scale = unit == LengthUnit::kMetre ? 1e6 : 1;
  return stress_error(ccx, {-scale, -scale, -scale, 0, 0, 0}) / scale;
}

TEST_F(CalculixTest, PressureFromAllSidesIsMinusOneInEveryTet) {
  EXPECT_LT(pressure_error(0.4, Order::kFirst), 5e-7);
  EXPECT_LT(pressure_error(0.4, Order::kStraight), 5e-7);
  EXPECT_LT(pressure_error(0.5, Order::kFirst, LengthUnit::kMetre), 5e-7);
}

TEST_F(CalculixTest, PressureOnCurvedTetsErrsLessAtSmallerSizes) {
  const double coarse = pressure_error(0.4, Order::kCurved), fine = pressure_error(0.2, Order::kCurved);
  RecordProperty("coarse", std::to_string(coarse));
  RecordProperty("order", std::to_string(std::log2(coarse / fine)));
  EXPECT_LT(fine, coarse);
}

/// Parts the mesh along a disc across it: tets above the plane z = 0 get nodes of their own there.
void plant_crack(TetMesh& mesh, double radius) {
  std::map<std::uint32_t, std::uint32_t> twins;
  for (Tet& tet : mesh.tets) {
    double height = 0;
    for (std::uint32_t v : tet) height += mesh.points[v].z;
    if (height < 0) continue;
    for (std::uint32_t& v : tet) {
      const Point3 p = mesh.points[v];
      if (norm(p) > radius || std::abs(p.z) > 0.1) continue;
      const auto [twin, is_new] = twins.try_emplace(v, static_cast<std::uint32_t>(mesh.points.size()));
      if (is_new) mesh.points.push_back(p);
      v = twin->second;
    }
  }
  ASSERT_GT(twins.size(), 3u);
}

/// Pulls a bar along z by the forces that belong to a stress of 1 on its surface: at its ends, all but.
double tension_error(bool with_crack) {
  TetMesh mesh = bar_mesh(0.15);
  std::map<std::uint32_t, double> force;
  for (const Triangle& t : mesh.boundary) {
    const double along_z = cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]).z / 2;
    for (std::uint32_t v : t) force[v] += along_z / 3;
  }
  if (with_crack) plant_crack(mesh, 0.25);
  StaticDeck deck;
  hold(mesh, deck, still);
  const Calculix ccx;
  write_deck(mesh, deck, ccx.deck());
  std::ostringstream loads;
  loads.precision(12);
  loads << "*CLOAD\n";
  for (const auto& [node, value] : force) loads << number_of(node) << ", 3, " << value << '\n';
  ccx.request(loads.str() + "*EL PRINT, ELSET=EALL\nS\n");
  EXPECT_EQ(ccx.run(), "");
  return stress_error(ccx, {0, 0, 1, 0, 0, 0});
}

TEST_F(CalculixTest, TensionFindsNoCrackAndFindsOnePlanted) {
  EXPECT_LT(tension_error(false), 1e-5);
  EXPECT_GT(tension_error(true), 0.3);
}

/// Lame: radial displacement of a shell of radii a < b under inner pressure p.
Vector3 lame(const Point3& at) {
  constexpr double a = 0.5, b = 1, p = 10;
  const double r = norm(at), k = p * a * a * a / (b * b * b - a * a * a) / kModulus;
  const double u = k * ((1 - 2 * kPoisson) * r + (1 + kPoisson) * b * b * b / (2 * r * r));
  return (u / r) * at;
}

/// Root mean square difference from Lame's displacements, a common translation apart (the three held nodes err as all
/// do), over theirs.
double shape_error(const Calculix& ccx, const TetMesh& mesh) {
  const auto rows = ccx.rows(4);
  EXPECT_EQ(rows.size(), mesh.points.size());
  Vector3 mean;
  double squares = 0, expected = 0;
  for (const auto& row : rows) {
    const Vector3 u = lame(mesh.points[static_cast<std::size_t>(row[0]) - 1]);
    const Vector3 difference = Vector3{row[1], row[2], row[3]} - u;
    mean = mean + (1.0 / static_cast<double>(rows.size())) * difference;
    squares += squared_norm(difference);
    expected += squared_norm(u);
  }
  return std::sqrt((squares - static_cast<double>(rows.size()) * squared_norm(mean)) / expected);
}

double shell_error(double size, Order order) {
  const auto oracle = ball(1, 0.5);
  TetMesh mesh = tets_of(*oracle, size);
  if (order == Order::kCurved) make_second_order(mesh, oracle.get());
  mesh.materials = {{"stuff", 1, kModulus, kPoisson, 0}};
  mesh.sets = select_sets(mesh, {{"INSIDE", SphereRule{{0, 0, 0}, 0.75}}});
  StaticDeck deck;
  deck.pressures = {{"INSIDE", 10}};
  hold(mesh, deck, lame);
  const Calculix ccx;
  write_deck(mesh, deck, ccx.deck());
  ccx.request("*NODE PRINT, NSET=NALL\nU\n");
  EXPECT_EQ(ccx.run(), "");
  return shape_error(ccx, mesh);
}

TEST_F(CalculixTest, APressurisedShellSwellsAsLameSays) {
  const double coarse = shell_error(0.3, Order::kFirst), fine = shell_error(0.15, Order::kFirst);
  const double curved = shell_error(0.3, Order::kCurved), curved_fine = shell_error(0.15, Order::kCurved);
  RecordProperty("first", std::to_string(coarse) + " " + std::to_string(fine));
  RecordProperty("second", std::to_string(curved) + " " + std::to_string(curved_fine));
  EXPECT_LT(fine, 0.6 * coarse);
  EXPECT_LT(fine, 0.15);
  EXPECT_LT(curved_fine, 0.25 * curved);
  EXPECT_LT(curved_fine, 0.005);
}

}  // namespace
}  // namespace delvox::test
