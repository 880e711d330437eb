#include "volume_input.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <numbers>

#include "delvox/core/errors.h"
#include "delvox/volume/histogram.h"
#include "delvox/volume/preprocess.h"
#include "delvox/volume/voxel_topology.h"
#include "format.h"
#include "signals.h"
#include "validators.h"

namespace delvox::tools {
namespace {

Vector3 parse_spacing(const std::string& text) {
  const std::vector<std::string> pieces = split(text, ',');
  if (pieces.size() != 3) throw OptionError("--spacing: '" + text + "' is not three numbers; give sx,sy,sz in mm");
  Vector3 spacing;
  for (int axis = 0; axis < 3; ++axis) {
    spacing[axis] = parse_number(pieces[static_cast<std::size_t>(axis)], "--spacing");
    if (!(spacing[axis] > 0)) throw OptionError("--spacing: '" + text + "' is not positive; give sx,sy,sz in mm");
  }
  return spacing;
}

// Ends a pass at Ctrl-C.
class CancellableReader final : public SliceReader {
 public:
  explicit CancellableReader(std::unique_ptr<SliceReader> reader) : reader_(std::move(reader)) {}
  void read(int count, float* out) override {
    throw_if_cancelled();
    reader_->read(count, out);
  }
  std::vector<std::string> warnings() const override { return reader_->warnings(); }

 private:
  std::unique_ptr<SliceReader> reader_;
};

class CancellableSource final : public VolumeSource {
 public:
  explicit CancellableSource(VolumeSourcePtr source) : VolumeSource(source->header()), source_(std::move(source)) {}
  std::unique_ptr<SliceReader> start() const override { return std::make_unique<CancellableReader>(source_->start()); }
  const float* samples() const override { return source_->samples(); }

 private:
  VolumeSourcePtr source_;
};

}  // namespace

void add_reading_options(CLI::App& app, VolumeInputOptions& options) {
  app.add_option_function<std::string>(
         "--spacing", [&options](const std::string& text) { options.read.spacing = parse_spacing(text); },
         "Voxel spacing in mm, for files that do not state it (TIFF)")
      ->type_name("SX,SY,SZ");
  app.add_option("--volume-index", options.read.volume_index, "Which volume of a 4D file, from 0")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->type_name("N");
}

void add_preprocessing_options(CLI::App& app, VolumeInputOptions& options) {
  app.add_option("--crop", options.crop,
                 "Keep a part: voxel indices x0:x1,y0:y1,z0:z1 (x1 excluded; either may be left out), or with suffix "
                 "mm world coordinates")
      ->type_name("BOX");
  app.add_option("--resample", options.resample, "Then resample to cubic voxels of this edge, mm")
      ->check(finite_number(Zero::kExcluded))
      ->type_name("MM");
  app.add_option("--smooth", options.smooth, "Then smooth with a Gaussian of this sigma, mm")
      ->check(finite_number(Zero::kAllowed))
      ->type_name("SIGMA");
}

void add_isovalue_options(CLI::App& app, IsosurfaceOptions& options) {
  app.add_option("--iso", options.iso,
                 "Isovalue, inside is at or above it: a number, otsu, otsu3:2 (second of three classes' thresholds), "
                 "p97.5 (percentile) or at:x,y,z (value at a world point)")
      ->capture_default_str()
      ->type_name("V");
  app.add_flag("--below", options.below, "Inside is at or below the isovalue");
}

void add_component_options(CLI::App& app, IsosurfaceOptions& options) {
  app.add_flag("--largest", options.largest, "Keep the largest component only");
  app.add_option("--min-component", options.min_component,
                 "Take out components and cavities smaller than this, mm3; 0 keeps all (default: the volume of one "
                 "surface ball, 4/3 pi size^3)")
      ->check(finite_number(Zero::kAllowed))
      ->type_name("MM3");
  app.add_flag("--fill-cavities", options.fill_cavities, "Fill cavities");
}

VolumeSourcePtr cancellable(VolumeSourcePtr source) { return std::make_shared<CancellableSource>(std::move(source)); }

VolumeInput open_input(const VolumeInputOptions& options, const std::string& frame) {
  VolumeSourcePtr source = cancellable(open_volume(options.path, options.read));
  VolumeInput input{source->header(), FrameChange(source->header().frame, frame), nullptr};
  if (!options.crop.empty()) {
    source = crop(source, parse_crop(source->header(), input.frame.crop_in_volume(options.crop)));
  }
  if (options.resample > 0) source = resample(source, {.spacing_mm = options.resample});
  if (options.smooth > 0) source = smooth(source, {.sigma_mm = options.smooth});
  input.source = std::move(source);
  return input;
}

VolumeSourcePtr kept_if_small(const VolumeSourcePtr& source) {
  constexpr std::size_t kSmall = std::size_t{1} << 27;  // samples: 512 MB
  return source->voxel_count() <= kSmall ? in_memory(*source) : source;
}

void tell_warnings(const VolumeHeader& header, const VolumeInputOptions& options, const Console& console) {
  for (const std::string& warning : header.warnings) console.note("warning: " + options.path + ": " + warning);
}

ChosenIsosurface choose_isosurface(const VolumeSource& source, const IsosurfaceOptions& options,
                                   const FrameChange& frame) {
  const IsovalueChoice choice = choose_isovalue(source, frame.iso_in_volume(options.iso));
  return {{choice.value, options.below}, choice.sentence + (options.below ? ", inside is at or below" : "")};
}

void carry_isosurface(const Isosurface& surface, Mesh& mesh) {
  MeshInfo& info = std::visit([](auto& m) -> MeshInfo& { return m.info; }, mesh);
  info.isovalue = surface.isovalue;
  info.below = surface.below;
}

void check_isosurface(const ChosenIsosurface& chosen, const Volume& volume) {
  check_isovalue({chosen.surface.isovalue, chosen.sentence}, volume);
}

FilteredVolume filter_volume(const Volume& volume, const Isosurface& surface, const IsosurfaceOptions& options,
                             double size) {
  const double ball = 4.0 / 3.0 * std::numbers::pi * size * size * size;
  const double least = options.min_component.value_or(ball);
  FilteredVolume filtered = filter_components(volume, surface, {options.largest, least, options.fill_cavities});
  const FilterReport& report = filtered.report;
  if (report.kept_components == 0 && report.removed_components > 0) {
    throw NothingToMesh("all of " + plural(report.removed_components, "component") + " lie below --min-component " +
                        number(least) + " mm3; lower it, or give a smaller --size");
  }
  return filtered;
}

std::string describe(const FilterReport& report) {
  if (report.removed_components == 0 && report.filled_cavities == 0) return {};
  std::string text = plural(report.kept_components, "component") + " kept";
  if (report.removed_components > 0) {
    text += "; " + plural(report.removed_components, "component") + " taken out (" + number(report.removed_mm3) + " mm3)";
  }
  if (report.filled_cavities > 0) {
    text += "; " + grouped(report.filled_cavities) + (report.filled_cavities == 1 ? " cavity" : " cavities") +
            " filled (" + number(report.filled_mm3) + " mm3)";
  }
  return text;
}

}  // namespace delvox::tools
