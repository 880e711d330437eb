#include "volume/region_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "volume/cell_topology.h"

namespace delvox {

// One slice of the padded grid, i fastest.
struct RegionMap::Slice {
  const float* samples = nullptr;
  std::vector<std::uint8_t> inside;
  std::vector<std::uint32_t> run;
};

RegionMap::RegionMap(const Volume& volume, const LevelSet& level_set)
    : level_(level_set.level), nx_(volume.dims()[0] + 2), ny_(volume.dims()[1] + 2), nz_(volume.dims()[2] + 2) {
  constexpr std::size_t kBatchSamples = std::size_t{1} << 22;
  const std::size_t area = static_cast<std::size_t>(nx_) * ny_;
  const int depth = static_cast<int>(std::clamp<std::size_t>(kBatchSamples / area, 2, 64));
  std::vector<float> batch(area * (depth + 1));
  Slice lower, upper;
  for (Slice* slice : {&lower, &upper}) {
    slice->inside.resize(area);
    slice->run.resize(area);
  }
  row_begin_.reserve(static_cast<std::size_t>(ny_) * nz_ + 1);
  row_begin_.push_back(0);
  // Batches overlap by the last slice of the one before, moved to the front.
  for (int k = 0; k < nz_;) {
    const int count = std::min(depth, nz_ - k);
    copy_padded_block(volume, level_set, {-1, -1, k - 1}, {nx_, ny_, count}, batch.data() + area);
    lower.samples = batch.data();
    for (int s = 1; s <= count; ++s, ++k) {
      add_slice(batch.data() + s * area, k, upper);
      if (k > 0) add_cells(lower, upper);
      std::swap(lower, upper);
    }
    std::copy_n(batch.data() + count * area, area, batch.data());
  }
  const VolumeHeader& header = volume.header();
  number_regions(std::abs(header.index_to_world.determinant()));
  find_parents();
}

void RegionMap::add_slice(const float* samples, int k, Slice& slice) {
  slice.samples = samples;
  const std::size_t area = static_cast<std::size_t>(nx_) * ny_;
  for (std::size_t i = 0; i < area; ++i) slice.inside[i] = samples[i] > level_;
  for (int j = 0; j < ny_; ++j) {
    const std::size_t row_offset = static_cast<std::size_t>(j) * nx_;
    std::uint8_t sign = 1;  // the first sample lies in the padding, outside: it begins a run
    for (int i = 0; i < nx_; ++i) {
      if (slice.inside[row_offset + i] != sign) {
        sign = slice.inside[row_offset + i];
        joined_.push_back(static_cast<std::uint32_t>(joined_.size()));
        run_start_.push_back(i);
      }
      slice.run[row_offset + i] = static_cast<std::uint32_t>(joined_.size() - 1);
    }
    row_begin_.push_back(joined_.size());
    const std::size_t row = static_cast<std::size_t>(k) * ny_ + j;
    if (j > 0) join_rows(row - 1, row);
    if (k > 0) join_rows(row - ny_, row);
  }
  correction_.resize(joined_.size(), 0.0);
}

void RegionMap::join_rows(std::size_t row_a, std::size_t row_b) {
  std::size_t a = row_begin_[row_a], b = row_begin_[row_b];
  const std::size_t a_end = row_begin_[row_a + 1], b_end = row_begin_[row_b + 1];
  while (true) {
    if ((a - row_begin_[row_a]) % 2 == (b - row_begin_[row_b]) % 2) {
      join(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
    }
    const int next_a = a + 1 < a_end ? run_start_[a + 1] : nx_, next_b = b + 1 < b_end ? run_start_[b + 1] : nx_;
    if (next_a == nx_ && next_b == nx_) return;
    if (next_a <= next_b) ++a;
    if (next_b <= next_a) ++b;
  }
}

void RegionMap::add_cells(const Slice& lower, const Slice& upper) {
  std::vector<std::uint8_t> column(nx_);  // per i, the signs of the four samples across, at the bits of x = 0
  for (int j = 0; j + 1 < ny_; ++j) {
    const std::size_t row = static_cast<std::size_t>(j) * nx_;
    const std::uint8_t *a = &lower.inside[row], *b = a + nx_, *c = &upper.inside[row], *d = c + nx_;
    for (int i = 0; i < nx_; ++i) {
      column[i] = static_cast<std::uint8_t>(a[i] | b[i] << 2 | c[i] << 4 | d[i] << 6);
    }
    for (int i = 0; i + 1 < nx_; ++i) {
      const unsigned mask = column[i] | static_cast<unsigned>(column[i + 1]) << 1;
      if (mask != 0 && mask != 255) add_mixed_cell(lower, upper, row + i, mask);
    }
  }
}

void RegionMap::add_mixed_cell(const Slice& lower, const Slice& upper, std::size_t at, unsigned mask) {
  std::array<float, 8> values;
  std::array<std::uint32_t, 8> runs;
  for (int corner = 0; corner < 8; ++corner) {
    const Slice& slice = corner & 4 ? upper : lower;
    const std::size_t place = at + (corner & 1) + (corner & 2 ? nx_ : 0);
    values[corner] = slice.samples[place];
    runs[corner] = slice.run[place];
  }
  if (is_ambiguous(mask)) {
    const CellTopology cell = cell_topology(values, level_);
    weight_ += cell.weight(mask);
    for (int corner = 0; corner < 8; ++corner) {
      if (cell.group[corner] != corner) join(runs[corner], runs[cell.group[corner]]);
    }
  } else {
    weight_ += weight_of_simple_cell(mask);
  }
  // Each sample owns an eighth of the cells around it; what the cell holds beyond that is shared by its samples.
  const int inside = std::popcount(mask);
  const double surplus = inside_fraction(values, level_) - inside / 8.0;
  for (int corner = 0; corner < 8; ++corner) {
    correction_[runs[corner]] += mask >> corner & 1 ? surplus / inside : -surplus / (8 - inside);
  }
}

std::uint32_t RegionMap::root(std::uint32_t run) {
  while (joined_[run] != run) run = joined_[run] = joined_[joined_[run]];
  return run;
}

void RegionMap::join(std::uint32_t a, std::uint32_t b) {
  a = root(a);
  b = root(b);
  if (a < b) joined_[b] = a;
  else joined_[a] = b;
}

void RegionMap::number_regions(double voxel_volume) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  // Roots are the smallest runs of their regions, so they are numbered before anything that points to them.
  std::vector<std::uint32_t> number(joined_.size(), kNone);
  std::uint32_t count = 0;
  for (std::uint32_t run = 0; run < joined_.size(); ++run) {
    const std::uint32_t r = root(run);
    if (number[r] == kNone) number[r] = count++;
  }
  for (std::uint32_t run = 0; run < joined_.size(); ++run) joined_[run] = root(run);
  for (std::uint32_t& run : joined_) run = number[run];

  std::vector<VoxelRegion> regions(count);
  constexpr int kFar = std::numeric_limits<int>::max();
  for (VoxelRegion& region : regions) region.low = {kFar, kFar, kFar}, region.high = {-1, -1, -1};
  std::size_t index = 0;
  for_each_run([&](const Run& run) {
    VoxelRegion& region = regions[run.region];
    region.inside = run.inside;
    region.volume_mm3 += (run.length + correction_[index++]) * voxel_volume;
    const std::array<int, 3> low{std::max(run.begin[0], 0), run.begin[1], run.begin[2]};
    const std::array<int, 3> high{std::min(run.begin[0] + run.length, nx_ - 2) - 1, run.begin[1], run.begin[2]};
    const bool in_image = low[0] <= high[0] && low[1] >= 0 && low[1] < ny_ - 2 && low[2] >= 0 && low[2] < nz_ - 2;
    if (!in_image) return;
    region.samples += high[0] - low[0] + 1;
    for (int axis = 0; axis < 3; ++axis) {
      region.low[axis] = std::min(region.low[axis], low[axis]);
      region.high[axis] = std::max(region.high[axis], high[axis]);
    }
  });
  std::vector<std::uint32_t> order(count), rank(count);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin() + 1, order.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (regions[a].inside != regions[b].inside) return regions[a].inside;
    return regions[a].volume_mm3 > regions[b].volume_mm3;
  });
  for (std::uint32_t i = 0; i < count; ++i) {
    rank[order[i]] = i;
    result_.regions.push_back(regions[order[i]]);
  }
  for (std::uint32_t& run : joined_) run = rank[run];
}

