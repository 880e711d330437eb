// Gmsh MSH 4.1 and 2.2 as text: https://gmsh.info/doc/texinfo/gmsh.html#Gmsh-file-formats
// Physical groups: the boundary, each region of tets, and (4.1) each set, of faces and of tets. Where sets overlap,
// cells are parted into entities by the sets they belong to, so that no cell is written twice.
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"
#include "mesh_io/set_suffix.h"

namespace delvox::mesh_io {
namespace {

constexpr int kSurface = 1;  // the boundary's physical group, and in 2.2 its entity
constexpr int kSetsFrom = 2;

int triangle_type(const MeshView& mesh) {
  return mesh.second_order() ? 9 : 2;
}
int tet_type(const MeshView& mesh) {
  return mesh.second_order() ? 11 : 4;
}

/// Cells of one entity, and the physical groups it belongs to. Entities count from 1 in each dimension.
struct Entity {
  int dimension;
  int tag;
  std::vector<std::int64_t> groups;
  std::vector<std::size_t> cells;  ///< indices of triangles or tets
};

/// What the groups of sets are called by number: triangles and tets of one set share it.
std::int64_t first_set_group(const Regions& regions) {
  return regions.empty() ? kSetsFrom : std::max<std::int64_t>(kSetsFrom, std::int64_t{regions.rbegin()->first} + 1);
}

std::vector<Entity> entities_of(const MeshView& mesh, const Regions& regions) {
  std::vector<Entity> entities;
  const std::int64_t first_set = first_set_group(regions);
  const auto add = [&](int dimension, std::int64_t group, std::vector<Membership> parts) {
    for (Membership& part : parts) {
      const bool follows = !entities.empty() && entities.back().dimension == dimension;
      Entity entity{dimension, follows ? entities.back().tag + 1 : 1, {group}, std::move(part.cells)};
      for (std::size_t set : part.sets) entity.groups.push_back(first_set + static_cast<std::int64_t>(set));
      entities.push_back(std::move(entity));
    }
  };
  add(2, kSurface, triangles_by_sets(mesh));
  for (const auto& [region, tets] : regions) add(3, region, tets_by_sets(mesh, tets));
  return entities;
}

void write_head(const char* version, const MeshView& mesh, const Regions& regions, bool with_sets, Out& out) {
  out.put("$MeshFormat\n", version, " 0 8\n$EndMeshFormat\n$Comments\n", header_comment(mesh.info), "\n$EndComments\n");
  std::vector<std::string> names{"2 " + std::to_string(kSurface) + " \"boundary\""};
  for (const auto& [region, tets] : regions) {
    names.push_back("3 " + std::to_string(region) + " \"" + mesh.region_name(region) + "\"");
  }
  for (std::size_t s = 0; with_sets && s < mesh.sets.size(); ++s) {
    const MeshSet& set = mesh.sets[s];
    const std::string group = " " + std::to_string(first_set_group(regions) + static_cast<std::int64_t>(s)) + " \"";
    if (!set.faces.empty()) names.push_back("2" + group + set.name + "\"");
    if (!set.tets.empty()) names.push_back("3" + group + set.name + kTetsSuffix + "\"");
  }
  out.put("$PhysicalNames\n", names.size(), '\n');
  for (const std::string& name : names) out.put(name, '\n');
  out.put("$EndPhysicalNames\n");
}

void write_entities(const MeshView& mesh, const std::vector<Entity>& entities, Out& out) {
  Box3 box;
  for (const Point3& p : mesh.points) box.extend(p);
  std::size_t surfaces = 0;
  for (const Entity& entity : entities) surfaces += entity.dimension == 2 ? 1 : 0;
  const std::size_t volumes = entities.size() - surfaces;
  out.put("$Entities\n0 0 ", surfaces, ' ', volumes, '\n');
  for (const Entity& entity : entities) {
    out.put(entity.tag);
    for (const Point3& p : {box.min, box.max}) out.put(' ', p.x, ' ', p.y, ' ', p.z);
    out.put(' ', entity.groups.size());
    for (std::int64_t group : entity.groups) out.put(' ', group);
    // Where there are several volumes, which part of the boundary bounds which is not said.
    const bool bounded_by_all = entity.dimension == 3 && volumes == 1;
    out.put(' ', bounded_by_all ? surfaces : 0);
    for (std::size_t s = 0; bounded_by_all && s < surfaces; ++s) out.put(' ', s + 1);
    out.put('\n');
  }
  out.put("$EndEntities\n");
}

/// Nodes by the entity they lie on: the last entities do not take those of earlier ones.
std::vector<std::vector<std::size_t>> nodes_by_entity(const MeshView& mesh, const std::vector<Entity>& entities) {
  const std::size_t last = entities.size() - 1;
  std::vector<std::size_t> entity_of(mesh.points.size(), last);
  for (std::size_t e = entities.size(); e-- > 0;) {
    for (std::size_t cell : entities[e].cells) {
      const CellNodes nodes = entities[e].dimension == 3 ? mesh.tet_nodes(cell) : mesh.triangle_nodes(cell);
      for (std::uint32_t node : nodes) entity_of[node] = e;
    }
  }
  std::vector<std::vector<std::size_t>> result(entities.size());
  for (std::size_t i = 0; i < entity_of.size(); ++i) result[entity_of[i]].push_back(i);
  return result;
}

void write_nodes41(const MeshView& mesh, const std::vector<Entity>& entities, Out& out) {
  const auto by_entity = nodes_by_entity(mesh, entities);
  out.put("$Nodes\n", by_entity.size(), ' ', mesh.points.size(), " 1 ", mesh.points.size(), '\n');
  for (std::size_t e = 0; e < by_entity.size(); ++e) {
    const std::vector<std::size_t>& nodes = by_entity[e];
    out.put(entities[e].dimension, ' ', entities[e].tag, " 0 ", nodes.size(), '\n');
    for (std::size_t i : nodes) out.put(i + 1, '\n');
    for (std::size_t i : nodes) out.put(mesh.points[i].x, ' ', mesh.points[i].y, ' ', mesh.points[i].z, '\n');
  }
  out.put("$EndNodes\n");
}

void put_nodes(const CellNodes& nodes, Out& out) {
  for (std::uint32_t node : nodes) out.put(' ', node + 1);
  out.put('\n');
}

void write_elements41(const MeshView& mesh, const std::vector<Entity>& entities, Out& out) {
  const std::size_t count = mesh.triangles.size() + mesh.tets.size();
  out.put("$Elements\n", entities.size(), ' ', count, " 1 ", count, '\n');
  for (const Entity& entity : entities) {
    const bool is_surface = entity.dimension == 2;
    out.put(entity.dimension, ' ', entity.tag, ' ', is_surface ? triangle_type(mesh) : tet_type(mesh), ' ',
            entity.cells.size(), '\n');
    for (std::size_t cell : entity.cells) {
      out.put(is_surface ? cell + 1 : mesh.triangles.size() + cell + 1);
      put_nodes(is_surface ? mesh.triangle_nodes(cell, kGmshOrder) : mesh.tet_nodes(cell, kGmshOrder), out);
    }
  }
  out.put("$EndElements\n");
}

}  // namespace

void write_gmsh41(const MeshView& mesh, Out& out) {
  const Regions regions = regions_of(mesh);
  const std::vector<Entity> entities = entities_of(mesh, regions);
  write_head("4.1", mesh, regions, true, out);
  write_entities(mesh, entities, out);
  write_nodes41(mesh, entities, out);
  write_elements41(mesh, entities, out);
}

void write_gmsh22(const MeshView& mesh, Out& out) {
  const Regions regions = regions_of(mesh);
  write_head("2.2", mesh, regions, false, out);
  out.put("$Nodes\n", mesh.points.size(), '\n');
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    out.put(i + 1, ' ', mesh.points[i].x, ' ', mesh.points[i].y, ' ', mesh.points[i].z, '\n');
  }
  out.put("$EndNodes\n$Elements\n", mesh.triangles.size() + mesh.tets.size(), '\n');
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    out.put(i + 1, ' ', triangle_type(mesh), " 2 ", kSurface, ' ', kSurface);
    put_nodes(mesh.triangle_nodes(i, kGmshOrder), out);
  }
  std::map<Label, int> entity_of;
  for (const auto& [region, tets] : regions) entity_of.emplace(region, static_cast<int>(entity_of.size()) + 1);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Label region = mesh.region(t);
    out.put(mesh.triangles.size() + t + 1, ' ', tet_type(mesh), " 2 ", region, ' ', entity_of[region]);
    put_nodes(mesh.tet_nodes(t, kGmshOrder), out);
  }
  out.put("$EndElements\n");
}

}  // namespace delvox::mesh_io
