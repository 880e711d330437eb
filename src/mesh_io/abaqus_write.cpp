// Abaqus and CalculiX input. CalculiX reads at most 20 characters per field and silently misreads longer ones, so
// coordinates get 12 significant digits.
#include <string>
#include <vector>

#include "mesh_io/abaqus_deck.h"
#include "mesh_io/abaqus_names.h"
#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"

namespace delvox::mesh_io {
namespace {

constexpr std::size_t kPerLine = 16;  // what Abaqus takes at most

void write_nodes(const MeshView& mesh, Out& out) {
  out.put("*NODE, NSET=", kAllNodes, '\n');
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const Point3& p = mesh.points[i];
    out.put(i + 1, ", ", Digits12{p.x}, ", ", Digits12{p.y}, ", ", Digits12{p.z}, '\n');
  }
}

/// Eleven numbers, those of a quadratic tet, fit the 16 of a line.
void write_element(std::size_t number, const CellNodes& nodes, Out& out) {
  out.put(number);
  for (std::uint32_t node : nodes) out.put(", ", node + 1);
  out.put('\n');
}

void write_tets(const MeshView& mesh, Out& out) {
  const Regions regions = regions_of(mesh);
  for (const auto& [region, tets] : regions) {
    out.put("*ELEMENT, TYPE=", mesh.second_order() ? "C3D10" : "C3D4", ", ELSET=", kRegionPrefix, region, '\n');
    for (std::size_t t : tets) write_element(t + 1, mesh.tet_nodes(t), out);
  }
  out.put("*ELSET, ELSET=", kAllTets, '\n');
  for (const auto& [region, tets] : regions) out.put(kRegionPrefix, region, '\n');
}

/// A list of numbers, counted from 1.
void write_numbers(std::span<const std::uint32_t> indices, Out& out) {
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (i > 0) out.put(i % kPerLine == 0 ? ",\n" : ", ");
    out.put(indices[i] + 1);
  }
  out.put('\n');
}

void write_faces(std::string_view name, std::span<const TetFace> faces, Out& out) {
  out.put("*SURFACE, NAME=", name, ", TYPE=ELEMENT\n");
  for (TetFace face : faces) {
    out.put(face.tet + 1, ", S", int{kAbaqusFace[face.face]}, '\n');
  }
}

/// The nodes of the boundary, and its faces if they are known: for boundary conditions.
void write_boundary(const MeshView& mesh, Out& out) {
  std::vector<bool> used(mesh.points.size(), false);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t node : mesh.triangle_nodes(t)) used[node] = true;
  }
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t i = 0; i < used.size(); ++i) {
    if (used[i]) nodes.push_back(i);
  }
  out.put("*NSET, NSET=", kBoundary, '\n');
  write_numbers(nodes, out);
  if (!mesh.faces.empty()) write_faces(kBoundary, mesh.faces, out);
}

void write_sets(const MeshView& mesh, Out& out) {
  for (const MeshSet& set : mesh.sets) {
    if (!set.nodes.empty()) {
      out.put("*NSET, NSET=", set.name, '\n');
      write_numbers(set.nodes, out);
    }
    if (!set.tets.empty()) {
      out.put("*ELSET, ELSET=", set.name, '\n');
      write_numbers(set.tets, out);
    }
    if (!set.faces.empty()) write_faces(set.name, set.faces, out);
  }
}

void write_materials(const MeshView& mesh, Out& out) {
  for (const Material& material : mesh.materials) {
    out.put("*MATERIAL, NAME=", material.name, "\n*ELASTIC\n", Digits12{mesh.modulus_in_unit(material)}, ", ",
            Digits12{material.poisson_ratio}, '\n');
    if (material.density_kg_m3 > 0) out.put("*DENSITY\n", Digits12{mesh.density_in_unit(material)}, '\n');
  }
  for (const auto& [region, tets] : regions_of(mesh)) {
    const Material* material = mesh.material(region);
    if (material == nullptr) continue;
    out.put("*SOLID SECTION, ELSET=", kRegionPrefix, region, ", MATERIAL=", material->name, '\n');
  }
}

}  // namespace

void write_abaqus(const MeshView& mesh, Out& out) {
  out.put("** ", header_comment(mesh.info), '\n');
  write_nodes(mesh, out);
  if (mesh.is_tet_mesh) {
    write_tets(mesh, out);
    write_boundary(mesh, out);
    write_sets(mesh, out);
    write_materials(mesh, out);
    if (mesh.deck != nullptr) write_static_step(mesh, *mesh.deck, out);
    return;
  }
  out.put("*ELEMENT, TYPE=S3, ELSET=", kBoundary, '\n');
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) write_element(t + 1, mesh.triangle_nodes(t), out);
}

}  // namespace delvox::mesh_io
