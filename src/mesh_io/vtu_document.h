#pragma once

#include <string_view>
#include <vector>

#include "delvox/core/mesh.h"
#include "mesh_io/vtu_data.h"
#include "mesh_io/xml.h"

namespace delvox::mesh_io {

/// A VTU file, parsed as far as its elements; arrays are decoded as they are asked for.
struct VtuDocument {
  XmlNode document;
  const XmlNode* grid;  ///< its UnstructuredGrid
  VtuArrays arrays;
};

/// Throws InputError unless it is a VTU file. Views point into the source.
VtuDocument open_vtu(const Source& source);

/// The first child of that name. Throws InputError if there is none.
const XmlNode& required_child(const Source& source, const XmlNode& parent, std::string_view name);
/// The DataArray of that name, or null; also if there is no parent.
const XmlNode* find_array(const XmlNode* parent, std::string_view name);
/// What a file of ours says of itself.
void read_field_data(const Source& source, const XmlNode& grid, VtuArrays& arrays, MeshInfo& info);
/// The points of a piece; `coordinate_error` is set if they are float32. Throws InputError unless they are as many as
/// the piece says.
std::vector<Point3> piece_points(const Source& source, const XmlNode& piece, VtuArrays& arrays,
                                 double& coordinate_error);

}  // namespace delvox::mesh_io
