// FEBio, Nastran, UNV, MED and XDMF against what their manuals say, and files by others in them.
#include <gtest/gtest.h>

#include <algorithm>

#include "delvox/core/errors.h"
#include "delvox/mesh_io/read_mesh.h"
#include "delvox/mesh_io/write_mesh.h"
#include "mesh_io/mesh_io_support.h"

namespace delvox {
namespace {

using testing::awkward_tets_with_sets;
using testing::file_bytes;
using testing::TemporaryFolder;
using testing::write_bytes;

std::string written(const TetMesh& mesh, const std::string& name) {
  const TemporaryFolder folder;
  write_mesh(mesh, folder / name);
  return file_bytes(folder / name);
}

TetMesh read_text(const std::string& name, const std::string& text) {
  const TemporaryFolder folder;
  write_bytes(folder / name, text);
  return std::get<TetMesh>(read_mesh(folder / name).mesh);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines(1);
  for (char c : text) {
    if (c == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += c;
    }
  }
  return lines;
}

TetMesh with_materials() {
  TetMesh mesh = awkward_tets_with_sets();
  mesh.materials = {{"bone", 7, 17000, 0.3, 1900}, {"fat", 2, 0.5, 0.49, 0}};
  return mesh;
}

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t n = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
  return n;
}

TEST(Febio, HasTheSectionsOfVersionFourInTheirOrder) {
  const std::string text = written(with_materials(), "a.feb");
  std::size_t at = 0;
  for (const char* section : {"<febio_spec version=\"4.0\">", "<Module type=\"solid\"/>", "<Material>", "</Material>",
                              "<Mesh>", "<Nodes", "</Nodes>", "<Elements type=\"tet10\"", "</Elements>", "<NodeSet",
                              "<Surface", "<ElementSet", "</Mesh>", "<MeshDomains>", "</febio_spec>"}) {
    const std::size_t found = text.find(section, at);
    ASSERT_NE(found, std::string::npos) << section;
    at = found;
  }
  EXPECT_NE(text.find("<SolidDomain name=\"region_7\" mat=\"bone\"/>"), std::string::npos);
  EXPECT_NE(text.find("<E>17000</E>"), std::string::npos);
  EXPECT_EQ(count(text, "<tri6 id="), 5u) << "three faces in one set, two in the other";
  EXPECT_EQ(count(text, "<density>"), 1u) << "what is not known is not written";
  for (const char* tag : {"Nodes", "Elements", "NodeSet", "Surface", "ElementSet", "elem", "node"}) {
    EXPECT_EQ(count(text, std::string("<") + tag + " "), count(text, std::string("</") + tag + ">")) << tag;
  }
}

TEST(Febio, ReadsVersionTwo) {
  const TetMesh mesh = read_text("a.feb", R"(<?xml version="1.0"?>
<febio_spec version="2.5"><Geometry>
<Nodes name="n"><node id="5"> 0,0,0</node><node id="6">1.0e0, 0,0</node><node id="7">0,1,0</node><node id="8">0,0,1</node></Nodes>
<Elements type="tet4" mat="1" name="Part"><elem id="9">5,6,7,8</elem></Elements>
<NodeSet name="fixed"><node id="5"/><node id="7"/></NodeSet>
<Surface name="face"><tri3 id="1">7,6,5</tri3></Surface>
</Geometry></febio_spec>)");
  EXPECT_EQ(mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}}));
  ASSERT_EQ(mesh.sets.size(), 2u);
  EXPECT_EQ(mesh.sets[0], (MeshSet{"fixed", {0, 2}, {}, {}}));
  EXPECT_EQ(mesh.sets[1], (MeshSet{"face", {}, {}, {{0, 3}}}));
}

TEST(Nastran, FieldsKeepToTheirColumns) {
  for (const std::string& line : lines_of(written(with_materials(), "a.bdf"))) {
    if (line.starts_with('$') || line.empty()) continue;
    EXPECT_LE(line.size(), 80u) << line;
    if (line.starts_with("GRID*")) {
      EXPECT_EQ(line.size(), 73u) << line;
      for (std::size_t start : {40u, 56u}) {
        EXPECT_NE(line.substr(start, 16).find('.'), std::string::npos) << "a real number without a point: " << line;
      }
    }
  }
}

TEST(Nastran, PressuresNameACornerOfTheFaceAndTheOneOpposite) {
  const TetMesh mesh = with_materials();
  std::vector<std::string> found;
  for (const std::string& line : lines_of(written(mesh, "a.bdf"))) {
    if (line.starts_with("PLOAD4")) found.push_back(line);
  }
  ASSERT_EQ(found.size(), 5u);
  // Face 1 of tet 0 lies opposite corner 1, which is node 2; its first corner is node 1.
  EXPECT_EQ(found[0].substr(16, 8), "1       ");
  EXPECT_EQ(found[0].substr(56, 8), "1       ");
  EXPECT_EQ(found[0].substr(64), "2       ");
}

