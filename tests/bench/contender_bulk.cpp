#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "contender.h"

namespace delvox::bench {

BenchRun run_bulk_insertion(const std::vector<Point3>& points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> input;
  input.reserve(points.size());
  for (const Point3& p : points) input.emplace_back(p.x, p.y, p.z);

  BenchRun run;
  const Meter meter;
  CGAL::Delaunay_triangulation_3<Kernel> triangulation;
  triangulation.insert(input.begin(), input.end());
  meter.stop(run);
  run.all_cells = triangulation.number_of_finite_cells();
  return run;
}

}  // namespace delvox::bench
