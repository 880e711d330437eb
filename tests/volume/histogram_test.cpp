#include "delvox/volume/histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "delvox/core/errors.h"
#include "delvox/volume/phantom.h"

namespace delvox {
namespace {

/// Deterministic numbers in [0, 1).
class Numbers {
 public:
  double next() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }
  double normal() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += next();
    return sum;
  }

 private:
  std::uint64_t state_ = 42;
};

/// Samples of several tissues, each a bell around its mean.
std::vector<float> tissues(const std::vector<double>& means, double spread, bool integers, int count = 3000) {
  Numbers numbers;
  std::vector<float> samples;
  for (std::size_t tissue = 0; tissue < means.size(); ++tissue) {
    for (int i = 0; i < count * static_cast<int>(tissue + 1); ++i) {
      const double sample = means[tissue] + spread * numbers.normal();
      samples.push_back(static_cast<float>(integers ? std::round(sample) : sample));
    }
  }
  return samples;
}

/// Variance within classes, times the number of samples, when samples are parted at the thresholds.
double within_variance(const std::vector<float>& samples, const std::vector<double>& thresholds) {
  std::vector<double> sum(thresholds.size() + 1), squares(sum), weight(sum);
  for (double sample : samples) {
    std::size_t c = 0;
    while (c < thresholds.size() && sample >= thresholds[c]) ++c;
    sum[c] += sample;
    squares[c] += sample * sample;
    weight[c] += 1;
  }
  double total = 0;
  for (std::size_t c = 0; c < sum.size(); ++c) total += weight[c] > 0 ? squares[c] - sum[c] * sum[c] / weight[c] : 0;
  return total;
}

/// Midpoints between neighbouring distinct values.
constexpr double kMidway = 0.5027864;  // where thresholds lie between samples

std::vector<double> gaps(std::vector<float> samples) {
  std::sort(samples.begin(), samples.end());
  samples.erase(std::unique(samples.begin(), samples.end()), samples.end());
  std::vector<double> result;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    result.push_back(samples[i - 1] + kMidway * (double{samples[i]} - samples[i - 1]));
  }
  return result;
}

Volume volume_of(std::array<int, 3> dims, const std::vector<float>& samples) {
  VolumeHeader header;
  header.dims = dims;
  return Volume(header, samples);
}

TEST(Histogram, CountsEverySampleInItsBin) {
  const std::vector<float> samples{0, 0.5f, 1, 1.5f, 2, 3.99f, 4};
  const Histogram histogram = SampleStatistics(samples).histogram(4);
  EXPECT_EQ(histogram.low, 0);
  EXPECT_EQ(histogram.high, 4);
  EXPECT_EQ(histogram.bin_width(), 1);
  EXPECT_EQ(histogram.counts, (std::vector<std::size_t>{2, 2, 1, 2}));
  EXPECT_EQ(SampleStatistics(std::vector<float>{7, 7}).histogram(3).counts, (std::vector<std::size_t>{2, 0, 0}));
  EXPECT_THROW(SampleStatistics(samples).histogram(0), OptionError);
  EXPECT_THROW(SampleStatistics(std::vector<float>{}).histogram(4), OptionError);
}

TEST(Histogram, LosesNoSampleAcrossThreads) {
  const Volume volume = make_phantom("gyroid");
  const auto samples = volume.samples();
  const Histogram histogram = SampleStatistics(samples).histogram(17);
  EXPECT_EQ(std::accumulate(histogram.counts.begin(), histogram.counts.end(), std::size_t{0}), samples.size());
}

TEST(Percentiles, EqualSortingAndInterpolating) {
  for (const bool integers : {false, true}) {
    std::vector<float> samples = tissues({-300, 0, 5, 900}, 40, integers);
    samples.push_back(-0.0f);
    samples.push_back(1e30f);
    samples.push_back(-1e-30f);
    const std::vector<double> percents{0, 0.1, 1, 2.5, 10, 33.3, 50, 75, 97.5, 99.9, 100};
    const std::vector<double> found = SampleStatistics(samples).percentiles(percents);
    std::vector<float> sorted = samples;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 0; i < percents.size(); ++i) {
      const double rank = percents[i] / 100 * static_cast<double>(sorted.size() - 1);
      const std::size_t below = static_cast<std::size_t>(rank);
      const double above = sorted[std::min(below + 1, sorted.size() - 1)];
      EXPECT_EQ(found[i], sorted[below] + (rank - static_cast<double>(below)) * (above - sorted[below])) << percents[i];
    }
  }
}

TEST(Percentiles, OfOneSampleIsThatSample) {
  EXPECT_EQ(SampleStatistics(std::vector<float>{-3.5f}).percentiles(std::vector<double>{0, 50, 100}), (std::vector<double>(3, -3.5)));
  EXPECT_THROW(SampleStatistics(std::vector<float>{1}).percentiles(std::vector<double>{100.1}), OptionError);
  EXPECT_THROW(SampleStatistics(std::vector<float>{1}).percentiles(std::vector<double>{std::nan("")}), OptionError);
}

