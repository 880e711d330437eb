#include <algorithm>
#include <array>
#include <optional>

#include "delvox/core/errors.h"
#include "delvox/oracle/isosurface_oracle.h"
#include "delvox/oracle/spline_function.h"
#include "delvox/volume/peel.h"
#include "format.h"
#include "meshing_domain.h"
#include "open_border.h"
#include "sizes.h"
#include "verdict.h"

namespace delvox::tools {
namespace {

constexpr double kMinBallRadiusVoxels = 0.0001, kThinBallRadiusVoxels = 0.25;
// The trilinear surface has a crease at every face of a voxel.
constexpr double kMinSmoothRadiusVoxels = 0.5;

/// Whether an isovalue takes passes over the samples: all but a number do.
bool needs_samples(const std::string& iso) {
  return iso.empty() || iso.find_first_not_of("0123456789.eE+-") != std::string::npos;
}

bool fits_spline(const std::array<int, 3>& dims) {
  return std::all_of(dims.begin(), dims.end(), [](int n) { return n <= kMostSplineSamples; });
}

class VolumeDomain final : public MeshingDomain {
 public:
  explicit VolumeDomain(const MeshingOptions& options) : options_(options) {}

  // Opens the volume, chooses the isovalue, and reads what lies near its surface.
  void read(Stopwatch& watch, const Console& console) override {
    const VolumeInput input = open_input(options_.volume, options_.frame);
    file_header_ = input.file_header;
    frame_ = input.frame;
    VolumeSourcePtr source = input.source;
    if (needs_samples(options_.isosurface.iso)) {
      source = watch.timed("reading", [&] { return kept_if_small(source); });
    }
    chosen_ = watch.timed("isovalue", [&] { return choose_isosurface(*source, options_.isosurface, frame_); });
    ties_.emplace(chosen_.surface);
    // The spline that DelSurf2 meshes depends on all samples.
    const auto near = options_.algorithm == "delsurf2" && fits_spline(source->dims()) ? std::nullopt
                                                                                      : std::optional(chosen_.surface);
    volume_ = watch.timed("reading", [&] { return load(*source, near, &*ties_); });
    const VolumeHeader& h = volume_->header();
    tell_warnings(h, options_.volume, console);
    check_isosurface(chosen_, *volume_);
    console.detail(options_.volume.path + ": " + file_header_.format + "; meshing " + std::to_string(h.dims[0]) + " x " +
                   std::to_string(h.dims[1]) + " x " + std::to_string(h.dims[2]) + " voxels of " + point(h.spacing()) +
                   " mm, " + h.orientation());
    console.note(chosen_.sentence);
    if (const std::string text = advice(); !text.empty()) console.note("note: " + text);
  }

  FrameChange frame() const override { return frame_; }
  Frame own_frame() const override { return volume_->header().frame; }
  std::optional<VolumeHeader> image() const override { return volume_->header(); }
  std::optional<Volume> samples(int layers) const override {
    const Volume whole = load(*open_input(options_.volume, options_.frame).source);
    return layers > 0 ? peeled(whole, chosen_.surface, layers) : whole;
  }
  double default_size() const override { return tools::default_size(*volume_, chosen_.surface); }
  std::string origin_of_default_size() const override { return "from the organ's extent and the voxels"; }
  double guess_size(std::size_t tets) const override { return tools::guess_size(tets, *volume_, chosen_.surface); }
  double min_ball_radius(const SizeField&) const override { return kMinBallRadiusVoxels * smallest_spacing(); }
  double thin_ball_radius(const SizeField&) const override { return kThinBallRadiusVoxels * smallest_spacing(); }
  double min_smooth_radius(const SizeField&) const override { return kMinSmoothRadiusVoxels * smallest_spacing(); }

  std::unique_ptr<Oracle> make_oracle(const SizeField& size, Stopwatch& watch) override {
    const FilteredVolume filtered = watch.timed(
        "components", [&] { return filter_volume(*volume_, chosen_.surface, options_.isosurface, size.minimum()); });
    filter_report_ = filtered.report;
    return watch.timed("oracle", [&] { return make_isosurface_oracle(filtered.volume, chosen_.surface); });
  }
  bool may_vanish() const override { return !options_.isosurface.min_component; }
  std::optional<SmoothDomain> smooth() const override { return make_spline_domain(*volume_, chosen_.surface); }

  void finish(Mesh& mesh) const override {
    if (options_.border == "open") mesh = open_at_border(std::get<SurfaceMesh>(mesh), volume_->header());
    if (options_.algorithm == "delsurf2") return;  // its nodes lie on the spline, not on the trilinear isosurface
    carry_isosurface(chosen_.surface, mesh);
  }

  std::optional<Unmet> shortfall(const CheckReport& check) const override {
    const std::size_t wanted = filter_report_.kept_components;
    const std::size_t pieces = check.statistics.surface_components - check.statistics.cavities;
    if (wanted == 0 || pieces == wanted || options_.border == "open") return std::nullopt;
    return Unmet{"topology", 1, std::nullopt,
                 "the mesh is in " + plural(pieces, "piece") + ", the isosurface in " + grouped(wanted) +
                     ": parts thinner than the size",
                 false};
  }

  std::string left_out() const override { return describe(filter_report_); }
  std::string advice() const override { return advice_on(*ties_); }
  std::string how_to_shrink() const override { return "--crop or --resample the volume"; }
  std::string sentence() const override { return chosen_.sentence; }

  Json report() const override {
    return {{"volume", to_json(file_header_)},
            {"meshed_volume", to_json(volume_->header())},
            {"isovalue", chosen_.surface.isovalue},
            {"isovalue_choice", chosen_.sentence},
            {"below", chosen_.surface.below},
            {"components", to_json(filter_report_)}};
  }

 private:
  double smallest_spacing() const {
    const Vector3 spacing = volume_->header().spacing();
    return std::min({spacing.x, spacing.y, spacing.z});
  }

  const MeshingOptions& options_;
  VolumeHeader file_header_;
  FrameChange frame_;
  ChosenIsosurface chosen_;
  std::optional<Ties> ties_;
  std::optional<Volume> volume_;
  FilterReport filter_report_;
};

}  // namespace

std::unique_ptr<MeshingDomain> make_volume_domain(const MeshingOptions& options) {
  return std::make_unique<VolumeDomain>(options);
}

}  // namespace delvox::tools
