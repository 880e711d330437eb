#include <CLI/CLI.hpp>
#include <cmath>

#include "console.h"
#include "delvox/core/errors.h"
#include "delvox/volume/phantom.h"
#include "delvox/volume/write_volume.h"
#include "format.h"
#include "mesh_output.h"
#include "report_json.h"
#include "signals.h"
#include "validators.h"
#include "thread_limit.h"
#include "verbs.h"
#include "volume_input.h"

namespace delvox::tools {
namespace {

struct Options {
  std::string kind, output;
  std::string dims, spacing, center, direction, type;
  std::optional<double> noise;
  std::optional<std::uint64_t> seed;
  ConsoleOptions console;
};

std::vector<double> parse_list(const std::string& text, std::size_t count, const std::string& option) {
  const std::vector<std::string> pieces = split(text, ',');
  if (pieces.size() != count) {
    throw OptionError(option + ": '" + text + "' is not a list of " + std::to_string(count) + " numbers");
  }
  std::vector<double> values;
  for (const std::string& piece : pieces) values.push_back(parse_number(piece, option));
  return values;
}

Point3 parse_point(const std::string& text, const std::string& option) {
  const std::vector<double> v = parse_list(text, 3, option);
  return {v[0], v[1], v[2]};
}

PhantomOptions phantom_options(const Options& options) {
  PhantomOptions result = phantom_defaults(options.kind);
  if (!options.dims.empty()) {
    const std::vector<double> dims = parse_list(options.dims, 3, "--dims");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!(dims[axis] >= 1 && dims[axis] <= 1e6 && dims[axis] == std::floor(dims[axis]))) {
        throw OptionError("--dims: '" + options.dims + "' must be three whole numbers from 1");
      }
      result.dims[axis] = static_cast<int>(dims[axis]);
    }
  }
  if (!options.spacing.empty()) result.spacing = parse_point(options.spacing, "--spacing");
  if (!options.center.empty()) result.center = parse_point(options.center, "--center");
  if (!options.direction.empty()) {
    const std::vector<double> v = parse_list(options.direction, 9, "--direction");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result.direction[axis] = {v[3 * axis], v[3 * axis + 1], v[3 * axis + 2]};
    }
  }
  result.uint16 = options.type == "uint16";
  if (options.noise) result.noise = *options.noise;
  if (options.seed) result.seed = *options.seed;
  return result;
}

template <class T>
Json optional_json(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json truth_json(const PhantomTruth& truth) {
  return {{"isovalue", truth.isovalue},
          {"components", optional_json(truth.components)},
          {"bodies", optional_json(truth.bodies)},
          {"euler", optional_json(truth.euler)},
          {"volume_mm3", optional_json(truth.volume_mm3)},
          {"area_mm2", optional_json(truth.area_mm2)},
          {"center", truth.center ? to_json(*truth.center) : Json(nullptr)},
          {"radius", optional_json(truth.radius)}};
}

std::string truth_text(const PhantomTruth& truth) {
  std::string text = "isovalue " + number(truth.isovalue, 9);
  if (truth.components) text += ", closed surfaces " + std::to_string(*truth.components);
  if (truth.bodies) text += ", bodies " + std::to_string(*truth.bodies);
  if (truth.euler) text += ", Euler number " + std::to_string(*truth.euler);
  if (truth.volume_mm3) text += ", volume " + number(*truth.volume_mm3, 9) + " mm3";
  if (truth.area_mm2) text += ", area " + number(*truth.area_mm2, 9) + " mm2";
  if (truth.radius) text += ", radius " + number(*truth.radius, 9) + " mm";
  return text + "\n";
}

std::string kinds_text() {
  std::string text = "Kinds:\n";
  for (const PhantomKind& kind : phantom_kinds()) {
    std::string name = "  " + kind.name;
    name.resize(18, ' ');
    text += name + kind.description + "\n";
  }
  return text;
}

void add_options(CLI::App& app, Options& options) {
  app.footer(kinds_text());
  app.add_option("KIND", options.kind, "What it shows: see below")->required();
  app.add_option("-o,--output", options.output, "Volume to write: .nii .nii.gz .tif .json (with raw data) .vdb")
      ->required()
      ->type_name("VOLUME");
  app.add_option("--dims", options.dims, "Number of voxels (default: of the kind, mostly 64,64,64)")
      ->type_name("NX,NY,NZ");
  app.add_option("--spacing", options.spacing, "Voxel spacing, mm (default: of the kind, mostly 1,1,1)")
      ->type_name("SX,SY,SZ");
  app.add_option("--center", options.center, "World position of the middle of the image, mm")->type_name("X,Y,Z");
  app.add_option("--direction", options.direction, "World directions of the three axes, nine numbers, orthonormal")
      ->type_name("IX,IY,IZ,...");
  app.add_option("--noise", options.noise, "Standard deviation of noise added to every sample")
      ->check(finite_number(Zero::kAllowed))
      ->type_name("SIGMA");
  app.add_option("--type", options.type,
                 "float32, or uint16: 256 steps per unit, the isovalue at 32767.5 (a TIFF stores 16 bits then, slice by "
                 "slice, so that it may be larger than memory)")
      ->check(CLI::IsMember({"float32", "uint16"}))
      ->type_name("TYPE");
  app.add_option("--seed", options.seed, "Of the noise, and of kind random")->type_name("N");
  add_config_option(app);
  add_console_options(app, options.console, JsonFlag::kOffered);
}

}  // namespace

void run_phantom(const Verb& verb, const Arguments& arguments) {
  CLI::App app(std::string(verb.summary) + "\n", std::string("delvox ") + verb.name);
  Options options;
  add_options(app, options);
  const ThreadLimit threads(app);
  if (!parse_arguments(app, arguments)) return;

  const PhantomOptions phantom = phantom_options(options);
  const PhantomTruth truth = phantom_truth(options.kind, phantom);
  check_output(options.output, {});
  const Console console(options.console);
  const VolumeSourcePtr volume = cancellable(phantom_source(options.kind, phantom));
  write_volume(*volume, options.output);
  console.note("wrote " + options.output);
  if (console.json()) {
    Json json = run_header(verb, arguments);
    json["options"] = options_json(app);
    json["volume"] = to_json(volume->header());
    json["truth"] = truth_json(truth);
    console.machine_result(text_of(json));
  }
  console.result(truth_text(truth));
}

}  // namespace delvox::tools
