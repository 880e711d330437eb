// Files as other programs write them, each the tet (0,0,0) (1,0,0) (0,1,0) (0,0,1) or a surface.
#include <gtest/gtest.h>

#include <bit>

#include "delvox/core/errors.h"
#include "delvox/mesh_io/read_mesh.h"
#include "mesh_io/binary.h"
#include "mesh_io/mesh_io_support.h"

namespace delvox {
namespace {

using testing::TemporaryFolder;
using testing::write_bytes;

MeshFile read_text(const std::string& name, const std::string& bytes) {
  const TemporaryFolder folder;
  write_bytes(folder / name, bytes);
  return read_mesh(folder / name);
}

SurfaceMesh read_surface(const std::string& name, const std::string& bytes) {
  return std::get<SurfaceMesh>(read_text(name, bytes).mesh);
}

void expect_unit_tet(const MeshFile& file, const std::vector<Label>& regions) {
  ASSERT_TRUE(std::holds_alternative<TetMesh>(file.mesh));
  const auto& mesh = std::get<TetMesh>(file.mesh);
  EXPECT_EQ(mesh.points, (std::vector<Point3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}}));
  EXPECT_EQ(mesh.regions, regions);
  EXPECT_EQ(mesh.boundary.size(), 4u);
}

/// Adds binary numbers to a string.
class Binary {
 public:
  explicit Binary(std::endian order) : order_(order) {}
  Binary& text(const std::string& text) {
    bytes += text;
    return *this;
  }
  template <class T, class... Values>
  Binary& numbers(Values... values) {
    (append(static_cast<T>(values)), ...);
    return *this;
  }
  std::string bytes;

 private:
  template <class T>
  void append(T value) {
    if (order_ != std::endian::native) value = mesh_io::byte_swapped(value);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  std::endian order_;
};

TEST(ForeignVtu, IsReadAsAsciiWithOtherTypesAndCells) {
  expect_unit_tet(read_text("a.vtu", R"(<?xml version="1.0"?>
<VTKFile type='UnstructuredGrid' version="0.1" byte_order="BigEndian">
  <!-- a comment with <tags> -->
  <UnstructuredGrid><Piece NumberOfPoints = "4" NumberOfCells="2">
    <PointData Scalars="s"><DataArray type="Float32" Name="s" format="ascii">1 2 3 4</DataArray></PointData>
    <Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">
      0 0 0  1 0 0  0 1 0  0 0 1 </DataArray></Points>
    <Cells>
      <DataArray type="Int64" Name="connectivity" format="ascii">0 1  0 1 2 3</DataArray>
      <DataArray type="Int64" Name="offsets" format="ascii">2 6</DataArray>
      <DataArray type="Int64" Name="types" format="ascii">3 10</DataArray>
    </Cells>
  </Piece></UnstructuredGrid>
</VTKFile>)"), {});
}

TEST(ForeignVtu, IsReadInPiecesAndAsBase64WithHeadersEncodedApart) {
  // Two pieces of one triangle each; the points of the first are base64: header 72 alone, then nine doubles.
  const std::string cells = R"(<Cells><DataArray type="Int32" Name="connectivity" format="ascii">0 1 2</DataArray>
    <DataArray type="Int32" Name="offsets" format="ascii">3</DataArray>
    <DataArray type="UInt8" Name="types" format="ascii">5</DataArray></Cells></Piece>)";
  const std::string points =
      "SAAAAA==AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA8D8AAAAAAAAAAAAAAAAAAAAAAAAAAAAA"
      "AAAAAAAAAADwPwAAAAAAAAAA";
  const SurfaceMesh mesh = read_surface("a.vtu", R"(<VTKFile type="UnstructuredGrid" byte_order="LittleEndian">
    <UnstructuredGrid><Piece NumberOfPoints="3" NumberOfCells="1"><Points>
    <DataArray type="Float64" NumberOfComponents="3" format="binary">)" + points + R"(</DataArray></Points>)" + cells +
    R"(<Piece NumberOfPoints="3" NumberOfCells="1"><Points>
    <DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 5 1 0 5 0 1 5</DataArray></Points>)" + cells +
    "</UnstructuredGrid></VTKFile>");
  ASSERT_EQ(mesh.points.size(), 6u);
  EXPECT_EQ(mesh.points[1], (Point3{1, 0, 0}));
  EXPECT_EQ(mesh.points[2], (Point3{0, 1, 0}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}}));
}

