// A heated ball, -laplace T = 6 with T = 0 on its surface: T = 1 - r^2. The order at which the error falls tells
// whether nodes lie on the sphere.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "delvox/mesh_io/write_mesh.h"
#include "delvox/meshing/second_order.h"
#include "solvers/calculix.h"

namespace delvox::test {
namespace {

/// Root of the mean square error of T at the nodes, each weighted by a quarter of the volumes of its corner's tets (of
/// mid-side nodes: a sixth).
double temperature_error(double size, bool second_order) {
  const auto oracle = ball(1);
  TetMesh mesh = tets_of(*oracle, size);
  if (second_order) make_second_order(mesh, oracle.get());
  const Calculix ccx;
  write_mesh(mesh, ccx.deck());
  ccx.append(
      "*MATERIAL, NAME=HEAT\n*CONDUCTIVITY\n1.\n*SOLID SECTION, ELSET=EALL, MATERIAL=HEAT\n"
      "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNALL, 0.\n*STEP\n*HEAT TRANSFER, STEADY STATE\n"
      "*BOUNDARY\nSURFACE, 11, 11, 0.\n*DFLUX\nEALL, BF, 6.\n*NODE PRINT, NSET=NALL\nNT\n*END STEP\n");
  EXPECT_EQ(ccx.run(), "");
  std::vector<double> weight(mesh.points.size(), 0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Tet& v = mesh.tets[t];
    const Point3 a = mesh.points[v[0]];
    const double volume = dot(cross(mesh.points[v[1]] - a, mesh.points[v[2]] - a), mesh.points[v[3]] - a) / 6;
    for (std::uint32_t node : v) weight[node] += volume / 4;
    if (!second_order) continue;
    for (std::uint32_t node : mesh.mid_nodes[t]) weight[node] += volume / 6;
  }
  double sum = 0;
  const auto rows = ccx.rows(2);
  EXPECT_EQ(rows.size(), mesh.points.size());
  for (const auto& row : rows) {
    const auto node = static_cast<std::size_t>(row[0]) - 1;
    const double error = row[1] - (1 - squared_norm(mesh.points[node]));
    sum += weight[node] * error * error;
  }
  return std::sqrt(sum / std::accumulate(weight.begin(), weight.end(), 0.0));
}

/// Slope of log error over log size, fitted.
double order(bool second_order, const std::vector<double>& sizes) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = static_cast<double>(sizes.size());
  for (double size : sizes) {
    const double x = std::log(size), y = std::log(temperature_error(size, second_order));
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

TEST(CalculixHeat, TheErrorFallsAtTheOrderOfTheTets) {
  if (!has_calculix()) GTEST_SKIP() << "no ccx";
  const double first = order(false, {0.4, 0.28, 0.2, 0.14}), second = order(true, {0.4, 0.28, 0.2, 0.14});
  RecordProperty("first", std::to_string(first));
  RecordProperty("second", std::to_string(second));
  EXPECT_GE(first, 1.9);
  EXPECT_GE(second, 2.7);
}

}  // namespace
}  // namespace delvox::test
