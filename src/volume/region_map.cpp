#include "volume/region_map.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "volume/cell_topology.h"

namespace delvox {

RegionMap::RegionMap(const VolumeHeader& header, const LevelSet& level_set)
    : level_set_(level_set),
      voxel_volume_(std::abs(header.index_to_world.determinant())),
      nx_(header.dims[0] + 2),
      ny_(header.dims[1] + 2),
      nz_(header.dims[2] + 2) {
  const std::size_t area = static_cast<std::size_t>(nx_) * ny_;
  lower_.resize(area);
  upper_.resize(area);
  starts_.resize(ny_);
  mixed_.resize(ny_ - 1);
  row_begin_.reserve(static_cast<std::size_t>(ny_) * nz_ + 1);
  row_begin_.push_back(0);
}

void RegionMap::add(const float* samples, int slices) {
  const int block_rows = (ny_ - 3) / BlockSides::kBlock + 1;
  add(samples, slices, std::vector<Stretches>(block_rows, {{0, nx_ - 2}}));
}

void RegionMap::add(const float* samples, int slices, const std::vector<Stretches>& near) {
  const std::size_t area = static_cast<std::size_t>(nx_ - 2) * (ny_ - 2);
  if (slices_ == 0) add_padded_slice(samples, true, near);
  for (int k = 0; k < slices; ++k) add_padded_slice(samples + k * area, false, near);
  const float* last = samples + (slices - 1) * area;
  if (slices_ == nz_ - 1) add_padded_slice(last, true, near);
}

void RegionMap::finish() {
  number_regions();
  find_parents();
}

/// Fills a row of the padded slice in hand where it is near the surface, and finds where its runs start.
void RegionMap::find_runs(const float* slice, bool in_padding, const std::vector<Stretches>& near, int j) {
  const int in_image = std::clamp(j - 1, 0, ny_ - 3), n = nx_ - 2;
  const float* from = slice + static_cast<std::size_t>(in_image) * n;
  float* row = upper_.data() + static_cast<std::size_t>(j) * nx_;
  std::vector<int>& starts = starts_[j];
  starts.assign(1, 0);
  bool sign = false;  // the first sample lies in the padding, outside
  for (const Stretch& s : near[in_image / BlockSides::kBlock]) {
    // Pads at either end of the stretch, which is right at the image's edge and elsewhere falls on what nobody reads.
    pad_row(level_set_, from + s.begin, s.end - s.begin, in_padding || in_image != j - 1, row + s.begin);
    for (int i = s.begin + 1; i < (s.end == n ? nx_ : s.end + 1); ++i) {
      if (level_set_.inside(row[i]) == sign) continue;
      sign = !sign;
      starts.push_back(i);
    }
  }
}

void RegionMap::add_padded_slice(const float* slice, bool in_padding, const std::vector<Stretches>& near) {
  tbb::parallel_for(0, ny_, [&](int j) { find_runs(slice, in_padding, near, j); });
  for (int j = 0; j < ny_; ++j) {
    for (int start : starts_[j]) {
      joined_.push_back(static_cast<std::uint32_t>(joined_.size()));
      run_start_.push_back(start);
    }
    row_begin_.push_back(joined_.size());
    const std::size_t row = static_cast<std::size_t>(slices_) * ny_ + j;
    if (j > 0) join_rows(row - 1, row);
    if (slices_ > 0) join_rows(row - ny_, row);
  }
  correction_.resize(joined_.size(), 0.0);
  if (slices_ > 0) {
    tbb::parallel_for(0, ny_ - 1, [&](int j) { find_mixed_cells(j, mixed_[j]); });
    for (const std::vector<MixedCell>& cells : mixed_) {
      for (const MixedCell& cell : cells) add(cell);
    }
  }
  lower_.swap(upper_);
  ++slices_;
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

// Between two starts of runs the signs stay the same along a row of cells: where the four rows agree, all of them can be
// passed over at once.
void RegionMap::find_mixed_cells(int j, std::vector<MixedCell>& cells) const {
  cells.clear();
  const std::size_t row = static_cast<std::size_t>(slices_) * ny_ + j;
  const std::array<std::size_t, 4> rows{row - ny_, row - ny_ + 1, row, row + 1};
  Runs run;
  for (int r = 0; r < 4; ++r) run[r] = static_cast<std::uint32_t>(row_begin_[rows[r]]);
  const auto end_of = [&](int r) { return run[r] + 1 < row_begin_[rows[r] + 1] ? run_start_[run[r] + 1] : nx_; };
  constexpr unsigned kAllInside = 0b01010101;  // the signs of the four samples across, at the bits of x = 0
  unsigned column = 0;
  for (int i = 0; i + 1 < nx_; ++i) {
    const int next_start = std::min({end_of(0), end_of(1), end_of(2), end_of(3)});
    if (column == 0 || column == kAllInside) i = next_start - 1;
    if (i + 1 >= nx_) return;
    Runs next = run;
    unsigned next_column = column;
    for (int r = 0; r < 4; ++r) {
      if (end_of(r) != i + 1) continue;
      ++next[r];
      next_column ^= 1u << 2 * r;
    }
    cells.push_back(mixed_cell(i, j, run, next, column | next_column << 1));
    run = next;
    column = next_column;
  }
}

RegionMap::MixedCell RegionMap::mixed_cell(int i, int j, const Runs& low_i, const Runs& high_i, unsigned mask) const {
  MixedCell cell;
  cell.mask = static_cast<std::uint8_t>(mask);
  std::array<float, 8> values;
  for (int corner = 0; corner < 8; ++corner) {
    const std::vector<float>& slice = corner & 4 ? upper_ : lower_;
    values[corner] = slice[static_cast<std::size_t>(j + (corner >> 1 & 1)) * nx_ + i + (corner & 1)];
    cell.runs[corner] = (corner & 1 ? high_i : low_i)[corner >> 1];
    cell.group[corner] = static_cast<std::uint8_t>(corner);
  }
  if (is_ambiguous(mask)) {
    const CellTopology topology = cell_topology(values, level_set_.level);
    cell.weight = topology.weight(mask);
    cell.group = topology.group;
  } else {
    cell.weight = weight_of_simple_cell(mask);
  }
  // Each sample owns an eighth of the cells around it; what the cell holds beyond that is shared by its samples.
  cell.surplus = inside_fraction(values, level_set_.level) - std::popcount(mask) / 8.0;
  return cell;
}

void RegionMap::add(const MixedCell& cell) {
  weight_ += cell.weight;
  const int inside = std::popcount(cell.mask);
  for (int corner = 0; corner < 8; ++corner) {
    if (cell.group[corner] != corner) join(cell.runs[corner], cell.runs[cell.group[corner]]);
    correction_[cell.runs[corner]] +=
        cell.mask >> corner & 1 ? cell.surplus / inside : -cell.surplus / (8 - inside);
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

void RegionMap::number_regions() {
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
    region.volume_mm3 += (run.length + correction_[index++]) * voxel_volume_;
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
