#include "meshing/deep_lattice.h"

#include <algorithm>
#include <limits>

namespace delvox {

std::vector<Point3> DeepLattice::take_near(const Point3& place, double reach) {
  double radius = std::numeric_limits<double>::infinity();
  for (const Point3& p : points) radius = std::min(radius, distance(p, place));
  radius += reach;
  const auto is_taken = [&](const Point3& p) { return distance(p, place) <= radius; };
  const auto old_shell = static_cast<std::uint32_t>(shell.size());
  const auto taken_count = static_cast<std::uint32_t>(std::count_if(points.begin(), points.end(), is_taken));

  std::vector<Point3> taken;
  std::vector<std::uint32_t> number(points.size());  // as corners, from now on
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_taken(points[i])) {
      number[i] = old_shell + static_cast<std::uint32_t>(taken.size());
      taken.push_back(points[i]);
    } else {
      number[i] = old_shell + taken_count + kept;
      points[kept] = points[i];
      labels[kept++] = labels[i];
    }
  }
  points.resize(kept);
  labels.resize(kept);
  shell.resize(shell.size() + taken.size(), kNone);

  for (auto& tet : tets) {
    for (std::uint32_t& corner : tet) {
      if (corner >= old_shell) corner = number[corner - old_shell];
    }
  }
  std::erase_if(tets, [&](const auto& tet) {
    return std::all_of(tet.begin(), tet.end(), [&](std::uint32_t corner) { return corner < shell.size(); });
  });
  return taken;
}

}  // namespace delvox