TEST(Otsu, EqualsBruteForceOnBimodalIntegers) {
  const std::vector<float> samples = tissues({20, 90}, 12, true);
  double best = std::numeric_limits<double>::infinity(), best_threshold = 0;
  for (double threshold : gaps(samples)) {
    const double variance = within_variance(samples, {threshold});
    if (variance < best) {
      best = variance;
      best_threshold = threshold;
    }
  }
  const std::vector<double> found = SampleStatistics(samples).otsu_isovalues(2);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_DOUBLE_EQ(found[0], best_threshold);
}

TEST(Otsu, EqualsBruteForceForThreeClasses) {
  const std::vector<float> samples = tissues({0, 12, 40}, 4, true, 200);
  double best = std::numeric_limits<double>::infinity();
  std::vector<double> best_thresholds;
  const std::vector<double> candidates = gaps(samples);
  for (std::size_t a = 0; a < candidates.size(); ++a) {
    for (std::size_t b = a + 1; b < candidates.size(); ++b) {
      const double variance = within_variance(samples, {candidates[a], candidates[b]});
      if (variance < best) {
        best = variance;
        best_thresholds = {candidates[a], candidates[b]};
      }
    }
  }
  const std::vector<double> found = SampleStatistics(samples).otsu_isovalues(3);
  ASSERT_EQ(found.size(), 2u);
  for (int i : {0, 1}) EXPECT_DOUBLE_EQ(found[i], best_thresholds[i]);
}

TEST(Otsu, FourClassesBeatEveryNeighbouringChoice) {
  const std::vector<float> samples = tissues({0, 30, 60, 100}, 6, true);
  const std::vector<double> thresholds = SampleStatistics(samples).otsu_isovalues(4);
  ASSERT_EQ(thresholds.size(), 3u);
  const double best = within_variance(samples, thresholds);
  for (int move = 0; move < 125; ++move) {
    std::vector<double> moved = thresholds;
    moved[0] += move % 5 - 2;
    moved[1] += move / 5 % 5 - 2;
    moved[2] += move / 25 - 2;
    EXPECT_GE(within_variance(samples, moved), best * (1 - 1e-12)) << move;
  }
  EXPECT_NEAR(thresholds[0], 15, 3);
  EXPECT_NEAR(thresholds[1], 45, 3);
  EXPECT_NEAR(thresholds[2], 80, 3);
}

TEST(Otsu, FloatSamplesAreWithinABinOfBruteForce) {
  const std::vector<float> samples = tissues({-0.3, 0.8}, 0.1, false, 100);
  double best = std::numeric_limits<double>::infinity();
  for (double threshold : gaps(samples)) best = std::min(best, within_variance(samples, {threshold}));
  const std::vector<double> thresholds = SampleStatistics(samples).otsu_isovalues(2);
  ASSERT_EQ(thresholds.size(), 1u);
  EXPECT_LE(within_variance(samples, thresholds), best * (1 + 1e-4));
}

TEST(Otsu, LiesAHairAboveMidwaySoThatNeitherSamplesNorSaddlesTie) {
  EXPECT_EQ(SampleStatistics(std::vector<float>{0, 0, 0, 255, 255}).otsu_isovalues(2), std::vector<double>{255 * kMidway});
  EXPECT_EQ(SampleStatistics(std::vector<float>{3, 3, 4}).otsu_isovalues(2), std::vector<double>{3 + kMidway});
  EXPECT_EQ(SampleStatistics(std::vector<float>{0, 1, 2}).otsu_isovalues(3), (std::vector<double>{kMidway, 1 + kMidway}));
  const std::vector<double> thresholds = SampleStatistics(std::vector<float>{0, 0, 0.25f, 0.25f, 1, 1}).otsu_isovalues(3);
  ASSERT_EQ(thresholds.size(), 2u);
  EXPECT_NEAR(thresholds[0], 0.25 * kMidway, 1e-4);
  EXPECT_NEAR(thresholds[1], 0.25 + 0.75 * kMidway, 1e-4);
}

TEST(Otsu, HasNoAnswerForFewerValuesThanClasses) {
  EXPECT_TRUE(SampleStatistics(std::vector<float>{5, 5, 5}).otsu_isovalues(2).empty());
  EXPECT_TRUE(SampleStatistics(std::vector<float>{0, 1, 1}).otsu_isovalues(3).empty());
  EXPECT_TRUE(SampleStatistics(std::vector<float>{0.5f}).otsu_isovalues(2).empty());
  EXPECT_THROW(SampleStatistics(std::vector<float>{0, 1}).otsu_isovalues(1), OptionError);
}

TEST(Otsu, SurvivesHugeRanges) {
  const std::vector<double> thresholds = SampleStatistics(std::vector<float>{-3e38f, -3e38f, 3e38f, 3e38f}).otsu_isovalues(2);
  ASSERT_EQ(thresholds.size(), 1u);
  EXPECT_NEAR(thresholds[0], 6e38 * kMidway - 3e38, 1e34);
}

