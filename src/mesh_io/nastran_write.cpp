// Nastran bulk data. Nodes in large fields of 16 characters, elements in small ones of 8, which hold node numbers up to
// 99,999,999. Sets of nodes and tets are SET1 entries; sets of faces are unit pressures (PLOAD4), which do nothing
// until a LOAD of the case control names them.
#include <cstdio>
#include <string>

#include "delvox/core/errors.h"
#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"

namespace delvox::mesh_io {
namespace {

constexpr std::size_t kSmall = 8, kLarge = 16;

std::string padded(std::string text, std::size_t width) {
  text.resize(width, ' ');
  return text;
}

std::string small(std::int64_t value) {
  return padded(std::to_string(value), kSmall);
}

/// As many digits as fit, with the decimal point that Nastran tells real numbers by: "%.*f" or "%.*E", whichever is
/// nearer to the value.
std::string real(double value, std::size_t width) {
  std::string best;
  double best_error = 0;
  for (const char* pattern : {"%.*f", "%.*E"}) {
    for (int digits = static_cast<int>(width); digits >= 1; --digits) {
      char text[400];
      const int length = std::snprintf(text, sizeof text, pattern, digits, value);
      if (length > static_cast<int>(width)) continue;
      const double error = std::abs(std::strtod(text, nullptr) - value);
      if (best.empty() || error < best_error) {
        best = text;
        best_error = error;
      }
      break;
    }
  }
  return padded(best, width);
}

void write_cell(const char* card, std::size_t number, Label property, const CellNodes& nodes, Out& out) {
  out.put(padded(card, kSmall), small(static_cast<std::int64_t>(number)), small(property));
  constexpr std::size_t kFieldsOfALine = 8;
  std::size_t field = 2;
  for (std::uint32_t node : nodes) {
    if (field % kFieldsOfALine == 0) out.put("+\n", padded("+", kSmall));
    out.put(small(std::int64_t{node} + 1));
    ++field;
  }
  out.put('\n');
}

void write_set(const std::string& kind, const std::string& name, std::size_t id,
               const std::vector<std::uint32_t>& members, std::size_t first, Out& out) {
  if (members.empty()) return;
  out.put("$ set of ", kind, ": ", name, '\n', padded("SET1", kSmall), small(static_cast<std::int64_t>(id)));
  std::size_t field = 1;
  for (std::uint32_t member : members) {
    if (field % 8 == 0) out.put("+\n", padded("+", kSmall));
    out.put(small(static_cast<std::int64_t>(first + member)));
    ++field;
  }
  out.put('\n');
}

/// G1 is a corner of the face, G4 the corner opposite to it.
void write_pressure(const MeshView& mesh, const MeshSet& set, std::size_t id, Out& out) {
  if (set.faces.empty()) return;
  out.put("$ set of faces: ", set.name, '\n');
  for (TetFace face : set.faces) {
    out.put(padded("PLOAD4", kSmall), small(static_cast<std::int64_t>(id)), small(std::int64_t{face.tet} + 1),
            padded("1.0", kSmall), std::string(3 * kSmall, ' '), small(std::int64_t{mesh.face_nodes(face)[0]} + 1),
            small(std::int64_t{mesh.tets[face.tet][face.face]} + 1), '\n');
  }
}

void write_properties(const MeshView& mesh, Out& out) {
  for (const auto& [region, tets] : regions_of(mesh)) {
    out.put("$ property ", region, ": ", mesh.region_name(region), '\n', padded("PSOLID", kSmall), small(region),
            small(region), '\n');
    const Material* material = mesh.material(region);
    if (material == nullptr) continue;
    out.put(padded("MAT1*", kSmall), padded(std::to_string(region), kLarge),
            real(mesh.modulus_in_unit(*material), kLarge), padded("", kLarge), real(material->poisson_ratio, kLarge),
            "*\n", padded("*", kSmall), real(mesh.density_in_unit(*material), kLarge), '\n');
  }
}

}  // namespace

void write_nastran(const MeshView& mesh, Out& out) {
  constexpr std::size_t kMostNodes = 99'999'999;
  if (mesh.points.size() > kMostNodes || mesh.tets.size() > kMostNodes) {
    throw OptionError("Nastran's fields hold no numbers above 99,999,999; write another format");
  }
  out.put("$ ", header_comment(mesh.info), "\nBEGIN BULK\n");
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const Point3& p = mesh.points[i];
    out.put("GRID*   ", padded(std::to_string(i + 1), kLarge), padded("", kLarge), real(p.x, kLarge), real(p.y, kLarge),
            "*\n*       ", real(p.z, kLarge), '\n');
  }
  if (!mesh.is_tet_mesh) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) write_cell("CTRIA3", t + 1, 1, mesh.triangle_nodes(t), out);
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    write_cell("CTETRA", t + 1, mesh.region(t), mesh.tet_nodes(t), out);
  }
  write_properties(mesh, out);
  std::size_t id = 0;
  for (const MeshSet& set : mesh.sets) {
    write_set("nodes", set.name, ++id, set.nodes, 1, out);
    write_set("tets", set.name, ++id, set.tets, 1, out);
    write_pressure(mesh, set, ++id, out);
  }
  out.put("ENDDATA\n");
}

}  // namespace delvox::mesh_io
