// Damaged and lying files: an InputError of one line or a valid mesh, never a crash or memory beyond reason.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>

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
using testing::write_bytes;

template <class Cell>
void expect_valid(const std::vector<Point3>& points, const std::vector<Cell>& cells) {
  EXPECT_TRUE(std::all_of(points.begin(), points.end(), is_finite));
  for (const Cell& cell : cells) {
    for (std::uint32_t index : cell) ASSERT_LT(index, points.size());
  }
}

/// Reads what may be damaged; the message of the error, or "" if a valid mesh came out.
std::string read_damaged(const std::filesystem::path& path) {
  try {
    const Mesh mesh = read_mesh(path).mesh;
    if (const auto* tets = std::get_if<TetMesh>(&mesh)) {
      expect_valid(tets->points, tets->tets);
      EXPECT_TRUE(tets->regions.empty() || tets->regions.size() == tets->tets.size());
      EXPECT_TRUE(tets->on_surface.empty() || tets->on_surface.size() == tets->points.size());
    } else {
      expect_valid(std::get<SurfaceMesh>(mesh).points, std::get<SurfaceMesh>(mesh).triangles);
    }
    return "";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_EQ(message.find(path.string()), 0u) << message;
    return message;
  }
}

class HostileFile : public ::testing::TestWithParam<const char*> {
 protected:
  std::filesystem::path file() const { return folder_ / (std::string("mesh") + GetParam()); }

  std::vector<std::string> originals() const {
    std::vector<std::string> result;
    write_mesh(awkward_tets(), file());
    result.push_back(file_bytes(file()));
    write_mesh(awkward_surface(), file());
    result.push_back(file_bytes(file()));
    return result;
  }
  TemporaryFolder folder_;
};

TEST_P(HostileFile, CutOffAnywhereIsAnErrorOrAMesh) {
  for (const std::string& original : originals()) {
    for (std::size_t length = 0; length < original.size(); ++length) {
      write_bytes(file(), original.substr(0, length));
      read_damaged(file());
    }
    write_bytes(file(), original.substr(0, original.size() / 2));
    EXPECT_NE(read_damaged(file()), "") << "half a file was taken for a mesh";
  }
}

TEST_P(HostileFile, WithChangedBytesIsAnErrorOrAMesh) {
  std::mt19937 random(7);
  for (const std::string& original : originals()) {
    for (int round = 0; round < 400; ++round) {
      std::string bytes = original;
      const std::size_t changes = 1 + random() % 4;
      for (std::size_t i = 0; i < changes; ++i) {
        const char interesting[] = {'\0', '\xff', '9', '-', ' ', '\n', '<', static_cast<char>(random())};
        bytes[random() % bytes.size()] = interesting[random() % sizeof interesting];
      }
      write_bytes(file(), bytes);
      read_damaged(file());
    }
  }
}

TEST_P(HostileFile, WithPartsRemovedOrRepeatedIsAnErrorOrAMesh) {
  std::mt19937 random(11);
  for (const std::string& original : originals()) {
    for (int round = 0; round < 200; ++round) {
      std::string bytes = original;
      const std::size_t start = random() % bytes.size(), length = random() % 40;
      if (round % 2 == 0) {
        bytes.erase(start, length);
      } else {
        bytes.insert(random() % bytes.size(), original.substr(start, length));
      }
      write_bytes(file(), bytes);
      read_damaged(file());
    }
  }
}

TEST_P(HostileFile, OfNoiseIsAnError) {
  std::mt19937 random(3);
  for (std::size_t size : {1u, 2u, 10u, 83u, 84u, 85u, 500u}) {
    std::string noise(size, '\0');
    for (char& c : noise) c = static_cast<char>(random());
    write_bytes(file(), noise);
    EXPECT_NE(read_damaged(file()), "");
  }
}

