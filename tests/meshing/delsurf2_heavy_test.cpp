#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <set>

#include "delvox/meshing/delsurf.h"
#include "delvox/meshing/delsurf2.h"
#include "mesh_expectations.h"
#include "random_formulas.h"

// 200 random smooth formulas, whose surfaces are known by an independent count on voxels: how many of the meshes are
// homeomorphic to them?

namespace delvox {
namespace {

using test::KnownFormula;

constexpr int kFormulas = 200;

const std::vector<KnownFormula>& formulas() {
  static const std::vector<KnownFormula> all = [] {
    std::vector<KnownFormula> formulas;
    for (int number = 0; number < kFormulas; ++number) {
      formulas.push_back(test::known_formula(static_cast<std::uint64_t>(number)));
    }
    return formulas;
  }();
  return all;
}

/// "components 2, Euler number 0, cavities 1"
std::string text_of(std::size_t components, long euler, std::size_t cavities) {
  return "components " + std::to_string(components) + ", Euler number " + std::to_string(euler) + ", cavities " +
         std::to_string(cavities);
}

/// What is wrong with a mesh; empty if it is a good one of the surface.
std::string fault_of(const SurfaceMesh& mesh, const RunReport& report, const KnownFormula& known) {
  for (const Unmet& unmet : report.unmet) {
    if (unmet.breaks_promise) return "unmet " + unmet.criterion + ": " + unmet.reason;
  }
  if (!report.succeeded()) return to_string(report.stop);
  const CheckReport check = check_mesh(mesh);
  const MeshStatistics& s = check.statistics;
  const std::string found = text_of(s.surface_components, s.euler, s.cavities);
  const VoxelTopology& t = known.topology;
  const std::string expected = text_of(t.surface_components, t.euler, t.cavities);
  if (found != expected) return found + "; should be " + expected;
  return check.all_hold() ? "" : "a check fails";
}

/// Counts the formulas that `mesh` does right, and tells of the others.
template <class MeshOf>
int count_right(const char* title, const MeshOf& mesh_of) {
  int right = 0;
  for (int number = 0; number < kFormulas; ++number) {
    const KnownFormula& known = formulas()[static_cast<std::size_t>(number)];
    RunReport report;
    const SurfaceMesh mesh = mesh_of(known, report);
    const std::string fault = fault_of(mesh, report, known);
    right += fault.empty();
    if (!fault.empty()) std::cout << title << ", formula " << number << ": " << fault << "\n  " << known.text << "\n";
  }
  std::cout << title << ": " << right << " of " << kFormulas << " right" << std::endl;
  return right;
}

SurfaceMesh delsurf_at(const KnownFormula& known, double size, RunReport& report) {
  DelSurfOptions options;
  options.surface.size = size;
  options.surface.min_ball_radius = 0.001 * size;
  const double volume = 64;
  const double resolution = std::max(std::min(size / 2, std::cbrt(volume / 1e6)), std::cbrt(volume / 2e7));
  return delsurf(*make_formula_oracle(Formula(known.text), known.box, resolution), options, report);
}

TEST(RandomFormulas, AreOfManyKinds) {
  std::map<long, int> of_genus;
  std::set<std::string> texts;
  int several = 0, nested = 0;
  for (const KnownFormula& known : formulas()) {
    ++of_genus[test::genus_of(known.topology)];
    texts.insert(known.text);
    several += known.topology.surface_components > 1;
    nested += known.topology.cavities > 0;
  }
  for (const auto& [genus, count] : of_genus) std::cout << "genus " << genus << ": " << count << "\n";
  EXPECT_EQ(texts.size(), static_cast<std::size_t>(kFormulas));
  for (long genus = 0; genus <= test::kMostGenus; ++genus) EXPECT_GE(of_genus[genus], 3) << genus;
  EXPECT_GE(several, 20);
  EXPECT_GE(nested, 10);
}

// Theorem 14.7.
TEST(RandomFormulas, DelSurf2IsHomeomorphicToEachWithoutASize) {
  const int right = count_right("DelSurf2", [](const KnownFormula& known, RunReport& report) {
    DelSurf2Options options;
    options.surface.min_angle_degrees = 0;
    return delsurf2(*make_smooth_function(Formula(known.text)), known.box, options, report);
  });
  EXPECT_EQ(right, kFormulas);
}

TEST(RandomFormulas, DelSurfIsHomeomorphicToMostAtItsDefaultSize) {
  const int right = count_right("DelSurf at its default size", [](const KnownFormula& known, RunReport& report) {
    return delsurf_at(known, known.box.diagonal() / 40, report);
  });
  EXPECT_GE(right, kFormulas * 8 / 10);
}

TEST(RandomFormulas, DelSurfIsHomeomorphicToEachAtAQuarterOfThat) {
  const int right = count_right("DelSurf at a quarter of it", [](const KnownFormula& known, RunReport& report) {
    return delsurf_at(known, known.box.diagonal() / 160, report);
  });
  EXPECT_EQ(right, kFormulas);
}

}  // namespace
}  // namespace delvox
