#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>

#include "console.h"
#include "delvox/core/errors.h"
#include "delvox/volume/histogram.h"
#include "delvox/volume/voxel_topology.h"
#include "format.h"
#include "report_json.h"
#include "samples_input.h"
#include "signals.h"
#include "text_histogram.h"
#include "thread_limit.h"
#include "verbs.h"
#include "volume_input.h"

namespace delvox::tools {
namespace {

constexpr double kPercents[] = {1, 5, 25, 50, 75, 95, 99};
constexpr int kHistogramBins = 64;

struct Options {
  VolumeInputOptions volume;  // its path names the input, samples too
  SamplesInputOptions samples;
  bool below = false;
  ConsoleOptions console;
};

// An isovalue that info proposes, and what it would enclose.
struct Suggestion {
  std::string spec;  // what --iso takes
  double isovalue = 0;
  VoxelTopology topology;
};

struct Findings {
  float low = 0, high = 0;
  std::vector<std::string> warnings;
  std::vector<double> percentiles;
  Histogram histogram;
  std::vector<Suggestion> suggestions;
};

using CountTopologies = std::function<std::vector<VoxelTopology>(const std::vector<Isosurface>&)>;

std::vector<Suggestion> suggest(const SampleStatistics& statistics, bool below, const CountTopologies& count) {
  std::vector<Suggestion> suggestions;
  std::vector<Isosurface> surfaces;
  for (int classes = 2; classes <= 4; ++classes) {
    const std::vector<double> values = statistics.otsu_isovalues(classes);
    for (std::size_t i = 0; i < values.size(); ++i) {
      throw_if_cancelled();
      const std::string spec = classes == 2 ? "otsu" : "otsu" + std::to_string(classes) + ":" + std::to_string(i + 1);
      suggestions.push_back({spec, values[i], {}});
      surfaces.push_back({values[i], below});
    }
  }
  if (surfaces.empty()) return suggestions;
  const std::vector<VoxelTopology> topologies = count(surfaces);
  for (std::size_t n = 0; n < suggestions.size(); ++n) suggestions[n].topology = topologies[n];
  return suggestions;
}

Findings find(const SampleStatistics& statistics, bool below, const CountTopologies& count) {
  Findings findings;
  findings.low = statistics.min();
  findings.high = statistics.max();
  findings.warnings = statistics.warnings();
  findings.percentiles = statistics.percentiles(kPercents);
  findings.histogram = statistics.histogram(kHistogramBins);
  findings.suggestions = suggest(statistics, below, count);
  return findings;
}

std::string header_text(const std::string& path, const VolumeHeader& header) {
  const Vector3 spacing = header.spacing();
  const auto& n = header.dims;
  std::string text = path + ": " + header.format + ", " + header.sample_type + "\n";
  text += "voxels       " + std::to_string(n[0]) + " x " + std::to_string(n[1]) + " x " + std::to_string(n[2]) + "\n";
  text += "spacing      " + point(spacing) + " mm\n";
  text += "extent       " + point({n[0] * spacing.x, n[1] * spacing.y, n[2] * spacing.z}) + " mm\n";
  text += "orientation  " + header.orientation() + ", frame " + to_string(header.frame) + "\n";
  text += "first voxel  " + point(header.index_to_world({0, 0, 0})) + " mm\n";
  for (const std::string& warning : header.warnings) text += "warning      " + warning + "\n";
  return text;
}

std::string suggestion_text(const std::vector<Suggestion>& suggestions) {
  if (suggestions.empty()) return "isovalues    none: all samples are equal\n";
  std::string text = "--iso             value  inside/ml     pieces  surfaces  cavities  Euler number\n";
  for (const Suggestion& s : suggestions) {
    char line[160];
    std::snprintf(line, sizeof line, "%-9s %13s %10s %10zu %9zu %9zu %13ld\n", s.spec.c_str(),
                  number(s.isovalue, 6).c_str(), number(s.topology.volume_mm3 / 1000, 5).c_str(), s.topology.inside_components,
                  s.topology.surface_components, s.topology.cavities, s.topology.euler);
    text += line;
  }
  return text;
}

std::string findings_text(const Findings& findings) {
  std::string text = "range        " + number(findings.low, 7) + " to " + number(findings.high, 7) + "\npercentiles  ";
  for (std::size_t i = 0; i < std::size(kPercents); ++i) {
    text += (i > 0 ? ", p" : "p") + number(kPercents[i]) + " " + number(findings.percentiles[i], 6);
  }
  std::vector<double> marks;
  for (const Suggestion& s : findings.suggestions) {
    if (s.spec == "otsu" || s.spec.starts_with("otsu3")) marks.push_back(s.isovalue);
  }
  return text + "\n\n" + text_histogram(findings.histogram, marks) + "\n" + suggestion_text(findings.suggestions);
}

Json findings_json(const Findings& findings) {
  Json percentile_values = Json::object();
  for (std::size_t i = 0; i < std::size(kPercents); ++i) {
    percentile_values["p" + number(kPercents[i])] = findings.percentiles[i];
  }
  Json suggestions = Json::array();
  for (const Suggestion& s : findings.suggestions) {
    suggestions.push_back({{"iso", s.spec},
                           {"isovalue", s.isovalue},
                           {"inside_components", s.topology.inside_components},
                           {"surface_components", s.topology.surface_components},
                           {"cavities", s.topology.cavities},
                           {"euler", s.topology.euler},
                           {"volume_mm3", s.topology.volume_mm3}});
  }
  const Histogram& h = findings.histogram;
  return {{"min", findings.low},
          {"max", findings.high},
          {"percentiles", std::move(percentile_values)},
          {"histogram", {{"low", h.low}, {"high", h.high}, {"counts", h.counts}}},
          {"isovalues", std::move(suggestions)}};
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("VOLUME", options.volume.path,
                 "The scan: .nii .nii.gz .hdr .inr .inr.gz .tif .json .vdb, a folder of slices; or scattered samples: .csv "
                 ".tsv .txt with columns x, y, z and a value, .vtu with an array on its points")
      ->required();
  app.add_flag("--below", options.below, "Count components at or below each isovalue");
  add_field_option(app, options.samples);
  add_reading_options(app, options.volume);
  add_preprocessing_options(app, options.volume);
  add_config_option(app);
  add_console_options(app, options.console, JsonFlag::kOffered);
}

bool holds_samples(const std::string& path) {
  return is_samples_path(path) || std::filesystem::path(path).extension() == ".vtu";
}

void refuse_options(const CLI::App& app, const Options& options, bool samples) {
  const auto refuse = [&](const char* name, const std::string& why) {
    if (app.count(name) > 0) throw OptionError(std::string(name) + ": " + why);
  };
  if (!samples) return refuse("--field", "is for scattered samples (.csv .tsv .txt .vtu)");
  for (const char* name : {"--spacing", "--volume-index", "--crop", "--resample", "--smooth"}) {
    refuse(name, "is for volumes, and " + options.volume.path + " holds samples");
  }
}

void tell_volume(const Options& options, const Console& console, Json json) {
  const VolumeSourcePtr source = kept_if_small(open_input(options.volume, "").source);
  const Findings findings = find(SampleStatistics(*source), options.below, [&](const std::vector<Isosurface>& surfaces) {
    return count_topologies(*source, surfaces);
  });
  VolumeHeader header = source->header();
  header.warnings.insert(header.warnings.end(), findings.warnings.begin(), findings.warnings.end());
  if (console.json()) {
    json["volume"] = to_json(header);
    const Vector3 spacing = header.spacing();
    json["volume"]["extent_mm"] = {header.dims[0] * spacing.x, header.dims[1] * spacing.y, header.dims[2] * spacing.z};
    json.update(findings_json(findings));
    console.machine_result(text_of(json));
  }
  console.result(header_text(options.volume.path, header) + findings_text(findings));
}

// The topologies are those of the linear interpolant.
void tell_samples(const Options& options, const Console& console, Json json) {
  const SamplesInput input = read_samples_input(options.volume.path, options.samples);
  const SampleField& field = input.field;
  const std::vector<float> values = rounded_values(field);
  const Findings findings = find(SampleStatistics(values), options.below, [&](const std::vector<Isosurface>& surfaces) {
    std::vector<VoxelTopology> topologies;
    for (const Isosurface& surface : surfaces) {
      throw_if_cancelled();
      topologies.push_back(count_samples_topology(field, surface));
    }
    return topologies;
  });
  Box3 box;
  for (const Point3& p : field.samples().points) box.extend(p);
  if (console.json()) {
    json["samples"] = {{"path", input.path},
                       {"format", input.format},
                       {"field", input.field_name},
                       {"count", values.size()},
                       {"merged", input.merged},
                       {"tets", field.tet_count()},
                       {"frame", to_string(field.samples().frame)},
                       {"box", {to_json(box.min), to_json(box.max)}},
                       {"hull_mm3", field.hull_mm3()},
                       {"spacing_mm", field.spacing()}};
    json.update(findings_json(findings));
    console.machine_result(text_of(json));
  }
  std::string text = input.sentence() + "\n";
  text += "box          " + point(box.min) + " to " + point(box.max) + " mm, frame " +
          to_string(field.samples().frame) + "\n";
  text += "hull         " + number(field.hull_mm3() / 1000, 5) + " ml, " + number(field.spacing()) +
          " mm from sample to sample\n";
  if (const std::string warning = input.warning(); !warning.empty()) text += "warning      " + warning + "\n";
  console.result(text + findings_text(findings));
}

}  // namespace

void run_info(const Verb& verb, const Arguments& arguments) {
  CLI::App app(std::string(verb.summary) + "\n", std::string("delvox ") + verb.name);
  Options options;
  add_options(app, options);
  const ThreadLimit threads(app);
  if (!parse_arguments(app, arguments)) return;

  const Console console(options.console);
  const bool samples = holds_samples(options.volume.path);
  refuse_options(app, options, samples);
  (samples ? tell_samples : tell_volume)(options, console, run_header(verb, arguments));
}

}  // namespace delvox::tools
