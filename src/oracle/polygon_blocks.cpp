#include "oracle/polygon_blocks.h"

#include <algorithm>
#include <cmath>

#include "core/hash.h"
#include "core/parallel.h"

namespace delvox {
namespace {

/// Whether a triangle may meet a box: no axis of the box, nor the triangle's plane, nor a product of edges parts them
/// by more than rounding.
bool may_meet(const std::array<Point3, 3>& triangle, const Box3& box) {
  const Point3 center = box.center();
  const Vector3 half = (0.5 + 1e-9) * (box.max - box.min);
  const Point3 v[3] = {triangle[0] - center, triangle[1] - center, triangle[2] - center};
  const auto parts = [&](const Vector3& axis) {
    const double at[3] = {dot(axis, v[0]), dot(axis, v[1]), dot(axis, v[2])};
    const double reach = std::abs(axis.x) * half.x + std::abs(axis.y) * half.y + std::abs(axis.z) * half.z;
    const auto [low, high] = std::minmax_element(at, at + 3);
    const double slack = 1e-12 * (std::abs(*low) + std::abs(*high));
    return *low > reach + slack || *high < -reach - slack;
  };
  const Vector3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const Vector3& axis : axes) {
    if (parts(axis)) return false;
  }
  const Vector3 edges[3] = {v[1] - v[0], v[2] - v[1], v[0] - v[2]};
  if (parts(cross(edges[0], edges[1]))) return false;
  for (const Vector3& axis : axes) {
    for (const Vector3& edge : edges) {
      if (parts(cross(axis, edge))) return false;
    }
  }
  return true;
}

}  // namespace

PolygonBlocks::PolygonBlocks(const PolygonSurface& surface, const PolygonTree& tree) : tree_(tree) {
  for (const Point3& p : surface.points) box_.extend(p);
  constexpr double kBlocksPerTriangle = 2, kLeast = 1 << 15, kMost = 1 << 20, kMostInLine = 1024;
  const double blocks = std::clamp(kBlocksPerTriangle * static_cast<double>(surface.triangles.size()), kLeast, kMost);
  const Vector3 extent = box_.max - box_.min;
  const double longest = std::max({extent.x, extent.y, extent.z});
  width_ = std::max(std::cbrt(extent.x * extent.y * extent.z / blocks), longest / kMostInLine);
  for (int axis = 0; axis < 3; ++axis) counts_[axis] = std::max(1, static_cast<int>(std::ceil(extent[axis] / width_)));
  states_.assign(static_cast<std::size_t>(counts_[0]) * counts_[1] * counts_[2], kOutside);
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const std::array<Point3, 3> triangle{surface.corner(t, 0), surface.corner(t, 1), surface.corner(t, 2)};
    Box3 box;
    for (const Point3& p : triangle) box.extend(p);
    Cell low = cell_of(box.min), high = cell_of(box.max);
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::max(0, low[axis] - 1);  // a face between two blocks touches both
      high[axis] = std::min(counts_[axis], high[axis] + 2);
    }
    mark_mixed(triangle, low, high);
  }
  const auto rows = static_cast<std::size_t>(counts_[1]) * counts_[2];
  for_each_chunk(rows, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      label_row(static_cast<int>(row % counts_[1]), static_cast<int>(row / counts_[1]));
    }
  });
}

PolygonBlocks::Cell PolygonBlocks::cell_of(const Point3& p) const {
  Cell cell;
  for (int axis = 0; axis < 3; ++axis) {
    cell[axis] = std::clamp(static_cast<int>((p[axis] - box_.min[axis]) / width_), 0, counts_[axis] - 1);
  }
  return cell;
}

Box3 PolygonBlocks::box_of(const Cell& low, const Cell& high) const {
  return {box_.min + width_ * Point3{double(low[0]), double(low[1]), double(low[2])},
          box_.min + width_ * Point3{double(high[0]), double(high[1]), double(high[2])}};
}

Point3 PolygonBlocks::center_of(const Cell& c) const { return box_of(c, {c[0] + 1, c[1] + 1, c[2] + 1}).center(); }

/// Off the planes and lines that surfaces like to keep to.
Point3 PolygonBlocks::reference(const Cell& c, int attempt) const {
  const std::uint64_t h = mix_hash(index(c) * 128 + static_cast<std::uint64_t>(attempt));
  const double x = unit_interval(h), y = unit_interval(mix_hash(h)), z = unit_interval(mix_hash(h ^ 1));
  return center_of(c) + (0.4 * width_) * Point3{x - 0.5, y - 0.5, z - 0.5};
}

/// Of blocks from low to below high, halving the range where the triangle passes.
void PolygonBlocks::mark_mixed(const std::array<Point3, 3>& triangle, const Cell& low, const Cell& high) {
  if (!may_meet(triangle, box_of(low, high))) return;
  int axis = 0;
  for (int other : {1, 2}) {
    if (high[other] - low[other] > high[axis] - low[axis]) axis = other;
  }
  if (high[axis] - low[axis] == 1) {
    states_[index(low)] = kMixed;
    return;
  }
  Cell middle_low = low, middle_high = high;
  middle_low[axis] = middle_high[axis] = (low[axis] + high[axis]) / 2;
  mark_mixed(triangle, low, middle_high);
  mark_mixed(triangle, middle_low, high);
}

/// Along a row each label follows from the one before: from reference to reference, the segment stays in the two blocks.
void PolygonBlocks::label_row(int j, int k) {
  bool label = false, mixed_before = true;
  Point3 before = reference({0, j, k}, 0);
  before.x = box_.min.x - width_;
  for (int i = 0; i < counts_[0]; ++i) {
    std::uint8_t& state = states_[index({i, j, k})];
    const bool mixed = state == kMixed;
    int attempt = 0;
    Point3 here = reference({i, j, k}, attempt);
    if (mixed || mixed_before) {
      constexpr int kMostAttempts = 60;
      PolygonTree::Parity parity = tree_.parity(here, before);
      while (parity == PolygonTree::Parity::kOnSurface && attempt < kMostAttempts) {
        here = reference({i, j, k}, ++attempt);
        parity = tree_.parity(here, before);
      }
      label ^= parity == PolygonTree::Parity::kOdd;
    }
    state = static_cast<std::uint8_t>((mixed ? kMixed + 2 * attempt : kOutside) + label);
    before = here;
    mixed_before = mixed;
  }
}

bool PolygonBlocks::inside(const Point3& p) const {
  if (!box_.contains(p)) return false;
  const Cell cell = cell_of(p);
  const std::uint8_t state = states_[index(cell)];
  if (state < kMixed) return state == kInside;
  const bool label = (state - kMixed) % 2 == 1;
  switch (tree_.parity(p, reference(cell, (state - kMixed) / 2))) {
    case PolygonTree::Parity::kEven: return label;
    case PolygonTree::Parity::kOdd: return !label;
    case PolygonTree::Parity::kOnSurface: break;
  }
  return true;
}

void PolygonBlocks::for_each(const std::function<void(const Point3& center, bool is_inside)>& visit) const {
  Cell c;
  for (c[2] = 0; c[2] < counts_[2]; ++c[2]) {
    for (c[1] = 0; c[1] < counts_[1]; ++c[1]) {
      for (c[0] = 0; c[0] < counts_[0]; ++c[0]) {
        const std::uint8_t state = states_[index(c)];
        visit(center_of(c), state % 2 == 1);
      }
    }
  }
}

}  // namespace delvox
