#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "delvox/volume/volume.h"

namespace delvox {

/// Counts of samples in bins of equal width over [low, high]; a sample equal to `high` is in the last bin.
struct Histogram {
  double low = 0;
  double high = 0;
  std::vector<std::size_t> counts;

  double bin_width() const { return (high - low) / static_cast<double>(counts.size()); }
};

/// Histogram over the range of the samples (all in the first bin if there is one value only).
/// pre: samples finite. Throws OptionError: bins below 1, no samples.
Histogram make_histogram(std::span<const float> samples, int bins);

/// Percentiles, each 0 to 100, with linear interpolation between the two nearest samples (numpy's default): exact, as
/// if the samples had been sorted. pre: samples finite. Throws OptionError: a percentile outside 0 to 100, no samples.
std::vector<double> percentiles(std::span<const float> samples, std::span<const double> percents);

/// Otsu's thresholds (IEEE SMC 9, 1979), which part the samples into `classes` classes of least variance within:
/// (classes - 1) values in ascending order, as isovalues. Exact optimum over bins: one bin per integer if all samples
/// are integers that span at most 65536, else 65536 bins of equal width. A threshold lies midway between the
/// neighbouring occupied bins of two classes, so integer and label volumes have no sample on it. Empty if there are
/// fewer distinct values than classes. pre: samples finite. Throws OptionError: classes below 2, no samples.
std::vector<double> otsu_isovalues(std::span<const float> samples, int classes);

/// An isovalue and how it came about.
struct IsovalueChoice {
  double value = 0;
  std::string sentence;  ///< "isovalue 127.5: Otsu's threshold", for the run to print
};

/// Resolves what `--iso` takes: a number; "otsu"; "otsu3:2" (second of the two thresholds between three classes; 2 to 5
/// classes); "p97.5" (percentile); "at:x,y,z" (value at a world point in the volume's frame, mm, trilinear; the image
/// ends half a voxel outside the last voxel centers).
/// Throws OptionError: the spec does not parse, or the point lies outside the image; NothingToMesh: the value is
/// outside the range of the samples, or there are too few distinct values for Otsu.
IsovalueChoice choose_isovalue(const Volume& volume, std::string_view spec);

}  // namespace delvox
