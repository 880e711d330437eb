#include "delvox/volume/voxel_topology.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>

#include "core/parallel.h"
#include "delvox/volume/volume_source.h"
#include "volume/block_sides.h"
#include "volume/grid_editor.h"
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
      }
    } else if (too_small || filter.fill_cavities) {
      changed[r] = true;
      ++report.filled_cavities;
      report.filled_mm3 += region.volume_mm3;
    }
  }
  return changed;
}

/// Copies the stretches of a row of blocks to their places in a slab.
void copy_stretches(const Volume& volume, const Stretches& stretches, int block_j, int begin_k, int slices,
                    float* slab) {
  const std::array<int, 3>& dims = volume.dims();
  const int begin_j = block_j * BlockSides::kBlock, rows = std::min(BlockSides::kBlock, dims[1] - begin_j);
  std::vector<float> samples;
  for (const Stretch& s : stretches) {
    const int length = s.end - s.begin;
    samples.resize(static_cast<std::size_t>(length) * rows * slices);
    volume.copy_block({s.begin, begin_j, begin_k}, {length, rows, slices}, samples.data());
    for (int n = 0; n < rows * slices; ++n) {
      const std::size_t row = static_cast<std::size_t>(n / rows) * dims[1] + begin_j + n % rows;
      std::copy_n(samples.data() + static_cast<std::size_t>(n) * length, length, slab + row * dims[0] + s.begin);
    }
  }
}

/// Reads those blocks only that the surface passes, and their neighbours.
RegionMap map_regions(const Volume& volume, const LevelSet& level_set) {
  const std::array<int, 3>& dims = volume.dims();
  const BlockSides sides = block_sides(volume, level_set);
  RegionMap map(volume.header(), level_set);
  const auto slab = std::make_unique_for_overwrite<float[]>(static_cast<std::size_t>(dims[0]) * dims[1] *
                                                            std::min(BlockSides::kBlock, dims[2]));
  for (int k = 0; k < dims[2]; k += BlockSides::kBlock) {
    const int slices = std::min(BlockSides::kBlock, dims[2] - k);
    const auto near = map_chunks(sides.counts[1], 1, [&](std::size_t row, std::size_t) {
      const int j = static_cast<int>(row);
      Stretches stretches = stretches_near_surface(sides, j, k / BlockSides::kBlock, dims);
      copy_stretches(volume, stretches, j, k, slices, slab.get());
      return stretches;
    });
    map.add(slab.get(), slices, near);
  }
  map.finish();
  return map;
}

}  // namespace

VoxelTopology count_topology(const Volume& volume, const Isosurface& surface) {
  return list_regions(volume, surface).topology;
}

std::vector<VoxelTopology> count_topologies(const VolumeSource& source, const std::vector<Isosurface>& surfaces) {
  std::vector<RegionMap> maps;
  for (const Isosurface& surface : surfaces) maps.emplace_back(source.header(), LevelSet(surface));
  for_each_slab(source, [&](const float* samples, int, int slices) {
    tbb::parallel_for(std::size_t{0}, maps.size(), [&](std::size_t n) { maps[n].add(samples, slices); });
  });
  std::vector<VoxelTopology> result;
  for (RegionMap& map : maps) {
    map.finish();
    result.push_back(map.result().topology);
  }
  return result;
}

VoxelRegions list_regions(const Volume& volume, const Isosurface& surface) {
  return map_regions(volume, LevelSet(surface)).result();
}

FilteredVolume filter_components(const Volume& volume, const Isosurface& surface, const ComponentFilter& filter) {
  const LevelSet level_set(surface);
  const RegionMap map = map_regions(volume, level_set);
  FilterReport report;
  const std::vector<VoxelRegion>& regions = map.result().regions;
  const std::vector<bool> changed = regions_to_change(regions, filter, report);
  const std::vector<bool> inside = signs_after(regions, changed);
  for (std::size_t r = 1; r < regions.size(); ++r) {  // what lies in a filled cavity is part of what surrounds it
    report.kept_components += regions[r].inside && !changed[r] && !inside[regions[r].parent];
  }
  if (report.removed_components + report.filled_cavities == 0) return {volume, report};

  const float just_inside = level_set.nearest(true), just_outside = level_set.nearest(false);
  GridEditor editor(volume);
  map.for_each_run([&](const RegionMap::Run& run) {
    // Runs of changed regions lie in the image: the padding belongs to the outermost region, which never changes.
    if (inside[run.region] == run.inside) return;
    editor.set_run(run.begin, run.length, run.inside ? just_outside : just_inside);
  });
  return {editor.finish(), report};
}

}  // namespace delvox
