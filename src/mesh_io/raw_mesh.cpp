#include "mesh_io/raw_mesh.h"

#include <limits>
#include <string>
#include <utility>

#include "mesh_io/triangulate_polygon.h"

namespace delvox::mesh_io {
namespace {

std::uint32_t as_index(const Source& source, std::int64_t node) {
  if (node < 0 || node >= std::numeric_limits<std::uint32_t>::max()) {
    source.fail("a cell names point " + std::to_string(node) + ", which cannot be");
  }
  return static_cast<std::uint32_t>(node);
}

/// Throws unless every index of a cell is below `point_count`.
template <class Cell>
void check_cell(const Source& source, const Cell& cell, std::size_t point_count) {
  for (std::uint32_t index : cell) {
    if (index < point_count) continue;
    source.fail("a cell names point " + std::to_string(index) + " (counted from 0) of " + std::to_string(point_count));
  }
}

}  // namespace

void RawMesh::add_cell(const Source& source, CellKind kind, std::span<const std::int64_t> nodes,
                       const std::string& name) {
  const auto need = [&](std::size_t count) {
    if (nodes.size() < count) source.fail("a cell of kind " + name + " has " + std::to_string(nodes.size()) + " nodes");
  };
  const auto node = [&](std::size_t i) { return as_index(source, nodes[i]); };
  const auto mark_mid_nodes = [&](std::size_t corners) {
    for (std::size_t i = corners; i < nodes.size(); ++i) mid_nodes_.push_back(node(i));
  };
  switch (kind) {
    case CellKind::kIgnored: break;
    case CellKind::kTriangle:
      need(3);
      triangles.push_back({node(0), node(1), node(2)});
      mark_mid_nodes(3);
      break;
    case CellKind::kTet:
      need(4);
      tets.push_back({node(0), node(1), node(2), node(3)});
      mark_mid_nodes(4);
      break;
    case CellKind::kPolygon: {
      need(3);
      if (nodes.size() == 3) {
        triangles.push_back({node(0), node(1), node(2)});
        break;
      }
      std::vector<std::uint32_t>& polygon = polygons_.emplace_back();
      for (std::size_t i = 0; i < nodes.size(); ++i) polygon.push_back(node(i));
      break;
    }
    case CellKind::kStrip:
      need(3);
      for (std::size_t i = 0; i + 2 < nodes.size(); ++i) {
        const std::size_t odd = i % 2;
        triangles.push_back({node(i + odd), node(i + 1 - odd), node(i + 2)});
      }
      break;
    case CellKind::kUnsupported:
      source.fail("holds a cell of kind " + name + ", which is neither tet nor triangle nor polygon",
                  "split such cells into tets or triangles first");
  }
}

void RawMesh::add_cell(const Source& source, CellKind kind, std::span<const std::int64_t> nodes,
                       const std::string& name, std::int64_t region) {
  add_cell(source, kind, nodes, name);
  if (kind != CellKind::kTet) return;
  if (region < std::numeric_limits<Label>::min() || region > std::numeric_limits<Label>::max()) {
    source.fail("a tet has region " + std::to_string(region) + ", which does not fit 32 bits");
  }
  regions.push_back(static_cast<Label>(region));
}

void RawMesh::triangulate_polygons(const Source& source) {
  for (const std::vector<std::uint32_t>& polygon : polygons_) {
    check_cell(source, polygon, points.size());
    const auto pieces = triangulate_polygon(polygon, points);
    if (!pieces) {
      source.fail("a polygon of " + std::to_string(polygon.size()) + " corners crosses itself or is too large",
                  "triangulate it with another tool first");
    }
    triangles.insert(triangles.end(), pieces->begin(), pieces->end());
  }
}

/// Nodes that only higher-order cells used would stay behind as orphans: our cells have corners alone.
void RawMesh::drop_mid_nodes() {
  if (mid_nodes_.empty()) return;
  constexpr std::uint32_t kDropped = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> renumbered(points.size(), 0);
  for (std::uint32_t node : mid_nodes_) renumbered[node] = kDropped;
  for (const Tet& tet : tets) {
    for (std::uint32_t node : tet) renumbered[node] = 0;
  }
  for (const Triangle& triangle : triangles) {
    for (std::uint32_t node : triangle) renumbered[node] = 0;
  }
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (renumbered[i] == kDropped) continue;
    points[kept] = points[i];
    if (!on_surface.empty()) on_surface[kept] = on_surface[i];
    renumbered[i] = kept++;
  }
  points.resize(kept);
  if (!on_surface.empty()) on_surface.resize(kept);
  for (Tet& tet : tets) {
    for (std::uint32_t& node : tet) node = renumbered[node];
  }
  for (Triangle& triangle : triangles) {
    for (std::uint32_t& node : triangle) node = renumbered[node];
  }
}

Mesh RawMesh::finish(const Source& source) && {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_finite(points[i])) source.fail("point " + std::to_string(i) + " (counted from 0) is not finite");
  }
  for (const Tet& tet : tets) check_cell(source, tet, points.size());
  if (tets.empty()) {
    triangulate_polygons(source);
  } else {
    triangles.clear();
  }
  for (const Triangle& triangle : triangles) check_cell(source, triangle, points.size());
  if (tets.empty() && triangles.empty()) {
    source.fail("holds neither tets nor triangles", "is it a mesh, and whole?");
  }
  check_cell(source, mid_nodes_, points.size());
  if (!on_surface.empty() && on_surface.size() != points.size()) source.fail("on_surface does not match its points");
  drop_mid_nodes();
  if (tets.empty()) return SurfaceMesh{std::move(points), std::move(triangles), info};
  if (!regions.empty() && regions.size() != tets.size()) source.fail("region does not match its tets");
  TetMesh mesh{std::move(points), std::move(tets), std::move(regions), {}, std::move(on_surface), info};
  mesh.boundary = boundary_of(mesh.tets);
  return mesh;
}

}  // namespace delvox::mesh_io
