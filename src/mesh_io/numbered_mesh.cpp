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

void NumberedMesh::move_into(const Source& source, RawMesh& mesh) {
  sort_nodes();
  const auto twice = std::adjacent_find(numbers_.begin(), numbers_.end());
  if (twice != numbers_.end()) {
    source.fail("two nodes have the number " + std::to_string(*twice),
                "does it hold several parts? write them to files of their own");
  }
  // Differences of unsigned numbers cannot overflow.
  const std::uint64_t first = numbers_.empty() ? 0 : static_cast<std::uint64_t>(numbers_.front());
  const bool in_a_row = !numbers_.empty() && static_cast<std::uint64_t>(numbers_.back()) - first == numbers_.size() - 1;
  const auto index_of = [&](std::int64_t number) {
    if (in_a_row) {
      const std::uint64_t index = static_cast<std::uint64_t>(number) - first;
      if (index < numbers_.size()) return static_cast<std::int64_t>(index);
    } else {
      const auto found = std::lower_bound(numbers_.begin(), numbers_.end(), number);
      if (found != numbers_.end() && *found == number) return static_cast<std::int64_t>(found - numbers_.begin());
    }
    source.fail("an element names node " + std::to_string(number) + ", which there is not");
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
  const auto first_element = [&](std::int64_t number) {
    return std::lower_bound(elements_.begin(), elements_.end(), number,
                            [](const Element& element, std::int64_t wanted) { return element.number < wanted; });
  };
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
    const auto at = first_element(member.element);
    if (at == elements_.end() || at->number != member.element) continue;
    const std::int64_t tet = tet_of[static_cast<std::size_t>(at - elements_.begin())];
    if (tet >= 0) mesh.set(member.set).faces.push_back({static_cast<std::uint32_t>(tet), member.face});
  }
}

}  // namespace delvox::mesh_io
