// VTK, meshio, Gmsh, libmed and dolfinx open what we write. Each is skipped where it is not installed (Debian:
// python3-vtk9, python3-meshio with python3-h5py, gmsh, libmed-tools, python3-dolfinx).
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "delvox/check/check_mesh.h"
#include "delvox/core/mesh_sets.h"
#include "delvox/mesh_io/read_mesh.h"
#include "delvox/mesh_io/write_mesh.h"
#include "mesh_io/mesh_io_support.h"
#include "support/test_meshes.h"

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

/// Whether a shell command succeeds; its output is thrown away.
bool succeeds(const std::string& command) {
  return std::system(("(" + command + ") >/dev/null 2>&1").c_str()) == 0;
}

/// Runs a Python script in a folder; true if it comes to its end without an error.
bool python_succeeds(const TemporaryFolder& folder, const std::string& script) {
  write_bytes(folder / "script.py", script);
  const std::string command = "cd '" + folder.path().string() + "' && /usr/bin/python3 script.py >/dev/null";
  return std::system(command.c_str()) == 0;
}

TEST(Meshio, OpensWhatWeWrite) {
  if (!succeeds("/usr/bin/python3 -c 'import meshio'")) GTEST_SKIP() << "no meshio";
  const TemporaryFolder folder;
  for (const char* extension : {"vtu", "vtk", "mesh", "msh", "inp", "bdf", "med", "xdmf"}) {
    write_mesh(awkward_tets(), folder / (std::string("tets.") + extension));
  }
  for (const char* extension : {"vtu", "mesh", "msh", "inp", "bdf", "med", "xdmf", "stl", "ply", "off", "obj"}) {
    write_mesh(awkward_surface(), folder / (std::string("surface.") + extension));
  }
  // meshio reads no MEDIT files of second order.
  for (const char* extension : {"vtu", "vtk", "msh", "inp", "bdf", "med", "xdmf"}) {
    write_mesh(testing::awkward_tets_with_sets(), folder / (std::string("second.") + extension));
  }
  EXPECT_TRUE(python_succeeds(folder, R"(
import glob, meshio
files = sorted(f for stem in ('tets', 'surface', 'second') for f in glob.glob(stem + '.*') if not f.endswith('.h5'))
assert len(files) == 26, files
counts = {'tets': ('tetra', 2, 5), 'surface': ('triangle', 6, 5), 'second': ('tetra10', 2, 14)}
for name in files:
    mesh = meshio.read(name)
    kind, count, points = counts[name.split('.')[0]]
    assert len(mesh.points) == points, name
    assert sum(len(block.data) for block in mesh.cells if block.type == kind) == count, name
)"));
}

TEST(Meshio, FindsTheSets) {
  if (!succeeds("/usr/bin/python3 -c 'import meshio'")) GTEST_SKIP() << "no meshio";
  const TemporaryFolder folder;
  for (const char* name : {"a.inp", "a.msh", "a.med"}) write_mesh(testing::awkward_tets_with_sets(), folder / name);
  EXPECT_TRUE(python_succeeds(folder, R"(
import meshio
inp = meshio.read('a.inp')
assert list(inp.point_sets['NODES-ONLY']) == [0, 3, 7]
assert sum(len(part) for part in inp.cell_sets['TETS']) == 1
assert sum(len(part) for part in inp.cell_sets['ALL_3']) == 2
msh = meshio.read('a.msh')
sizes = {name: sum(len(part) for part in parts) for name, parts in msh.cell_sets.items()}
assert sizes['boundary'] == 6 and sizes['ALL_3'] == 3 and sizes['FACES'] == 2, sizes
assert sizes['ALL_3_tets'] == 2 and sizes['TETS_tets'] == 1 and sizes['region_7'] == 1, sizes
med = meshio.read('a.med')
def members(tags, names, group):
    return sum(int(tag) in names and group in names[int(tag)] for tag in tags)
assert members(med.point_data['point_tags'], med.point_tags, 'NODES-ONLY') == 3
for group, kind, count in (('boundary', 'triangle6', 6), ('ALL_3', 'triangle6', 3), ('FACES', 'triangle6', 2),
                           ('ALL_3_tets', 'tetra10', 2), ('TETS_tets', 'tetra10', 1), ('region_7', 'tetra10', 1)):
    block = [cells.type for cells in med.cells].index(kind)
    assert members(med.cell_data['cell_tags'][block], med.cell_tags, group) == count, group
)"));
}

/// A cube of 2 x 2 x 2 cells with its top named, of second order.
TetMesh named_cube(int order) {
  TetMesh mesh = test::cube_mesh(2);
  if (order == 2) make_second_order(mesh, nullptr);
  mesh.sets = select_sets(mesh, {{"top", PlaneRule{{0, 0, 2}, {0, 0, 1}, 0.1}}, {"all", AllRule{}}});
  return mesh;
}

TEST(Gmsh, OpensWhatWeWriteAndFindsNothingWrong) {
  if (!succeeds("gmsh --version")) GTEST_SKIP() << "no gmsh";
  for (int order : {1, 2}) {
    for (const char* name : {"a.msh", "a.msh2", "a.unv", "a.bdf"}) {
      const TemporaryFolder folder;
      const TetMesh written = named_cube(order);
      write_mesh(written, folder / name);
      const std::string there =
          "cd '" + folder.path().string() + "' && gmsh " + name + " -setnumber General.Terminal 1 ";
      EXPECT_TRUE(succeeds(there + "-check > log 2>&1; ! grep -E 'Warning|Error' log")) << file_bytes(folder / "log");
      EXPECT_TRUE(succeeds(there + "-save -o back.msh -format msh41")) << name;
      const auto back = std::get<TetMesh>(read_mesh(folder / "back.msh").mesh);
      EXPECT_EQ(back.points.size(), written.points.size()) << name;
      EXPECT_EQ(back.tets.size(), written.tets.size()) << name;
      EXPECT_EQ(back.mid_nodes.size(), written.mid_nodes.size()) << name;
      EXPECT_TRUE(check_mesh(back).all_hold()) << name << to_text(check_mesh(back));
    }
  }
}

TEST(Gmsh, GroupsCarryTheirNames) {
  if (!succeeds("gmsh --version")) GTEST_SKIP() << "no gmsh";
  const TemporaryFolder folder;
  write_mesh(named_cube(2), folder / "a.msh");
  ASSERT_TRUE(succeeds("cd '" + folder.path().string() + "' && gmsh a.msh -save -o b.msh -format msh41"));
  const auto back = std::get<TetMesh>(read_mesh(folder / "b.msh").mesh);
  ASSERT_EQ(back.sets.size(), 2u);
  for (const MeshSet& set : back.sets) {
    EXPECT_EQ(set.faces.size(), set.name == "top" ? 8u : 48u);
    EXPECT_EQ(set.tets.size(), set.name == "top" ? 0u : 48u);
  }
}

TEST(Med, ItsOwnLibraryFindsTheFileGood) {
  if (!succeeds("which medconforme mdump4")) GTEST_SKIP() << "no libmed-tools";
  const TemporaryFolder folder;
  write_mesh(named_cube(2), folder / "a.med");
  const std::string there = "cd '" + folder.path().string() + "' && ";
  EXPECT_TRUE(succeeds(there + "medconforme a.med"));
  EXPECT_TRUE(succeeds(there + "mdump4 a.med NODALE FULL_INTERLACE 1 > dump"));
  const std::string dump = file_bytes(folder / "dump");
  for (const char* word : {"MED_TETRA10", "MED_TRIA6", "top", "all_tets", "boundary", "region_1", "SPACE="}) {
    EXPECT_NE(dump.find(word), std::string::npos) << word;
  }
}

// -laplace T = 6 with T = 0 on the tagged boundary of a unit cube is what a series says: T at the centre is 0.337...
TEST(Dolfinx, SolvesPoissonsProblemOnOurXdmf) {
  if (!succeeds("/usr/bin/python3 -c 'import dolfinx'")) GTEST_SKIP() << "no dolfinx";
  for (int order : {1, 2}) {
    const TemporaryFolder folder;
    TetMesh mesh = test::cube_mesh(8, 0.125);
    if (order == 2) make_second_order(mesh, nullptr);
    mesh.sets = select_sets(mesh, {{"skin", AllRule{}}});
    write_mesh(mesh, folder / "p.xdmf");
    EXPECT_TRUE(python_succeeds(folder, R"(
import numpy, ufl
from mpi4py import MPI
from petsc4py.PETSc import ScalarType
from dolfinx import fem, io
with io.XDMFFile(MPI.COMM_WORLD, 'p.xdmf', 'r') as file:
    mesh = file.read_mesh(name='mesh')
    regions = file.read_meshtags(mesh, name='mesh')
mesh.topology.create_connectivity(2, 3)
with io.XDMFFile(MPI.COMM_WORLD, 'p_facets.xdmf', 'r') as file:
    skin = file.read_meshtags(mesh, name='skin')
assert len(skin.indices) == 6 * 8 * 8 * 2 and len(regions.indices) == 6 * 8 ** 3
order = mesh.geometry.cmap.degree
space = fem.FunctionSpace(mesh, ('CG', order))
fixed = fem.dirichletbc(ScalarType(0), fem.locate_dofs_topological(space, 2, skin.indices), space)
u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
problem = fem.petsc.LinearProblem(ufl.dot(ufl.grad(u), ufl.grad(v)) * ufl.dx,
                                  fem.Constant(mesh, ScalarType(6)) * v * ufl.dx, bcs=[fixed],
                                  petsc_options={'ksp_type': 'cg', 'pc_type': 'jacobi', 'ksp_rtol': 1e-10})
solution = problem.solve()
centre = 6 * sum(64 / numpy.pi ** 5 * numpy.sin(i * numpy.pi / 2) * numpy.sin(j * numpy.pi / 2) * numpy.sin(k * numpy.pi / 2)
                 / (i * j * k * (i * i + j * j + k * k)) for i in range(1, 100, 2) for j in range(1, 100, 2)
                 for k in range(1, 100, 2))
error = abs(max(solution.x.array) - centre) / centre
assert error < (0.03 if order == 1 else 0.001), error
)")) << order;
  }
}

}  // namespace
}  // namespace delvox
