#include <algorithm>

#include "delvox/core/errors.h"
#include "format.h"
#include "meshing_domain.h"
#include "samples_input.h"
#include "signals.h"
#include "sizes.h"
#include "verdict.h"

namespace delvox::tools {
namespace {

constexpr double kSizesPerDiagonal = 60;

class SamplesDomain final : public MeshingDomain {
 public:
  explicit SamplesDomain(const MeshingOptions& options) : options_(options) {}

  void read(Stopwatch& watch, const Console& console) override {
    input_.emplace(watch.timed("reading", [&] { return read_samples_input(options_.volume.path, options_.samples); }));
    throw_if_cancelled();
    const SampleField& field = input_->field;
    frame_ = FrameChange(field.samples().frame, options_.frame);
    console.note(input_->sentence());
    if (const std::string text = input_->warning(); !text.empty()) console.note("warning: " + text);
    chosen_ = watch.timed("isovalue", [&] { return choose_isosurface(field, options_.isosurface, frame_); });
    console.note(chosen_.sentence);
    if (const std::string text = advice(); !text.empty()) console.note("note: " + text);
    inside_ = field.inside(chosen_.surface);
    if (inside_.on_hull) {
      console.note("note: the inside reaches the convex hull of the samples: the surface closes along it");
    }
    const Interpolation how =
        options_.samples.interpolation == "natural" ? Interpolation::kNatural : Interpolation::kLinear;
    oracle_ = watch.timed("oracle", [&] { return make_samples_oracle(field, chosen_.surface, how); });
  }

  FrameChange frame() const override { return frame_; }
  Frame own_frame() const override { return input_->field.samples().frame; }
  double default_size() const override {
    return std::max(inside_.box.diagonal() / kSizesPerDiagonal, input_->field.spacing());
  }
  std::string origin_of_default_size() const override {
    return "from the extent of the inside and the spacing of the samples";
  }
  double guess_size(std::size_t tets) const override { return tools::guess_size(tets, inside_.mm3); }
  double min_ball_radius(const SizeField& size) const override { return polygon_ball_radii(size).min; }
  double thin_ball_radius(const SizeField& size) const override { return polygon_ball_radii(size).thin; }

  std::unique_ptr<Oracle> make_oracle(const SizeField&, Stopwatch&) override { return oracle_->clone(); }

  void finish(Mesh& mesh) const override { carry_isosurface(chosen_.surface, mesh); }

  std::optional<Unmet> shortfall(const CheckReport& check) const override {
    return topology_shortfall(check, oracle_->topology(), "the linear interpolant");
  }
  std::string advice() const override { return advice_on_ties(input_->field, chosen_.surface); }
  std::string how_to_shrink() const override { return "leave out samples away from what is to be meshed"; }
  std::string sentence() const override {
    return chosen_.sentence + ", " + options_.samples.interpolation + " between " +
           plural(input_->field.samples().points.size(), "sample");
  }

  Json report() const override {
    const Box3 box = [&] {
      Box3 result;
      for (const Point3& p : input_->field.samples().points) result.extend(p);
      return result;
    }();
    Json json = {{"samples",
                  {{"format", input_->format},
                   {"field", input_->field_name},
                   {"count", input_->field.samples().points.size()},
                   {"merged", input_->merged},
                   {"tets", input_->field.tet_count()},
                   {"frame", to_string(own_frame())},
                   {"box", {to_json(box.min), to_json(box.max)}},
                   {"spacing_mm", input_->field.spacing()},
                   {"interpolation", options_.samples.interpolation}}},
                 {"isovalue", chosen_.surface.isovalue},
                 {"isovalue_choice", chosen_.sentence},
                 {"below", chosen_.surface.below},
                 {"inside_mm3", inside_.mm3},
                 {"closed_along_hull", inside_.on_hull}};
    if (const auto topology = oracle_->topology()) {
      json["samples"]["surface_components"] = topology->components;
      json["samples"]["euler"] = topology->euler;
    }
    return json;
  }

 private:
  const MeshingOptions& options_;
  std::optional<SamplesInput> input_;
  FrameChange frame_;
  ChosenIsosurface chosen_;
  SampleField::Inside inside_;
  std::unique_ptr<Oracle> oracle_;
};

}  // namespace

std::unique_ptr<MeshingDomain> make_samples_domain(const MeshingOptions& options) {
  return std::make_unique<SamplesDomain>(options);
}

}  // namespace delvox::tools
