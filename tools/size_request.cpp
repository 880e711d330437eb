#include "size_request.h"

#include <algorithm>
#include <cmath>

#include "delvox/core/errors.h"
#include "delvox/meshing/feature_size.h"
#include "format.h"
#include "signals.h"
#include "sizes.h"

namespace delvox::tools {
namespace {

const GoOn kUntilCancelled = [] {
  throw_if_cancelled();
  return true;
};

/// Calls visit(p) for points of the surface, and of a grid over the inside.
template <class Visit>
void for_each_place(const Oracle& oracle, double spacing, const Visit& visit) {
  for (const Point3& p : oracle.seeds(SizeField(spacing), kUntilCancelled).points) visit(p);
  constexpr int kAcross = 32;
  const Box3 box = oracle.bounds();
  const Vector3 step = (1.0 / kAcross) * (box.max - box.min);
  for (int i = 0; i < kAcross * kAcross * kAcross; ++i) {
    const Vector3 at{i % kAcross + 0.5, i / kAcross % kAcross + 0.5, i / (kAcross * kAcross) + 0.5};
    const Point3 p = box.min + Vector3{at.x * step.x, at.y * step.y, at.z * step.z};
    if (oracle.label(p) != 0) visit(p);
  }
}

SizeField formula_size(const Formula& formula, const Oracle& oracle, double spacing, const FrameChange& frame) {
  double least = Box3::kInfinity, most = 0;
  for_each_place(oracle, spacing, [&](const Point3& p) {
    const double size = formula.value(frame(p));
    if (!(size > 0 && std::isfinite(size))) {
      throw OptionError("--size '" + formula.text() + "': is " + number(size) + " at " + point(frame(p)) +
                        "; sizes must be positive on all of the surface and its inside");
    }
    least = std::min(least, size);
    most = std::max(most, size);
  });
  if (!(most > 0)) throw NothingToMesh("the surface is empty");
  return SizeField(
      [formula, frame, least, most](const Point3& p) {
        const double size = formula.value(frame(p));
        return size >= least ? std::min(size, most) : least;  // also where it is undefined
      },
      least, most);
}

}  // namespace

SizeRequest::SizeRequest(const std::string& text, Frame frame) : text_(text) {
  if (text == "lfs" || text == "curvature") {
    kind_ = text == "lfs" ? Kind::kFeature : Kind::kCurvature;
    return;
  }
  if (is_size_field(text)) {
    field_ = parse_size(text, "--size", frame);
    return;
  }
  kind_ = Kind::kFormula;
  try {
    formula_.emplace(text);
  } catch (const OptionError& error) {
    throw OptionError("--size: '" + text +
                      "' is neither a number, a volume file, lfs, curvature nor a formula: " + error.what());
  }
}

SizeField SizeRequest::on(const Oracle& oracle, double spacing, double epsilon, const FrameChange& frame) const {
  if (kind_ == Kind::kField) return *field_;
  if (kind_ == Kind::kFormula) return formula_size(*formula_, oracle, spacing, frame);
  const double least = 2 * epsilon * spacing, most = std::max(least, epsilon * oracle.bounds().diagonal());
  if (kind_ == Kind::kFeature) {
    return scaled(local_feature_size(oracle, spacing, kUntilCancelled), epsilon, least, most);
  }
  const auto* smooth = dynamic_cast<const SmoothOracle*>(&oracle);
  if (smooth == nullptr) throw OptionError("--size curvature: neither polygon surfaces nor samples have one; --size lfs is for those too");
  return scaled(curvature_radius(*smooth, spacing, kUntilCancelled), epsilon, least, most);
}

SizeField SizeRequest::cells_on(const Oracle& oracle, double spacing, const SizeField& size) const {
  if (kind_ != Kind::kFeature) return size;
  std::vector<Point3> points = oracle.seeds(SizeField(spacing), kUntilCancelled).points;
  std::vector<double> lengths;
  for (const Point3& p : points) lengths.push_back(size(p));
  return scaled(FeatureSize(std::move(points), std::move(lengths)), 1, size.minimum(), oracle.bounds().diagonal());
}

}  // namespace delvox::tools
