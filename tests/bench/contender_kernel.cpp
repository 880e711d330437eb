#include <algorithm>

#include "contender.h"
#include "delaunay/delaunay3.h"
#include "delaunay/spatial_order.h"

namespace delvox::bench {

BenchRun run_kernel_insertion(const std::vector<Point3>& points) {
  Box3 bounds;
  for (const Point3& p : points) bounds.extend(p);

  BenchRun run;
  const Meter meter;
  Delaunay3 delaunay(bounds);
  Star star;
  std::vector<CellId> created{delaunay.cell_of(0)};
  for (const std::uint32_t i : spatial_order(points)) {
    delaunay.evaluate(points[i], delaunay.nearest_hint(points[i], created), star);
    if (!star.duplicate) delaunay.commit(star, created);
  }
  meter.stop(run);
  for (CellId cell = Delaunay3::kOutside + 1; cell < delaunay.cell_capacity(); ++cell) {
    const auto& v = delaunay.vertices(cell);
    run.all_cells += delaunay.stamp(cell) != 0 && *std::min_element(v.begin(), v.end()) >= Delaunay3::kCorners;
  }
  return run;
}

}  // namespace delvox::bench
