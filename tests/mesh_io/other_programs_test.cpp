// VTK and meshio open what we write. Skipped where they are not installed (Debian: python3-vtk9, python3-meshio).
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

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

class Vtk : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("/usr/bin/python3 -c 'import vtk' >/dev/null 2>&1") != 0) GTEST_SKIP() << "no VTK for Python";
  }
  /// Runs Python in the folder and gives back what it wrote to the file "out".
  std::string run(const std::string& script) {
    write_bytes(folder_ / "script.py", "import vtk\nout = open('out', 'w')\n" + script);
    const std::string command = "cd '" + folder_.path().string() + "' && /usr/bin/python3 script.py";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return file_bytes(folder_ / "out");
  }
  TemporaryFolder folder_;
};

TEST_F(Vtk, OpensTetsInVtuAndLegacyVtk) {
  write_mesh(awkward_tets(), folder_ / "a.vtu");
  write_mesh(awkward_tets(), folder_ / "a.vtk");
  const std::string result = run(R"(
for reader, name in (vtk.vtkXMLUnstructuredGridReader(), 'a.vtu'), (vtk.vtkUnstructuredGridReader(), 'a.vtk'):
    reader.SetFileName(name)
    if name == 'a.vtk': reader.ReadAllScalarsOn()
    reader.Update()
    grid = reader.GetOutput()
    region = grid.GetCellData().GetArray('region')
    volume = sum(vtk.vtkTetra.ComputeVolume(*[grid.GetPoint(grid.GetCell(c).GetPointId(i)) for i in range(4)]) > 0
                 for c in range(grid.GetNumberOfCells()))
    out.write('%d %d %d %d %d %r %r %g;' % (grid.GetNumberOfPoints(), grid.GetNumberOfCells(), volume,
              region.GetValue(0), region.GetValue(1), grid.GetPoint(3)[0], grid.GetPoint(3)[2],
              grid.GetFieldData().GetArray('delvox_isovalue').GetValue(0)))
out.close()
)");
  const std::string one = "5 2 2 7 2 0.30000000000000004 54321.0987654321 2.9;";
  EXPECT_EQ(result, one + one);
}

// 3D Slicer looks for SPACE=RAS and SPACE=LPS in these, by these readers.
TEST_F(Vtk, FindsTheFrameInTheHeaders) {
  for (const char* name : {"a.vtk", "a.stl", "a.ply", "a.obj"}) write_mesh(awkward_surface(), folder_ / name);
  const std::string result = run(R"(
for reader, name in ((vtk.vtkPolyDataReader(), 'a.vtk'), (vtk.vtkSTLReader(), 'a.stl'), (vtk.vtkPLYReader(), 'a.ply'),
                     (vtk.vtkOBJReader(), 'a.obj')):
    reader.SetFileName(name)
    reader.Update()
    header = (reader.GetComment() if name == 'a.obj' else reader.GetHeader() if name != 'a.ply' else
              ''.join(reader.GetComments().GetValue(i) for i in range(reader.GetComments().GetNumberOfValues())))
    out.write('%s %d;' % (name, 'SPACE=RAS' in header))
out.close()
)");
  EXPECT_EQ(result, "a.vtk 1;a.stl 1;a.ply 1;a.obj 1;");
}

TEST_F(Vtk, OpensSurfaces) {
  for (const char* name : {"a.vtu", "a.vtk", "a.stl", "a.ply", "a.obj"}) write_mesh(awkward_surface(), folder_ / name);
  const std::string result = run(R"(
for reader, name in ((vtk.vtkXMLUnstructuredGridReader(), 'a.vtu'), (vtk.vtkPolyDataReader(), 'a.vtk'),
                     (vtk.vtkSTLReader(), 'a.stl'), (vtk.vtkPLYReader(), 'a.ply'), (vtk.vtkOBJReader(), 'a.obj')):
    reader.SetFileName(name)
    reader.Update()
    out.write('%d %d;' % (reader.GetOutput().GetNumberOfPoints(), reader.GetOutput().GetNumberOfCells()))
out.close()
)");
  EXPECT_EQ(result, "5 6;5 6;5 6;5 6;5 6;");
}

TEST_F(Vtk, WritesVtuThatWeReadWhateverItsEncoding) {
  write_mesh(awkward_tets(), folder_ / "a.vtu");
  run(R"(
reader = vtk.vtkXMLUnstructuredGridReader()
reader.SetFileName('a.vtu')
reader.Update()
for variant in range(48):
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetInputData(reader.GetOutput())
    writer.SetDataMode(variant % 3)
    if variant // 3 % 2: writer.SetCompressorTypeToZLib()
    else: writer.SetCompressorTypeToNone()
    if variant // 6 % 2: writer.SetHeaderTypeToUInt64()
    else: writer.SetHeaderTypeToUInt32()
    if variant // 12 % 2: writer.SetByteOrderToBigEndian()
    else: writer.SetByteOrderToLittleEndian()
    writer.SetEncodeAppendedData(variant // 24)
    writer.SetFileName('v%d.vtu' % variant)
    writer.Write()
out.close()
)");
  const TetMesh written = awkward_tets();
  for (int variant = 0; variant < 48; ++variant) {
    const MeshFile file = read_mesh(folder_ / ("v" + std::to_string(variant) + ".vtu"));
    const auto& read = std::get<TetMesh>(file.mesh);
    EXPECT_EQ(read.points, written.points) << variant;
    EXPECT_EQ(read.tets, written.tets) << variant;
    EXPECT_EQ(read.regions, written.regions) << variant;
    EXPECT_EQ(read.on_surface, written.on_surface) << variant;
    EXPECT_EQ(read.info, written.info) << variant;
  }
}

TEST(Meshio, OpensWhatWeWrite) {
  if (std::system("/usr/bin/python3 -c 'import meshio' >/dev/null 2>&1") != 0) GTEST_SKIP() << "no meshio";
  const TemporaryFolder folder;
  for (const char* extension : {"vtu", "vtk", "mesh", "msh", "inp"}) {
    write_mesh(awkward_tets(), folder / (std::string("tets.") + extension));
  }
  for (const char* extension : {"vtu", "mesh", "msh", "inp", "stl", "ply", "off", "obj"}) {
    write_mesh(awkward_surface(), folder / (std::string("surface.") + extension));
  }
  write_bytes(folder / "script.py", R"(
import glob, meshio
files = sorted(glob.glob('tets.*') + glob.glob('surface.*'))
assert len(files) == 13
for name in files:
    mesh = meshio.read(name)
    kind, count = ('tetra', 2) if name.startswith('tets') else ('triangle', 6)
    assert len(mesh.points) == 5, name
    assert sum(len(block.data) for block in mesh.cells if block.type == kind) == count, name
)");
  const std::string command = "cd '" + folder.path().string() + "' && /usr/bin/python3 script.py >/dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

}  // namespace
}  // namespace delvox
