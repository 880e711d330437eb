// Wavefront OBJ: https://paulbourke.net/dataformats/obj/
#include <string>
#include <vector>

#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"

namespace delvox::mesh_io {
namespace {

/// The vertex of a corner "7", "7/2", "7//3" or "-1" (the last one so far), counted from 0.
std::int64_t vertex_of(const Source& source, std::string_view corner, std::size_t points_so_far) {
  const std::int64_t number = parse_integer(source, corner.substr(0, corner.find('/')));
  const auto so_far = static_cast<std::int64_t>(points_so_far);
  if (number == 0 || number < -so_far) source.fail("a face names vertex " + std::to_string(number));
  return number > 0 ? number - 1 : so_far + number;
}

/// Lines that end in a backslash go on in the next.
std::string next_line(TextCursor& cursor) {
  std::string line(cursor.line());
  while (!line.empty() && line.back() == '\\' && !cursor.at_end()) {
    line.back() = ' ';
    line += cursor.line();
  }
  return line;
}

}  // namespace

void write_obj(const MeshView& mesh, Out& out) {
  out.put("# ", header_comment(mesh.info), '\n');
  for (const Point3& p : mesh.points) out.put("v ", p.x, ' ', p.y, ' ', p.z, '\n');
  for (const Triangle& t : mesh.triangles) out.put("f ", t[0] + 1, ' ', t[1] + 1, ' ', t[2] + 1, '\n');
}

RawMesh read_obj(const Source& source) {
  RawMesh mesh;
  TextCursor lines(source, source.bytes);
  std::vector<std::int64_t> nodes;
  while (!lines.at_end()) {
    const std::string line = next_line(lines);
    if (line.starts_with('#')) read_header_comment(line, mesh.info);
    TextCursor cursor(source, line, '#');
    if (!cursor.more()) continue;
    const std::string_view word = cursor.token();
    if (word == "v") {
      const double x = cursor.real(), y = cursor.real(), z = cursor.real();
      mesh.points.push_back({x, y, z});
    } else if (word == "f") {
      nodes.clear();
      while (cursor.more()) nodes.push_back(vertex_of(source, cursor.token(), mesh.points.size()));
      mesh.add_cell(source, CellKind::kPolygon, nodes, "face");
    }
  }
  return mesh;
}

}  // namespace delvox::mesh_io
