// FEBio's .feb, version 4: https://febio.org/knowledgebase/ (FEBio User Manual 4, chapter "Free Format Input").
#include <string>
#include <vector>

#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"

namespace delvox::mesh_io {
namespace {

void put_list(const CellNodes& nodes, Out& out) {
  for (std::size_t i = 0; i < nodes.size(); ++i) out.put(i == 0 ? "" : ",", nodes[i] + 1);
}

void put_members(std::span<const std::uint32_t> members, Out& out) {
  for (std::size_t i = 0; i < members.size(); ++i) out.put(i == 0 ? "" : i % 16 == 0 ? ",\n" : ",", members[i] + 1);
}

void write_materials(const MeshView& mesh, Out& out) {
  if (mesh.materials.empty()) return;
  out.put("<Material>\n");
  std::size_t id = 0;
  for (const Material& material : mesh.materials) {
    out.put("<material id=\"", ++id, "\" name=\"", material.name, "\" type=\"isotropic elastic\">\n");
    if (material.density_kg_m3 > 0) out.put("<density>", mesh.density_in_unit(material), "</density>\n");
    out.put("<E>", mesh.modulus_in_unit(material), "</E>\n<v>", material.poisson_ratio, "</v>\n</material>\n");
  }
  out.put("</Material>\n");
}

void write_nodes(const MeshView& mesh, Out& out) {
  out.put("<Nodes name=\"all_nodes\">\n");
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const Point3& p = mesh.points[i];
    out.put("<node id=\"", i + 1, "\">", p.x, ",", p.y, ",", p.z, "</node>\n");
  }
  out.put("</Nodes>\n");
}

void write_elements(const MeshView& mesh, Out& out) {
  const auto put_element = [&](std::size_t number, const CellNodes& nodes) {
    out.put("<elem id=\"", number, "\">");
    put_list(nodes, out);
    out.put("</elem>\n");
  };
  if (!mesh.is_tet_mesh) {
    out.put("<Elements type=\"tri3\" name=\"region_1\">\n");
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) put_element(t + 1, mesh.triangle_nodes(t));
    out.put("</Elements>\n");
  }
  for (const auto& [region, tets] : regions_of(mesh)) {
    out.put("<Elements type=\"", mesh.second_order() ? "tet10" : "tet4", "\" name=\"region_", region, "\">\n");
    for (std::size_t t : tets) put_element(t + 1, mesh.tet_nodes(t));
    out.put("</Elements>\n");
  }
}

void write_surface(const std::string& name, std::span<const TetFace> faces, const MeshView& mesh, Out& out) {
  if (faces.empty()) return;
  const char* type = mesh.second_order() ? "tri6" : "tri3";
  out.put("<Surface name=\"", name, "\">\n");
  for (std::size_t i = 0; i < faces.size(); ++i) {
    out.put("<", type, " id=\"", i + 1, "\">");
    put_list(mesh.face_nodes(faces[i]), out);
    out.put("</", type, ">\n");
  }
  out.put("</Surface>\n");
}

void write_sets(const MeshView& mesh, Out& out) {
  for (const MeshSet& set : mesh.sets) {
    if (set.nodes.empty()) continue;
    out.put("<NodeSet name=\"", set.name, "\">");
    put_members(set.nodes, out);
    out.put("</NodeSet>\n");
  }
  for (const MeshSet& set : mesh.sets) write_surface(set.name, set.faces, mesh, out);
  for (const MeshSet& set : mesh.sets) {
    if (set.tets.empty()) continue;
    out.put("<ElementSet name=\"", set.name, "\">");
    put_members(set.tets, out);
    out.put("</ElementSet>\n");
  }
}

void write_domains(const MeshView& mesh, Out& out) {
  if (mesh.materials.empty()) return;
  out.put("<MeshDomains>\n");
  for (const auto& [region, tets] : regions_of(mesh)) {
    const Material* material = mesh.material(region);
    if (material != nullptr) out.put("<SolidDomain name=\"region_", region, "\" mat=\"", material->name, "\"/>\n");
  }
  out.put("</MeshDomains>\n");
}

}  // namespace

void write_febio(const MeshView& mesh, Out& out) {
  out.put("<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>\n<!-- ", header_comment(mesh.info), " -->\n");
  out.put("<febio_spec version=\"4.0\">\n<Module type=\"solid\"/>\n");
  write_materials(mesh, out);
  out.put("<Mesh>\n");
  write_nodes(mesh, out);
  write_elements(mesh, out);
  write_sets(mesh, out);
  out.put("</Mesh>\n");
  write_domains(mesh, out);
  out.put("</febio_spec>\n");
}

}  // namespace delvox::mesh_io