TEST(ForeignVtk, IsReadAsAscii) {
  expect_unit_tet(read_text("a.vtk", R"(# vtk DataFile Version 2.0
by someone
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 4 float
0 0 0 1 0 0
0 1 0 0 0 1
CELLS 2 8
4 0 1 2 3
2 0 1
CELL_TYPES 2
10
3
POINT_DATA 4
VECTORS v double
0 0 0 1 1 1 2 2 2 3 3 3
CELL_DATA 2
SCALARS region short
LOOKUP_TABLE default
9 0
)"), {9});
}

TEST(ForeignVtk, OfVersionFiveIsReadInBinary) {
  Binary file(std::endian::big);
  file.text("# vtk DataFile Version 5.1\nvtk output\nBINARY\nDATASET UNSTRUCTURED_GRID\n")
      .text("FIELD FieldData 1\nSPACE 1 1 string\n")
      .numbers<std::uint8_t>(0xC3)
      .text("RAS\nPOINTS 4 double\n")
      .numbers<double>(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1)
      .text("\nCELLS 2 4\nOFFSETS vtktypeint64\n")
      .numbers<std::int64_t>(0, 4)
      .text("\nCONNECTIVITY vtktypeint64\n")
      .numbers<std::int64_t>(0, 1, 2, 3)
      .text("\nCELL_TYPES 1\n")
      .numbers<std::int32_t>(10)
      .text("\n");
  expect_unit_tet(read_text("a.vtk", file.bytes), {});
}

TEST(ForeignVtk, PolygonsAndStripsBecomeTriangles) {
  const SurfaceMesh mesh = read_surface("a.vtk", R"(# vtk DataFile Version 3.0
x
ASCII
DATASET POLYDATA
POINTS 5 double
0 0 0 1 0 0 1 1 0 0 1 0 2 0 0
POLYGONS 1 5
4 0 1 2 3
TRIANGLE_STRIPS 1 5
4 0 1 3 2
)");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 3}, {3, 1, 2}, {0, 1, 2}, {0, 2, 3}}));
}

TEST(ForeignStl, IsReadAsAsciiWithSeveralSolids) {
  const std::string facet = "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1E0 0 0\n  vertex -0 +1 0\n"
                            " endloop\nendfacet\n";
  const SurfaceMesh mesh = read_surface("a.stl", "solid one\n" + facet + "endsolid one\nSOLID two\n" + facet +
                                                     "ENDSOLID two\n");
  EXPECT_EQ(mesh.points.size(), 3u);
  EXPECT_EQ(mesh.triangles.size(), 2u);
}

TEST(ForeignStl, InBinaryMayBeginWithSolidAndLosesCollapsedTriangles) {
  Binary file(std::endian::little);
  file.text("solid exported by some CAD" + std::string(54, ' ')).numbers<std::uint32_t>(2);
  file.numbers<float>(0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0).numbers<std::uint16_t>(0);
  file.numbers<float>(0, 0, 1, 0, 0, 0, -0.0f, 0, 0, 0, 1, 0).numbers<std::uint16_t>(0);
  const SurfaceMesh mesh = read_surface("a.stl", file.bytes);
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(ForeignPly, IsReadAsAsciiWithExtraProperties) {
  const SurfaceMesh mesh = read_surface("a.ply", R"(ply
format ascii 1.0
comment SPACE=LPS
obj_info made by hand
element vertex 4
property float nx
property float x
property float y
property float z
property uchar red
element face 1
property uchar flags
property list uchar int vertex_index
element edge 1
property int a
property list uchar float weights
end_header
9 0 0 0 255
9 1 0 0 255
9 1 1 0 255
9 0 1 0 255
7 4 0 1 2 3
3 2 0.5 0.5
)");
  EXPECT_EQ(mesh.points[2], (Point3{1, 1, 0}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(mesh.info.frame, Frame::kLps);
}

TEST(ForeignPly, IsReadInBothByteOrders) {
  for (const auto order : {std::endian::little, std::endian::big}) {
    Binary file(order);
    file.text(std::string("ply\nformat binary_") + (order == std::endian::big ? "big" : "little") + "_endian 1.0\n")
        .text("element vertex 3\nproperty float x\nproperty float y\nproperty double z\nproperty uchar red\n")
        .text("element face 1\nproperty list uint8 uint32 vertex_indices\nend_header\n");
    file.numbers<float>(0, 0).numbers<double>(5).numbers<std::uint8_t>(1);
    file.numbers<float>(1, 0).numbers<double>(5).numbers<std::uint8_t>(1);
    file.numbers<float>(0, 1).numbers<double>(5).numbers<std::uint8_t>(1);
    file.numbers<std::uint8_t>(3).numbers<std::uint32_t>(0, 1, 2);
    const SurfaceMesh mesh = read_surface("a.ply", file.bytes);
    EXPECT_EQ(mesh.points, (std::vector<Point3>{{0, 0, 5}, {1, 0, 5}, {0, 1, 5}}));
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  }
}

TEST(ForeignOff, IsReadWithCommentsColoursAndConcavePolygons) {
  // An arrowhead: the fan from its first corner would reach outside.
  const SurfaceMesh mesh = read_surface("a.off", R"(COFF  # with colours
# a comment
4 1 0
0 0 0 1 0 0 1   # first
2 -1 0 1 0 0 1
1 0 0 1 0 0 1

2 1 0 1 0 0 1
4 1 2 3 0 255 0 0
)");
  ASSERT_EQ(mesh.triangles.size(), 2u);
  for (const Triangle& t : mesh.triangles) {
    const Vector3 normal = cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]);
    EXPECT_GT(normal.z, 0);
  }
}

TEST(ForeignOff, NeedsNoKeyword) {
  EXPECT_EQ(read_surface("a.off", "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").triangles.size(), 1u);
}

TEST(ForeignObj, IsReadWithNormalsNegativeIndicesAndContinuedLines) {
  const SurfaceMesh mesh = read_surface("a.obj", "# Blender\r\nmtllib a.mtl\r\no thing\r\nv 0 0 0\r\nv 1 0 0 1.0\r\n"
                                                 "v 1 1 0\r\nvt 0 0\r\nvn 0 0 1\r\ns off\r\nf 1/1/1 2//1 \\\n3/1\r\n"
                                                 "v 0 1 0\nf -4 -2 -1\n");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(ForeignMedit, IsReadWithOtherSections) {
  expect_unit_tet(read_text("a.mesh", R"( MeshVersionFormatted
2
 Dimension
 3
# a comment
 Vertices
 4
 0 0 0 1
 1.D+00 0 0 1
 0 1.0d0 0 1
 0 0 1 1
 Edges 1
 1 2 8
RequiredVertices
2
1
2
 Triangles 1
 1 2 3 5
 Tetrahedra
 1
 1 2 3 4 3
 End
)"), {3});
}

constexpr const char* kGmsh22 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
1
3 12 "bone"
$EndPhysicalNames
$Nodes
4
10 0 0 0
30 0 1 0
20 1 0 0
40 0 0 1
$EndNodes
$Elements
3
1 15 2 0 1 10
2 2 2 0 1 10 20 30
3 4 3 12 1 7 10 20 30 40
$EndElements
$NodeData
1
"x"
$EndNodeData
)";

TEST(ForeignGmsh, OfVersion22IsReadAsText) { expect_unit_tet(read_text("a.msh", kGmsh22), {12}); }

TEST(ForeignGmsh, OfVersion22IsReadInBinary) {
  for (const auto order : {std::endian::little, std::endian::big}) {
    Binary file(order);
    file.text("$MeshFormat\n2.2 1 8\n").numbers<std::int32_t>(1).text("\n$EndMeshFormat\n$Nodes\n4\n");
    file.numbers<std::int32_t>(1).numbers<double>(0, 0, 0).numbers<std::int32_t>(2).numbers<double>(1, 0, 0);
    file.numbers<std::int32_t>(3).numbers<double>(0, 1, 0).numbers<std::int32_t>(4).numbers<double>(0, 0, 1);
    file.text("\n$EndNodes\n$Elements\n2\n");
    file.numbers<std::int32_t>(15, 1, 2, 1, 0, 1, 1);
    file.numbers<std::int32_t>(4, 1, 2, 2, 0, 6, 1, 2, 3, 4);
    file.text("\n$EndElements\n");
    expect_unit_tet(read_text("a.msh", file.bytes), {6});
  }
}

TEST(ForeignGmsh, OfVersion41IsReadAsTextWithParametricNodes) {
  expect_unit_tet(read_text("a.msh", R"($MeshFormat
4.1 0 8
$EndMeshFormat
$Entities
1 1 0 1
7 0 0 0 0
1 0 0 0 1 1 1 1 55 2 7 7
3 0 0 0 1 1 1 2 44 45 0
$EndEntities
$Nodes
2 4 1 4
1 1 1 2
1
2
0 0 0 0.25
1 0 0 0.75
3 3 0 2
3
4
0 1 0
0 0 1
$EndNodes
$Elements
2 2 1 2
1 1 1 1
1 1 2
3 3 4 1
2 1 2 3 4
$EndElements
)"), {44});
}

TEST(ForeignGmsh, OfVersion41IsReadInBinary) {
  Binary file(std::endian::little);
  file.text("$MeshFormat\n4.1 1 8\n").numbers<std::int32_t>(1).text("\n$EndMeshFormat\n$Entities\n");
  file.numbers<std::uint64_t>(0, 0, 0, 1).numbers<std::int32_t>(3).numbers<double>(0, 0, 0, 1, 1, 1);
  file.numbers<std::uint64_t>(1).numbers<std::int32_t>(44).numbers<std::uint64_t>(0).text("\n$EndEntities\n$Nodes\n");
  file.numbers<std::uint64_t>(1, 4, 1, 4).numbers<std::int32_t>(3, 3, 0).numbers<std::uint64_t>(4, 1, 2, 3, 4);
  file.numbers<double>(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1).text("\n$EndNodes\n$Elements\n");
  file.numbers<std::uint64_t>(1, 1, 1, 1).numbers<std::int32_t>(3, 3, 4).numbers<std::uint64_t>(1, 1, 1, 2, 3, 4);
  file.text("\n$EndElements\n");
  expect_unit_tet(read_text("a.msh", file.bytes), {44});
}

TEST(ForeignGmsh, OfAnotherVersionIsRefusedByName) {
  try {
    read_text("a.msh", "$MeshFormat\n4 0 8\n$EndMeshFormat\n");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("save it as version 4.1 or 2.2"), std::string::npos);
  }
}

TEST(ForeignAbaqus, IsReadWithOtherKeywordsAndMidNodes) {
  // A C3D10 over two lines, nodes out of order, a shell on a face, lines and a step.
  const MeshFile file = read_text("a.inp", R"(*Heading
 a part
** a comment
*Node
2, 1., 0., 0.
1, 0., 0., 0.
3, 0., 1.,
4, 0., 0., 1.
5, .5, 0., 0.
6, .5, .5, 0.
7, 0., .5, 0.
8, 0., 0., .5
9, .5, 0., .5
10, 0., .5, .5
*Element, type=C3D10M, elset=Bone
11, 1, 2, 3, 4, 5, 6, 7,
 8, 9, 10
*element,type=s3
12, 1,2,3
*ELEMENT, TYPE=B31
13, 1, 2
*Nset, nset=all, generate
1, 10, 1
*Step
*Static
*Node print, nset=all
U
*End step
)");
  ASSERT_TRUE(std::holds_alternative<TetMesh>(file.mesh));
  const auto& mesh = std::get<TetMesh>(file.mesh);
  EXPECT_EQ(mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}}));
  EXPECT_EQ(mesh.mid_nodes, (std::vector<MidNodes>{{4, 5, 6, 7, 8, 9}}));
  EXPECT_EQ(mesh.points[9], (Point3{0, 0.5, 0.5}));
  ASSERT_EQ(mesh.sets.size(), 1u);
  EXPECT_EQ(mesh.sets[0].name, "all");
  EXPECT_EQ(mesh.sets[0].nodes.size(), 10u);
}

