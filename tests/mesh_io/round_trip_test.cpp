#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>

#include "delvox/core/errors.h"
#include "delvox/mesh_io/read_mesh.h"
#include "delvox/mesh_io/write_mesh.h"
#include "mesh_io/mesh_io_support.h"

namespace delvox {
namespace {

using testing::awkward_surface;
using testing::awkward_tets;
using testing::file_bytes;
using testing::TemporaryFolder;

void expect_same_points(const std::vector<Point3>& read, const std::vector<Point3>& written, double relative_error) {
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(std::abs(read[i][axis] - written[i][axis]), relative_error * std::abs(written[i][axis]));
    }
  }
}

/// The corners of each triangle, with indices resolved: what a format without shared points keeps.
std::vector<Point3> corners_of(const SurfaceMesh& mesh) {
  std::vector<Point3> corners;
  for (const Triangle& triangle : mesh.triangles) {
    for (std::uint32_t index : triangle) corners.push_back(mesh.points[index]);
  }
  return corners;
}

class EveryFormat : public ::testing::TestWithParam<const char*> {
 protected:
  std::filesystem::path file() const { return folder_ / (std::string("mesh") + GetParam()); }
  bool holds_surfaces_only() const {
    const std::string extension = GetParam();
    return extension == ".stl" || extension == ".ply" || extension == ".off" || extension == ".obj";
  }
  bool holds_every_info() const {
    const std::string extension = GetParam();
    return extension == ".vtu" || extension == ".vtk";
  }
  TemporaryFolder folder_;
};

TEST_P(EveryFormat, KeepsASurface) {
  const SurfaceMesh written = awkward_surface();
  write_mesh(written, file());
  const MeshFile read = read_mesh(file());
  ASSERT_TRUE(std::holds_alternative<SurfaceMesh>(read.mesh));
  const auto& surface = std::get<SurfaceMesh>(read.mesh);
  EXPECT_EQ(surface.points.size(), written.points.size());
  expect_same_points(corners_of(surface), corners_of(written), read.coordinate_error);
  if (std::string(GetParam()) != ".stl") {
    EXPECT_EQ(surface.triangles, written.triangles);
  }
  EXPECT_EQ(surface.info.frame, written.info.frame);
  if (holds_every_info()) {
    EXPECT_EQ(surface.info, written.info);
  }
}

TEST_P(EveryFormat, KeepsTetsOrTheirBoundary) {
  const TetMesh written = awkward_tets();
  write_mesh(written, file());
  const MeshFile read = read_mesh(file());
  if (holds_surfaces_only()) {
    ASSERT_TRUE(std::holds_alternative<SurfaceMesh>(read.mesh));
    expect_same_points(corners_of(std::get<SurfaceMesh>(read.mesh)), corners_of(boundary_surface(written)),
                       read.coordinate_error);
    return;
  }
  ASSERT_TRUE(std::holds_alternative<TetMesh>(read.mesh));
  const auto& tets = std::get<TetMesh>(read.mesh);
  expect_same_points(tets.points, written.points, read.coordinate_error);
  EXPECT_EQ(tets.tets, written.tets);
  EXPECT_EQ(tets.regions, written.regions);
  EXPECT_EQ(tets.boundary, written.boundary);
  if (holds_every_info()) {
    EXPECT_EQ(tets.on_surface, written.on_surface);
  }
  if (holds_every_info()) {
    EXPECT_EQ(tets.info, written.info);
  }
}

TEST_P(EveryFormat, ReadsTetsWithoutRegionsAsRegionOne) {
  if (holds_surfaces_only()) GTEST_SKIP() << "no regions in this format";
  TetMesh written = awkward_tets();
  written.regions.clear();
  written.boundary.clear();
  written.on_surface.clear();
  write_mesh(written, file());
  const Mesh read = read_mesh(file()).mesh;
  EXPECT_EQ(std::get<TetMesh>(read).regions, std::vector<Label>({1, 1}));
  EXPECT_TRUE(std::get<TetMesh>(read).on_surface.empty());
}

