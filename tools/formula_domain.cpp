#include <algorithm>
#include <cmath>

#include "delvox/core/errors.h"
#include "delvox/oracle/formula.h"
#include "formula_flags.h"
#include "meshing_domain.h"
#include "sizes.h"

namespace delvox::tools {
namespace {

constexpr double kSizesPerDiagonal = 40;
constexpr double kMinBallRadiusSizes = 0.001;

class FormulaDomain final : public MeshingDomain {
 public:
  explicit FormulaDomain(const MeshingOptions& options)
      : formula_(options.implicit), box_(parse_box(options.box)), frame_(Frame::kUnknown, options.frame) {}

  void read(Stopwatch&, const Console&) override {}

  FrameChange frame() const override { return frame_; }
  Frame own_frame() const override { return Frame::kUnknown; }
  double default_size() const override { return box_.diagonal() / kSizesPerDiagonal; }
  std::string origin_of_default_size() const override { return "1/40 of the box's diagonal"; }
  double guess_size(std::size_t tets) const override {
    double inside_mm3 = 0;
    make_formula_oracle(formula_, box_, resolution_for(default_size()))
        ->for_each_patch([&](const DomainPatch& patch) { inside_mm3 += patch.inside_mm3; });
    return tools::guess_size(tets, inside_mm3);
  }
  double min_ball_radius(const SizeField& size) const override {
    return kMinBallRadiusSizes * std::min(size.minimum(), default_size());
  }
  double thin_ball_radius(const SizeField&) const override { return 0; }

  std::unique_ptr<Oracle> make_oracle(const SizeField& size, Stopwatch& watch) override {
    return watch.timed("oracle", [&] { return make_formula_oracle(formula_, box_, resolution_for(size.minimum())); });
  }

  std::optional<SmoothDomain> smooth() const override { return SmoothDomain{make_smooth_function(formula_), box_, {}}; }

  void finish(Mesh&) const override {}
  std::string how_to_shrink() const override { return "take a tighter --box"; }
  std::string sentence() const override { return "formula " + formula_.text(); }
  Json report() const override {
    return {{"formula", formula_.text()}, {"box", {{"min", to_json(box_.min)}, {"max", to_json(box_.max)}}}};
  }

 private:
  /// Half the size, within what a grid over the box can show in reasonable time.
  double resolution_for(double size) const {
    constexpr double kFewestSamples = 1e6, kMostSamples = 2e7, kSamplesAcross = 8;
    const Vector3 extent = box_.max - box_.min;
    const double volume = extent.x * extent.y * extent.z;
    const double across = std::min({extent.x, extent.y, extent.z}) / kSamplesAcross;
    return std::max(std::min({size / 2, across, std::cbrt(volume / kFewestSamples)}), std::cbrt(volume / kMostSamples));
  }

  Formula formula_;
  Box3 box_;
  FrameChange frame_;
};

}  // namespace

std::unique_ptr<MeshingDomain> make_formula_domain(const MeshingOptions& options) {
  return std::make_unique<FormulaDomain>(options);
}

}  // namespace delvox::tools
