#include "oracle/surface_cover.h"

#include <string>

#include "delvox/core/errors.h"
#include "oracle/border_search.h"

namespace delvox {
namespace {

constexpr double kSmallestShare = 1e-6;  // of the box's diagonal
constexpr std::size_t kMostNodes = 4'000'000;

/// Where the function is at most 0 on the border of the box, the surface would end there.
void certify_border(const SmoothFunction& function, const Box3& box) {
  constexpr double kShare = 1e-3;
  const BorderFinding finding = search_border(function, box, kShare * box.diagonal());
  if (finding.kind == BorderFinding::kInside) throw OptionError(inside_on_border(finding.place));
  if (finding.kind == BorderFinding::kUndecided) {
    throw OptionError("it cannot be ruled out that the surface meets the border of the box near " +
                      place_text(finding.place) + "; widen the box");
  }
}

/// The part of the line from a to b, as an interval of its parameter, that lies in the box; none if it misses it.
bool clip_line(const Point3& a, const Vector3& ab, const IntervalBox& box, Interval& t) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double from = a[static_cast<int>(axis)], step = ab[static_cast<int>(axis)];
    if (step == 0) {
      if (!box[axis].contains(from)) return false;
      continue;
    }
    const Interval hit = (box[axis] - Interval(from)) / Interval(step);
    if (disjoint(t, hit)) return false;
    t = intersection(t, hit);
  }
  return true;
}

}  // namespace

SurfaceCover::SurfaceCover(const SmoothFunction& function, const Box3& box, const GoOn& go_on)
    : function_(function), box_(box), smallest_(kSmallestShare * box.diagonal()) {
  certify_border(function, box);
  build(go_on);
}

SurfaceCover::Node SurfaceCover::make_node(const IntervalBox& box) const {
  Node node;
  node.box = box;
  std::array<Interval, SmoothFunction::kResults[2]> results;
  node.smooth = function_.enclose(box, 2, results.data());
  node.value = results[0];
  if (!node.smooth || !node.value.contains_zero()) return node;
  std::array<Interval, SmoothFunction::kResults[1]> at_middle;
  const Point3 middle = middle_of(box);
  function_.enclose(box_of(middle), 1, at_middle.data());
  Interval mean_value = at_middle[0];
  for (std::size_t i = 0; i < 3; ++i) {
    Interval derivative = at_middle[1 + i];
    for (std::size_t j = 0; j < 3; ++j) {
      derivative = derivative + results[SmoothFunction::kSecond[i][j]] * (box[j] - Interval(middle[static_cast<int>(j)]));
    }
    node.gradient[i] = intersection(results[1 + i], derivative);
    mean_value = mean_value + node.gradient[i] * (box[i] - Interval(middle[static_cast<int>(i)]));
  }
  node.value = disjoint(node.value, mean_value) ? mean_value : intersection(node.value, mean_value);
  return node;
}

/// Plantinga and Vegter's small normal variation: the gradients at any two points make an acute angle.
bool SurfaceCover::regular(const Node& node) const {
  if (!node.smooth) return false;
  Interval product = 0.0;
  for (const Interval& component : node.gradient) product = product + component * component;
  return product.low > 0;
}

void SurfaceCover::build(const GoOn& go_on) {
  const IntervalBox whole{Interval(box_.min.x, box_.max.x), Interval(box_.min.y, box_.max.y),
                          Interval(box_.min.z, box_.max.z)};
  nodes_.push_back(make_node(whole));
  std::vector<std::uint32_t> waiting;
  if (nodes_[0].value.contains_zero()) waiting.push_back(0);
  while (!waiting.empty()) {
    const std::uint32_t number = waiting.back();
    waiting.pop_back();
    const Node& node = nodes_[number];
    if (regular(node)) {
      empty_ = false;
      continue;
    }
    if (width_of(node.box) <= smallest_) {
      throw OptionError("DelSurf2 needs a smooth surface, and near " + place_text(middle_of(node.box)) +
                        (node.smooth ? " it may have a point without a normal, or parts too close to tell apart"
                                     : " it may meet a kink, jump or pole, as of min, max, abs, sqrt or division"));
    }
    go_on();
    divide(number);
    for (std::uint32_t i = 0; i < nodes_[number].children; ++i) waiting.push_back(nodes_[number].first_child + i);
    if (nodes_.size() > kMostNodes)
      throw OptionError("DelSurf2: the surface is too intricate to be covered with boxes");
  }
}

