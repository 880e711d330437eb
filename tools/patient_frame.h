#pragma once

#include <string>

#include "delvox/core/mesh.h"
#include "delvox/core/run.h"
#include "delvox/meshing/remove_slivers.h"

namespace CLI {
class App;
}

namespace delvox::tools {

/// --frame ras|lps; empty: the volume's own.
void add_frame_option(CLI::App& app, std::string& frame);

/// From the frame of a volume to the frame that the user works in, and back: RAS and LPS differ by the signs of x and y,
/// a half turn, so it is its own inverse and keeps orientation.
class FrameChange {
 public:
  FrameChange() = default;
  /// `wanted`: "ras", "lps", or empty for the volume's own. A volume that states no frame is taken to be in the wanted
  /// one.
  FrameChange(Frame of_volume, const std::string& wanted);

  Frame target() const { return target_; }
  bool turns() const { return turns_; }
  Point3 operator()(const Point3& p) const { return turns_ ? Point3{-p.x, -p.y, p.z} : p; }
  /// Carries a mesh from the volume's frame to the target, and labels it.
  void apply(Mesh& mesh) const;
  /// The places that a report names.
  void apply(RunReport& report) const;
  void apply(SliverReport& report) const;
  /// --iso at:x,y,z and --crop x0:x1,y0:y1,z0:z1mm with their world coordinates carried to the volume's frame; other
  /// texts are returned as they are.
  std::string iso_in_volume(const std::string& text) const;
  std::string crop_in_volume(const std::string& text) const;

 private:
  Frame target_ = Frame::kUnknown;
  bool turns_ = false;
};

}  // namespace delvox::tools
