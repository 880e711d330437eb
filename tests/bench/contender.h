#pragma once

#include <string>
#include <vector>

#include "bench_image.h"
#include "delvox/core/mesh.h"
#include "delvox/meshing/deltetsurf.h"

namespace delvox::bench {

/// The criteria that all contenders meet: mm and degrees.
struct BenchCriteria {
  double size = 1;       ///< bound on surface Delaunay ball radii
  double cell_size = 1;  ///< bound on circumradii of tets
  double angle_degrees = 30;
  double radius_edge = 2;
  bool optimise = false;  ///< against slivers: remove_slivers() at 15 degrees; CGAL's perturber and exuder
};

/// Choices that CGAL leaves to its user; the defaults are CGAL's own.
struct Mesh3Choices {
  bool parallel_tag = false;
  bool manifold = false;         ///< parameters::manifold() instead of FACET_VERTICES_ON_SURFACE alone
  bool function_domain = false;  ///< an implicit labelling function of ours instead of the gray Image_3
  bool component_seeds = false;  ///< initialize_triangulation_from_gray_image: seeds for every component of voxels
  double error_bound = 1e-3;     ///< relative to the bounding box
};

/// A mesh in memory and what it took to make it.
struct BenchRun {
  TetMesh mesh;               ///< points and tets only; points in mm, the first voxel at the origin
  std::size_t all_cells = 0;  ///< bulk insertion only: finite cells of the triangulation
  double seconds = 0;
  double cpu_seconds = 0;
  double peak_bytes = 0;  ///< above what the process held before meshing (input image included)
  std::string note;       ///< what the contender has to say of the run; empty: nothing
};

/// What the program would run with: its defaults beside the criteria.
DelTetSurfOptions program_options(const Volume& volume, const BenchCriteria& criteria);

/// Read volume once -> isosurface oracle -> deltetsurf -> extracted mesh -> remove_slivers if asked for.
BenchRun run_delvox(const Volume& volume, const Isosurface& surface, const BenchCriteria& criteria);

/// Image in memory -> domain -> make_mesh_3 without Lloyd and ODT, without perturber and exuder unless asked for.
/// Extraction is not timed.
BenchRun run_mesh3(BenchImage image, const BenchCriteria& criteria, const Mesh3Choices& choices);

/// CGAL's Delaunay_triangulation_3 of the points, inserted as a range (spatially sorted): what nobody who inserts every
/// vertex by Bowyer-Watson can beat on this machine without a faster kernel. Fills no mesh.
BenchRun run_bulk_insertion(const std::vector<Point3>& points);

/// The same by our kernel, in its own spatial order, without labels: the limit on the time of a refinement that inserts
/// these vertices. `all_cells` as above, cells at the corners of the triangulation left out.
BenchRun run_kernel_insertion(const std::vector<Point3>& points);

/// Wall clock, CPU time and peak memory from construction to stop(). Inputs must be built before it.
class Meter {
 public:
  Meter();
  void stop(BenchRun& run) const;
  double peak_bytes() const;

 private:
  double resident_, wall_, cpu_;
};

}  // namespace delvox::bench
