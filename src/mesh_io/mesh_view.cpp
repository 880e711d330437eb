#include "mesh_io/mesh_view.h"

#include <algorithm>

namespace delvox::mesh_io {
namespace {

template <std::size_t N, class NodeAt>
CellNodes in_order(const std::array<std::uint8_t, N>& order, const NodeAt& node_at) {
  CellNodes nodes;
  for (std::uint8_t place : order) nodes.add(node_at(place));
  return nodes;
}

/// Groups cells by the list of sets that name them; groups in the order of those lists.
template <class Cells>
std::vector<Membership> grouped(const Cells& cells, const std::vector<std::vector<std::size_t>>& sets_of) {
  std::map<std::vector<std::size_t>, std::vector<std::size_t>> groups;
  for (std::size_t cell : cells) groups[sets_of[cell]].push_back(cell);
  std::vector<Membership> result;
  for (auto& [sets, members] : groups) result.push_back({sets, std::move(members)});
  return result;
}

}  // namespace

CellNodes MeshView::tet_nodes(std::size_t tet, const NodeOrder& order) const {
  const auto node_at = [&](std::uint8_t place) { return place < 4 ? tets[tet][place] : mid_nodes[tet][place - 4u]; };
  return second_order() ? in_order(order.tet10, node_at) : in_order(order.tet4, node_at);
}

CellNodes MeshView::face_nodes(TetFace face, const NodeOrder& order) const {
  const auto& corners = kTetFaces[face.face];
  std::array<std::uint32_t, 6> nodes{};
  for (std::size_t i = 0; i < 3; ++i) nodes[i] = tets[face.tet][static_cast<std::size_t>(corners[i])];
  CellNodes result;
  if (!second_order()) {
    for (std::size_t i = 0; i < 3; ++i) result.add(nodes[i]);
    return result;
  }
  const std::array<std::uint32_t, 3> middles = face_mid_nodes(mid_nodes[face.tet], face.face);
  std::copy(middles.begin(), middles.end(), nodes.begin() + 3);
  return in_order(order.triangle6, [&](std::uint8_t place) { return nodes[place]; });
}

CellNodes MeshView::triangle_nodes(std::size_t triangle, const NodeOrder& order) const {
  if (second_order()) return face_nodes(faces[triangle], order);
  CellNodes nodes;
  for (std::uint32_t node : triangles[triangle]) nodes.add(node);
  return nodes;
}

const Material* MeshView::material(Label region) const {
  const auto found =
      std::find_if(materials.begin(), materials.end(), [&](const Material& m) { return m.region == region; });
  return found == materials.end() ? nullptr : &*found;
}

std::string MeshView::region_name(Label region) const {
  const Material* found = material(region);
  return found != nullptr ? found->name : "region_" + std::to_string(region);
}

double MeshView::modulus_in_unit(const Material& material) const {
  return material.youngs_modulus_mpa * (info.unit == LengthUnit::kMetre ? 1e6 : 1);
}

double MeshView::density_in_unit(const Material& material) const {
  return material.density_kg_m3 * (info.unit == LengthUnit::kMetre ? 1 : 1e-12);
}

Regions regions_of(const MeshView& mesh) {
  Regions regions;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) regions[mesh.region(t)].push_back(t);
  return regions;
}

std::vector<Membership> triangles_by_sets(const MeshView& mesh) {
  std::vector<std::vector<std::size_t>> sets_of(mesh.triangles.size());
  for (std::size_t s = 0; s < mesh.sets.size(); ++s) {
    for (TetFace face : mesh.sets[s].faces) {
      const auto found = std::lower_bound(mesh.faces.begin(), mesh.faces.end(), face);
      if (found != mesh.faces.end() && *found == face) {
        sets_of[static_cast<std::size_t>(found - mesh.faces.begin())].push_back(s);
      }
    }
  }
  std::vector<std::size_t> all(mesh.triangles.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  return grouped(all, sets_of);
}

std::vector<Membership> tets_by_sets(const MeshView& mesh, const std::vector<std::size_t>& tets) {
  std::vector<std::vector<std::size_t>> sets_of(mesh.tets.size());
  for (std::size_t s = 0; s < mesh.sets.size(); ++s) {
    for (std::uint32_t tet : mesh.sets[s].tets) sets_of[tet].push_back(s);
  }
  return grouped(tets, sets_of);
}

}  // namespace delvox::mesh_io
