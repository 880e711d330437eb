#pragma once

#include <memory>
#include <optional>
#include <string>

#include "console.h"
#include "delvox/core/mesh.h"
#include "delvox/core/size_field.h"
#include "delvox/oracle/oracle.h"
#include "delvox/oracle/spline_function.h"
#include "meshing_options.h"
#include "patient_frame.h"
#include "report_json.h"
#include "stopwatch.h"

namespace delvox::tools {

/// What a meshing verb meshes, as the steps of a run see it. Coordinates are those of the input until the run's end.
class MeshingDomain {
 public:
  virtual ~MeshingDomain() = default;

  /// Reads the input, and says what was chosen where the options leave a choice.
  virtual void read(Stopwatch& watch, const Console& console) = 0;

  /// From the input's patient frame to that of the output.
  virtual FrameChange frame() const = 0;
  /// The frame that the input states, for size fields.
  virtual Frame own_frame() const = 0;
  /// The image that the domain is cut off by, if there is one: for sets on its border.
  virtual std::optional<VolumeHeader> image() const { return std::nullopt; }
  /// All samples of the image, in the input's frame, `layers` voxels at the surface replaced by what lies further in.
  virtual std::optional<Volume> samples(int layers) const {
    (void)layers;
    return std::nullopt;
  }
  /// The polygon surface that is meshed, in the input's frame, or null.
  virtual const SurfaceMesh* polygons() const { return nullptr; }
  /// A size for a run that was given none, mm, and where it comes from.
  virtual double default_size() const = 0;
  virtual std::string origin_of_default_size() const = 0;
  /// A guess at the size that gives `tets` tets.
  virtual double guess_size(std::size_t tets) const = 0;
  /// Defaults of SurfaceCriteria for surfaces refined to `size`, mm.
  virtual double min_ball_radius(const SizeField& size) const = 0;
  virtual double thin_ball_radius(const SizeField& size) const = 0;
  virtual double min_smooth_radius(const SizeField& size) const { return 0.05 * size.minimum(); }

  /// The oracle for a run at `size`. Throws NothingToMesh if nothing is left at that size.
  virtual std::unique_ptr<Oracle> make_oracle(const SizeField& size, Stopwatch& watch) = 0;
  /// For DelSurf2, if the domain can be had as that.
  virtual std::optional<SmoothDomain> smooth() const { return std::nullopt; }
  /// Whether a larger size may have nothing to mesh where a smaller one has.
  virtual bool may_vanish() const { return false; }

  /// What the mesh, still in the input's frame, is to say of where it comes from.
  virtual void finish(Mesh& mesh) const = 0;
  /// What was left out of the input for the last oracle; empty if nothing was.
  virtual std::string left_out() const { return {}; }
  /// What the mesh, as it was checked, lacks of the input though every promise holds, if the oracle has not noted that.
  virtual std::optional<Unmet> shortfall(const CheckReport&) const { return std::nullopt; }
  /// What to do about promises that do not hold; empty if there is nothing better than the usual.
  virtual std::string advice() const { return {}; }
  /// What could be given in place of the options that did not fit, "--crop or --resample the volume".
  virtual std::string how_to_shrink() const = 0;
  /// One line on what was meshed, for the summary; may be empty.
  virtual std::string sentence() const = 0;
  /// What the report says of the input.
  virtual Json report() const = 0;
};

/// Of surfaces made of polygons: repair of the topology ends at `min`; from `thin` on it gives up if the smaller the
/// balls, the more of them it takes.
struct PolygonBallRadii {
  double min, thin;
};
inline PolygonBallRadii polygon_ball_radii(const SizeField& size) {
  return {0.001 * size.minimum(), 0.25 * size.minimum()};
}

/// The isosurface of a volume. Keeps a reference to the options.
std::unique_ptr<MeshingDomain> make_volume_domain(const MeshingOptions& options);
/// The domain of --implicit and --box. Throws OptionError: the formula or the box does not parse.
std::unique_ptr<MeshingDomain> make_formula_domain(const MeshingOptions& options);
/// What a polygon surface encloses. Keeps a reference to the options.
std::unique_ptr<MeshingDomain> make_polygon_domain(const MeshingOptions& options);
/// The isosurface of scattered samples. Keeps a reference to the options.
std::unique_ptr<MeshingDomain> make_samples_domain(const MeshingOptions& options);

}  // namespace delvox::tools
