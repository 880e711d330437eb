// The geometry of a TIFF stack: resolution tags, and the lines key=value that ImageJ keeps in ImageDescription.
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "volume/tiff_file.h"

namespace delvox {
namespace {

using Fields = std::map<std::string, std::string>;

Fields parse_fields(const std::string& description) {
  Fields fields;
  for (std::size_t begin = 0; begin < description.size();) {
    const std::size_t end = std::min(description.find('\n', begin), description.size());
    std::string line = description.substr(begin, end - begin);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const std::size_t equals = line.find('=');
    if (equals != std::string::npos) fields[line.substr(0, equals)] = line.substr(equals + 1);
    begin = end + 1;
  }
  return fields;
}

std::optional<double> number(const Fields& fields, const std::string& key) {
  const auto found = fields.find(key);
  if (found == fields.end()) return std::nullopt;
  const std::string& text = found->second;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

int count(const Fields& fields, const std::string& key) {
  const double value = number(fields, key).value_or(1);
  return value >= 1 && value <= 1e9 ? static_cast<int>(value) : 1;
}

/// Millimetres per ImageJ unit; nothing for "pixel" and units that are no length.
std::optional<double> unit_in_mm(const std::string& unit) {
  static const std::map<std::string, double> kUnits{
      {"mm", 1},          {"millimeter", 1},  {"cm", 10},         {"m", 1000},    {"meter", 1000},
      {"um", 1e-3},       {"micron", 1e-3},   {"microns", 1e-3},  {"µm", 1e-3},   {"\xce\xbcm", 1e-3},
      {"\xb5m", 1e-3},    {"\\u00B5m", 1e-3}, {"nm", 1e-6},       {"inch", 25.4}, {"inches", 25.4},
      {"millimeters", 1}, {"centimeter", 10}, {"micrometer", 1e-3}};
  const auto found = kUnits.find(unit);
  if (found == kUnits.end()) return std::nullopt;
  return found->second;
}

void set_in_plane(TiffGeometry& geometry, const TiffPage& page, double unit) {
  const double resolutions[2] = {page.resolution_x, page.resolution_y};
  for (int axis = 0; axis < 2; ++axis) {
    if (resolutions[axis] > 0 && std::isfinite(resolutions[axis])) geometry.spacing[axis] = unit / resolutions[axis];
  }
}

void parse_imagej(const Fields& fields, const TiffPage& page, TiffGeometry& geometry,
                  std::vector<std::string>& warnings) {
  geometry.from_imagej = true;
  geometry.images = count(fields, "images");
  geometry.channels = count(fields, "channels");
  geometry.slices = count(fields, "slices");
  geometry.frames = count(fields, "frames");
  const auto unit_field = fields.find("unit");
  const std::string unit_name = unit_field == fields.end() ? "" : unit_field->second;
  const std::optional<double> unit = unit_in_mm(unit_name);
  if (unit) {
    set_in_plane(geometry, page, *unit);
    geometry.spacing[2] = std::abs(number(fields, "spacing").value_or(0)) * *unit;
    // write_volume notes them in full: the resolution tags are fractions of 32-bit integers.
    for (int axis = 0; axis < 2; ++axis) {
      const auto exact = number(fields, axis == 0 ? "xspacing" : "yspacing");
      if (exact && *exact > 0) geometry.spacing[axis] = *exact * *unit;
    }
    // ImageJ states the origin in pixels, as the place where world coordinates are 0.
    const char* keys[3] = {"xorigin", "yorigin", "zorigin"};
    for (int axis = 0; axis < 3; ++axis) {
      const double pixels = number(fields, keys[axis]).value_or(0);
      if (pixels != 0) geometry.origin[axis] = -pixels * geometry.spacing[axis];
    }
  } else if (!unit_name.empty() && unit_name != "pixel" && unit_name != "pixels") {
    warnings.push_back("ImageJ's unit '" + unit_name + "' is no length that is known; the spacing in it is ignored");
  }
  const auto frame = fields.find("frame");
  if (frame != fields.end()) geometry.frame = frame->second;
  // Calibration function 0 is a straight line; ImageJ stores signed 16-bit images as unsigned ones shifted by it.
  const auto c0 = number(fields, "c0"), c1 = number(fields, "c1");
  if (number(fields, "cf").value_or(-1) == 0 && c0 && c1 && *c1 != 0 && (*c0 != 0 || *c1 != 1)) {
    geometry.intercept = *c0;
    geometry.slope = *c1;
    warnings.push_back("ImageJ's calibration was applied: value = " + std::to_string(*c0) + " + " +
                       std::to_string(*c1) + " * stored");
  }
}

}  // namespace

TiffGeometry parse_tiff_geometry(const TiffPage& page, std::vector<std::string>& warnings) {
  TiffGeometry geometry;
  if (page.description.starts_with("ImageJ=")) {
    parse_imagej(parse_fields(page.description), page, geometry, warnings);
  } else if (page.description.find("<OME") != std::string::npos) {
    warnings.push_back("OME metadata are not read: pages are taken as slices; check the spacing (--spacing)");
  }
  constexpr int kInch = 2, kCentimetre = 3;
  if (geometry.spacing[0] == 0 && (page.resolution_unit == kInch || page.resolution_unit == kCentimetre)) {
    set_in_plane(geometry, page, page.resolution_unit == kInch ? 25.4 : 10);
    if (page.resolution_unit == kInch && (page.resolution_x == 72 || page.resolution_x == 96)) {
      warnings.push_back("the resolution of " + std::to_string(static_cast<int>(page.resolution_x)) +
                         " dots per inch looks like a default, not a measurement; check the spacing (--spacing)");
    }
  }
  return geometry;
}

}  // namespace delvox
