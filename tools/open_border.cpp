#include "open_border.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace delvox::tools {
namespace {

std::vector<bool> nodes_in_padding(const SurfaceMesh& surface, const VolumeHeader& header) {
  constexpr double kRounding = 1e-9;
  const Affine3 to_index = header.index_to_world.inverse();
  std::vector<bool> in_padding(surface.points.size());
  for (std::size_t v = 0; v < surface.points.size(); ++v) {
    const Point3 at = to_index(surface.points[v]);
    for (int axis = 0; axis < 3; ++axis) {
      const double last = header.dims[static_cast<std::size_t>(axis)] - 1;
      if (at[axis] < -kRounding || at[axis] > last + kRounding) in_padding[v] = true;
    }
  }
  return in_padding;
}

// Triangles around each point, as one flat list: those of v are corners[first[v]] .. corners[first[v + 1]].
struct Corners {
  std::vector<std::size_t> first, triangles;
};

Corners corners_of(const std::vector<Triangle>& triangles, std::size_t point_count) {
  Corners corners;
  corners.first.assign(point_count + 1, 0);
  for (const Triangle& t : triangles) {
    for (std::uint32_t v : t) ++corners.first[v + 1];
  }
  std::partial_sum(corners.first.begin(), corners.first.end(), corners.first.begin());
  corners.triangles.resize(3 * triangles.size());
  std::vector<std::size_t> next(corners.first.begin(), corners.first.end() - 1);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t v : triangles[t]) corners.triangles[next[v]++] = t;
  }
  return corners;
}

bool share_edge_at(const Triangle& a, const Triangle& b, std::uint32_t v) {
  return std::any_of(a.begin(), a.end(), [&](std::uint32_t w) {
    return w != v && std::find(b.begin(), b.end(), w) != b.end();
  });
}

// Marks the triangles around v outside its largest fan (triangles joined by edges at v).
void mark_smaller_fans(const std::vector<Triangle>& triangles, std::uint32_t v, std::vector<std::size_t> around,
                       std::vector<bool>& drop) {
  std::vector<std::vector<std::size_t>> fans;
  while (!around.empty()) {
    std::vector<std::size_t> fan{around.back()};
    around.pop_back();
    for (std::size_t i = 0; i < fan.size(); ++i) {
      const auto joined = std::partition(around.begin(), around.end(), [&](std::size_t t) {
        return !share_edge_at(triangles[fan[i]], triangles[t], v);
      });
      const auto first_joined = joined - around.begin();
      fan.insert(fan.end(), joined, around.end());
      around.resize(static_cast<std::size_t>(first_joined));
    }
    fans.push_back(std::move(fan));
  }
  const auto largest = std::max_element(fans.begin(), fans.end(),
                                        [](const auto& a, const auto& b) { return a.size() < b.size(); });
  for (auto fan = fans.begin(); fan != fans.end(); ++fan) {
    if (fan == largest) continue;
    for (std::size_t t : *fan) drop[t] = true;
  }
}

// Takes out triangles until those around every point form one fan.
void remove_pinches(std::vector<Triangle>& triangles, std::size_t point_count) {
  for (bool changed = true; changed;) {
    const Corners corners = corners_of(triangles, point_count);
    std::vector<bool> drop(triangles.size());
    for (std::uint32_t v = 0; v < point_count; ++v) {
      mark_smaller_fans(triangles, v,
                        {corners.triangles.begin() + static_cast<std::ptrdiff_t>(corners.first[v]),
                         corners.triangles.begin() + static_cast<std::ptrdiff_t>(corners.first[v + 1])},
                        drop);
    }
    std::vector<Triangle> kept;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (!drop[t]) kept.push_back(triangles[t]);
    }
    changed = kept.size() != triangles.size();
    triangles = std::move(kept);
  }
}

}  // namespace

SurfaceMesh open_at_border(const SurfaceMesh& surface, const VolumeHeader& header) {
  const std::vector<bool> in_padding = nodes_in_padding(surface, header);
  std::vector<Triangle> triangles;
  for (const Triangle& t : surface.triangles) {
    if (std::none_of(t.begin(), t.end(), [&](std::uint32_t v) { return in_padding[v]; })) triangles.push_back(t);
  }
  remove_pinches(triangles, surface.points.size());
  SurfaceMesh result;
  result.info = surface.info;
  result.info.open_border = true;
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> renumbered(surface.points.size(), kUnused);
  for (Triangle t : triangles) {
    for (std::uint32_t& v : t) {
      if (renumbered[v] == kUnused) {
        renumbered[v] = static_cast<std::uint32_t>(result.points.size());
        result.points.push_back(surface.points[v]);
      }
      v = renumbered[v];
    }
    result.triangles.push_back(t);
  }
  return result;
}

}  // namespace delvox::tools
