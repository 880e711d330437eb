#include "oracle/formula_crossings.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "oracle/bracketed_root.h"

namespace delvox {
namespace {

class CrossingSearch {
 public:
  CrossingSearch(const SmoothFunction& function, const Point3& a, const Point3& b, double coarse)
      : function_(function), a_(a), step_(b - a), coarse_(std::min(1.0, coarse / norm(b - a))) {}

  std::vector<double> run() {
    search({0, value(0)}, {1, value(1)});
    return std::move(found_);
  }

 private:
  struct End {
    double t = 0, value = 0;
    bool inside() const { return value <= 0; }
  };
  /// What intervals say of a piece.
  enum class Piece { kNoCrossing, kMonotonic, kUndecided, kUndefined };

  /// Undefined counts as positive, that is, as outside.
  double value(double t) const {
    double result = 0;
    function_.evaluate(a_ + t * step_, 0, &result);
    return std::isnan(result) ? 1 : result;
  }

  Piece look_at(const End& low, const End& high) {
    IntervalBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double from = a_[static_cast<int>(axis)], along = step_[static_cast<int>(axis)];
      box[axis] = Interval(from) + Interval(along) * Interval(low.t, high.t);
    }
    std::array<Interval, SmoothFunction::kResults[1]> results;
    const bool smooth = function_.enclose(box, 1, results.data());
    ++pieces_;
    Interval values = results[0];
    if (!values.bounded()) return Piece::kUndefined;
    if (values.low > 0 || values.high <= 0) return Piece::kNoCrossing;
    if (!smooth) return Piece::kUndecided;
    Interval slope = 0.0;
    for (int axis = 0; axis < 3; ++axis)
      slope = slope + results[static_cast<std::size_t>(axis) + 1] * Interval(step_[axis]);
    if (!slope.bounded()) return Piece::kUndecided;
    return slope.low > 0 || slope.high < 0 ? Piece::kMonotonic : Piece::kUndecided;
  }

  void search(const End& low, const End& high) {
    constexpr int kMostPieces = 4096;
    constexpr double kFinest = 0x1p-44;
    const Piece piece = look_at(low, high);
    if (piece == Piece::kNoCrossing && low.inside() == high.inside()) return;
    const bool coarsely = piece == Piece::kUndefined || pieces_ > kMostPieces;
    if (piece == Piece::kMonotonic || high.t - low.t <= (coarsely ? coarse_ : kFinest)) {
      if (low.inside() != high.inside()) found_.push_back(root(low, high));
      return;
    }
    const double t = 0.5 * (low.t + high.t);
    const End middle{t, value(t)};
    search(low, middle);
    search(middle, high);
  }

  double root(const End& low, const End& high) const {
    return bracketed_root([this](double t) { return value(t); }, low.t, low.value, high.t, high.value,
                          std::min(std::abs(low.value), std::abs(high.value)));
  }

  const SmoothFunction& function_;
  Point3 a_;
  Vector3 step_;
  double coarse_;
  int pieces_ = 0;
  std::vector<double> found_;
};

}  // namespace

std::vector<double> formula_crossings(const SmoothFunction& function, const Point3& a, const Point3& b, double coarse) {
  if (a == b) return {};
  return CrossingSearch(function, a, b, coarse).run();
}

}  // namespace delvox
