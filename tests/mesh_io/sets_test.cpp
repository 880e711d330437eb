// Sets, second order and units survive the files that have a place for them.
#include <gtest/gtest.h>

#include "delvox/mesh_io/read_mesh.h"
#include "delvox/mesh_io/write_mesh.h"
#include "mesh_io/mesh_io_support.h"

namespace delvox {
namespace {

using testing::awkward_tets_with_sets;
using testing::file_bytes;
using testing::TemporaryFolder;

TetMesh there_and_back(const TetMesh& mesh, const char* extension, double* error = nullptr) {
  const TemporaryFolder folder;
  const auto path = folder / (std::string("a") + extension);
  write_mesh(mesh, path);
  MeshFile file = read_mesh(path);
  if (error != nullptr) *error = file.coordinate_error;
  return std::get<TetMesh>(std::move(file.mesh));
}

class TetFormat : public ::testing::TestWithParam<const char*> {};

TEST_P(TetFormat, KeepsMidSideNodes) {
  const TetMesh written = awkward_tets_with_sets();
  double error = 0;
  const TetMesh read = there_and_back(written, GetParam(), &error);
  EXPECT_EQ(read.tets, written.tets);
  EXPECT_EQ(read.mid_nodes, written.mid_nodes);
  EXPECT_EQ(read.boundary, written.boundary);
  ASSERT_EQ(read.points.size(), written.points.size());
  for (std::size_t i = 0; i < read.points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(read.points[i][axis], written.points[i][axis], error * std::abs(written.points[i][axis]));
    }
  }
}

TEST_P(TetFormat, InMetresComesBackInMillimetres) {
  TetMesh written = awkward_tets_with_sets();
  written.info.unit = LengthUnit::kMetre;
  double error = 0;
  const TetMesh read = there_and_back(written, GetParam(), &error);
  EXPECT_GT(error, 0);
  EXPECT_EQ(read.info.unit, LengthUnit::kMetre);
  for (std::size_t i = 0; i < read.points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(read.points[i][axis], written.points[i][axis], error * std::abs(written.points[i][axis]));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, TetFormat,
                         ::testing::Values(".vtu", ".vtk", ".mesh", ".msh", ".msh2", ".inp", ".feb", ".bdf", ".unv"),
                         [](const auto& extension) { return std::string(extension.param).substr(1); });

TEST(Sets, SurviveVtuWhole) {
  const TetMesh written = awkward_tets_with_sets();
  const TetMesh read = there_and_back(written, ".vtu");
  ASSERT_EQ(read.sets.size(), written.sets.size());
  for (const MeshSet& set : written.sets)
    EXPECT_NE(std::find(read.sets.begin(), read.sets.end(), set), read.sets.end());
}

TEST(Sets, SurviveSolversFormatsWhole) {
  const TetMesh written = awkward_tets_with_sets();
  for (const char* extension : {".inp", ".bdf", ".unv", ".feb"}) {
    const TetMesh read = there_and_back(written, extension);
    EXPECT_EQ(read.sets.size(), written.sets.size()) << extension;
    for (const MeshSet& set : written.sets) {
      EXPECT_NE(std::find(read.sets.begin(), read.sets.end(), set), read.sets.end()) << extension << " " << set.name;
    }
  }
}

// To Abaqus BASE and base are one; the spelling is the user's all the same.
TEST(Sets, KeepTheSpellingOfTheirNamesInAbaqus) {
  TetMesh written = awkward_tets_with_sets();
  for (MeshSet& set : written.sets) {
    for (char& c : set.name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  const TetMesh read = there_and_back(written, ".inp");
  EXPECT_EQ(read.sets.size(), written.sets.size());
  for (const MeshSet& set : written.sets) {
    EXPECT_NE(std::find(read.sets.begin(), read.sets.end(), set), read.sets.end()) << set.name;
  }
}

TEST(Sets, OfFacesAndTetsSurviveGmsh) {
  const TetMesh written = awkward_tets_with_sets();
  TetMesh read = there_and_back(written, ".msh");
  EXPECT_EQ(read.regions, written.regions);
  ASSERT_EQ(read.sets.size(), 3u) << "all but the set of nodes alone";
  for (MeshSet set : written.sets) {
    set.nodes.clear();
    if (set.tets.empty() && set.faces.empty()) continue;
    EXPECT_NE(std::find(read.sets.begin(), read.sets.end(), set), read.sets.end()) << set.name;
  }
}

TEST(Sets, AreWrittenToAbaqusInItsNotation) {
  const TemporaryFolder folder;
  write_mesh(awkward_tets_with_sets(), folder / "a.inp");
  const std::string text = file_bytes(folder / "a.inp");
  EXPECT_NE(text.find("*NSET, NSET=NODES-ONLY\n1, 4, 8\n"), std::string::npos);
  EXPECT_NE(text.find("*ELSET, ELSET=TETS\n2\n"), std::string::npos);
  EXPECT_NE(text.find("*SURFACE, NAME=FACES, TYPE=ELEMENT\n1, S2\n2, S1\n"), std::string::npos);
  EXPECT_NE(text.find("TYPE=C3D10"), std::string::npos);
}

TEST(Sets, LinesOfAbaqusHoldAtMostSixteenNumbersOfTwentyCharacters) {
  const TemporaryFolder folder;
  write_mesh(awkward_tets_with_sets(), folder / "a.inp");
  std::size_t field = 0, fields = 1;
  for (char c : file_bytes(folder / "a.inp")) {
    if (c == '\n') fields = 1;
    if (c == ',') ++fields;
    field = c == ',' || c == '\n' || c == ' ' ? 0 : field + 1;
    EXPECT_LE(field, 20u);
    EXPECT_LE(fields, 17u);
  }
}

}  // namespace
}  // namespace delvox
