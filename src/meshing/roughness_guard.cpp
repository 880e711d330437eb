#include "meshing/roughness_guard.h"

#include <algorithm>

#include "meshing/roughness.h"

namespace delvox {
namespace {

/// Whether a triangle runs along its boundary from `from` to `to`.
bool runs_along(const Triangle& t, std::uint32_t from, std::uint32_t to) {
  for (int i = 0; i < 3; ++i) {
    if (t[i] == from && t[(i + 1) % 3] == to) return true;
  }
  return false;
}

}  // namespace

bool RoughnessGuard::too_rough(std::span<const Triangle> triangles, std::uint32_t moved, const Point3& place,
                               std::span<const std::uint32_t> gone) const {
  if (max_degrees_ >= 179) return false;
  const auto at = [&](std::uint32_t v) { return v == moved ? place : mesh_.point(v); };
  const auto normal = [&](const Triangle& t) { return normal_of(at(t[0]), at(t[1]), at(t[2])); };
  const auto rough = [&](const Triangle& a, const Triangle& b) {
    return roughness_degrees(normal(a), normal(b)) > max_degrees_;
  };
  for (const Triangle& t : triangles) {
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t from = t[i], to = t[(i + 1) % 3];
      for (const Triangle& other : triangles) {
        if (runs_along(other, to, from) && rough(t, other)) return true;
      }
      const std::uint32_t known = from < mesh_.point_count() ? from : to;  // a vertex to be made has no fan yet
      if (known >= mesh_.point_count()) continue;
      for (std::uint32_t other : mesh_.fan(known)) {
        if (std::find(gone.begin(), gone.end(), other) != gone.end()) continue;
        if (runs_along(mesh_.triangle(other), to, from) && rough(t, mesh_.triangle(other))) return true;
      }
    }
  }
  return false;
}

}  // namespace delvox
