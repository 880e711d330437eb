#include "oracle/polygon_surface.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <tuple>

#include "delvox/core/errors.h"
#include "delvox/core/merge_points.h"
#include "oracle/polygon_crossings.h"

namespace delvox {
namespace {

constexpr std::uint32_t kNone = ~0u;

std::string at(const Point3& p) {
  char text[96];
  std::snprintf(text, sizeof text, "%.6g, %.6g, %.6g", p.x, p.y, p.z);
  return text;
}

std::string and_more(std::size_t more, const std::string& what) {
  return more == 0 ? "" : ", and " + std::to_string(more) + " more " + what;
}

class SurfaceMaker {
 public:
  PolygonSurface make(const SurfaceMesh& mesh) {
    take_over(mesh);
    join_at_edges();
    refuse_flat_triangles();
    refuse_pinched_vertices();
    orient();
    refuse_crossings();
    return std::move(surface_);
  }

 private:
  void refuse_crossings() const {
    const CrossingTriangles crossing = find_crossing_triangles(surface_.points, surface_.triangles);
    if (crossing.pairs > 0) {
      throw InputError("the surface crosses itself: " + named({crossing.first[0], crossing.first[1]}) + " meet near " +
                       at(crossing.where) + and_more(crossing.pairs - 1, "pairs") + "; repair it first");
    }
  }

  void take_over(const SurfaceMesh& mesh) {
    for (const Point3& p : mesh.points) {
      if (!is_finite(p)) throw InputError("a point of the surface is not finite");
    }
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::uint32_t v : mesh.triangles[t]) {
        if (v >= mesh.points.size()) throw InputError("triangle " + std::to_string(t) + " names a point that is not there");
      }
    }
    SurfaceMesh merged = with_equal_points_merged(mesh, &numbers_);
    surface_.points = std::move(merged.points);
    surface_.triangles = std::move(merged.triangles);
    if (surface_.triangles.empty()) throw InputError("the surface has no triangles");
    Box3 box;
    for (const Point3& p : surface_.points) box.extend(p);
    constexpr double kLeast = 1e-90, kMost = 1e90;  // cubes of lengths must be numbers
    const double reach = box.diagonal() + norm(box.center());
    if (!(box.diagonal() >= kLeast && reach <= kMost)) {
      throw InputError("the surface is of no size to compute with: from " + at(box.min) + " to " + at(box.max) + " mm");
    }
  }

