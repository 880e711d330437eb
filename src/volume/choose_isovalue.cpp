#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

#include "delvox/core/errors.h"
#include "delvox/volume/histogram.h"

namespace delvox {
namespace {

constexpr int kMaxClasses = 5;

[[noreturn]] void fail(std::string_view spec, const std::string& cause) {
  throw OptionError("isovalue '" + std::string(spec) + "': " + cause);
}

std::string format(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);  // nine digits tell all floats apart
  return text;
}

std::optional<double> parse_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<Point3> parse_point(std::string_view text) {
  Point3 point;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t comma = text.find(',');
    if ((comma == std::string_view::npos) != (axis == 2)) return std::nullopt;
    const auto number = parse_number(text.substr(0, comma));
    if (!number) return std::nullopt;
    point[axis] = *number;
    if (axis < 2) text.remove_prefix(comma + 1);
  }
  return point;
}

IsovalueChoice choose_otsu(const VolumeSource& source, std::string_view spec) {
  int classes = 2, which = 1;
  if (spec != "otsu") {
    // "otsu3:2" and nothing longer or shorter.
    const std::string_view rest = spec.substr(4);
    const bool well_formed = rest.size() == 3 && rest[1] == ':';
    classes = well_formed ? rest[0] - '0' : 0;
    which = well_formed ? rest[2] - '0' : 0;
    if (classes < 2 || classes > kMaxClasses || which < 1 || which >= classes) {
      fail(spec, "write otsu, or otsuN:K for threshold K (1 to N-1) between N classes (2 to 5), as in otsu3:2");
    }
  }
  const SampleStatistics statistics(source);
  const std::vector<double> thresholds = statistics.otsu_isovalues(classes);
  if (thresholds.empty()) {
    throw NothingToMesh("isovalue '" + std::string(spec) + "': the volume has fewer than " + std::to_string(classes) +
                        " distinct values (range " + format(statistics.min()) + " to " + format(statistics.max()) +
                        "); give a number or fewer classes");
  }
  const double value = thresholds[static_cast<std::size_t>(which - 1)];
  std::string how = "Otsu's threshold";
  if (classes > 2) {
    how += " " + std::to_string(which) + " of " + std::to_string(classes - 1) + " (" + std::to_string(classes) +
           " classes)";
  }
  return {value, "isovalue " + format(value) + ": " + how};
}

IsovalueChoice choose_percentile(const VolumeSource& source, std::string_view spec) {
  const auto percent = parse_number(spec.substr(1));
  if (!percent || *percent < 0 || *percent > 100) fail(spec, "write a percentile from p0 to p100, as in p97.5");
  const double value = SampleStatistics(source).percentiles(std::span(&*percent, 1))[0];
  return {value, "isovalue " + format(value) + ": percentile " + format(*percent) + " of the samples"};
}

double trilinear(const VolumeSource& source, const Point3& index) {
  const std::array<int, 3>& dims = source.dims();
  std::array<int, 3> begin, size;
  std::array<double, 3> fraction;
  for (int axis = 0; axis < 3; ++axis) {
    const int last = dims[axis] - 1;
    const double position = std::clamp(index[axis], 0.0, static_cast<double>(last));
    begin[axis] = std::min(static_cast<int>(position), std::max(last - 1, 0));
    size[axis] = std::min(2, last + 1);
    fraction[axis] = position - begin[axis];
  }
  std::vector<float> slice(static_cast<std::size_t>(dims[0]) * dims[1]);
  const auto reader = source.start();
  for (int k = 0; k < begin[2]; ++k) reader->read(1, slice.data());
  double sum = 0;
  for (int k = 0; k < size[2]; ++k) {
    reader->read(1, slice.data());
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        const double weight = (i ? fraction[0] : 1 - fraction[0]) * (j ? fraction[1] : 1 - fraction[1]) *
                              (k ? fraction[2] : 1 - fraction[2]);
        sum += weight * slice[static_cast<std::size_t>(begin[1] + j) * dims[0] + begin[0] + i];
      }
    }
  }
  return sum;
}

IsovalueChoice choose_at_point(const VolumeSource& source, std::string_view spec) {
  const auto point = parse_point(spec.substr(3));
  if (!point) fail(spec, "write three world coordinates in mm, as in at:10.5,-3,42");
  const Point3 index = source.header().index_to_world.inverse()(*point);
  for (int axis = 0; axis < 3; ++axis) {
    constexpr double kRounding = 1e-6;  // voxel
    if (index[axis] >= -0.5 - kRounding && index[axis] <= source.dims()[axis] - 0.5 + kRounding) continue;
    fail(spec, "the point lies outside the image (voxel " + format(index.x) + ", " + format(index.y) + ", " +
                   format(index.z) + " of " + std::to_string(source.dims()[0]) + " x " +
                   std::to_string(source.dims()[1]) + " x " + std::to_string(source.dims()[2]) +
                   "); give one inside, in mm and in the image's frame");
  }
  const double value = trilinear(source, index);
  return {value, "isovalue " + format(value) + ": the value at (" + format(point->x) + ", " + format(point->y) + ", " +
                     format(point->z) + ")"};
}

}  // namespace

IsovalueChoice choose_isovalue(const VolumeSource& source, std::string_view spec) {
  if (const auto number = parse_number(spec)) return {*number, "isovalue " + format(*number) + ": as given"};
  if (spec.substr(0, 4) == "otsu") return choose_otsu(source, spec);
  if (spec.substr(0, 3) == "at:") return choose_at_point(source, spec);
  if (spec.substr(0, 1) == "p") return choose_percentile(source, spec);
  fail(spec, "not understood; write a number, otsu, otsu3:2, p97.5 or at:x,y,z");
}

void check_isovalue(const IsovalueChoice& choice, const Volume& volume) {
  if (choice.value >= volume.min() && choice.value <= volume.max()) return;
  throw NothingToMesh("isovalue " + format(choice.value) + " is outside the range of the volume, " +
                      format(volume.min()) + " to " + format(volume.max()) + "; choose one inside it");
}

IsovalueChoice choose_isovalue(const Volume& volume, std::string_view spec) {
  const IsovalueChoice choice = choose_isovalue(*source_of(volume), spec);
  check_isovalue(choice, volume);
  return choice;
}

}  // namespace delvox
