#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mesh_io/raw_mesh.h"

namespace delvox::mesh_io {

/// Nodes and elements that carry numbers, in files that may list them in any order.
class NumberedMesh {
 public:
  void add_node(std::int64_t number, const Point3& point) {
    numbers_.push_back(number);
    points_.push_back(point);
  }
  void add_element(std::int64_t number, CellKind kind, std::span<const std::int64_t> nodes, std::int64_t region);

  /// Puts nodes and elements into `mesh` by rising number, which gives our own files back the order they had.
  void move_into(const Source& source, RawMesh& mesh);

 private:
  struct Element {
    std::int64_t number;
    CellKind kind;
    std::size_t first_node, node_count;  ///< in element_nodes_
    std::int64_t region;
  };
  void sort_nodes();

  std::vector<std::int64_t> numbers_;
  std::vector<Point3> points_;
  std::vector<Element> elements_;
  std::vector<std::int64_t> element_nodes_;
};

}  // namespace delvox::mesh_io
