#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "delvox/core/mesh.h"
#include "delvox/mesh_io/write_deck.h"
#include "mesh_io/node_order.h"

namespace delvox::mesh_io {

/// The nodes of one cell, up to ten.
class CellNodes {
 public:
  void add(std::uint32_t node) { nodes_[count_++] = node; }
  std::size_t size() const { return count_; }
  std::uint32_t operator[](std::size_t i) const { return nodes_[i]; }
  const std::uint32_t* begin() const { return nodes_.data(); }
  const std::uint32_t* end() const { return nodes_.data() + count_; }

 private:
  std::array<std::uint32_t, 10> nodes_{};
  std::size_t count_ = 0;
};

/// A mesh to be written, in the unit of the file: a surface, or tets and their boundary.
struct MeshView {
  std::span<const Point3> points;
  std::span<const Triangle> triangles;       ///< the surface, or the boundary of the tets
  std::span<const Tet> tets;                 ///< empty for a surface
  std::span<const Label> regions;            ///< one per tet, or empty: all 1
  std::span<const std::uint8_t> on_surface;  ///< one per point, or empty: not known
  const MeshInfo& info;
  bool is_tet_mesh;
  std::span<const TetFace> faces = {};       ///< the boundary triangles as faces of tets, rising; if there are sets
                                             ///< or mid-side nodes
  std::span<const MidNodes> mid_nodes = {};  ///< one per tet, or empty: first order
  std::span<const MeshSet> sets = {};
  std::span<const Material> materials = {};
  const StaticDeck* deck = nullptr;  ///< to be run on it (.inp), or null
  std::string stem = {};  ///< the file's name without its extension, for files that name others

  bool second_order() const { return !mid_nodes.empty(); }
  Label region(std::size_t tet) const { return regions.empty() ? 1 : regions[tet]; }
  /// Corners and mid-side nodes, in the order of a format.
  CellNodes tet_nodes(std::size_t tet, const NodeOrder& order = kOwnOrder) const;
  CellNodes triangle_nodes(std::size_t triangle, const NodeOrder& order = kOwnOrder) const;
  CellNodes face_nodes(TetFace face, const NodeOrder& order = kOwnOrder) const;
  /// The material of a region, or null.
  const Material* material(Label region) const;
  /// The name of its material, or "region_N".
  std::string region_name(Label region) const;
  /// Young's modulus (MPa in mm, Pa in m) and density (t/mm3 in mm, kg/m3 in m) in units that go with the file's.
  double modulus_in_unit(const Material& material) const;
  double density_in_unit(const Material& material) const;
};

/// Tets by region, regions rising.
using Regions = std::map<Label, std::vector<std::size_t>>;
Regions regions_of(const MeshView& mesh);

/// Cells that belong to the same sets, one group after the other: for formats where a cell belongs to one group.
struct Membership {
  std::vector<std::size_t> sets;   ///< indices into MeshView::sets, rising
  std::vector<std::size_t> cells;  ///< indices into MeshView::triangles or tets, rising
};
/// All boundary triangles, by the sets they belong to.
std::vector<Membership> triangles_by_sets(const MeshView& mesh);
/// Those of `tets`, by the sets they belong to.
std::vector<Membership> tets_by_sets(const MeshView& mesh, const std::vector<std::size_t>& tets);

}  // namespace delvox::mesh_io
