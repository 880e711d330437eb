#include "samples_input.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "delvox/core/errors.h"
#include "delvox/volume/histogram.h"
#include "format.h"

namespace delvox::tools {
namespace {

/// The value at a point: "at:x,y,z".
IsovalueChoice choose_at_point(const SampleField& field, const std::string& spec) {
  const std::vector<std::string> pieces = split(spec.substr(3), ',');
  if (pieces.size() != 3) throw OptionError("--iso '" + spec + "': write three coordinates in mm, as in at:10.5,-3,42");
  Point3 p;
  for (int axis = 0; axis < 3; ++axis)
    p[axis] = parse_number(pieces[static_cast<std::size_t>(axis)], "--iso '" + spec + "'");
  const double value = field.value(p);
  if (std::isnan(value)) {
    throw OptionError("--iso '" + spec + "': the point lies outside the convex hull of the samples; give one inside");
  }
  return {value, "isovalue " + number(value, 9) + ": the value at (" + point(p) + ")"};
}

}  // namespace

void add_field_option(CLI::App& app, SamplesInputOptions& options) {
  app.add_option(
         "--field", options.field,
         "Of samples: the column, or the array on the points of a .vtu, that holds the values (default: the only "
         "one, or the column 'value')")
      ->type_name("NAME");
}

void add_interpolation_option(CLI::App& app, SamplesInputOptions& options) {
  app.add_option(
         "--interpolation", options.interpolation,
         "Between samples: linear on their Delaunay tets, or by natural neighbours (Sibson), smoother and slower")
      ->check(CLI::IsMember({"linear", "natural"}))
      ->capture_default_str()
      ->type_name("HOW");
}

std::string SamplesInput::sentence() const {
  return path + ": " + format + ", " + plural(field.samples().points.size(), "sample") +
         (field_name.empty() ? "" : " of '" + field_name + "'") + ", " + plural(field.tet_count(), "tet") +
         " between them";
}

std::string SamplesInput::warning() const {
  if (merged == 0) return {};
  return path + ": " + plural(merged, "sample") + " left out, equal to another in place and value";
}

SamplesInput read_samples_input(const std::string& path, const SamplesInputOptions& options) {
  SamplesFile file = read_samples(path, options.field);
  try {
    return {path, file.format, file.field, file.merged, SampleField(std::move(file.samples))};
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what());
  }
}

std::vector<float> rounded_values(const SampleField& field) {
  const std::vector<double>& values = field.samples().values;
  std::vector<float> rounded;
  rounded.reserve(values.size());
  for (double value : values) rounded.push_back(static_cast<float>(value));
  return rounded;
}

ChosenIsosurface choose_isosurface(const SampleField& field, const IsosurfaceOptions& options,
                                   const FrameChange& frame) {
  const std::vector<double>& values = field.samples().values;
  const std::string spec = frame.iso_in_volume(options.iso);
  IsovalueChoice choice;
  if (spec.starts_with("at:")) {
    choice = choose_at_point(field, spec);
  } else {
    VolumeHeader row;
    row.dims = {static_cast<int>(values.size()), 1, 1};
    choice = choose_isovalue(*source_of(row, rounded_values(field)), spec);
  }
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (!(choice.value >= *low && choice.value <= *high)) {
    throw NothingToMesh("isovalue " + number(choice.value, 9) + " is outside the range of the samples, " +
                        number(*low, 9) + " to " + number(*high, 9) + "; choose one inside it");
  }
  return {{choice.value, options.below}, choice.sentence + (options.below ? ", inside is at or below" : "")};
}

std::string advice_on_ties(const SampleField& field, const Isosurface& surface) {
  const double sign = surface.below ? -1 : 1, level = sign * surface.isovalue;
  double outside = -Box3::kInfinity;
  std::size_t ties = 0;
  for (double value : field.samples().values) {
    ties += value == surface.isovalue;
    if (sign * value < level) outside = std::max(outside, sign * value);
  }
  if (ties == 0) return {};
  std::string text = plural(ties, "sample") + (ties == 1 ? " equals" : " equal") +
                     " the isovalue, which leaves parts of the surface as thin as a rounding error";
  if (std::isfinite(outside)) {
    text += "; --iso " + number(sign * (0.5 * (level + outside)), 9) + " labels every sample alike without that";
  }
  return text;
}

}  // namespace delvox::tools
