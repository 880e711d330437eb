#include "delvox/mesh_io/read_samples.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <tuple>

#include "mesh_io/raw_samples.h"

namespace delvox {
namespace {

using namespace mesh_io;

constexpr double kLargestCoordinate = 1e15, kLargestValue = 1e30;
/// Places further from the origin than this many times their extent differ in their last digits only.
constexpr double kFarthest = 1e9;

std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string name_of(const RawSamples& raw, std::size_t i) {
  if (!raw.line_of.empty()) return "line " + std::to_string(raw.line_of[i]);
  return "point " + std::to_string(i) + " (counted from 0)";
}

void check_numbers(const Source& source, const RawSamples& raw) {
  const Samples& samples = raw.samples;
  Box3 box;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const Point3& p = samples.points[i];
    const double value = samples.values[i], farthest = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    if (!is_finite(p) || !std::isfinite(value)) {
      source.fail(name_of(raw, i) + " is not finite", "leave out samples without a place or value");
    }
    if (farthest > kLargestCoordinate || std::abs(value) > kLargestValue) {
      source.fail(name_of(raw, i) + " holds " + text_of(farthest > kLargestCoordinate ? farthest : value) +
                      ", which cannot be meant",
                  "check the units, or leave it out");
    }
    box.extend(p);
  }
  const Point3 far{std::max(std::abs(box.min.x), std::abs(box.max.x)),
                   std::max(std::abs(box.min.y), std::abs(box.max.y)),
                   std::max(std::abs(box.min.z), std::abs(box.max.z))};
  if (box.diagonal() > 0 && norm(far) > kFarthest * box.diagonal()) {
    source.fail("its places are too far from the origin to tell them apart", "subtract a common offset");
  }
}

/// Keeps the first of those with one place and one value; returns how many others there were.
std::size_t merge_equal(const Source& source, RawSamples& raw) {
  const Samples& samples = raw.samples;
  std::vector<std::uint32_t> order(samples.points.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto place = [&](std::uint32_t i) {
    const Point3& p = samples.points[i];
    return std::tuple(p.x, p.y, p.z);
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t i, std::uint32_t j) { return std::tuple(place(i), i) < std::tuple(place(j), j); });
  std::vector<bool> dropped(order.size(), false);
  std::size_t first = 0;
  for (std::size_t n = 1; n < order.size(); ++n) {
    const std::uint32_t i = order[first], j = order[n];
    if (place(i) != place(j)) {
      first = n;
      continue;
    }
    if (samples.values[i] != samples.values[j]) {
      const Point3& p = samples.points[i];
      source.fail(name_of(raw, i) + " and " + name_of(raw, j) + " are both at (" + text_of(p.x) + ", " + text_of(p.y) +
                      ", " + text_of(p.z) + "), with values " + text_of(samples.values[i]) + " and " +
                      text_of(samples.values[j]),
                  "leave one out");
    }
    dropped[j] = true;
  }
  Samples kept;
  kept.frame = samples.frame;
  for (std::size_t i = 0; i < dropped.size(); ++i) {
    if (dropped[i]) continue;
    // Without -0, which equals 0 and has other bits.
    kept.points.push_back(samples.points[i] + Point3{0, 0, 0});
    kept.values.push_back(samples.values[i]);
  }
  const std::size_t merged = samples.points.size() - kept.points.size();
  raw.samples = std::move(kept);
  return merged;
}

}  // namespace

SamplesFile read_samples(const std::filesystem::path& path, const std::string& field) {
  const Source source = load_source(path);
  const bool vtu = lower_case(path.extension().string()) == ".vtu";
  RawSamples raw = vtu ? read_samples_vtu(source, field) : read_samples_text(source, field);
  check_numbers(source, raw);
  SamplesFile file;
  file.merged = merge_equal(source, raw);
  if (raw.samples.points.size() < 4) {
    source.fail("holds samples in " + std::to_string(raw.samples.points.size()) + " places",
                "four are needed, not in one plane, for anything to lie between them");
  }
  file.samples = std::move(raw.samples);
  file.format = vtu ? "VTU" : "CSV";
  file.field = std::move(raw.field);
  return file;
}

bool is_samples_path(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  return extension == ".csv" || extension == ".tsv" || extension == ".txt";
}

}  // namespace delvox
