#include <limits>

#include "mesh_io/raw_mesh.h"
#include "mesh_io/raw_samples.h"
#include "mesh_io/vtk_common.h"
#include "mesh_io/vtu_document.h"

namespace delvox::mesh_io {
namespace {

bool is_scalar(const XmlNode& array) {
  const std::string_view components = array.attribute("NumberOfComponents", "1");
  return array.name == "DataArray" && (components == "1" || components == "0");
}

bool is_ours(std::string_view name) {
  return name == kOnSurfaceArray || name.starts_with(kSetNodes);
}

/// The name of the array to take, which the first piece has.
std::string choose_field(const Source& source, const XmlNode& piece, const std::string& wanted) {
  const XmlNode* data = piece.child("PointData");
  std::vector<std::string> names;
  std::string list;
  if (data != nullptr) {
    for (const XmlNode& array : data->children) {
      const std::string name(array.attribute("Name"));
      if (!is_scalar(array)) continue;
      if (name == wanted) return name;
      if (is_ours(name)) continue;
      names.push_back(name);
      list += (list.empty() ? "" : ", ") + in_quotes(name);
    }
  }
  if (names.empty()) source.fail("has no array of numbers on its points", "add one, or give a text of samples");
  if (!wanted.empty()) {
    source.fail("no array of numbers on its points is named " + in_quotes(wanted), "there are " + list);
  }
  if (names.size() > 1) source.fail("which array holds the values?", "choose with --field among " + list);
  return names[0];
}

}  // namespace

RawSamples read_samples_vtu(const Source& source, const std::string& field) {
  VtuDocument file = open_vtu(source);
  MeshInfo info;
  read_field_data(source, *file.grid, file.arrays, info);
  RawSamples result;
  Samples& samples = result.samples;
  double coordinate_error = 0;
  for (const XmlNode& piece : file.grid->children) {
    if (piece.name != "Piece") continue;
    if (result.field.empty()) result.field = choose_field(source, piece, field);
    const std::vector<Point3> points = piece_points(source, piece, file.arrays, coordinate_error);
    const XmlNode* array = find_array(piece.child("PointData"), result.field);
    if (array == nullptr) source.fail("a piece has no array " + in_quotes(result.field));
    const std::vector<double> values = file.arrays.reals(*array);
    if (values.size() != points.size()) {
      source.fail("its array " + in_quotes(result.field) + " has " + std::to_string(values.size()) + " numbers for " +
                  std::to_string(points.size()) + " points");
    }
    samples.points.insert(samples.points.end(), points.begin(), points.end());
    samples.values.insert(samples.values.end(), values.begin(), values.end());
  }
  if (samples.points.empty()) source.fail("has no points", "give a file with samples");
  if (info.unit == LengthUnit::kMetre) {
    for (Point3& p : samples.points) p = kMmPerMetre * p;
  }
  samples.frame = info.frame;
  return result;
}

}  // namespace delvox::mesh_io