TEST(Nastran, ReadsFreeSmallAndLargeFields) {
  const TetMesh mesh = read_text("a.nas", R"(SOL 101
CEND
BEGIN BULK
$ a comment
GRID,10,,0.,0.0,0.
GRID          20         1.0    0.0     0.0
GRID*                 30                              0.             1.5
*                   2.-1
GRID,40,0,0,0,1.0+0
CTETRA,1,5,10,20,30,40
CTETRA  2       6       10      30      20      40
CBAR,77,1,10,20,0.,0.,1.
ENDDATA
)");
  EXPECT_EQ(mesh.points[2], (Point3{0, 1.5, 0.2}));
  EXPECT_EQ(mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}, {0, 2, 1, 3}}));
  EXPECT_EQ(mesh.regions, (std::vector<Label>{5, 6}));
}

TEST(Unv, RecordsHaveTheColumnsOfTheirFormats) {
  const std::vector<std::string> lines = lines_of(written(awkward_tets_with_sets(), "a.unv"));
  const auto nodes = std::find(lines.begin(), lines.end(), "  2411");
  ASSERT_NE(nodes, lines.end());
  EXPECT_EQ(nodes[1], "         1         1         1        11");
  EXPECT_EQ(nodes[2].size(), 75u);
  EXPECT_NE(nodes[2].find("D-09"), std::string::npos) << nodes[2];
  const auto elements = std::find(lines.begin(), lines.end(), "  2412");
  ASSERT_NE(elements, lines.end());
  EXPECT_EQ(elements[1], "         1        92         1         1         7         6");
  EXPECT_EQ(elements[2].size(), 60u);
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "    -1"), 8);
}

TEST(Unv, ReadsOldDatasetsAndGroupsByOthers) {
  const TetMesh mesh = read_text("a.unv", R"(    -1
   164
         1  SI: Meters (newton)         2
    -1
    -1
   781
         1         0         0        11
  0.0000000000000000D+00  0.0000000000000000D+00  0.0000000000000000D+00
         2         0         0        11
  1.0000000000000000D+00  0.0000000000000000D+00  0.0000000000000000D+00
         3         0         0        11
  0.0000000000000000D+00  1.0000000000000000D+00  0.0000000000000000D+00
         4         0         0        11
  0.0000000000000000D+00  0.0000000000000000D+00  1.0000000000000000D+00
    -1
    -1
  2412
         1        11         2         1         7         2
         0         1         1
         1         2
         2        41         2         1         7         3
         1         2         3
         3       111         4         1         7         4
         1         2         3         4
    -1
    -1
  2467
         1         0         0         0         0         0         0         3
Base
         8         2         0         0         7         1         0         0
         7         3         0         0
    -1
)");
  EXPECT_EQ(mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}}));
  EXPECT_EQ(mesh.regions, std::vector<Label>{4});
  ASSERT_EQ(mesh.sets.size(), 1u);
  EXPECT_EQ(mesh.sets[0], (MeshSet{"Base", {0, 2}, {}, {{0, 3}}}));
}

TEST(Hdf5Formats, GiveTheSameBytesAndLeaveNothingElse) {
  for (const char* name : {"a.med", "a.xdmf"}) {
    const TemporaryFolder folder;
    write_mesh(awkward_tets_with_sets(), folder / name);
    std::vector<std::string> first;
    std::size_t files = 0;
    for (const auto& file : files_of(folder / name)) first.push_back(file_bytes(file));
    write_mesh(awkward_tets_with_sets(), folder / name);
    for (const auto& file : files_of(folder / name)) EXPECT_EQ(file_bytes(file), first[files++]);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), static_cast<long>(files));
    EXPECT_NE(first[0].find("SPACE=LPS"), std::string::npos);
  }
}

TEST(Hdf5Formats, AreNotReadAndSayItInOneLine) {
  const TemporaryFolder folder;
  for (const char* name : {"a.med", "a.xdmf"}) {
    write_mesh(awkward_tets_with_sets(), folder / name);
    try {
      read_mesh(folder / name);
      FAIL();
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("not read"), std::string::npos);
    }
  }
}

TEST(Hdf5Formats, XdmfWithoutSetsOfFacesHasNoFacets) {
  const TemporaryFolder folder;
  write_mesh(testing::awkward_surface(), folder / "a&b.xdmf");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);
  EXPECT_NE(file_bytes(folder / "a&b.xdmf").find("a&amp;b.h5:/mesh/geometry"), std::string::npos);
}

}  // namespace
}  // namespace delvox
