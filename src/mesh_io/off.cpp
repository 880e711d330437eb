// OFF: http://www.geomview.org/docs/html/OFF.html
#include <string>
#include <vector>

#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"

namespace delvox::mesh_io {
namespace {

/// Comments are skipped by the cursor: they are looked through here, where ours stand.
void read_first_comments(const Source& source, MeshInfo& info) {
  TextCursor cursor(source, source.bytes);
  for (int line = 0; line < 3 && !cursor.at_end(); ++line) {
    const std::string_view text = cursor.line();
    if (text.starts_with('#')) read_header_comment(text, info);
  }
}

/// Reads the header keyword, which may be missing; true if vertices carry more than coordinates.
bool read_keyword(TextCursor& cursor) {
  const Source& source = cursor.source();
  const std::size_t start = cursor.position();
  const std::string keyword = upper_case(cursor.token());
  if (keyword[0] >= '0' && keyword[0] <= '9' && keyword.find_first_not_of("0123456789") == std::string::npos) {
    cursor.seek(start);
    return false;
  }
  if (!keyword.ends_with("OFF")) source.fail("does not begin like an OFF file", "is it an .off file?");
  const std::string prefix = keyword.substr(0, keyword.size() - 3);
  if (prefix.find_first_not_of("STCN") != std::string::npos) {
    source.fail("holds " + in_quotes(keyword) + ", which is not three-dimensional", "save it as plain OFF");
  }
  return !prefix.empty();
}

}  // namespace

void write_off(const MeshView& mesh, Out& out) {
  out.put("OFF\n# ", header_comment(mesh.info), '\n', mesh.points.size(), ' ', mesh.triangles.size(), " 0\n");
  for (const Point3& p : mesh.points) out.put(p.x, ' ', p.y, ' ', p.z, '\n');
  for (const Triangle& t : mesh.triangles) out.put("3 ", t[0], ' ', t[1], ' ', t[2], '\n');
}

RawMesh read_off(const Source& source) {
  RawMesh mesh;
  read_first_comments(source, mesh.info);
  TextCursor cursor(source, source.bytes, '#');
  if (!cursor.more()) source.fail("holds nothing but comments");
  const bool more_per_vertex = read_keyword(cursor);
  if (cursor.more() && cursor.peek() == 'B') source.fail("is a binary OFF file", "save it as text");
  const std::size_t points = cursor.count("points", 6);
  const std::size_t faces = cursor.count("faces", 4);
  cursor.integer();  // edges, which no reader needs
  mesh.points.reserve(points);
  for (std::size_t i = 0; i < points; ++i) {
    const double x = cursor.real(), y = cursor.real(), z = cursor.real();
    mesh.points.push_back({x, y, z});
    if (more_per_vertex) cursor.line();
  }
  std::vector<std::int64_t> nodes;
  for (std::size_t i = 0; i < faces; ++i) {
    nodes.resize(cursor.count("corners", 2));
    for (std::int64_t& node : nodes) node = cursor.integer();
    mesh.add_cell(source, nodes.size() < 3 ? CellKind::kIgnored : CellKind::kPolygon, nodes, "face");
    if (!cursor.at_end()) cursor.line();  // a colour may follow
  }
  return mesh;
}

}  // namespace delvox::mesh_io
