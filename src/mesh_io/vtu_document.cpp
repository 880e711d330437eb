#include "mesh_io/vtu_document.h"

#include <string>

#include "mesh_io/raw_mesh.h"
#include "mesh_io/vtk_common.h"

namespace delvox::mesh_io {

VtuDocument open_vtu(const Source& source) {
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
  XmlNode document = parse_xml(source, bytes.substr(0, appended_tag));
  const XmlNode& root = required_child(source, document, "VTKFile");
  if (root.attribute("type") != "UnstructuredGrid") {
    source.fail("holds " + in_quotes(root.attribute("type")) + ", not an UnstructuredGrid", "save it as VTU");
  }
  VtuArrays arrays(source, root, appended, appended_is_base64);
  const XmlNode& grid = required_child(source, root, "UnstructuredGrid");
  return {std::move(document), &grid, std::move(arrays)};  // children stay where they are when their parent moves
}

const XmlNode& required_child(const Source& source, const XmlNode& parent, std::string_view name) {
  const XmlNode* child = parent.child(name);
  if (child == nullptr) {
    source.fail("has no " + std::string(name) + " in its " + std::string(parent.name), "is it a VTU file?");
  }
  return *child;
}

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

std::vector<Point3> piece_points(const Source& source, const XmlNode& piece, VtuArrays& arrays,
                                 double& coordinate_error) {
  const XmlNode* points = piece.child("Points");
  const XmlNode* array = points == nullptr ? nullptr : points->child("DataArray");
  if (array == nullptr) source.fail("has a piece without points");
  if (array->attribute("type") == "Float32") coordinate_error = kFloat32Error;
  const std::vector<double> xyz = arrays.reals(*array);
  const std::string_view claimed = piece.attribute("NumberOfPoints");
  if (xyz.size() % 3 != 0 || parse_integer(source, trimmed(claimed)) != static_cast<std::int64_t>(xyz.size() / 3)) {
    source.fail("its points are not as many as it says");
  }
  std::vector<Point3> result;
  for (std::size_t i = 0; i < xyz.size(); i += 3) result.push_back({xyz[i], xyz[i + 1], xyz[i + 2]});
  return result;
}

}  // namespace delvox::mesh_io
