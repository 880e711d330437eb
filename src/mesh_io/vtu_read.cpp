#include <limits>
#include <span>
#include <string>

#include "mesh_io/formats.h"
#include "mesh_io/vtk_common.h"
#include "mesh_io/vtu_document.h"

namespace delvox::mesh_io {
namespace {

class PieceReader {
 public:
  PieceReader(const Source& source, VtuArrays& arrays, RawMesh& mesh)
      : source_(source), arrays_(arrays), mesh_(mesh) {}

  void read(const XmlNode& piece) {
    const std::int64_t first_point = static_cast<std::int64_t>(mesh_.points.size());
    read_points(piece);
    if (const XmlNode* array = find_array(piece.child("PointData"), kOnSurfaceArray)) {
      for (std::int64_t value : arrays_.integers(*array)) mesh_.on_surface.push_back(value != 0);
    }
    read_node_sets(piece, first_point);
    read_cells(piece, first_point);
  }

 private:
  void read_points(const XmlNode& piece) {
    const std::vector<Point3> points = piece_points(source_, piece, arrays_, mesh_.coordinate_error);
    mesh_.points.insert(mesh_.points.end(), points.begin(), points.end());
  }

  /// Calls take(name of the set, values) for each array whose name has that prefix.
  template <class Take>
  void for_each_set(const XmlNode* data, std::string_view prefix, std::size_t count, const Take& take) {
    if (data == nullptr) return;
    for (const XmlNode& array : data->children) {
      const std::string_view name = array.attribute("Name");
      if (array.name != "DataArray" || !name.starts_with(prefix)) continue;
      const std::vector<std::int64_t> values = arrays_.integers(array);
      if (values.size() != count) source_.fail("its array " + in_quotes(name) + " does not match its mesh");
      take(std::string(name.substr(prefix.size())), values);
    }
  }

  void read_node_sets(const XmlNode& piece, std::int64_t first_point) {
    const std::size_t count = mesh_.points.size() - static_cast<std::size_t>(first_point);
    for_each_set(piece.child("PointData"), kSetNodes, count, [&](const std::string& name, const auto& values) {
      RawSet& set = mesh_.set(name);
      for (std::size_t i = 0; i < count; ++i) {
        if (values[i] != 0)
          set.nodes.push_back(static_cast<std::uint32_t>(first_point) + static_cast<std::uint32_t>(i));
      }
    });
  }

  /// `tet_of`: the tet that each cell has become, or -1.
  void read_tet_sets(const XmlNode& piece, const std::vector<std::int64_t>& tet_of) {
    const XmlNode* data = piece.child("CellData");
    const auto for_each_member = [&](const auto& values, const auto& add) {
      for (std::size_t i = 0; i < tet_of.size(); ++i) {
        if (values[i] != 0 && tet_of[i] >= 0) add(static_cast<std::uint32_t>(tet_of[i]), values[i]);
      }
    };
    for_each_set(data, kSetTets, tet_of.size(), [&](const std::string& name, const auto& values) {
      RawSet& set = mesh_.set(name);
      for_each_member(values, [&](std::uint32_t tet, std::int64_t) { set.tets.push_back(tet); });
    });
    for_each_set(data, kSetFaces, tet_of.size(), [&](const std::string& name, const auto& values) {
      RawSet& set = mesh_.set(name);
      for_each_member(values, [&](std::uint32_t tet, std::int64_t bits) {
        for (std::uint8_t face = 0; face < 4; ++face) {
          if (bits >> face & 1) set.faces.push_back({tet, face});
        }
      });
    });
  }

  std::vector<std::int64_t> integers(const XmlNode& cells, std::string_view name) {
    const XmlNode* array = find_array(&cells, name);
    if (array == nullptr) source_.fail("its cells have no " + std::string(name));
    return arrays_.integers(*array);
  }

  void read_cells(const XmlNode& piece, std::int64_t first_point) {
    const XmlNode& cells = required_child(source_, piece, "Cells");
    std::vector<std::int64_t> nodes = integers(cells, "connectivity");
    const std::vector<std::int64_t> offsets = integers(cells, "offsets"), types = integers(cells, "types");
    std::vector<std::int64_t> regions;
    if (const XmlNode* array = find_array(piece.child("CellData"), kRegionArray)) regions = arrays_.integers(*array);
    const std::string_view claimed = piece.attribute("NumberOfCells");
    if (types.size() != offsets.size() ||
        parse_integer(source_, trimmed(claimed)) != static_cast<std::int64_t>(types.size()) ||
        (!regions.empty() && regions.size() != types.size())) {
      source_.fail("its cells are not as many as it says");
    }
    for (std::int64_t& node : nodes) {
      if (node < 0 || node > std::numeric_limits<std::uint32_t>::max()) {
        source_.fail("a cell names point " + std::to_string(node) + ", which cannot be");
      }
      node += first_point;
    }
    std::int64_t start = 0;
    std::vector<std::int64_t> tet_of;
    for (std::size_t i = 0; i < types.size(); ++i) {
      const std::int64_t end = offsets[i];
      if (end < start || end > static_cast<std::int64_t>(nodes.size())) source_.fail("the offsets of its cells lie");
      const auto length = static_cast<std::size_t>(end - start);
      const auto cell = std::span(nodes).subspan(static_cast<std::size_t>(start), length);
      const std::size_t tets = mesh_.tets.size();
      add_cell(types[i], cell, regions.empty() ? nullptr : &regions[i]);
      tet_of.push_back(mesh_.tets.size() > tets ? static_cast<std::int64_t>(tets) : -1);
      start = end;
    }
    read_tet_sets(piece, tet_of);
  }

  void add_cell(std::int64_t type, std::span<const std::int64_t> nodes, const std::int64_t* region) {
    const CellKind kind = vtk_cell_kind(type);
    const auto name = [&] { return kind == CellKind::kUnsupported ? "VTK " + std::to_string(type) : std::string(); };
    if (region == nullptr) {
      mesh_.add_cell(source_, kind, nodes, name());
    } else {
      mesh_.add_cell(source_, kind, nodes, name(), *region);
    }
  }

  const Source& source_;
  VtuArrays& arrays_;
  RawMesh& mesh_;
};

}  // namespace

RawMesh read_vtu(const Source& source) {
  VtuDocument file = open_vtu(source);
  RawMesh mesh;
  read_field_data(source, *file.grid, file.arrays, mesh.info);
  PieceReader reader(source, file.arrays, mesh);
  for (const XmlNode& piece : file.grid->children) {
    if (piece.name == "Piece") reader.read(piece);
  }
  return mesh;
}

}  // namespace delvox::mesh_io
