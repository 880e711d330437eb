#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <type_traits>

#include "delvox/core/errors.h"
#include "delvox/volume/preprocess.h"

namespace delvox {
namespace {

[[noreturn]] void fail(std::string_view text, const char* cause) {
  throw OptionError("crop '" + std::string(text) + "': " + cause +
                    "; write x0:x1,y0:y1,z0:z1 in voxels, or with mm behind it in world coordinates");
}

/// A bound as written; none if left out.
template <typename Number>
std::optional<Number> parse_bound(std::string_view whole, std::string_view text) {
  if (text.empty()) return std::nullopt;
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    fail(whole, std::is_integral_v<Number> ? "a bound is not a whole number" : "a bound is not a number");
  }
  if (!std::isfinite(static_cast<double>(value))) fail(whole, "a bound is not finite");
  return value;
}

/// The lower and upper bound along each axis.
template <typename Number>
std::array<std::array<std::optional<Number>, 2>, 3> parse_ranges(std::string_view whole, std::string_view text) {
  std::array<std::array<std::optional<Number>, 2>, 3> ranges;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t comma = text.find(',');
    if ((comma == std::string_view::npos) != (axis == 2)) fail(whole, "there must be three ranges");
    const std::string_view range = text.substr(0, comma);
    const std::size_t colon = range.find(':');
    if (colon == std::string_view::npos) fail(whole, "a range lacks its colon");
    ranges[axis][0] = parse_bound<Number>(whole, range.substr(0, colon));
    ranges[axis][1] = parse_bound<Number>(whole, range.substr(colon + 1));
    if (axis < 2) text.remove_prefix(comma + 1);
  }
  return ranges;
}

/// World box around all voxel centers.
Box3 world_box(const VolumeHeader& header) {
  Box3 box;
  for (int corner = 0; corner < 8; ++corner) {
    Point3 index;
    for (int axis = 0; axis < 3; ++axis) index[axis] = corner >> axis & 1 ? header.dims[axis] - 1 : 0;
    box.extend(header.index_to_world(index));
  }
  return box;
}

}  // namespace

IndexBox parse_crop(const VolumeHeader& header, std::string_view text) {
  const std::string_view whole = text;
  if (text.ends_with("mm")) {
    Box3 world = world_box(header);
    const auto ranges = parse_ranges<double>(whole, text.substr(0, text.size() - 2));
    for (int axis = 0; axis < 3; ++axis) {
      world.min[axis] = ranges[axis][0].value_or(world.min[axis]);
      world.max[axis] = ranges[axis][1].value_or(world.max[axis]);
    }
    return index_box(header, world);
  }
  IndexBox box{{0, 0, 0}, header.dims};
  const auto ranges = parse_ranges<int>(whole, text);
  for (int axis = 0; axis < 3; ++axis) {
    box.begin[axis] = std::clamp(ranges[axis][0].value_or(0), 0, header.dims[axis]);
    box.end[axis] = std::clamp(ranges[axis][1].value_or(header.dims[axis]), 0, header.dims[axis]);
  }
  return box;
}

}  // namespace delvox
