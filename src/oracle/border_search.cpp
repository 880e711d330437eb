#include "oracle/border_search.h"

#include <algorithm>
#include <cstdio>

namespace delvox {
namespace {

class BorderSearch {
 public:
  BorderSearch(const SmoothFunction& function, double resolution) : function_(function), resolution_(resolution) {}

  BorderFinding on_faces_of(const Box3& box) {
    for (int axis = 0; axis < 3; ++axis) {
      for (double at : {box.min[axis], box.max[axis]}) {
        IntervalBox face{{{box.min.x, box.max.x}, {box.min.y, box.max.y}, {box.min.z, box.max.z}}};
        face[static_cast<std::size_t>(axis)] = at;
        if (!look_at(face)) return finding_;
      }
    }
    return finding_;
  }

 private:
  /// False once a point is found.
  bool look_at(const IntervalBox& box) {
    Interval enclosure;
    function_.enclose(box, 0, &enclosure);
    if (enclosure.low > 0) return true;
    for (int corner = 0; corner < 9; ++corner) {
      Point3 p;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Interval& side = box[axis];
        p[static_cast<int>(axis)] = corner == 8 ? side.middle() : (corner >> axis & 1) != 0 ? side.high : side.low;
      }
      double value = 0;
      function_.evaluate(p, 0, &value);
      if (!(value <= 0)) continue;
      finding_ = {BorderFinding::kInside, p};
      return false;
    }
    const auto widest = std::max_element(box.begin(), box.end(),
                                         [](const Interval& a, const Interval& b) { return a.width() < b.width(); });
    if (widest->width() <= resolution_) {
      finding_ = {BorderFinding::kUndecided, {box[0].middle(), box[1].middle(), box[2].middle()}};
      return true;
    }
    for (const Interval& half : {Interval(widest->low, widest->middle()), Interval(widest->middle(), widest->high)}) {
      IntervalBox part = box;
      part[static_cast<std::size_t>(widest - box.begin())] = half;
      if (!look_at(part)) return false;
    }
    return true;
  }

  const SmoothFunction& function_;
  double resolution_;
  BorderFinding finding_;
};

}  // namespace

BorderFinding search_border(const SmoothFunction& function, const Box3& box, double resolution) {
  return BorderSearch(function, resolution).on_faces_of(box);
}

std::string place_text(const Point3& p) {
  char text[100];
  std::snprintf(text, sizeof text, "%.4g, %.4g, %.4g", p.x, p.y, p.z);
  return text;
}

std::string inside_on_border(const Point3& place) {
  return "the formula is at most 0, that is inside, at " + place_text(place) +
         " on the border of the box: widen the box, cut the domain within it with max(formula, ...), or "
         "turn the formula's sign if it is positive inside";
}

}  // namespace delvox
