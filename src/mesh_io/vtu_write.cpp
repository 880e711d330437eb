// VTU: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
// Appended raw data, zlib blocks, native byte order (stated in the file).
#include <zlib.h>

#include <bit>
#include <limits>
#include <string>
#include <vector>

#include "delvox/core/errors.h"
#include "mesh_io/cell_quality.h"
#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"
#include "mesh_io/vtk_common.h"

namespace delvox::mesh_io {
namespace {

constexpr std::size_t kBlockSize = std::size_t{1} << 18;
constexpr int kCompressionLevel = 1;  // level 6 takes five times as long for a tenth less

void append_u64(std::string& to, std::uint64_t value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// vtkZLibDataCompressor's layout: number of blocks, their size, size of a last partial one, compressed sizes, blocks.
std::string compressed(std::string_view data) {
  const std::size_t blocks = (data.size() + kBlockSize - 1) / kBlockSize;
  std::string head, body;
  append_u64(head, blocks);
  append_u64(head, blocks == 0 ? 0 : kBlockSize);
  append_u64(head, data.size() % kBlockSize);
  std::vector<Bytef> packed(compressBound(kBlockSize));
  for (std::size_t start = 0; start < data.size(); start += kBlockSize) {
    const std::string_view block = data.substr(start, kBlockSize);
    uLongf size = packed.size();
    const int status = compress2(packed.data(), &size, reinterpret_cast<const Bytef*>(block.data()), block.size(),
                                 kCompressionLevel);
    if (status != Z_OK) throw IoError("VTU: zlib failed with code " + std::to_string(status) + "; free some memory");
    append_u64(head, size);
    body.append(reinterpret_cast<const char*>(packed.data()), size);
  }
  return head + body;
}

template <class T>
std::string_view bytes_of(std::span<const T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}
template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
  return bytes_of(std::span<const T>(values));
}

/// Collects the compressed arrays and the XML that points to them.
class VtuBody {
 public:
  void open(const std::string& element) { xml_ += "<" + element + ">\n"; }
  void close(const std::string& element) { xml_ += "</" + element + ">\n"; }
  void array(const char* name, const char* type, int components, std::string_view bytes) {
    xml_ += std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
            std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(size_) + "\"/>\n";
    appended_.push_back(compressed(bytes));
    size_ += appended_.back().size();
  }
  void write(Out& out) const {
    out.put(xml_, "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
    for (const std::string& data : appended_) out.bytes(data);
    // meshio's reader wants the newline before the end tag.
    out.put("\n</AppendedData>\n</VTKFile>\n");
  }

 private:
  std::string xml_;
  std::vector<std::string> appended_;
  std::size_t size_ = 0;
};

void add_tet_quality(const MeshView& mesh, VtuBody& body) {
  std::vector<float> radius_edge, dihedral;
  radius_edge.reserve(mesh.tets.size());
  dihedral.reserve(mesh.tets.size());
  for (const Tet& t : mesh.tets) {
    const TetQuality quality =
        tet_quality({mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]});
    radius_edge.push_back(static_cast<float>(quality.radius_edge));
    dihedral.push_back(static_cast<float>(quality.min_dihedral_degrees));
  }
  body.array("radius_edge", "Float32", 1, bytes_of(radius_edge));
  body.array("min_dihedral_degrees", "Float32", 1, bytes_of(dihedral));
}

void add_triangle_quality(const MeshView& mesh, VtuBody& body) {
  std::vector<float> angle;
  angle.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    angle.push_back(static_cast<float>(min_angle_degrees({mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]})));
  }
  body.array("min_angle_degrees", "Float32", 1, bytes_of(angle));
}

void add_cell_data(const MeshView& mesh, VtuBody& body) {
  body.open("CellData");
  if (mesh.is_tet_mesh) {
    std::vector<Label> regions(mesh.regions.begin(), mesh.regions.end());
    regions.resize(mesh.tets.size(), 1);
    body.array(kRegionArray, "Int32", 1, bytes_of(regions));
    add_tet_quality(mesh, body);
  } else {
    add_triangle_quality(mesh, body);
  }
  body.close("CellData");
}

void add_cells(const MeshView& mesh, VtuBody& body) {
  const std::size_t corners = mesh.is_tet_mesh ? 4 : 3;
  const std::size_t count = mesh.is_tet_mesh ? mesh.tets.size() : mesh.triangles.size();
  std::vector<std::int64_t> offsets(count);
  for (std::size_t i = 0; i < count; ++i) offsets[i] = static_cast<std::int64_t>(corners * (i + 1));
  const std::vector<std::uint8_t> types(count, static_cast<std::uint8_t>(mesh.is_tet_mesh ? kVtkTet : kVtkTriangle));
  // Indices as they lie in memory; only meshes of over two thousand million points need another type.
  const bool fits = mesh.points.size() <= std::numeric_limits<std::int32_t>::max();
  body.open("Cells");
  body.array("connectivity", fits ? "Int32" : "UInt32", 1,
             mesh.is_tet_mesh ? bytes_of(mesh.tets) : bytes_of(mesh.triangles));
  body.array("offsets", "Int64", 1, bytes_of(offsets));
  body.array("types", "UInt8", 1, bytes_of(types));
  body.close("Cells");
}

void write_head(const MeshView& mesh, Out& out) {
  const char* order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  out.put("<?xml version=\"1.0\"?>\n<!-- ", header_comment(mesh.info), " -->\n");
  out.put("<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"", order,
          "\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n<FieldData>\n");
  for (const auto& [name, value] : info_fields(mesh.info)) {
    out.put("<DataArray type=\"Float64\" Name=\"", name, "\" NumberOfTuples=\"1\" format=\"ascii\">", value,
            "</DataArray>\n");
  }
  const std::size_t cells = mesh.is_tet_mesh ? mesh.tets.size() : mesh.triangles.size();
  out.put("</FieldData>\n<Piece NumberOfPoints=\"", mesh.points.size(), "\" NumberOfCells=\"", cells, "\">\n");
}

}  // namespace

void write_vtu(const MeshView& mesh, Out& out) {
  static_assert(sizeof(Point3) == 3 * sizeof(double));
  write_head(mesh, out);
  VtuBody body;
  body.open("PointData");
  if (!mesh.on_surface.empty()) body.array(kOnSurfaceArray, "UInt8", 1, bytes_of(mesh.on_surface));
  body.close("PointData");
  add_cell_data(mesh, body);
  body.open("Points");
  body.array("Points", "Float64", 3, bytes_of(mesh.points));
  body.close("Points");
  add_cells(mesh, body);
  body.write(out);
}

}  // namespace delvox::mesh_io
