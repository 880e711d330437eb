#include "mesh_io/numbered_mesh.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace delvox::mesh_io {

void NumberedMesh::add_element(std::int64_t number, CellKind kind, std::span<const std::int64_t> nodes,
                               std::int64_t region) {
  elements_.push_back({number, kind, element_nodes_.size(), nodes.size(), region});
  element_nodes_.insert(element_nodes_.end(), nodes.begin(), nodes.end());
}

void NumberedMesh::sort_nodes() {
  if (std::is_sorted(numbers_.begin(), numbers_.end())) return;
  std::vector<std::size_t> order(numbers_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return numbers_[a] < numbers_[b]; });
  std::vector<Point3> points;
  points.reserve(points_.size());
  for (std::size_t i : order) points.push_back(points_[i]);
  points_ = std::move(points);
  std::sort(numbers_.begin(), numbers_.end());
}

std::int64_t NumberedMesh::find_node(std::int64_t number) const {
  if (numbers_.empty()) return -1;
  // Differences of unsigned numbers cannot overflow.
  const std::uint64_t first = static_cast<std::uint64_t>(numbers_.front());
  const bool in_a_row = static_cast<std::uint64_t>(numbers_.back()) - first == numbers_.size() - 1;
  if (in_a_row) {
    const std::uint64_t index = static_cast<std::uint64_t>(number) - first;
    return index < numbers_.size() ? static_cast<std::int64_t>(index) : -1;
  }
  const auto found = std::lower_bound(numbers_.begin(), numbers_.end(), number);
  return found != numbers_.end() && *found == number ? found - numbers_.begin() : -1;
}

std::vector<NumberedMesh::Element>::const_iterator NumberedMesh::first_element(std::int64_t number) const {
  return std::lower_bound(elements_.begin(), elements_.end(), number,
                          [](const Element& element, std::int64_t wanted) { return element.number < wanted; });
}

std::int64_t NumberedMesh::tet_numbered(std::int64_t number, const std::vector<std::int64_t>& tet_of) const {
  const auto at = first_element(number);
  if (at == elements_.end() || at->number != number) return -1;
  return tet_of[static_cast<std::size_t>(at - elements_.begin())];
}

void NumberedMesh::move_into(const Source& source, RawMesh& mesh) {
  sort_nodes();
  const auto twice = std::adjacent_find(numbers_.begin(), numbers_.end());
  if (twice != numbers_.end()) {
    source.fail("two nodes have the number " + std::to_string(*twice),
                "does it hold several parts? write them to files of their own");
  }
  const auto index_of = [&](std::int64_t number) {
    const std::int64_t index = find_node(number);
    if (index < 0) source.fail("an element names node " + std::to_string(number) + ", which there is not");
    return index;
  };
  const auto by_number = [](const Element& a, const Element& b) { return a.number < b.number; };
  if (!std::is_sorted(elements_.begin(), elements_.end(), by_number)) {
    std::stable_sort(elements_.begin(), elements_.end(), by_number);
  }
  for (std::int64_t& node : element_nodes_) node = index_of(node);
  std::vector<std::int64_t> tet_of;  // of each element, or -1
  for (const Element& element : elements_) {
    const auto nodes = std::span(element_nodes_).subspan(element.first_node, element.node_count);
    const std::size_t tets = mesh.tets.size();
    mesh.add_cell(source, element.kind, nodes, "element", element.region);
    tet_of.push_back(mesh.tets.size() > tets ? static_cast<std::int64_t>(tets) : -1);
  }
  mesh.points = std::move(points_);
  fill_sets(source, tet_of, mesh);
}

void NumberedMesh::fill_sets(const Source& source, const std::vector<std::int64_t>& tet_of, RawMesh& mesh) const {
  for (const std::string& name : set_names_) mesh.set(name);
  std::size_t budget = 64 * (source.bytes.size() + 1);  // steps: ranges may say far more than there is
  const auto spend = [&] {
    if (budget-- == 0) source.fail("its sets overlap beyond reason");
  };
  const auto in_range = [](const NumberRange& range, std::int64_t number) {
    const std::uint64_t offset = static_cast<std::uint64_t>(number) - static_cast<std::uint64_t>(range.first);
    return offset % static_cast<std::uint64_t>(range.step) == 0;
  };
  for (const auto& [name, range] : node_sets_) {
    RawSet& set = mesh.set(name);
    for (auto at = std::lower_bound(numbers_.begin(), numbers_.end(), range.first);
         at != numbers_.end() && *at <= range.last; ++at) {
      spend();
      if (in_range(range, *at)) set.nodes.push_back(static_cast<std::uint32_t>(at - numbers_.begin()));
    }
  }
  for (const auto& [name, range] : element_sets_) {
    RawSet& set = mesh.set(name);
    for (auto at = first_element(range.first); at != elements_.end() && at->number <= range.last; ++at) {
      spend();
      if (!in_range(range, at->number)) continue;
      const std::int64_t tet = tet_of[static_cast<std::size_t>(at - elements_.begin())];
      const auto* nodes = &element_nodes_[at->first_node];
      if (tet >= 0) {
        set.tets.push_back(static_cast<std::uint32_t>(tet));
      } else if (at->kind == CellKind::kTriangle) {
        set.triangles.push_back({static_cast<std::uint32_t>(nodes[0]), static_cast<std::uint32_t>(nodes[1]),
                                 static_cast<std::uint32_t>(nodes[2])});
      }
    }
  }
  for (const FaceOfSet& member : face_sets_) {
    const std::int64_t tet = tet_numbered(member.element, tet_of);
    if (tet >= 0) mesh.set(member.set).faces.push_back({static_cast<std::uint32_t>(tet), member.face});
  }
  for (const OppositeFace& member : opposite_faces_) {
    const std::int64_t tet = tet_numbered(member.element, tet_of), corner = find_node(member.corner);
    if (tet < 0 || corner < 0) continue;
    const Tet& corners = mesh.tets[static_cast<std::size_t>(tet)];
    for (std::uint8_t face = 0; face < 4; ++face) {
      if (corners[face] == corner) mesh.set(member.set).faces.push_back({static_cast<std::uint32_t>(tet), face});
    }
  }
  for (const auto& [name, corners] : triangles_) {
    Triangle triangle{};
    bool known = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t node = find_node(corners[i]);
      known = known && node >= 0;
      triangle[i] = static_cast<std::uint32_t>(std::max<std::int64_t>(node, 0));
    }
    if (known) mesh.set(name).triangles.push_back(triangle);
  }
}

}  // namespace delvox::mesh_io
