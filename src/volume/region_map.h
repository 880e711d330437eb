#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "delvox/volume/voxel_topology.h"
#include "volume/block_sides.h"

namespace delvox {

/// The padded grid as runs of equal sign along i, joined into regions by the trilinear function. Every row begins in
/// the padding, so its runs alternate: outside, inside, outside, ...
class RegionMap {
 public:
  RegionMap(const VolumeHeader& header, const LevelSet& level_set);
  /// Adds the next slices of the image, in order.
  void add(const float* samples, int slices);
  /// The same where the samples of block row n (of BlockSides) are read, and differ in sign from the one before, only
  /// in the stretches near[n].
  void add(const float* samples, int slices, const std::vector<Stretches>& near);
  /// After all slices: numbers the regions. Only then may the members below be called.
  void finish();

  struct Run {
    std::array<int, 3> begin;  ///< voxel indices, -1 in the padding
    int length;
    bool inside;
    std::uint32_t region;      ///< see regions()
  };
  /// Calls visit(Run) for every run, row by row.
  template <class Visit>
  void for_each_run(const Visit& visit) const;

  const VoxelRegions& result() const { return result_; }

 private:
  using Runs = std::array<std::uint32_t, 4>;  // one in each of the four rows around a row of cells
  /// What there is to be said of a cell that the surface crosses.
  struct MixedCell {
    std::array<std::uint32_t, 8> runs;
    std::array<std::uint8_t, 8> group;  // of the corners, as in CellTopology
    std::uint8_t mask;
    int weight;
    double surplus;  // of the volume inside, over what the inside corners own
  };
  void add_padded_slice(const float* slice, bool in_padding, const std::vector<Stretches>& near);
  void find_runs(const float* slice, bool in_padding, const std::vector<Stretches>& near, int j);
  void join_rows(std::size_t row_a, std::size_t row_b);
  void find_mixed_cells(int j, std::vector<MixedCell>& cells) const;
  MixedCell mixed_cell(int i, int j, const Runs& low_i, const Runs& high_i, unsigned mask) const;
  void add(const MixedCell& cell);
  std::uint32_t root(std::uint32_t run);
  void join(std::uint32_t a, std::uint32_t b);
  void number_regions();
  void find_parents();

  LevelSet level_set_;
  double voxel_volume_;
  int nx_, ny_, nz_;  // of the padded grid
  int slices_ = 0;    // of it that were added
  std::vector<float> lower_, upper_;     // the last two slices of the padded grid
  std::vector<std::vector<int>> starts_;       // of the runs in each row of the slice in hand
  std::vector<std::vector<MixedCell>> mixed_;  // in each row of cells below it
  std::vector<std::size_t> row_begin_;   // per row, its first run; one more at the end
  std::vector<std::int32_t> run_start_;
  std::vector<std::uint32_t> joined_;    // union-find, later the region
  std::vector<double> correction_;       // per run: its volume in voxels minus its length
  long weight_ = 0;                      // 8 * Euler characteristic of the inside with compact support
  VoxelRegions result_;
};

template <class Visit>
void RegionMap::for_each_run(const Visit& visit) const {
  for (std::size_t row = 0; row + 1 < row_begin_.size(); ++row) {
    const int j = static_cast<int>(row % ny_) - 1, k = static_cast<int>(row / ny_) - 1;
    for (std::size_t run = row_begin_[row]; run < row_begin_[row + 1]; ++run) {
      const int end = run + 1 < row_begin_[row + 1] ? run_start_[run + 1] : nx_;
      visit(Run{{run_start_[run] - 1, j, k}, end - run_start_[run], (run - row_begin_[row]) % 2 == 1, joined_[run]});
    }
  }
}

}  // namespace delvox
