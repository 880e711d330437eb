#include "delvox/volume/voxel_topology.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "volume/region_map.h"

namespace delvox {
namespace {

// What each region becomes: as it is, or as what surrounds it. Parents are settled before their children because the
// walk upward ends at a region that stays.
std::vector<bool> signs_after(const std::vector<VoxelRegion>& regions, const std::vector<bool>& changed) {
  std::vector<bool> inside(regions.size());
  for (std::size_t r = 0; r < regions.size(); ++r) {
    std::size_t at = r;
    while (changed[at]) at = regions[at].parent;
    inside[r] = regions[at].inside;
  }
  return inside;
}

std::vector<bool> regions_to_change(const std::vector<VoxelRegion>& regions, const ComponentFilter& filter,
                                    FilterReport& report) {
  std::vector<bool> changed(regions.size(), false);
  for (std::size_t r = 1; r < regions.size(); ++r) {
    const VoxelRegion& region = regions[r];
    const bool too_small = region.volume_mm3 < filter.min_component_mm3;
    if (region.inside) {
      changed[r] = too_small || (filter.largest_only && r != 1);  // inside components come first, largest first
      if (changed[r]) {
        ++report.removed_components;
        report.removed_mm3 += region.volume_mm3;
      } else {
        ++report.kept_components;
      }
    } else if (too_small || filter.fill_cavities) {
      changed[r] = true;
      ++report.filled_cavities;
      report.filled_mm3 += region.volume_mm3;
    }
  }
  return changed;
}

}  // namespace

VoxelTopology count_topology(const Volume& volume, const Isosurface& surface) {
  return list_regions(volume, surface).topology;
}

VoxelRegions list_regions(const Volume& volume, const Isosurface& surface) {
  return RegionMap(volume, LevelSet(surface)).result();
}

FilteredVolume filter_components(const Volume& volume, const Isosurface& surface, const ComponentFilter& filter) {
  const LevelSet level_set(surface);
  const RegionMap map(volume, level_set);
  FilterReport report;
  const std::vector<VoxelRegion>& regions = map.result().regions;
  const std::vector<bool> changed = regions_to_change(regions, filter, report);
  if (report.removed_components + report.filled_cavities == 0) return {volume, report};

  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  float just_inside = static_cast<float>(level_set.level);
  if (!level_set.inside(just_inside)) just_inside = std::nextafter(just_inside, kInfinity);
  const float just_outside = std::nextafter(just_inside, -kInfinity);
  const std::vector<bool> inside = signs_after(regions, changed);
  std::vector<float> samples = volume.samples();
  const std::array<int, 3>& dims = volume.dims();
  map.for_each_run([&](const RegionMap::Run& run) {
    // Runs of changed regions lie in the image: the padding belongs to the outermost region, which never changes.
    if (inside[run.region] == run.inside) return;
    const std::size_t begin =
        (static_cast<std::size_t>(run.begin[2]) * dims[1] + run.begin[1]) * dims[0] + run.begin[0];
    const float value = level_set.sign * (run.inside ? just_outside : just_inside);
    std::fill_n(samples.begin() + static_cast<std::ptrdiff_t>(begin), run.length, value);
  });
  return {Volume(volume.header(), samples), report};
}

}  // namespace delvox
