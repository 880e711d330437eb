#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "delaunay/ids.h"
#include "delaunay/surface_balls.h"
#include "delvox/core/geometry.h"
#include "delvox/core/mesh.h"
#include "delvox/oracle/oracle.h"

namespace delvox {

/// Del|Sigma of a sample of a closed surface, kept without Del S (book, exercise 3; Dey and Levine, Delaunay meshing of
/// isosurfaces, The Visual Computer 24, 2008): triangles that know their neighbours, each with a surface Delaunay ball.
/// Where the sample is dense, a new point changes the triangles whose balls contain it and no others; these form a
/// disk, and the triangles that take their place join the point to the disk's boundary. Anything else is no insertion,
/// so that the triangulation stays a closed, oriented 2-manifold of one topology. What cannot be seen from there, a
/// vertex of another part of the surface in a ball, look_into_balls() finds.
class SurfaceTriangulation {
 public:
  using TriangleId = std::uint32_t;

  /// Triangles are counter-clockwise seen from outside, with a ball each. None if they form no closed, oriented
  /// 2-manifold.
  static std::optional<SurfaceTriangulation> make(std::vector<Point3> points, std::span<const Triangle> triangles,
                                                  std::span<const SurfaceBall> balls);

  const std::vector<Point3>& points() const { return points_; }
  std::size_t size() const { return faces_.size(); }
  const std::array<TriangleId, 3>& neighbors(TriangleId t) const { return faces_[t].neighbors; }
  const Triangle& corners(TriangleId t) const { return faces_[t].corners; }
  const Point3& corner(TriangleId t, int i) const { return points_[faces_[t].corners[i]]; }
  SurfaceBall ball(TriangleId t) const { return {faces_[t].ball_center, faces_[t].squared_radius}; }
  /// Changes whenever the number is given to another triangle. There are no numbers that are not in use.
  std::uint32_t stamp(TriangleId t) const { return faces_[t].stamp; }

  /// Inserts the centre of a triangle's ball; created() holds the triangles at it. False, and nothing is changed, if
  /// the triangles whose balls contain it form no disk, or one that would take their place has no ball around it that
  /// is centred on the surface nearby, where the inside is left along its normal, and is empty of the vertices around.
  bool insert_ball_center(TriangleId t, const Oracle& oracle);
  const std::vector<TriangleId>& created() const { return created_; }

  struct BallFindings {
    std::vector<TriangleId> occupied;      ///< with a vertex in their ball, in order
    std::vector<std::uint32_t> uncovered;  ///< probes not near enough to the plane of any triangle whose ball they are in
  };
  /// Restricted Delaunay triangles are those whose balls are empty; a triangulation of such does not cross itself. Of a
  /// sample that has missed nothing, the balls cover the surface (book, exercise 1): `probes` are points of it;
  /// `near` is a share of the ball's radius.
  BallFindings look_into_balls(const std::vector<Point3>& probes, double near = 1) const;

 private:
  /// Balls pass through their own vertices, and those of cocircular triangles through each other's: as a factor of
  /// their squared radii.
  static constexpr double kAHairLess = 1 - 1e-9;

  struct alignas(64) Face {
    Triangle corners;
    std::array<TriangleId, 3> neighbors;  // opposite the corners
    Point3 ball_center;
    double squared_radius;
    std::uint32_t stamp;
    std::uint32_t met;  // the last search that has met it
  };
  static_assert(sizeof(Face) == 64);
  /// An edge of the disk's boundary, and the triangle beyond it.
  struct RimEdge {
    std::uint32_t from, to;
    TriangleId outer;
  };

  bool join_neighbors();
  bool has_disks() const;
  bool in_ball(const Point3& p, const Face& face) const;
  void find_zone(const Point3& p, TriangleId start);
  bool order_rim();
  bool find_balls(const Point3& p, const Oracle& oracle);
  bool empty_nearby(const SurfaceBall& ball, std::size_t edge) const;
  void commit(const Point3& p);

  std::vector<Point3> points_;
  std::vector<Face> faces_;
  std::uint32_t searches_ = 0;
  std::uint32_t next_stamp_ = 1;
  std::vector<TriangleId> zone_, created_;
  std::vector<RimEdge> rim_;
  std::vector<SurfaceBall> balls_;  // of the triangles at the rim's edges
};

}  // namespace delvox