/// Only children that may meet the surface are kept.
void SurfaceCover::divide(std::uint32_t number) {
  const IntervalBox box = nodes_[number].box;
  nodes_[number].leaf = false;
  nodes_[number].first_child = static_cast<std::uint32_t>(nodes_.size());
  for (int octant = 0; octant < 8; ++octant) {
    IntervalBox part;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Interval& side = box[axis];
      part[axis] = (octant >> axis & 1) != 0 ? Interval(side.middle(), side.high) : Interval(side.low, side.middle());
    }
    Node child = make_node(part);
    if (!child.value.contains_zero()) continue;
    nodes_.push_back(std::move(child));
    ++nodes_[number].children;
  }
}

struct SurfaceCover::CriticalSearch {
  Vector3 direction;
  Point3 from;
  double share = 0;
  std::size_t most = 0;
  std::vector<IntervalBox> found;
};

std::vector<IntervalBox> SurfaceCover::critical_boxes(const ConvexRegion& region, const Vector3& direction,
                                                      const Point3& from, double share, std::size_t most) {
  CriticalSearch search{direction, from, share, most, {}};
  if (!empty()) collect(0, region, search);
  return std::move(search.found);
}

void SurfaceCover::collect(std::uint32_t number, const ConvexRegion& region, CriticalSearch& search) {
  const IntervalBox box = nodes_[number].box;
  ConvexRegion cutting;
  for (const HalfSpace& half : region) {
    const Interval reach = project(half.normal, box);
    if (reach.low > half.offset) return;
    if (reach.high > half.offset) cutting.push_back(half);
  }
  const Node& node = nodes_[number];
  if (node.smooth && !project(search.direction, node.gradient).contains_zero()) return;
  if (node.leaf) {
    const double finest = std::max(search.share * distance(middle_of(box), search.from), smallest_);
    if (width_of(box) <= finest || search.found.size() >= search.most) {
      search.found.push_back(box);
      return;
    }
    divide(number);
  }
  const std::uint32_t first = nodes_[number].first_child, children = nodes_[number].children;
  for (std::uint32_t i = 0; i < children; ++i) collect(first + i, cutting, search);
}

std::vector<IntervalBox> SurfaceCover::critical_boxes(const Vector3& u, const Vector3& v) const {
  std::vector<IntervalBox> boxes;
  for (const Node& node : nodes_) {
    if (!node.leaf) continue;
    if (project(u, node.gradient).contains_zero() && project(v, node.gradient).contains_zero()) {
      boxes.push_back(node.box);
    }
  }
  return boxes;
}

std::vector<Interval> SurfaceCover::crossed_pieces(const Point3& a, const Point3& b) const {
  const Vector3 ab = b - a;
  std::vector<Interval> crossed;
  std::vector<std::uint32_t> waiting;
  if (!empty()) waiting.push_back(0);
  while (!waiting.empty()) {
    const Node& node = nodes_[waiting.back()];
    waiting.pop_back();
    Interval t(0, 1);
    if (!clip_line(a, ab, node.box, t)) continue;
    if (node.leaf) crossed.push_back(t);
    for (std::uint32_t i = 0; i < node.children; ++i) waiting.push_back(node.first_child + i);
  }
  std::sort(crossed.begin(), crossed.end(), [](const Interval& x, const Interval& y) { return x.low < y.low; });
  std::vector<Interval> pieces;
  for (const Interval& next : crossed) {
    if (pieces.empty() || next.low > pieces.back().high) {
      pieces.push_back(next);
    } else {
      pieces.back().high = std::max(pieces.back().high, next.high);
    }
  }
  return pieces;
}

}  // namespace delvox
