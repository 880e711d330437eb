#include <algorithm>

#include "delvox/core/errors.h"
#include "delvox/mesh_io/read_mesh.h"
#include "delvox/oracle/polygon_oracle.h"
#include "format.h"
#include "mesh_output.h"
#include "meshing_domain.h"
#include "signals.h"
#include "sizes.h"
#include "verdict.h"

namespace delvox::tools {
namespace {

constexpr double kSizesPerDiagonal = 60;

class PolygonDomain final : public MeshingDomain {
 public:
  explicit PolygonDomain(const MeshingOptions& options) : options_(options) {}

  void read(Stopwatch& watch, const Console& console) override {
    const std::string& path = options_.volume.path;
    const MeshFile file = watch.timed("reading", [&] { return read_mesh(path); });
    throw_if_cancelled();
    format_ = file.format;
    SurfaceMesh surface = surface_of(file.mesh);
    counts_ = describe_counts(Mesh(surface));
    console.note(path + ": " + format_ + ", " + counts_);
    own_frame_ = surface.info.frame;
    frame_ = FrameChange(own_frame_, options_.frame);
    try {
      oracle_ = watch.timed("oracle", [&] { return make_polygon_oracle(surface); });
    } catch (const InputError& error) {
      throw InputError(path + ": " + error.what());
    }
    for (const Triangle& triangle : surface.triangles) {
      for (std::uint32_t v : triangle) box_.extend(surface.points[v]);
    }
    if (options_.feature_angle_degrees) surface_ = std::move(surface);
    oracle_->for_each_patch([this](const DomainPatch& patch) { inside_mm3_ += patch.inside_mm3; });
  }

  FrameChange frame() const override { return frame_; }
  Frame own_frame() const override { return own_frame_; }
  const SurfaceMesh* polygons() const override { return surface_ ? &*surface_ : nullptr; }
  double default_size() const override { return box_.diagonal() / kSizesPerDiagonal; }
  std::string origin_of_default_size() const override { return "1/60 of the surface's diagonal"; }
  double guess_size(std::size_t tets) const override {
    return tools::guess_size(tets, inside_mm3_);
  }
  double min_ball_radius(const SizeField& size) const override { return polygon_ball_radii(size).min; }
  double thin_ball_radius(const SizeField& size) const override { return polygon_ball_radii(size).thin; }

  std::unique_ptr<Oracle> make_oracle(const SizeField&, Stopwatch&) override { return oracle_->clone(); }
  void finish(Mesh&) const override {}

  std::optional<Unmet> shortfall(const CheckReport& check) const override {
    return topology_shortfall(check, oracle_->topology(), "the input");
  }
  std::string advice() const override {
    return "where the surface is sharper than a right angle or thinner than the size, try a smaller --size, or see "
           "--report";
  }
  std::string how_to_shrink() const override { return "mesh a part of the surface"; }
  std::string sentence() const override { return format_ + " of " + counts_; }

  Json report() const override {
    const SurfaceTopology topology = *oracle_->topology();
    return {{"surface", {{"format", format_},
                         {"frame", to_string(own_frame_)},
                         {"box", {to_json(box_.min), to_json(box_.max)}},
                         {"components", topology.components},
                         {"euler", topology.euler}}}};
  }

 private:
  const MeshingOptions& options_;
  std::string format_, counts_;
  Frame own_frame_ = Frame::kUnknown;
  FrameChange frame_;
  Box3 box_;
  std::optional<SurfaceMesh> surface_;  // if it is to be compared with
  double inside_mm3_ = 0;
  std::unique_ptr<Oracle> oracle_;
};

}  // namespace

std::unique_ptr<MeshingDomain> make_polygon_domain(const MeshingOptions& options) {
  return std::make_unique<PolygonDomain>(options);
}

}  // namespace delvox::tools