TEST(ChooseIsovalue, TakesANumber) {
  const Volume volume = make_phantom("sphere");
  const IsovalueChoice choice = choose_isovalue(volume, "-2.5");
  EXPECT_EQ(choice.value, -2.5);
  EXPECT_EQ(choice.sentence, "isovalue -2.5: as given");
  EXPECT_EQ(choose_isovalue(volume, "1e-3").value, 1e-3);
}

TEST(ChooseIsovalue, TakesOtsuAndMultiOtsu) {
  const Volume volume = volume_of({4, 2, 1}, {0, 0, 0, 10, 10, 10, 50, 50});
  EXPECT_EQ(choose_isovalue(volume, "otsu").value, 10 + 40 * kMidway);
  EXPECT_EQ(choose_isovalue(volume, "otsu3:1").value, 10 * kMidway);
  EXPECT_EQ(choose_isovalue(volume, "otsu3:2").value, 10 + 40 * kMidway);
  EXPECT_EQ(choose_isovalue(volume, "otsu3:2").sentence, "isovalue 30.111456: Otsu's threshold 2 of 2 (3 classes)");
  EXPECT_THROW(choose_isovalue(volume, "otsu4:1"), NothingToMesh);
}

TEST(ChooseIsovalue, TakesAPercentile) {
  const Volume volume = volume_of({5, 1, 1}, {4, 0, 3, 1, 2});
  EXPECT_EQ(choose_isovalue(volume, "p25").value, 1);
  EXPECT_DOUBLE_EQ(choose_isovalue(volume, "p97.5").value, 3.9);
  EXPECT_EQ(choose_isovalue(volume, "p97.5").sentence, "isovalue 3.9: percentile 97.5 of the samples");
}

TEST(ChooseIsovalue, TakesTheValueAtAWorldPointOfAnObliqueImage) {
  PhantomOptions options = phantom_defaults("oblique-sphere");
  const Volume volume = make_phantom("ramp", options);
  const PhantomTruth truth = phantom_truth("ramp", options);
  const Point3 inside = options.center + Vector3{3.3, -4.4, 5.5};
  const std::string spec = "at:" + std::to_string(inside.x) + "," + std::to_string(inside.y) + "," +
                           std::to_string(inside.z);
  EXPECT_NEAR(choose_isovalue(volume, spec).value, truth.value(inside), 1e-4);  // a ramp is trilinear
  EXPECT_NE(choose_isovalue(volume, spec).sentence.find("the value at (15.8, -49.65, 83.625)"), std::string::npos);
}

TEST(ChooseIsovalue, AcceptsTheOuterHalfVoxelAndNothingBeyond) {
  const Volume volume = volume_of({3, 2, 1}, {0, 1, 2, 3, 4, 5});
  EXPECT_EQ(choose_isovalue(volume, "at:2.4,1.5,-0.5").value, 5);
  EXPECT_EQ(choose_isovalue(volume, "at:0.5,0.5,0").value, 2);
  EXPECT_THROW(choose_isovalue(volume, "at:2.6,0,0"), OptionError);
  EXPECT_THROW(choose_isovalue(volume, "at:0,0,0.6"), OptionError);
  EXPECT_THROW(choose_isovalue(volume, "at:1e300,0,0"), OptionError);
}

TEST(ChooseIsovalue, RefusesWhatDoesNotParseAndSaysWhatToWrite) {
  const Volume volume = make_phantom("sphere");
  for (const char* spec : {"", "abc", "12x", " 12", "nan", "inf", "1e999", "otsu:", "otsu3", "otsu3:", "otsu3:0",
                           "otsu3:3", "otsu9:1", "otsu1:1", "otsu3:22", "otsux", "p", "p101", "p-1", "pnan", "p5%",
                           "at:", "at:1,2", "at:1,2,3,4", "at:1,,3", "at:a,b,c", "at:1,2,nan", "at 1,2,3"}) {
    try {
      choose_isovalue(volume, spec);
      ADD_FAILURE() << "accepted '" << spec << "'";
    } catch (const OptionError& error) {
      const std::string message = error.what();
      EXPECT_TRUE(message.find("write ") != std::string::npos) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos);
    }
  }
}

TEST(ChooseIsovalue, NamesTheRangeWhenOutsideIt) {
  const Volume volume = volume_of({2, 1, 1}, {-7, 255});
  EXPECT_EQ(choose_isovalue(volume, "255").value, 255);
  EXPECT_EQ(choose_isovalue(volume, "-7").value, -7);
  for (const char* spec : {"255.5", "-8"}) {
    try {
      choose_isovalue(volume, spec);
      ADD_FAILURE() << spec;
    } catch (const NothingToMesh& error) {
      EXPECT_NE(std::string(error.what()).find("-7 to 255"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace delvox