TEST_P(EveryFormat, GivesTheSameBytesForTheSameMesh) {
  write_mesh(awkward_tets(), file());
  const std::string first = file_bytes(file());
  write_mesh(awkward_tets(), file());
  EXPECT_EQ(file_bytes(file()), first);
  EXPECT_EQ(first.find("mesh_io_"), std::string::npos) << "the path is in the file";
}

TEST_P(EveryFormat, NamesItsFrameAndThatItIsIncomplete) {
  write_mesh(awkward_tets(), file());
  EXPECT_NE(file_bytes(file()).find("SPACE=LPS"), std::string::npos);
  EXPECT_NE(file_bytes(file()).find("INCOMPLETE"), std::string::npos);
  const MeshFile read = read_mesh(file());
  EXPECT_FALSE(std::visit([](const auto& mesh) { return mesh.info; }, read.mesh).complete);
  write_mesh(awkward_surface(), file());
  EXPECT_NE(file_bytes(file()).find("SPACE=RAS"), std::string::npos);
  EXPECT_EQ(file_bytes(file()).find("INCOMPLETE"), std::string::npos);
}

TEST_P(EveryFormat, LeavesNothingBehindButTheFile) {
  write_mesh(awkward_tets(), file());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
}

TEST_P(EveryFormat, RefusesAPathWithoutAFolder) {
  const auto path = folder_ / (std::string("missing/mesh") + GetParam());
  EXPECT_THROW(write_mesh(awkward_surface(), path), IoError);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_P(EveryFormat, ExtensionMayBeInCapitals) {
  std::string name = std::string("mesh") + GetParam();
  for (char& c : name) c = static_cast<char>(std::toupper(c));
  write_mesh(awkward_surface(), folder_ / name);
  EXPECT_NO_THROW(read_mesh(folder_ / name));
}

INSTANTIATE_TEST_SUITE_P(Formats, EveryFormat,
                         ::testing::Values(".vtu", ".vtk", ".stl", ".ply", ".off", ".obj", ".mesh", ".msh", ".msh2",
                                           ".inp", ".feb", ".bdf", ".nas", ".unv"),
                         [](const auto& extension) { return std::string(extension.param).substr(1); });

TEST(WriteMesh, NamesTheFormatsWhenTheExtensionIsUnknown) {
  try {
    files_of("mesh.docx");
    FAIL();
  } catch (const OptionError& error) {
    EXPECT_NE(std::string(error.what()).find(".vtu"), std::string::npos);
  }
  EXPECT_THROW(files_of("mesh"), OptionError);
  EXPECT_EQ(files_of("a.b/mesh.STL"), std::vector<std::filesystem::path>{"a.b/mesh.STL"});
  EXPECT_EQ(files_of("a.b/mesh.xdmf"),
            (std::vector<std::filesystem::path>{"a.b/mesh.xdmf", "a.b/mesh.h5", "a.b/mesh_facets.xdmf",
                                                "a.b/mesh_facets.h5"}));
}

TEST(WriteMesh, RefusesAPathThatIsAFolder) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "a.stl");
  EXPECT_THROW(write_mesh(awkward_surface(), folder / "a.stl"), IoError);
}

TEST(WriteMesh, ReportsAFullDiskAndKeepsTheOldFile) {
  const TemporaryFolder folder;
  TetMesh mesh = awkward_tets();
  for (const char* name : {"a.vtu", "a.vtk", "a.stl", "a.inp", "a.msh"}) {
    testing::write_bytes(folder / name, "old");
    // A limit on the size of files stands in for the disk.
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before;
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit small{100, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    EXPECT_THROW(write_mesh(mesh, folder / name), IoError);
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_EQ(file_bytes(folder / name), "old");
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 5);
}

}  // namespace
}  // namespace delvox
