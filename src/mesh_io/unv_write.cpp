// I-DEAS universal file, as ElmerGrid, Salome and Gmsh read it: datasets 2411 (nodes), 2412 (elements), 2467 (groups).
// https://www.ceas3.uc.edu/sdrluff/
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"
#include "mesh_io/set_suffix.h"
#include "mesh_io/unv_types.h"

namespace delvox::mesh_io {
namespace {

/// Numbers in columns of ten.
class Columns {
 public:
  explicit Columns(Out& out, std::size_t per_line = 8) : out_(out), per_line_(per_line) {}
  ~Columns() {
    if (count_ % per_line_ != 0) out_.put('\n');
  }
  void put(std::int64_t value) {
    std::string text = std::to_string(value);
    out_.put(std::string(10 - std::min<std::size_t>(10, text.size()), ' '), text);
    if (++count_ % per_line_ == 0) out_.put('\n');
  }

 private:
  Out& out_;
  std::size_t per_line_, count_ = 0;
};

void put_row(Out& out, std::initializer_list<std::int64_t> values) {
  Columns row(out);
  for (std::int64_t value : values) row.put(value);
}

std::string fortran_double(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%25.16E", value);
  std::string result(text);
  result[result.find('E')] = 'D';
  return result;
}

void begin(int dataset, Out& out) {
  out.put("    -1\n", std::string(dataset < 1000 ? 3 : 2, ' '), dataset, '\n');
}
void end(Out& out) {
  out.put("    -1\n");
}

void write_nodes(const MeshView& mesh, Out& out) {
  begin(kUnvNodes, out);
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    put_row(out, {static_cast<std::int64_t>(i + 1), 1, 1, 11});
    const Point3& p = mesh.points[i];
    out.put(fortran_double(p.x), fortran_double(p.y), fortran_double(p.z), '\n');
  }
  end(out);
}

void write_cell(std::size_t number, int type, std::int64_t property, const CellNodes& nodes, Out& out) {
  put_row(out,
          {static_cast<std::int64_t>(number), type, property, property, 7, static_cast<std::int64_t>(nodes.size())});
  Columns row(out);
  for (std::uint32_t node : nodes) row.put(std::int64_t{node} + 1);
}

void write_cells(const MeshView& mesh, Out& out) {
  begin(kUnvElements, out);
  const bool second = mesh.second_order();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    write_cell(t + 1, second ? kUnvTriangle6 : kUnvTriangle3, 1, mesh.triangle_nodes(t, kUnvOrder), out);
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    write_cell(mesh.triangles.size() + t + 1, second ? kUnvTet10 : kUnvTet4, mesh.region(t),
               mesh.tet_nodes(t, kUnvOrder), out);
  }
  end(out);
}

class GroupWriter {
 public:
  explicit GroupWriter(Out& out) : out_(out) { begin(kUnvGroups, out_); }
  ~GroupWriter() { end(out_); }
  /// `numbers`: labels of nodes or elements.
  void write(const std::string& name, int kind, const std::vector<std::int64_t>& numbers) {
    if (numbers.empty()) return;
    put_row(out_, {++count_, 0, 0, 0, 0, 0, 0, static_cast<std::int64_t>(numbers.size())});
    out_.put(name, '\n');
    Columns row(out_);
    for (std::int64_t number : numbers) {
      for (std::int64_t value : {std::int64_t{kind}, number, std::int64_t{0}, std::int64_t{0}}) row.put(value);
    }
  }

 private:
  Out& out_;
  std::int64_t count_ = 0;
};

template <class Indices>
std::vector<std::int64_t> labels(const Indices& indices, std::size_t first) {
  std::vector<std::int64_t> result;
  for (auto index : indices) result.push_back(static_cast<std::int64_t>(first + index));
  return result;
}

void write_groups(const MeshView& mesh, Out& out) {
  const std::size_t first_tet = mesh.triangles.size() + 1;
  GroupWriter groups(out);
  std::vector<std::size_t> all(mesh.triangles.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  groups.write("boundary", kUnvElement, labels(all, 1));
  for (const auto& [region, tets] : regions_of(mesh)) {
    groups.write(mesh.region_name(region), kUnvElement, labels(tets, first_tet));
  }
  for (std::size_t s = 0; s < mesh.sets.size(); ++s) {
    const MeshSet& set = mesh.sets[s];
    std::vector<std::size_t> triangles;
    for (TetFace face : set.faces) {
      const auto found = std::lower_bound(mesh.faces.begin(), mesh.faces.end(), face);
      if (found != mesh.faces.end() && *found == face) {
        triangles.push_back(static_cast<std::size_t>(found - mesh.faces.begin()));
      }
    }
    groups.write(set.name, kUnvElement, labels(triangles, 1));
    groups.write(set.name + kTetsSuffix, kUnvElement, labels(set.tets, first_tet));
    groups.write(set.name + kNodesSuffix, kUnvNode, labels(set.nodes, 1));
  }
}

}  // namespace

void write_unv(const MeshView& mesh, Out& out) {
  begin(kUnvHeader, out);
  out.put("mesh\n", header_comment(mesh.info), '\n');
  for (const char* line : {"delvox", "", "", "", ""}) out.put(line, '\n');
  end(out);
  write_nodes(mesh, out);
  write_cells(mesh, out);
  if (mesh.is_tet_mesh) write_groups(mesh, out);
}

}  // namespace delvox::mesh_io
