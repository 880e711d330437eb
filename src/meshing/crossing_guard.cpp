#include "meshing/crossing_guard.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "delaunay/predicates.h"

namespace delvox {
struct CrossingGuard::Placed {
  Triangle ids;
  std::array<Point3, 3> corners;

  Placed(const RepairMesh& mesh, const Triangle& triangle, std::uint32_t moved = RepairMesh::kNone,
         const Point3& place = {})
      : ids(triangle) {
    for (int i = 0; i < 3; ++i) corners[i] = ids[i] == moved ? place : mesh.point(ids[i]);
  }
  bool has(std::uint32_t id) const { return std::find(ids.begin(), ids.end(), id) != ids.end(); }
  Box3 box() const {
    Box3 box;
    for (const Point3& p : corners) box.extend(p);
    return box;
  }
};

namespace {

bool overlap(const Box3& s, const Box3& t) {
  for (int axis = 0; axis < 3; ++axis) {
    if (s.min[axis] > t.max[axis] || t.min[axis] > s.max[axis]) return false;
  }
  return true;
}

bool pierces(const Point3& p, const Point3& q, const std::array<Point3, 3>& t) {
  const int at_p = orientation(t[0], t[1], t[2], p), at_q = orientation(t[0], t[1], t[2], q);
  if (at_p * at_q > 0 || (at_p == 0 && at_q == 0)) return false;
  const int a = orientation(p, q, t[0], t[1]), b = orientation(p, q, t[1], t[2]), c = orientation(p, q, t[2], t[0]);
  return std::min({a, b, c}) * std::max({a, b, c}) >= 0;
}

// An edge of one with no corner in common goes through the other. With a common edge, positive tets keep them apart.
template <class Placed>
bool cross(const Placed& s, const Placed& t) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (!t.has(s.ids[i]) && !t.has(s.ids[j]) && pierces(s.corners[i], s.corners[j], t.corners)) return true;
    if (!s.has(t.ids[i]) && !s.has(t.ids[j]) && pierces(t.corners[i], t.corners[j], s.corners)) return true;
  }
  return false;
}

// Bits of x, y and z in turn, 21 each.
std::uint64_t morton_code(const Point3& p, const Box3& box) {
  std::uint64_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = box.max[axis] - box.min[axis];
    const auto cell = static_cast<std::uint64_t>(extent > 0 ? (p[axis] - box.min[axis]) / extent * 0x1.fffffp20 : 0);
    for (int bit = 0; bit < 21; ++bit) code |= ((cell >> bit) & 1) << (3 * bit + axis);
  }
  return code;
}

void extend(Box3& box, const Box3& other) {
  box.extend(other.min);
  box.extend(other.max);
}

}  // namespace

Box3 CrossingGuard::box_of(std::uint32_t triangle) const {
  return Placed(mesh_, mesh_.triangle(triangle)).box();
}

void CrossingGuard::build() {
  const std::size_t count = mesh_.triangle_count();
  Box3 all;
  for (std::uint32_t t = 0; t < count; ++t) {
    if (mesh_.triangle_alive(t)) all.extend(mesh_.point(mesh_.triangle(t)[0]));
  }
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted;
  for (std::uint32_t t = 0; t < count; ++t) {
    sorted.emplace_back(mesh_.triangle_alive(t) ? morton_code(mesh_.point(mesh_.triangle(t)[0]), all) : 0, t);
  }
  std::sort(sorted.begin(), sorted.end());
  place_.assign(count, 0);
  for (const auto& [code, t] : sorted) {
    place_[t] = static_cast<std::uint32_t>(order_.size());
    order_.push_back(t);
  }
  leaves_ = std::bit_ceil((order_.size() + kLeaf - 1) / kLeaf);
  boxes_.assign(2 * leaves_, Box3{});
  for (std::size_t i = 0; i < order_.size(); ++i) {
    if (mesh_.triangle_alive(order_[i])) extend(boxes_[leaves_ + i / kLeaf], box_of(order_[i]));
  }
  for (std::size_t node = leaves_ - 1; node > 0; --node) {
    for (std::size_t child : {2 * node, 2 * node + 1}) {
      if (!boxes_[child].empty()) extend(boxes_[node], boxes_[child]);
    }
  }
}

void CrossingGuard::changed(std::span<const std::uint32_t> triangles) {
  if (boxes_.empty()) return;
  for (std::uint32_t t : triangles) {
    if (t >= place_.size()) {
      if (std::find(late_.begin(), late_.end(), t) == late_.end()) late_.push_back(t);
      continue;
    }
    const Box3 box = box_of(t);
    for (std::size_t node = leaves_ + place_[t] / kLeaf; node > 0; node /= 2) extend(boxes_[node], box);
  }
}

bool CrossingGuard::crosses(const Placed& triangle, const Box3& box, std::uint32_t other,
                            std::span<const std::uint32_t> gone) const {
  if (!mesh_.triangle_alive(other) || std::find(gone.begin(), gone.end(), other) != gone.end()) return false;
  const Placed t(mesh_, mesh_.triangle(other));
  return overlap(box, t.box()) && cross(triangle, t);
}

bool CrossingGuard::crosses(const Triangle& triangle, std::uint32_t moved, const Point3& place,
                            std::span<const std::uint32_t> gone) {
  if (boxes_.empty()) build();
  const Placed s(mesh_, triangle, moved, place);
  const Box3 box = s.box();
  for (std::uint32_t other : late_) {
    if (crosses(s, box, other, gone)) return true;
  }
  std::vector<std::size_t> nodes{1};
  while (!nodes.empty()) {
    const std::size_t node = nodes.back();
    nodes.pop_back();
    if (!overlap(box, boxes_[node])) continue;
    if (node < leaves_) {
      nodes.push_back(2 * node + 1);
      nodes.push_back(2 * node);
      continue;
    }
    const std::size_t first = (node - leaves_) * kLeaf;
    for (std::size_t i = first; i < std::min(first + kLeaf, order_.size()); ++i) {
      if (crosses(s, box, order_[i], gone)) return true;
    }
  }
  return false;
}

}  // namespace delvox
