// A user of the installed library: a ball of voxels to a tetrahedral mesh in a file.
#include <delvox/mesh_io/write_mesh.h>
#include <delvox/meshing/deltetsurf.h>
#include <delvox/oracle/isosurface_oracle.h>
#include <delvox/volume/phantom.h>

int main() {
  const delvox::Volume volume = delvox::make_phantom("sphere");
  const double isovalue = delvox::phantom_truth("sphere", delvox::phantom_defaults("sphere")).isovalue;
  const auto oracle = delvox::make_isosurface_oracle(volume, {isovalue, false});
  delvox::RunReport report;
  const delvox::TetMesh mesh = delvox::deltetsurf(*oracle, {{4.0}, {2.0, 4.0}, {}}, report);
  delvox::write_mesh(mesh, "sphere.vtu");
  return report.succeeded() && mesh.tets.size() > 100 ? 0 : 1;
}
