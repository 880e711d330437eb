#include "oracle/clip_segment.h"

#include <algorithm>
#include <utility>

namespace delvox {

bool clip_segment(const Box3& box, Point3& a, Point3& b) {
  const bool a_inside = box.contains(a), b_inside = box.contains(b);
  if (a_inside && b_inside) return true;
  const Point3 from = b_inside ? b : a, to = b_inside ? a : b;
  const Vector3 step = to - from;
  double enter = 0, leave = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (step[axis] == 0) {
      if (from[axis] < box.min[axis] || from[axis] > box.max[axis]) return false;
      continue;
    }
    double first = (box.min[axis] - from[axis]) / step[axis], last = (box.max[axis] - from[axis]) / step[axis];
    if (first > last) std::swap(first, last);
    enter = std::max(enter, first);
    leave = std::min(leave, last);
  }
  if (!(enter <= leave)) return false;
  (b_inside ? a : b) = from + leave * step;
  if (!a_inside && !b_inside) a = from + enter * step;
  return true;
}

}  // namespace delvox
