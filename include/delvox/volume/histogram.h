#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "delvox/volume/volume_source.h"

namespace delvox {

/// Counts of samples in bins of equal width over [low, high]; a sample equal to `high` is in the last bin.
struct Histogram {
  double low = 0;
  double high = 0;
  std::vector<std::size_t> counts;

  double bin_width() const { return (high - low) / static_cast<double>(counts.size()); }
};

/// What isovalues are chosen from. Takes one pass over the samples, and keeps counts of every value if all are integers
/// from -32768 to 65535 (bytes, 16 bits); of others each question takes another pass or two.
/// Exact, and the same for any number of threads. pre: samples finite.
class SampleStatistics {
 public:
  /// The samples must outlive this. Throw OptionError if there are none.
  explicit SampleStatistics(std::span<const float> samples);
  explicit SampleStatistics(const VolumeSource& source);

  float min() const { return low_; }
  float max() const { return high_; }
  /// What the source found odd in the samples.
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// Histogram over the range of the samples (all in the first bin if there is one value only).
  /// Throws OptionError: bins below 1.
  Histogram histogram(int bins) const;

  /// Percentiles, each 0 to 100, with linear interpolation between the two nearest samples (numpy's default): exact,
  /// as if the samples had been sorted. Throws OptionError: a percentile outside 0 to 100.
  std::vector<double> percentiles(std::span<const double> percents) const;

  /// Otsu's thresholds (IEEE SMC 9, 1979), which part the samples into `classes` classes of least variance within:
  /// (classes - 1) values in ascending order, as isovalues. Exact optimum over bins: one bin per integer if all samples
  /// are integers that span at most 65536, else 65536 bins of equal width. A threshold lies a hair above
  /// midway between the neighbouring occupied bins of two classes, so integer and label volumes have no sample on it, and
  /// those whose bins are neighbouring integers no saddle of a voxel's face. Empty if there are fewer distinct values
  /// than classes. Throws OptionError: classes below 2.
  std::vector<double> otsu_isovalues(int classes) const;

 private:
  struct OccupiedBins;
  class ClassSplitter;
  using Visit = std::function<void(std::span<const float>)>;

  void take_census();
  template <class BinOf>
  std::vector<std::size_t> count(std::size_t bins, const BinOf& bin_of) const;
  std::vector<float> select_ranks(const std::vector<std::size_t>& ranks) const;
  OccupiedBins occupied_bins() const;

  std::function<std::vector<std::string>(const Visit&)> for_each_piece_;  // returns the warnings
  std::size_t size_ = 0;
  float low_ = 0, high_ = 0;
  bool integers_ = true;
  std::vector<std::string> warnings_;
  std::vector<std::size_t> census_;  // per integer its number; empty if there are other samples
};

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
/// The same from a source, in as many passes as SampleStatistics takes; none for a number, whose range check_isovalue
/// checks once a pass has been made.
IsovalueChoice choose_isovalue(const VolumeSource& source, std::string_view spec);
/// Throws NothingToMesh unless the value lies in the range of the volume.
void check_isovalue(const IsovalueChoice& choice, const Volume& volume);

}  // namespace delvox
