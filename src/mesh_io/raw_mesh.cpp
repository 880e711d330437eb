#include "mesh_io/raw_mesh.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "mesh_io/triangulate_polygon.h"

namespace delvox::mesh_io {
namespace {

constexpr std::uint32_t kDropped = std::numeric_limits<std::uint32_t>::max();

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
      if (nodes.size() == 10) mid_nodes.push_back({node(4), node(5), node(6), node(7), node(8), node(9)});
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

RawSet& RawMesh::set(const std::string& name) {
  const auto [entry, is_new] = set_index_.try_emplace(name, sets.size());
  if (is_new) sets.emplace_back(name, RawSet{});
  return sets[entry->second].second;
}

/// Nodes that only cells without a place for them used would stay behind as orphans. Returns the new index of each.
std::vector<std::uint32_t> RawMesh::drop_mid_nodes() {
  std::vector<std::uint32_t> renumbered(points.size(), 0);
  for (std::uint32_t node : mid_nodes_) renumbered[node] = kDropped;
  const auto keep = [&](const auto& cells) {
    for (const auto& cell : cells) {
      for (std::uint32_t node : cell) renumbered[node] = 0;
    }
  };
  keep(tets);
  keep(triangles);
  keep(mid_nodes);
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (renumbered[i] == kDropped) continue;
    points[kept] = points[i];
    if (!on_surface.empty()) on_surface[kept] = on_surface[i];
    renumbered[i] = kept++;
  }
  points.resize(kept);
  if (!on_surface.empty()) on_surface.resize(kept);
  const auto renumber = [&](auto& cells) {
    for (auto& cell : cells) {
      for (std::uint32_t& node : cell) node = renumbered[node];
    }
  };
  renumber(tets);
  renumber(triangles);
  renumber(mid_nodes);
  return renumbered;
}

std::vector<MeshSet> RawMesh::finished_sets(const Source& source, const std::vector<std::uint32_t>& renumbered) const {
  std::map<Triangle, TetFace> face_of;
  const auto sorted = [](Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  const bool by_corners =
      std::any_of(sets.begin(), sets.end(), [](const auto& s) { return !s.second.triangles.empty(); });
  if (by_corners) {
    for (TetFace face : boundary_faces(tets)) face_of.emplace(sorted(face_corners(tets, face)), face);
  }
  std::vector<MeshSet> result;
  for (const auto& [name, raw] : sets) {
    MeshSet set{name, {}, raw.tets, raw.faces};
    for (std::uint32_t node : raw.nodes) {
      if (node >= renumbered.size()) source.fail("set " + in_quotes(name) + " names a node that there is not");
      if (renumbered[node] != kDropped) set.nodes.push_back(renumbered[node]);
    }
    for (const Triangle& t : raw.triangles) {
      if (*std::max_element(t.begin(), t.end()) >= renumbered.size()) continue;
      const auto found = face_of.find(sorted({renumbered[t[0]], renumbered[t[1]], renumbered[t[2]]}));
      if (found != face_of.end()) set.faces.push_back(found->second);
    }
    const auto tidy = [](auto& list) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    tidy(set.nodes);
    tidy(set.tets);
    tidy(set.faces);
    const bool beyond = (!set.tets.empty() && set.tets.back() >= tets.size()) ||
                        (!set.faces.empty() && set.faces.back().tet >= tets.size());
    if (beyond) source.fail("set " + in_quotes(name) + " names a tet that there is not");
    if (!set.nodes.empty() || !set.tets.empty() || !set.faces.empty()) result.push_back(std::move(set));
  }
  return result;
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
  if (mid_nodes.size() != tets.size()) mid_nodes.clear();
  for (const MidNodes& middles : mid_nodes) check_cell(source, middles, points.size());
  const std::vector<std::uint32_t> renumbered = drop_mid_nodes();
  if (info.unit == LengthUnit::kMetre) {
    for (Point3& p : points) p = kMmPerMetre * p;
  }
  if (tets.empty()) return SurfaceMesh{std::move(points), std::move(triangles), info, {}};
  if (!regions.empty() && regions.size() != tets.size()) source.fail("region does not match its tets");
  TetMesh mesh;
  mesh.sets = finished_sets(source, renumbered);
  mesh.points = std::move(points);
  mesh.tets = std::move(tets);
  mesh.regions = std::move(regions);
  mesh.on_surface = std::move(on_surface);
  mesh.info = info;
  mesh.mid_nodes = std::move(mid_nodes);
  mesh.boundary = boundary_of(mesh.tets);
  return mesh;
}

}  // namespace delvox::mesh_io