TEST_P(HostileFile, MissingEmptyOrAFolderIsAnError) {
  EXPECT_NE(read_damaged(file()).find("no such file"), std::string::npos);
  write_bytes(file(), "");
  EXPECT_NE(read_damaged(file()).find("empty"), std::string::npos);
  std::filesystem::remove(file());
  std::filesystem::create_directory(file());
  EXPECT_NE(read_damaged(file()).find("not a regular file"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Formats, HostileFile,
                         ::testing::Values(".vtu", ".vtk", ".stl", ".ply", ".off", ".obj", ".mesh", ".msh", ".msh2",
                                           ".inp", ".feb", ".bdf", ".unv"),
                         [](const auto& extension) { return std::string(extension.param).substr(1); });

struct Lie {
  const char* name;
  const char* bytes;
  const char* expected;  ///< part of the message
};

class LyingFile : public ::testing::TestWithParam<Lie> {};

TEST_P(LyingFile, IsRefusedWithItsCause) {
  const TemporaryFolder folder;
  write_bytes(folder / GetParam().name, GetParam().bytes);
  EXPECT_NE(read_damaged(folder / GetParam().name).find(GetParam().expected), std::string::npos)
      << read_damaged(folder / GetParam().name);
}

constexpr Lie kLies[] = {
    {"a.off", "OFF\n1000000000 1 0\n0 0 0\n", "claims 1000000000 points"},
    {"a.off", "OFF\n-1 1 0\n0 0 0\n", "claims -1 points"},
    {"a.off", "OFF\n99999999999999999999 1 0\n", "whole number"},
    {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "names point 3"},
    {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n", "names point -2"},
    {"a.off", "OFF\n3 1 0\n0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n", "not finite"},
    {"a.off", "OFF\n3 1 0\n0 0 0\ninf 0 0\n0 1 0\n3 0 1 2\n", "not finite"},
    {"a.off", "OFF\n3 1 0\n0 0 0\n1e999 0 0\n0 1 0\n3 0 1 2\n", "a number was expected"},
    {"a.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "neither tets nor triangles"},
    {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n", "names vertex 0"},
    {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n", "names vertex -4"},
    {"a.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n", "2 nodes"},
    {"a.obj", "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n", "crosses itself"},
    {"a.ply", "ply\nformat ascii 1.0\nelement vertex 999999999999\nproperty float x\nproperty float y\n"
              "property float z\nend_header\n0 0 0\n", "claims 999999999999"},
    {"a.ply", "ply\nformat ascii 1.0\nelement vertex 5\nend_header\n0 0 0\n", "without properties"},
    {"a.mesh", "MeshVersionFormatted 2 Dimension 3 Vertices 2000000000\n0 0 0 0\nEnd", "claims 2000000000 vertices"},
    {"a.mesh", "MeshVersionFormatted 2 Dimension 2\n", "not three-dimensional"},
    {"a.mesh", "MFEM mesh v1.0\n", "MeshVersionFormatted"},
    {"a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n888888888\n1 0 0 0\n$EndNodes\n", "claims 888888888"},
    {"a.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 1 1 1\n3 1 0 888888888\n$EndNodes\n",
     "claims 888888888 nodes"},
    {"a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n", "$EndNodes"},
    {"a.inp", "*NODE\n1,0,0,0\n1,1,0,0\n*ELEMENT,TYPE=S3\n1,1,1,1\n", "two nodes have the number 1"},
    {"a.inp", "*NODE\n1,0,0,0\n*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n", "names node 2"},
    {"a.inp", "*NODE\n1,0,0,0\n*ELEMENT,TYPE=C3D4\n1,1,1\n", "too few nodes"},
    {"a.inp", "*INCLUDE, INPUT=other.inp\n", "includes other files"},
    {"a.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 777777777 double\n0 0 0\n", "claims"},
    {"a.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\n", "STRUCTURED_POINTS"},
    {"a.vtu", "<VTKFile type=\"PolyData\"><PolyData></PolyData></VTKFile>", "not an UnstructuredGrid"},
    {"a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n",
     "endsolid"},
    {"a.docx", "x", "no mesh format has the extension '.docx'"},
};

INSTANTIATE_TEST_SUITE_P(Lies, LyingFile, ::testing::ValuesIn(kLies));

TEST(HostileVtu, ABlockThatClaimsToExpandBeyondReasonIsRefused) {
  // Uncompressed size 2^40 out of 4 bytes: nothing may be allocated for it.
  const TemporaryFolder folder;
  std::string head(32, '\0');
  head[0] = 1;
  head[8 + 5] = 1;
  head[24] = 4;
  write_bytes(folder / "a.vtu",
              "<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">"
              "<UnstructuredGrid><Piece NumberOfPoints=\"1\" NumberOfCells=\"1\"><Points><DataArray type=\"Float64\" "
              "format=\"appended\" offset=\"0\"/></Points></Piece></UnstructuredGrid><AppendedData encoding=\"raw\">_" +
                  head + "abcd\n</AppendedData></VTKFile>");
  EXPECT_NE(read_damaged(folder / "a.vtu").find("impossible size"), std::string::npos);
}

TEST(HostileVtu, ManyPiecesThatShareOneLargeArrayAreRefused) {
  const TemporaryFolder folder;
  constexpr std::uint32_t kPoints = 20'000;
  std::string array(4, '\0');
  for (unsigned byte = 0; byte < 4; ++byte) array[byte] = static_cast<char>(kPoints * 24 >> 8 * byte);
  array.resize(4 + kPoints * 24);
  std::string pieces;
  for (int i = 0; i < 2000; ++i) {
    pieces += "<Piece NumberOfPoints=\"20000\" NumberOfCells=\"0\"><Points><DataArray type=\"Float64\" "
              "format=\"appended\" offset=\"0\"/></Points><Cells><DataArray Name=\"connectivity\"/><DataArray "
              "Name=\"offsets\"/><DataArray Name=\"types\"/></Cells></Piece>";
  }
  write_bytes(folder / "a.vtu", "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>" + pieces +
                                    "</UnstructuredGrid><AppendedData encoding=\"raw\">_" + array +
                                    "</AppendedData></VTKFile>");
  EXPECT_NE(read_damaged(folder / "a.vtu").find("impossible size"), std::string::npos);
}

TEST(HostileObj, APolygonOfManyCornersIsRefusedQuickly) {
  const TemporaryFolder folder;
  std::string bytes, face = "f";
  for (int i = 1; i <= 20000; ++i) {
    bytes += "v " + std::to_string(i % 7) + " " + std::to_string(i % 11) + " " + std::to_string(i % 3) + "\n";
    face += " " + std::to_string(i);
  }
  write_bytes(folder / "a.obj", bytes + face + "\n");
  const auto start = std::chrono::steady_clock::now();
  EXPECT_NE(read_damaged(folder / "a.obj"), "");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

}  // namespace
}  // namespace delvox