  void refuse_flat_triangles() const {
    for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) {
      if (has_no_area(surface_.corner(t, 0), surface_.corner(t, 1), surface_.corner(t, 2))) {
        throw InputError(named({t}) + " at " + at(surface_.corner(t, 0)) + " has no area; remove it first");
      }
    }
  }

  /// Each edge must belong to two triangles.
  void join_at_edges() {
    struct Side {
      std::array<std::uint32_t, 2> edge;
      std::uint32_t corner;
    };
    std::vector<Side> sides;
    for (std::uint32_t corner = 0; corner < 3 * surface_.triangles.size(); ++corner) {
      const std::uint32_t a = vertex(corner), b = vertex(next(corner));
      sides.push_back({{std::min(a, b), std::max(a, b)}, corner});
    }
    std::sort(sides.begin(), sides.end(),
              [](const Side& a, const Side& b) { return std::tie(a.edge, a.corner) < std::tie(b.edge, b.corner); });
    across_.resize(sides.size());
    std::size_t open = 0;
    std::uint32_t first_open = kNone;
    std::vector<std::uint32_t> crowd;
    for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
      while (end < sides.size() && sides[end].edge == sides[begin].edge) ++end;
      if (end - begin == 1) {
        ++open;
        first_open = std::min(first_open, sides[begin].corner);
      } else if (end - begin == 2) {
        across_[sides[begin].corner] = sides[begin + 1].corner;
        across_[sides[begin + 1].corner] = sides[begin].corner;
      } else if (crowd.empty()) {
        for (std::size_t i = begin; i < end; ++i) crowd.push_back(sides[i].corner);
      }
    }
    if (open > 0) {
      throw InputError("the surface is open: " + std::to_string(open) +
                       " edges belong to one triangle only, the first at " + at(middle(first_open)) + " (" +
                       named({first_open / 3}) + "); close it first");
    }
    if (!crowd.empty()) {
      const Point3 place = middle(crowd.front());
      for (std::uint32_t& corner : crowd) corner /= 3;
      throw InputError("the surface is not manifold: " + named(crowd) + " share the edge at " + at(place) +
                       "; repair it first");
    }
  }

  void refuse_pinched_vertices() const {
    // A walk around a vertex from each of its corners: the second walk that begins afresh finds a second fan.
    std::vector<std::uint32_t> fan(surface_.points.size(), kNone);
    std::vector<bool> met(across_.size(), false);
    for (std::uint32_t corner = 0; corner < across_.size(); ++corner) {
      if (met[corner]) continue;
      const std::uint32_t v = vertex(corner);
      if (fan[v] != kNone) {
        throw InputError("the surface is not manifold: " + named({fan[v] / 3, corner / 3}) +
                         " touch in the vertex at " + at(surface_.points[v]) + " only; repair it first");
      }
      fan[v] = corner;
      std::uint32_t edge = corner, own = corner;  // leave the triangle by `edge`, whose corner at v is `own`
      do {
        met[own] = true;
        const std::uint32_t entered = across_[edge];
        own = vertex(entered) == v ? entered : next(entered);
        edge = entered == own ? next(next(own)) : own;
      } while (!met[own]);
    }
  }

  /// All triangles of a component one way round, its volume positive.
  void orient() {
    auto& triangles = surface_.triangles;
    surface_.component_of.assign(triangles.size(), kNone);
    std::vector<bool> flip(triangles.size(), false);
    std::vector<std::uint32_t> stack;
    std::vector<double> volume;
    for (std::uint32_t start = 0; start < triangles.size(); ++start) {
      if (surface_.component_of[start] != kNone) continue;
      stack.assign(1, start);
      surface_.component_of[start] = surface_.components;
      volume.push_back(0);
      while (!stack.empty()) {
        const std::uint32_t t = stack.back();
        stack.pop_back();
        volume.back() += (flip[t] ? -1 : 1) * six_volumes(t);
        for (std::uint32_t corner = 3 * t; corner < 3 * t + 3; ++corner) {
          const std::uint32_t other = across_[corner], u = other / 3;
          const bool flip_other = (vertex(corner) == vertex(other)) != flip[t];
          if (surface_.component_of[u] == kNone) {
            surface_.component_of[u] = surface_.components;
            flip[u] = flip_other;
            stack.push_back(u);
          } else if (flip[u] != flip_other) {
            throw InputError("the surface is not orientable: " + named({t, u}) + " at " + at(middle(corner)) +
                             " cannot be turned the same way as all between them");
          }
        }
      }
      ++surface_.components;
    }
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      if (flip[t] != (volume[surface_.component_of[t]] < 0)) std::swap(triangles[t][1], triangles[t][2]);
    }
  }

  double six_volumes(std::uint32_t t) const {
    const Point3& o = surface_.points[0];
    return dot(surface_.corner(t, 0) - o, cross(surface_.corner(t, 1) - o, surface_.corner(t, 2) - o));
  }

  /// By their numbers in the input: "triangle 3", "triangles 3 and 8", "triangles 3, 8 and 9".
  std::string named(std::vector<std::uint32_t> triangles) const {
    std::sort(triangles.begin(), triangles.end());
    std::string text = triangles.size() == 1 ? "triangle " : "triangles ";
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      if (i > 0) text += i + 1 < triangles.size() ? ", " : " and ";
      text += std::to_string(numbers_[triangles[i]]);
    }
    return text;
  }

  static std::uint32_t next(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
  std::uint32_t vertex(std::uint32_t corner) const { return surface_.triangles[corner / 3][corner % 3]; }
  /// Of the edge from a corner to the next.
  Point3 middle(std::uint32_t corner) const {
    return midpoint(surface_.points[vertex(corner)], surface_.points[vertex(next(corner))]);
  }

  PolygonSurface surface_;
  std::vector<std::uint32_t> numbers_;  // of its triangles in the input
  std::vector<std::uint32_t> across_;  // per edge, named by the corner it starts from: the same edge from beyond
};

}  // namespace

PolygonSurface sound_surface(const SurfaceMesh& mesh) { return SurfaceMaker().make(mesh); }

}  // namespace delvox