// Every closed surface crosses a grid edge along i, so consecutive runs show all pairs of neighbours; the pairs form
// a tree, rooted in the outermost region.
void RegionMap::find_parents() {
  std::vector<VoxelRegion>& regions = result_.regions;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  std::uint32_t previous = 0;
  for_each_run([&](const Run& run) {
    // A row begins in the padding, which is region 0, and so did end the row before.
    const std::pair<std::uint32_t, std::uint32_t> pair{previous, run.region};
    if (pair.first != pair.second && (pairs.empty() || pairs.back() != pair)) {
      pairs.push_back(pair);
      pairs.push_back({pair.second, pair.first});
    }
    previous = run.region;
  });
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::vector<bool> reached(regions.size(), false);
  std::vector<std::uint32_t> waiting{0};
  reached[0] = true;
  while (!waiting.empty()) {
    const std::uint32_t region = waiting.back();
    waiting.pop_back();
    auto pair = std::lower_bound(pairs.begin(), pairs.end(), std::pair<std::uint32_t, std::uint32_t>{region, 0});
    for (; pair != pairs.end() && pair->first == region; ++pair) {
      if (reached[pair->second]) continue;
      reached[pair->second] = true;
      regions[pair->second].parent = region;
      waiting.push_back(pair->second);
    }
  }
  VoxelTopology& topology = result_.topology;
  for (const VoxelRegion& region : regions) {
    if (region.inside) {
      ++topology.inside_components;
      topology.volume_mm3 += region.volume_mm3;
    } else {
      ++topology.cavities;
    }
  }
  --topology.cavities;  // the outermost region is none
  topology.surface_components = topology.inside_components + topology.cavities;
  topology.euler = -2 * (weight_ / 8);
}

}  // namespace delvox
