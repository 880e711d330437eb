#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "delaunay/ids.h"
#include "delvox/core/geometry.h"
#include "delvox/oracle/oracle.h"

namespace delvox {

/// The same landmarks in the order in which a curve through their box meets them, each link where the first of its ends
/// comes: whoever looks at one after the other finds cells that lie near each other in memory.
Landmarks along_curve(const Landmarks& landmarks);

/// Which landmarks and links are to be looked at again: all at first, then those near places where the surface changed.
class LandmarkWatch {
 public:
  /// A landmark, and a vertex near it if one is known.
  struct Due {
    std::uint32_t landmark = 0;
    VertexId near = kNone;
  };

  LandmarkWatch() = default;
  explicit LandmarkWatch(Landmarks landmarks);

  bool empty() const { return points_.empty(); }
  std::size_t size() const { return points_.size(); }
  const Point3& point(std::uint32_t landmark) const { return points_[landmark]; }
  const std::array<std::uint32_t, 2>& link(std::uint32_t link) const { return links_[link]; }
  double longest_link() const { return longest_link_; }

  /// The surface has changed somewhere in the box, at `near`.
  void note_change(const Box3& box, VertexId near);
  /// Landmarks near the changes noted since the last call, each once, in order.
  std::vector<Due> take_due();
  /// Adds the links of these landmarks to those waiting.
  void await_links_of(const std::vector<Due>& landmarks);
  /// All links waiting, each once.
  std::vector<std::uint32_t> take_links();

 private:
  struct Change {
    Box3 box;
    VertexId near;
  };

  void sort_into_cubes();
  void add_due(std::uint32_t change, std::vector<Due>& due);
  std::size_t cube_index(const std::array<int, 3>& cube) const {
    return (static_cast<std::size_t>(cube[2]) * counts_[1] + cube[1]) * counts_[0] + cube[0];
  }
  std::array<int, 3> cube_of(const Point3& p) const;

  std::vector<Point3> points_;
  std::vector<std::array<std::uint32_t, 2>> links_;
  Vector3 reach_;  // what the longest link spans along each axis
  double longest_link_ = 0;
  bool all_ = true;
  std::vector<Change> changes_;

  Box3 box_;
  std::array<int, 3> counts_{1, 1, 1};
  double width_ = 1;
  std::vector<std::uint32_t> first_in_cube_, in_cubes_;  // landmarks, cube after cube
  std::vector<std::uint32_t> first_link_, links_of_;     // links, landmark after landmark
  std::vector<std::uint32_t> waiting_links_;
  std::vector<bool> waits_;
  std::vector<std::uint32_t> first_change_;  // near each landmark, while due ones are gathered; else kNone
};

}  // namespace delvox
