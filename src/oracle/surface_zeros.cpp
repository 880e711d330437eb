#include "oracle/surface_zeros.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/frame.h"

namespace delvox {
namespace {

using Results = std::array<Interval, SmoothFunction::kResults[3]>;
using IntervalVector3 = IntervalVector<3>;

/// Boxes of a search that is not to be decided within so many never are.
constexpr std::size_t kMostBoxes = 50'000;

constexpr auto& kHessian = SmoothFunction::kSecond;
constexpr auto& kThird = SmoothFunction::kThird;

IntervalVector3 gradient_of(const Results& r) {
  return {r[1], r[2], r[3]};
}
/// H w.
IntervalVector3 hessian_times(const Results& r, const Vector3& w) {
  IntervalVector3 product;
  for (std::size_t i = 0; i < 3; ++i)
    product[i] = project(w, {r[kHessian[i][0]], r[kHessian[i][1]], r[kHessian[i][2]]});
  return product;
}
IntervalVector3 cross(const IntervalVector3& a, const IntervalVector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// h along the line a + t ab.
class LineSystem final : public ZeroSystem<1> {
 public:
  LineSystem(const SmoothFunction& function, const Point3& a, const Vector3& ab)
      : function_(function), a_(a), ab_(ab) {}

  bool enclose(const IntervalVector<1>& t, IntervalVector<1>& f, IntervalMatrix<1>& jacobian) const override {
    IntervalBox box;
    for (std::size_t i = 0; i < 3; ++i) {
      box[i] = Interval(a_[static_cast<int>(i)]) + Interval(ab_[static_cast<int>(i)]) * t[0];
    }
    Results r;
    const bool smooth = function_.enclose(box, 1, r.data());
    f[0] = r[0];
    jacobian[0][0] = project(ab_, gradient_of(r));
    return smooth;
  }

 private:
  const SmoothFunction& function_;
  Point3 a_;
  Vector3 ab_;
};

class CriticalPointSystem final : public ZeroSystem<3> {
 public:
  CriticalPointSystem(const SmoothFunction& function, const Vector3& direction) : function_(function) {
    find_frame(direction, u_, v_);
  }
  const Vector3& u() const { return u_; }
  const Vector3& v() const { return v_; }

  bool enclose(const IntervalVector<3>& x, IntervalVector<3>& f, IntervalMatrix<3>& jacobian) const override {
    Results r;
    const bool smooth = function_.enclose(x, 2, r.data());
    const IntervalVector3 gradient = gradient_of(r);
    f = {r[0], project(u_, gradient), project(v_, gradient)};
    jacobian = {gradient, hessian_times(r, u_), hessian_times(r, v_)};
    return smooth;
  }

 private:
  const SmoothFunction& function_;
  Vector3 u_, v_;
};

class PlaneSystem final : public ZeroSystem<2> {
 public:
  PlaneSystem(const SmoothFunction& function, const PlanePart& part, const Vector3& direction)
      : function_(function), part_(part), direction_(direction) {}

  IntervalBox box_of(const IntervalVector<2>& x) const {
    IntervalBox box;
    for (int i = 0; i < 3; ++i) {
      box[static_cast<std::size_t>(i)] =
          Interval(part_.origin[i]) + Interval(part_.u[i]) * x[0] + Interval(part_.v[i]) * x[1];
    }
    return box;
  }

  bool enclose(const IntervalVector<2>& x, IntervalVector<2>& f, IntervalMatrix<2>& jacobian) const override {
    Results r;
    const bool smooth = function_.enclose(box_of(x), 2, r.data());
    const IntervalVector3 gradient = gradient_of(r), along = hessian_times(r, direction_);
    f = {r[0], project(direction_, gradient)};
    jacobian = {IntervalVector<2>{project(part_.u, gradient), project(part_.v, gradient)},
                IntervalVector<2>{project(part_.u, along), project(part_.v, along)}};
    return smooth;
  }
  bool outside(const IntervalVector<2>& x) const override { return delvox::outside(part_.region, box_of(x)); }

 private:
  const SmoothFunction& function_;
  const PlanePart& part_;
  Vector3 direction_;
};

class SilhouetteSystem final : public ZeroSystem<3> {
 public:
  SilhouetteSystem(const SmoothFunction& function, const ConvexRegion& region, const Vector3& d, const Vector3& d_prime)
      : function_(function), region_(region), d_(d), d_prime_(d_prime) {}

  bool enclose(const IntervalVector<3>& x, IntervalVector<3>& f, IntervalMatrix<3>& jacobian) const override {
    Results r;
    const bool smooth = function_.enclose(x, 3, r.data());
    const IntervalVector3 gradient = gradient_of(r), along = hessian_times(r, d_);
    f = {r[0], project(d_, gradient), project(d_prime_, cross(gradient, along))};
    jacobian = {gradient, along, IntervalVector3{}};
    for (std::size_t k = 0; k < 3; ++k) {
      IntervalVector3 gradient_k, along_k;  // derivatives along axis k
      for (std::size_t i = 0; i < 3; ++i) {
        gradient_k[i] = r[kHessian[i][k]];
        along_k[i] = project(d_, {r[kThird[i][k][0]], r[kThird[i][k][1]], r[kThird[i][k][2]]});
      }
      jacobian[2][k] = project(d_prime_, cross(gradient_k, along)) + project(d_prime_, cross(gradient, along_k));
    }
    return smooth;
  }
  bool outside(const IntervalVector<3>& x) const override { return delvox::outside(region_, x); }

 private:
  const SmoothFunction& function_;
  const ConvexRegion& region_;
  Vector3 d_, d_prime_;
};

/// The middles of the boxes, as points.
template <std::size_t N, class PointOf>
FoundPoints found_in(const Zeros<N>& zeros, const PointOf& point_of) {
  FoundPoints found;
  for (const auto& x : zeros.simple) found.points.push_back(point_of(x));
  for (const auto& x : zeros.undecided) found.undecided.push_back(point_of(x));
  return found;
}

const auto kMiddle = [](const IntervalVector3& x) { return middle_of(x); };

}  // namespace

FoundPoints find_crossings(const SurfaceCover& cover, const Point3& a, const Point3& b) {
  const Vector3 ab = b - a;
  const LineSystem system(cover.function(), a, ab);
  const auto point = [&](const IntervalVector<1>& t) { return a + t[0].middle() * ab; };
  FoundPoints found;
  for (const Interval& piece : cover.crossed_pieces(a, b)) {
    const ZeroSearchLimits limits{1e-3 * cover.smallest_width() / norm(ab), kMostBoxes};
    Zeros<1> zeros = find_zeros<1>(system, {{piece}}, limits);
    std::sort(zeros.simple.begin(), zeros.simple.end(),
              [](const IntervalVector<1>& x, const IntervalVector<1>& y) { return x[0].low < y[0].low; });
    const FoundPoints in_piece = found_in<1>(zeros, point);
    found.points.insert(found.points.end(), in_piece.points.begin(), in_piece.points.end());
    found.undecided.insert(found.undecided.end(), in_piece.undecided.begin(), in_piece.undecided.end());
  }
  return found;
}

FoundPoints find_critical_points(const SurfaceCover& cover, const Vector3& direction) {
  const CriticalPointSystem system(cover.function(), direction);
  const ZeroSearchLimits limits{cover.smallest_width(), kMostBoxes};
  return found_in<3>(find_zeros<3>(system, cover.critical_boxes(system.u(), system.v()), limits), kMiddle);
}

FoundPoints find_critical_points(const SurfaceCover& cover, const PlanePart& part, const Vector3& direction,
                                 const std::vector<IntervalBox>& boxes, std::size_t enough) {
  const PlaneSystem system(cover.function(), part, direction);
  std::vector<IntervalVector<2>> start;
  for (const IntervalBox& box : boxes) {
    IntervalBox relative;
    for (int i = 0; i < 3; ++i) {
      relative[static_cast<std::size_t>(i)] = box[static_cast<std::size_t>(i)] - Interval(part.origin[i]);
    }
    const IntervalVector<2> shadow{project(part.u, relative), project(part.v, relative)};
    if (disjoint(shadow[0], part.rectangle[0]) || disjoint(shadow[1], part.rectangle[1])) continue;
    start.push_back({intersection(shadow[0], part.rectangle[0]), intersection(shadow[1], part.rectangle[1])});
  }
  return found_in<2>(find_zeros<2>(system, start, {cover.smallest_width(), kMostBoxes, enough}),
                     [&](const IntervalVector<2>& x) { return middle_of(system.box_of(x)); });
}

FoundPoints find_silhouette_critical_points(const SurfaceCover& cover, const ConvexRegion& region, const Vector3& d,
                                            const Vector3& d_prime, const std::vector<IntervalBox>& boxes,
                                            std::size_t enough) {
  const SilhouetteSystem system(cover.function(), region, d, d_prime);
  return found_in<3>(find_zeros<3>(system, boxes, {cover.smallest_width(), kMostBoxes, enough}), kMiddle);
}

}  // namespace delvox
