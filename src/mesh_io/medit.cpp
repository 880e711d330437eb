// MEDIT .mesh: https://www.ljll.fr/frey/publications/RT-0253.pdf
#include <map>
#include <string>
#include <vector>

#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"

namespace delvox::mesh_io {
namespace {

struct Section {
  CellKind kind;
  std::size_t nodes;
};

const std::map<std::string, Section, std::less<>>& cell_sections() {
  static const std::map<std::string, Section, std::less<>> kSections{
      {"TRIANGLES", {CellKind::kTriangle, 3}},      {"QUADRILATERALS", {CellKind::kPolygon, 4}},
      {"TETRAHEDRA", {CellKind::kTet, 4}},          {"TRIANGLESP2", {CellKind::kTriangle, 6}},
      {"TETRAHEDRAP2", {CellKind::kTet, 10}},       {"HEXAHEDRA", {CellKind::kUnsupported, 8}},
      {"PRISMS", {CellKind::kUnsupported, 6}},      {"PYRAMIDS", {CellKind::kUnsupported, 5}},
      {"HEXAHEDRAQ2", {CellKind::kUnsupported, 27}},
  };
  return kSections;
}

void read_vertices(TextCursor& cursor, RawMesh& mesh) {
  const std::size_t count = cursor.count("vertices", 8);
  mesh.points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = cursor.real(), y = cursor.real(), z = cursor.real();
    cursor.token();  // reference
    mesh.points.push_back({x, y, z});
  }
}

void read_cells(TextCursor& cursor, const std::string& name, Section section, RawMesh& mesh) {
  const std::size_t count = cursor.count("cells", 2 * section.nodes);
  std::vector<std::int64_t> nodes(section.nodes);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::int64_t& node : nodes) {
      node = cursor.integer();
      if (node < 1) cursor.source().fail("a cell names vertex " + std::to_string(node));
      --node;
    }
    const std::int64_t reference = cursor.integer();
    mesh.add_cell(cursor.source(), section.kind, nodes, in_quotes(name), reference);
  }
}

/// Sections that say nothing to us hold numbers alone: the next word begins the next section.
void skip_numbers(TextCursor& cursor) {
  while (cursor.more()) {
    const char first = cursor.peek();
    if ((first >= 'A' && first <= 'Z') || (first >= 'a' && first <= 'z')) return;
    cursor.token();
  }
}

void read_comments(const Source& source, MeshInfo& info) {
  TextCursor cursor(source, source.bytes);
  for (int line = 0; line < 5 && !cursor.at_end(); ++line) {
    const std::string_view text = cursor.line();
    if (text.starts_with('#')) read_header_comment(text, info);
  }
}

}  // namespace

void write_medit(const MeshView& mesh, Out& out) {
  out.put("MeshVersionFormatted 2\n# ", header_comment(mesh.info), "\nDimension 3\n");
  out.put("\nVertices\n", mesh.points.size(), '\n');
  for (const Point3& p : mesh.points) out.put(p.x, ' ', p.y, ' ', p.z, " 0\n");
  const auto put_cell = [&](const CellNodes& nodes, Label reference) {
    for (std::uint32_t node : nodes) out.put(node + 1, ' ');
    out.put(reference, '\n');
  };
  const char* suffix = mesh.second_order() ? "P2" : "";
  out.put("\nTriangles", suffix, '\n', mesh.triangles.size(), '\n');
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) put_cell(mesh.triangle_nodes(i), 1);
  if (mesh.is_tet_mesh) {
    out.put("\nTetrahedra", suffix, '\n', mesh.tets.size(), '\n');
    for (std::size_t i = 0; i < mesh.tets.size(); ++i) put_cell(mesh.tet_nodes(i), mesh.region(i));
  }
  out.put("\nEnd\n");
}

RawMesh read_medit(const Source& source) {
  RawMesh mesh;
  read_comments(source, mesh.info);
  TextCursor cursor(source, source.bytes, '#');
  if (!cursor.more() || upper_case(cursor.token()) != "MESHVERSIONFORMATTED") {
    source.fail("does not begin with MeshVersionFormatted", "is it a MEDIT file in text form?");
  }
  if (cursor.integer() == 1) mesh.coordinate_error = kFloat32Error;
  while (cursor.more()) {
    const std::string keyword = upper_case(cursor.token());
    const auto section = cell_sections().find(keyword);
    if (keyword == "END") break;
    if (keyword == "DIMENSION") {
      if (cursor.integer() != 3) source.fail("is not three-dimensional", "give a mesh in space");
    } else if (keyword == "VERTICES") {
      read_vertices(cursor, mesh);
    } else if (section != cell_sections().end()) {
      read_cells(cursor, keyword, section->second, mesh);
    } else {
      skip_numbers(cursor);
    }
  }
  return mesh;
}

}  // namespace delvox::mesh_io