TEST(ForeignAbaqus, SetsAreReadByNumberRangeAndName) {
  const MeshFile file = read_text("a.inp", R"(*NODE
10,0,0,0
20,1,0,0
30,0,1,0
40,0,0,1
*ELEMENT,TYPE=C3D4
7,10,20,30,40
*NSET,NSET=Base,GENERATE
10,30,10
*NSET,NSET=More
base, 40, 99
*ELSET,ELSET=Body
7
*SURFACE,NAME=Faces
7,S1
 7 , s4
*SURFACE,NAME=ByNodes,TYPE=NODE
10
)");
  const auto& mesh = std::get<TetMesh>(file.mesh);
  ASSERT_EQ(mesh.sets.size(), 4u);
  EXPECT_EQ(mesh.sets[0], (MeshSet{"Base", {0, 1, 2}, {}, {}}));
  EXPECT_EQ(mesh.sets[1], (MeshSet{"More", {0, 1, 2, 3}, {}, {}}));
  EXPECT_EQ(mesh.sets[2], (MeshSet{"Body", {}, {0}, {}}));
  // S1 is 1-2-3, opposite corner 3; S4 is 3-4-1, opposite corner 1.
  EXPECT_EQ(mesh.sets[3], (MeshSet{"Faces", {}, {}, {{0, 1}, {0, 3}}}));
}

TEST(ForeignAbaqus, OfShellsIsASurface) {
  EXPECT_EQ(read_surface("a.inp", "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n*ELEMENT,TYPE=S4R\n1,1,2,3,4\n")
                .triangles,
            (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(ForeignFile, WithHexahedraIsRefused) {
  EXPECT_THROW(read_text("a.inp", "*NODE\n1,0,0,0\n*ELEMENT, TYPE=C3D8R\n1,1,1,1,1,1,1,1,1\n"), InputError);
  EXPECT_THROW(read_text("a.mesh", "MeshVersionFormatted 2 Dimension 3 Vertices 1 0 0 0 0 Hexahedra 1 1 1 1 1 1 1 1 1 "
                                   "0 End"),
               InputError);
}

}  // namespace
}  // namespace delvox
