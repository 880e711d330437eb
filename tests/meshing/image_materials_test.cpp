#include "delvox/meshing/image_materials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "delvox/core/errors.h"
#include "delvox/meshing/deltetsurf.h"
#include "delvox/oracle/isosurface_oracle.h"
#include "delvox/volume/peel.h"

namespace delvox {
namespace {

// A femur's shaft in little: an ellipsoid of revolution whose samples fall from the middle outwards, and along its
// axis.
constexpr double kAcross = 15, kAlong = 30, kIso = 200;

double depth(const Point3& p) {
  return 1 - (p.x * p.x + p.y * p.y) / (kAcross * kAcross) - p.z * p.z / (kAlong * kAlong);
}
double hounsfield(const Point3& p) {
  return kIso + depth(p) * (1200 + 300 * p.z / kAlong);
}

ImageMaterialOptions calibrated() {
  ImageMaterialOptions options;
  options.density_offset = 0.1;
  options.density_slope = 0.0008;
  options.law = *find_density_law("morgan-femoral-neck");
  return options;
}

template <class Value>
Volume sampled(double spacing, const Value& value) {
  VolumeHeader header;
  header.dims = {static_cast<int>(36 / spacing), static_cast<int>(36 / spacing), static_cast<int>(68 / spacing)};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    header.index_to_world.rows[a][a] = spacing;
    header.index_to_world.rows[a][3] = -0.5 * spacing * (header.dims[a] - 1);
  }
  std::vector<float> samples;
  for (int k = 0; k < header.dims[2]; ++k) {
    for (int j = 0; j < header.dims[1]; ++j) {
      for (int i = 0; i < header.dims[0]; ++i) {
        samples.push_back(static_cast<float>(value(header.index_to_world({1.0 * i, 1.0 * j, 1.0 * k}))));
      }
    }
  }
  return {header, samples};
}

TetMesh tets_of(const Volume& volume, double size) {
  const auto oracle = make_isosurface_oracle(volume, {kIso, false});
  DelTetSurfOptions options;
  options.surface.size = options.tets.cell_size = size;
  RunReport report;
  return deltetsurf(*oracle, options, report);
}

/// Integral of the modulus over the ellipsoid, MPa mm3, in stretched spherical shells: s is the radius, c the cosine.
double exact_integral() {
  const ImageMaterialOptions options = calibrated();
  constexpr int kSteps = 2000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double s = (i + 0.5) / kSteps;
    for (int j = 0; j < kSteps; ++j) {
      const double c = -1 + 2 * (j + 0.5) / kSteps;
      const double value = kIso + (1 - s * s) * (1200 + 300 * s * c);
      sum += s * s * options.law.modulus_mpa(options.density_offset + options.density_slope * value);
    }
  }
  return sum / kSteps * 2 / kSteps * 2 * std::numbers::pi * kAcross * kAcross * kAlong;
}

double integral(const TetMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Tet& v = mesh.tets[t];
    const Point3 p = mesh.points[v[0]];
    const double six = dot(cross(mesh.points[v[1]] - p, mesh.points[v[2]] - p), mesh.points[v[3]] - p);
    sum += six / 6 * mesh.materials.at(static_cast<std::size_t>(mesh.regions[t]) - 1).youngs_modulus_mpa;
  }
  return sum;
}

TEST(ImageMaterials, TheModulusOfAFemurIntegratesToItsExactValue) {
  const Volume volume = sampled(1, hounsfield);
  for (std::size_t bins : {1u, 20u}) {
    TetMesh mesh = tets_of(volume, 2);
    ImageMaterialOptions options = calibrated();
    options.bins = bins;
    const ImageMaterialReport report = assign_image_materials(mesh, volume, options);
    EXPECT_LE(mesh.materials.size(), bins);
    EXPECT_NEAR(integral(mesh) / exact_integral(), 1, 0.01);
    EXPECT_EQ(report.thin_share, 0);
    EXPECT_LT(report.least_mpa, report.mean_mpa);
    EXPECT_LT(report.mean_mpa, report.greatest_mpa);
  }
}

TEST(ImageMaterials, BinsRiseAndEveryTetHasOne) {
  const Volume volume = sampled(2, hounsfield);
  TetMesh mesh = tets_of(volume, 3);
  assign_image_materials(mesh, volume, calibrated());
  ASSERT_GT(mesh.materials.size(), 10u);
  for (std::size_t m = 1; m < mesh.materials.size(); ++m) {
    EXPECT_GT(mesh.materials[m].youngs_modulus_mpa, mesh.materials[m - 1].youngs_modulus_mpa);
    EXPECT_GT(mesh.materials[m].density_kg_m3, mesh.materials[m - 1].density_kg_m3);
    EXPECT_EQ(mesh.materials[m].region, static_cast<Label>(m + 1));
  }
  for (Label region : mesh.regions) {
    EXPECT_GE(region, 1);
    EXPECT_LE(region, static_cast<Label>(mesh.materials.size()));
  }
}

TetMesh one_tet() {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {9, 1, 0}, {1, 8, 2}, {-1, 2, 11}};
  mesh.tets = {{0, 1, 2, 3}};
  return mesh;
}

TEST(ImageMaterials, ALinearLawOnALinearFieldIsExactInEveryTet) {
  const auto ramp = [](const Point3& p) { return 1000 + 10 * p.x - 5 * p.y + 3 * p.z; };
  const Volume volume = sampled(2, ramp);
  TetMesh mesh = one_tet();
  ImageMaterialOptions options;
  options.density_slope = 0.001;
  options.law = *find_density_law("E=1000*rho^1");
  assign_image_materials(mesh, volume, options);
  const Point3 centre{2.25, 2.75, 3.25};
  EXPECT_NEAR(mesh.materials.at(0).youngs_modulus_mpa, ramp(centre), 1e-3);
  EXPECT_NEAR(mesh.materials.at(0).density_kg_m3, ramp(centre), 1e-3);
}

TEST(ImageMaterials, AModulusBeyondAllNumbersIsRefused) {
  const Volume volume = sampled(2, [](const Point3&) { return 1000; });
  TetMesh mesh = one_tet();
  ImageMaterialOptions options;
  options.density_slope = 0.05;
  options.law = *find_density_law("E=6850*rho^999");
  EXPECT_THROW(assign_image_materials(mesh, volume, options), OptionError);
}

TEST(ImageMaterials, PeelingTakesThePartialVolumeAway) {
  // The same body of 1000 throughout, blurred at its surface over two voxels.
  const Volume volume = sampled(1, [](const Point3& p) { return 1000 / (1 + std::exp(-kAcross * depth(p))); });
  const double whole = calibrated().law.modulus_mpa(0.1 + 0.8);
  TetMesh mesh = tets_of(volume, 2.5);
  TetMesh peeled_mesh = mesh;
  const ImageMaterialReport as_it_is = assign_image_materials(mesh, volume, calibrated());
  const ImageMaterialReport report =
      assign_image_materials(peeled_mesh, peeled(volume, {kIso, false}, 3), calibrated());
  EXPECT_LT(as_it_is.mean_mpa, 0.95 * whole);
  EXPECT_GT(report.mean_mpa, as_it_is.mean_mpa + 0.5 * (whole - as_it_is.mean_mpa));
  EXPECT_LE(report.greatest_mpa, whole * (1 + 1e-6));
}

}  // namespace
}  // namespace delvox
