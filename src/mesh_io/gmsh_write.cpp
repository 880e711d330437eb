// Gmsh MSH 4.1 and 2.2 as text: https://gmsh.info/doc/texinfo/gmsh.html#Gmsh-file-formats
// One physical group for the boundary, one for each region of tets.
#include <map>
#include <string>
#include <vector>

#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"

namespace delvox::mesh_io {
namespace {

constexpr int kTriangleType = 2, kTetType = 4;
constexpr int kSurface = 1;  // both the entity and its physical group

/// Tets by region; the entity of a region is its rank here, counted from 1, its physical group the region itself.
using Regions = std::map<Label, std::vector<std::size_t>>;

Regions regions_of(const MeshView& mesh) {
  Regions regions;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) regions[mesh.region(t)].push_back(t);
  return regions;
}

void write_head(const char* version, const MeshView& mesh, const Regions& regions, Out& out) {
  out.put("$MeshFormat\n", version, " 0 8\n$EndMeshFormat\n$Comments\n", header_comment(mesh.info), "\n$EndComments\n");
  out.put("$PhysicalNames\n", regions.size() + 1, "\n2 ", kSurface, " \"boundary\"\n");
  for (const auto& [region, tets] : regions) out.put("3 ", region, " \"region_", region, "\"\n");
  out.put("$EndPhysicalNames\n");
}

void write_entities(const MeshView& mesh, const Regions& regions, Out& out) {
  Box3 box;
  for (const Point3& p : mesh.points) box.extend(p);
  const auto put_box = [&] {
    for (const Point3& p : {box.min, box.max}) out.put(' ', p.x, ' ', p.y, ' ', p.z);
  };
  out.put("$Entities\n0 0 1 ", regions.size(), '\n', kSurface);
  put_box();
  out.put(" 1 ", kSurface, " 0\n");
  int entity = 0;
  for (const auto& [region, tets] : regions) {
    out.put(++entity);
    put_box();
    // Where there are several regions, which part of the boundary bounds which is not said.
    out.put(" 1 ", region, regions.size() == 1 ? " 1 1\n" : " 0\n");
  }
  out.put("$EndEntities\n");
}

/// Nodes by the entity they lie on: 0 the surface, then the regions.
std::vector<std::vector<std::size_t>> nodes_by_entity(const MeshView& mesh, const Regions& regions) {
  const std::size_t last = regions.size();
  std::vector<std::size_t> entity_of(mesh.points.size(), last);
  std::size_t entity = last;
  for (auto region = regions.rbegin(); region != regions.rend(); ++region, --entity) {
    for (std::size_t t : region->second) {
      for (std::uint32_t node : mesh.tets[t]) entity_of[node] = entity;
    }
  }
  for (const Triangle& triangle : mesh.triangles) {
    for (std::uint32_t node : triangle) entity_of[node] = 0;
  }
  std::vector<std::vector<std::size_t>> result(last + 1);
  for (std::size_t i = 0; i < entity_of.size(); ++i) result[entity_of[i]].push_back(i);
  return result;
}

void write_nodes41(const MeshView& mesh, const Regions& regions, Out& out) {
  const auto by_entity = nodes_by_entity(mesh, regions);
  out.put("$Nodes\n", by_entity.size(), ' ', mesh.points.size(), " 1 ", mesh.points.size(), '\n');
  for (std::size_t entity = 0; entity < by_entity.size(); ++entity) {
    const std::vector<std::size_t>& nodes = by_entity[entity];
    if (entity == 0) {
      out.put("2 ", kSurface);
    } else {
      out.put("3 ", entity);
    }
    out.put(" 0 ", nodes.size(), '\n');
    for (std::size_t i : nodes) out.put(i + 1, '\n');
    for (std::size_t i : nodes) out.put(mesh.points[i].x, ' ', mesh.points[i].y, ' ', mesh.points[i].z, '\n');
  }
  out.put("$EndNodes\n");
}

void put_nodes(std::span<const std::uint32_t> nodes, Out& out) {
  for (std::uint32_t node : nodes) out.put(' ', node + 1);
  out.put('\n');
}

void write_elements41(const MeshView& mesh, const Regions& regions, Out& out) {
  const std::size_t count = mesh.triangles.size() + mesh.tets.size();
  out.put("$Elements\n", regions.size() + 1, ' ', count, " 1 ", count, '\n');
  out.put("2 ", kSurface, ' ', kTriangleType, ' ', mesh.triangles.size(), '\n');
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    out.put(i + 1);
    put_nodes(mesh.triangles[i], out);
  }
  int entity = 0;
  for (const auto& [region, tets] : regions) {
    out.put("3 ", ++entity, ' ', kTetType, ' ', tets.size(), '\n');
    for (std::size_t t : tets) {
      out.put(mesh.triangles.size() + t + 1);
      put_nodes(mesh.tets[t], out);
    }
  }
  out.put("$EndElements\n");
}

}  // namespace

void write_gmsh41(const MeshView& mesh, Out& out) {
  const Regions regions = regions_of(mesh);
  write_head("4.1", mesh, regions, out);
  write_entities(mesh, regions, out);
  write_nodes41(mesh, regions, out);
  write_elements41(mesh, regions, out);
}

void write_gmsh22(const MeshView& mesh, Out& out) {
  const Regions regions = regions_of(mesh);
  write_head("2.2", mesh, regions, out);
  out.put("$Nodes\n", mesh.points.size(), '\n');
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    out.put(i + 1, ' ', mesh.points[i].x, ' ', mesh.points[i].y, ' ', mesh.points[i].z, '\n');
  }
  out.put("$EndNodes\n$Elements\n", mesh.triangles.size() + mesh.tets.size(), '\n');
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    out.put(i + 1, ' ', kTriangleType, " 2 ", kSurface, ' ', kSurface);
    put_nodes(mesh.triangles[i], out);
  }
  std::map<Label, int> entity_of;
  for (const auto& [region, tets] : regions) entity_of.emplace(region, static_cast<int>(entity_of.size()) + 1);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Label region = mesh.region(t);
    out.put(mesh.triangles.size() + t + 1, ' ', kTetType, " 2 ", region, ' ', entity_of[region]);
    put_nodes(mesh.tets[t], out);
  }
  out.put("$EndElements\n");
}

}  // namespace delvox::mesh_io
