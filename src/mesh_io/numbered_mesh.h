#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mesh_io/raw_mesh.h"

namespace delvox::mesh_io {

/// Numbers first, first + step, ... up to last, as members of a set; one number is a range too.
struct NumberRange {
  std::int64_t first, last, step;
};

/// Nodes and elements that carry numbers, in files that may list them in any order.
class NumberedMesh {
 public:
  void add_node(std::int64_t number, const Point3& point) {
    numbers_.push_back(number);
    points_.push_back(point);
  }
  void add_element(std::int64_t number, CellKind kind, std::span<const std::int64_t> nodes, std::int64_t region);

  /// Members of a set that may be listed before what they name. Numbers that nothing carries are passed over.
  void add_nodes_to_set(const std::string& set, NumberRange numbers) {
    mention(set);
    node_sets_.emplace_back(set, numbers);
  }
  void add_elements_to_set(const std::string& set, NumberRange numbers) {
    mention(set);
    element_sets_.emplace_back(set, numbers);
  }
  /// `face`: of kTetFaces.
  void add_face_to_set(const std::string& set, std::int64_t element, std::uint8_t face) {
    mention(set);
    face_sets_.push_back({set, element, face});
  }

  /// The face of a tet that lies opposite one of its corners.
  void add_opposite_face_to_set(const std::string& set, std::int64_t element, std::int64_t corner) {
    mention(set);
    opposite_faces_.push_back({set, element, corner});
  }
  /// A boundary face by its corners, whichever tet it belongs to.
  void add_triangle_to_set(const std::string& set, const std::array<std::int64_t, 3>& corners) {
    mention(set);
    triangles_.emplace_back(set, corners);
  }

  /// Puts nodes and elements into `mesh` by rising number, which gives our own files back the order they had.
  void move_into(const Source& source, RawMesh& mesh);

 private:
  struct Element {
    std::int64_t number;
    CellKind kind;
    std::size_t first_node, node_count;  ///< in element_nodes_
    std::int64_t region;
  };
  struct FaceOfSet {
    std::string set;
    std::int64_t element;
    std::uint8_t face;
  };
  struct OppositeFace {
    std::string set;
    std::int64_t element, corner;
  };
  void sort_nodes();
  void mention(const std::string& set) {
    if (set_names_.empty() || set_names_.back() != set) set_names_.push_back(set);
  }
  void fill_sets(const Source& source, const std::vector<std::int64_t>& tet_of, RawMesh& mesh) const;
  /// The tet that an element has become, or -1.
  std::int64_t tet_numbered(std::int64_t number, const std::vector<std::int64_t>& tet_of) const;
  /// The index of a node, or -1.
  std::int64_t find_node(std::int64_t number) const;
  std::vector<Element>::const_iterator first_element(std::int64_t number) const;

  std::vector<std::int64_t> numbers_;
  std::vector<Point3> points_;
  std::vector<Element> elements_;
  std::vector<std::int64_t> element_nodes_;
  std::vector<std::pair<std::string, NumberRange>> node_sets_, element_sets_;
  std::vector<FaceOfSet> face_sets_;
  std::vector<OppositeFace> opposite_faces_;
  std::vector<std::pair<std::string, std::array<std::int64_t, 3>>> triangles_;
  std::vector<std::string> set_names_;  ///< as they were mentioned
};

}  // namespace delvox::mesh_io
