#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "delvox/core/mesh.h"
#include "delvox/core/size_field.h"
#include "delvox/oracle/oracle.h"
#include "meshing/ball_grid.h"
#include "meshing/feature_lines.h"

namespace delvox {

/// The sharp edges that a mesh is to keep, cut into segments by nodes, each of which is to be a vertex of Del S. A
/// segment is an edge of Del S for certain if its diametral ball, the smallest around it, holds no vertex but its ends
/// (Ruppert, "A Delaunay refinement algorithm for quality 2-dimensional mesh generation", 1995); a vertex that is in
/// the ball, or nearly, encroaches on the segment. Segments that meet at less than a right angle are cut at equal
/// distances from where they meet, and halved: then their ends never encroach on each other (concentric shells).
class FeatureSegments {
 public:
  struct Segment {
    Edge ends{};  ///< nodes
    std::uint32_t line = 0;
    double from = 0, to = 0;  ///< along the line, mm
  };

  /// Segments are no longer than 0.9 of the size along them, and 0.9 of `longest`. None is cut into parts shorter than
  /// `shortest`, mm, unless may_split() says so; what would have to be, or once go_on() is false, is left encroached.
  FeatureSegments(FeatureEdges edges, const SizeField& size, double longest, double shortest,
                  const GoOn& go_on = always_go_on);

  std::size_t node_count() const { return nodes_.size(); }
  const Point3& node(std::uint32_t node) const { return nodes_[node]; }
  /// Segments at a node.
  const std::vector<std::uint32_t>& at(std::uint32_t node) const { return at_[node]; }
  std::uint32_t segment_count() const { return static_cast<std::uint32_t>(segments_.size()); }
  const Segment& segment(std::uint32_t segment) const { return segments_[segment]; }
  double length(std::uint32_t segment) const { return distance(nodes_[ends(segment)[0]], nodes_[ends(segment)[1]]); }
  Point3 middle(std::uint32_t segment) const { return midpoint(nodes_[ends(segment)[0]], nodes_[ends(segment)[1]]); }
  /// The input's edge at its middle.
  const FeatureEdges::Edge& edge(std::uint32_t segment) const;
  /// The nodes where a line begins and ends.
  const Edge& line_ends(std::uint32_t line) const { return line_ends_[line]; }
  bool joined(std::uint32_t node, std::uint32_t other) const;

  /// The segment that p encroaches on most, if it does on any other than those at `node`.
  std::optional<std::uint32_t> encroached_by(const Point3& p, std::uint32_t node = ~0u) const;
  /// Not into parts shorter than the shortest, nor, of a line that is as short itself, into more than a few.
  bool may_split(std::uint32_t segment) const;
  /// Halves it: returns the new node. Its number stays that of one half. pre: may_split().
  std::uint32_t split(std::uint32_t segment);

 private:
  struct LineEnd {
    std::uint32_t line;
    bool last;
  };

  const Edge& ends(std::uint32_t segment) const { return segments_[segment].ends; }
  std::uint32_t add_node(const Point3& p);
  void add_segment(std::uint32_t line, Edge ends, double from, double to);
  void put_into_grid(std::uint32_t segment);
  double wanted_length(const Point3& p) const;
  std::vector<std::array<double, 2>> find_shells() const;
  double shell_at(const std::vector<LineEnd>& there, const std::vector<std::array<bool, 2>>& acute) const;
  void cut_line(std::uint32_t line, const Edge& ends, const std::array<double, 2>& shells, const GoOn& go_on);
  void cut_piece(std::uint32_t line, Edge ends, double from, double to, const GoOn& go_on);
  void cut_encroached(const GoOn& go_on);

  FeatureEdges edges_;
  SizeField size_;
  double longest_, shortest_;
  std::vector<FeatureLine> lines_;
  std::vector<Edge> line_ends_;
  std::vector<Point3> nodes_;
  std::vector<std::vector<std::uint32_t>> at_;
  std::vector<Segment> segments_;
  BallGrid grid_;
};

}  // namespace delvox
