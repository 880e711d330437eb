#include <limits>
#include <span>
#include <string>

#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"
#include "mesh_io/vtk_common.h"
#include "mesh_io/vtu_data.h"
#include "mesh_io/xml.h"

namespace delvox::mesh_io {
namespace {

const XmlNode& required(const Source& source, const XmlNode& parent, std::string_view name) {
  const XmlNode* child = parent.child(name);
  if (child == nullptr) {
    source.fail("has no " + std::string(name) + " in its " + std::string(parent.name), "is it a VTU file?");
  }
  return *child;
}

/// The DataArray of that name, or null.
const XmlNode* find_array(const XmlNode* parent, std::string_view name) {
  if (parent == nullptr) return nullptr;
  for (const XmlNode& child : parent->children) {
    if (child.name == "DataArray" && child.attribute("Name") == name) return &child;
  }
  return nullptr;
}

void read_field_data(const Source& source, const XmlNode& grid, VtuArrays& arrays, MeshInfo& info) {
  const XmlNode* fields = grid.child("FieldData");
  if (fields == nullptr) return;
  for (const XmlNode& array : fields->children) {
    const std::string name(array.attribute("Name"));
    if (array.name != "DataArray" || !name.starts_with("delvox_")) continue;
    const std::vector<double> values = arrays.reals(array);
    if (values.size() != 1) source.fail("its field " + in_quotes(name) + " does not hold one number");
    read_info_field(name, values[0], info);
  }
}

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
    const XmlNode* points = piece.child("Points");
    const XmlNode* array = points == nullptr ? nullptr : points->child("DataArray");
    if (array == nullptr) source_.fail("has a piece without points");
    if (array->attribute("type") == "Float32") mesh_.coordinate_error = kFloat32Error;
    const std::vector<double> xyz = arrays_.reals(*array);
    const std::string_view claimed = piece.attribute("NumberOfPoints");
    if (xyz.size() % 3 != 0 || parse_integer(source_, trimmed(claimed)) != static_cast<std::int64_t>(xyz.size() / 3)) {
      source_.fail("its points are not as many as it says");
    }
    for (std::size_t i = 0; i < xyz.size(); i += 3) mesh_.points.push_back({xyz[i], xyz[i + 1], xyz[i + 2]});
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
    const XmlNode& cells = required(source_, piece, "Cells");
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
  constexpr std::string_view kAppended = "<AppendedData";
  const std::string_view bytes = source.bytes;
  const std::size_t appended_tag = bytes.find(kAppended);
  std::string_view appended;
  bool appended_is_base64 = false;
  if (appended_tag != std::string_view::npos) {
    const std::size_t end = bytes.find('>', appended_tag);
    const std::size_t underscore = bytes.find('_', end);
    if (underscore == std::string_view::npos) source.fail("its appended data are missing");
    appended = bytes.substr(underscore + 1);
    appended_is_base64 = bytes.substr(appended_tag, end - appended_tag).find("base64") != std::string_view::npos;
  }
  const XmlNode document = parse_xml(source, bytes.substr(0, appended_tag));
  const XmlNode& root = required(source, document, "VTKFile");
  if (root.attribute("type") != "UnstructuredGrid") {
    source.fail("holds " + in_quotes(root.attribute("type")) + ", not an UnstructuredGrid", "save it as VTU");
  }
  VtuArrays arrays(source, root, appended, appended_is_base64);
  const XmlNode& grid = required(source, root, "UnstructuredGrid");
  RawMesh mesh;
  read_field_data(source, grid, arrays, mesh.info);
  PieceReader reader(source, arrays, mesh);
  for (const XmlNode& piece : grid.children) {
    if (piece.name == "Piece") reader.read(piece);
  }
  return mesh;
}

}  // namespace delvox::mesh_io
