// VTU: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
// Appended raw data, zlib blocks, native byte order (stated in the file).
#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "core/parallel.h"
#include "delvox/core/errors.h"
#include "mesh_io/cell_quality.h"
#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"
#include "mesh_io/vtk_common.h"

namespace delvox::mesh_io {
namespace {

constexpr std::size_t kBlockSize = std::size_t{1} << 18;
// Of a mesh of a million tets, 42 MB, level 1 takes half away, and higher ones hardly more. Floats and doubles would
// make the rest smaller by a twelfth for half of the time: stored as they are. (zlib's own level 1: 2.5 times as long.)
template <class T>
constexpr int kCompressionLevel = std::is_floating_point_v<T> ? 0 : 1;

/// As a zlib stream.
std::string compressed(std::string_view block, int level) {
  const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
      libdeflate_alloc_compressor(level), libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  std::string packed(libdeflate_zlib_compress_bound(compressor.get(), block.size()), '\0');
  packed.resize(libdeflate_zlib_compress(compressor.get(), block.data(), block.size(), packed.data(), packed.size()));
  packed.shrink_to_fit();
  return packed;
}

void append_u64(std::string& to, std::uint64_t value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Collects the compressed arrays and the XML that points to them.
class VtuBody {
 public:
  void open(const std::string& element) { xml_ += "<" + element + ">\n"; }
  void close(const std::string& element) { xml_ += "</" + element + ">\n"; }

  /// An array of `count` numbers, made by fill(begin, end, numbers) and compressed block by block, in parallel. Layout
  /// of vtkZLibDataCompressor: number of blocks, their size, size of a last partial one, compressed sizes, blocks.
  template <class T, class Fill>
  void filled_array(const char* name, const char* type, int components, std::size_t count, const Fill& fill) {
    constexpr std::size_t kPerBlock = kBlockSize / sizeof(T);
    xml_ += std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
            std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(size_) + "\"/>\n";
    std::vector<std::string> blocks = map_chunks(count, kPerBlock, [&](std::size_t begin, std::size_t end) {
      std::vector<T> values(end - begin);
      fill(begin, end, values.data());
      return compressed({reinterpret_cast<const char*>(values.data()), sizeof(T) * values.size()}, kCompressionLevel<T>);
    });
    std::string head;
    append_u64(head, blocks.size());
    append_u64(head, blocks.empty() ? 0 : kBlockSize);
    append_u64(head, count % kPerBlock * sizeof(T));
    for (const std::string& block : blocks) append_u64(head, block.size());
    append(std::move(head));
    for (std::string& block : blocks) append(std::move(block));
  }
  /// An array of value_at(0) ... value_at(count - 1).
  template <class T, class ValueAt>
  void array(const char* name, const char* type, int components, std::size_t count, const ValueAt& value_at) {
    filled_array<T>(name, type, components, count, [&](std::size_t begin, std::size_t end, T* values) {
      for (std::size_t i = begin; i < end; ++i) values[i - begin] = value_at(i);
    });
  }
  template <class T>
  void array(const char* name, const char* type, int components, std::span<const T> values) {
    array<T>(name, type, components, values.size(), [values](std::size_t i) { return values[i]; });
  }

  void write(Out& out) const {
    out.put(xml_, "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
    for (const std::string& data : appended_) out.bytes(data);
    // meshio's reader wants the newline before the end tag.
    out.put("\n</AppendedData>\n</VTKFile>\n");
  }

 private:
  void append(std::string&& data) {
    size_ += data.size();
    appended_.push_back(std::move(data));
  }

  std::string xml_;
  std::vector<std::string> appended_;
  std::size_t size_ = 0;
};

template <class Cell>
std::array<Point3, std::tuple_size_v<Cell>> corners_of(const MeshView& mesh, const Cell& cell) {
  std::array<Point3, std::tuple_size_v<Cell>> corners;
  for (std::size_t i = 0; i < cell.size(); ++i) corners[i] = mesh.points[cell[i]];
  return corners;
}

/// A measure of each tet, taken of two at a time.
template <class MeasurePair>
void add_measure(const char* name, const MeshView& mesh, VtuBody& body, const MeasurePair& measure) {
  body.filled_array<float>(name, "Float32", 1, mesh.tets.size(), [&](std::size_t begin, std::size_t end, float* values) {
    for (std::size_t i = begin; i < end; i += 2) {
      const std::size_t next = std::min(i + 1, end - 1);
      const Pair measured = measure(corners_of(mesh, mesh.tets[i]), corners_of(mesh, mesh.tets[next]));
      values[i - begin] = static_cast<float>(measured[0]);
      if (next > i) values[next - begin] = static_cast<float>(measured[1]);
    }
  });
}

/// One byte for each of `count` things: what `set_bits` puts there.
template <class SetBits>
void add_flags(const std::string& name, std::size_t count, VtuBody& body, const SetBits& set_bits) {
  std::vector<std::uint8_t> flags(count, 0);
  set_bits(flags);
  body.array(name.c_str(), "UInt8", 1, std::span<const std::uint8_t>(flags));
}

void add_node_sets(const MeshView& mesh, VtuBody& body) {
  for (const MeshSet& set : mesh.sets) {
    if (set.nodes.empty()) continue;
    add_flags(kSetNodes + set.name, mesh.points.size(), body, [&](auto& flags) {
      for (std::uint32_t node : set.nodes) flags[node] = 1;
    });
  }
}

void add_tet_sets(const MeshView& mesh, VtuBody& body) {
  for (const MeshSet& set : mesh.sets) {
    if (!set.tets.empty()) {
      add_flags(kSetTets + set.name, mesh.tets.size(), body, [&](auto& flags) {
        for (std::uint32_t tet : set.tets) flags[tet] = 1;
      });
    }
    if (!set.faces.empty()) {
      add_flags(kSetFaces + set.name, mesh.tets.size(), body, [&](auto& flags) {
        for (TetFace face : set.faces) flags[face.tet] = static_cast<std::uint8_t>(flags[face.tet] | 1 << face.face);
      });
    }
  }
}

void add_cell_data(const MeshView& mesh, VtuBody& body) {
  body.open("CellData");
  if (mesh.is_tet_mesh) {
    const std::size_t count = mesh.tets.size();
    body.array<Label>(kRegionArray, "Int32", 1, count, [&](std::size_t i) { return mesh.region(i); });
    add_measure("radius_edge", mesh, body, radius_edge_ratios);
    add_measure("min_dihedral_degrees", mesh, body, min_dihedrals_degrees);
    if (!mesh.materials.empty()) {
      std::map<Label, float> moduli;
      for (const Material& m : mesh.materials) moduli[m.region] = static_cast<float>(m.youngs_modulus_mpa);
      body.array<float>("youngs_modulus_mpa", "Float32", 1, count, [&](std::size_t i) {
        const auto found = moduli.find(mesh.region(i));
        return found == moduli.end() ? 0.0f : found->second;
      });
    }
    add_tet_sets(mesh, body);
  } else {
    body.array<float>("min_angle_degrees", "Float32", 1, mesh.triangles.size(), [&](std::size_t i) {
      return static_cast<float>(min_angle_degrees(corners_of(mesh, mesh.triangles[i])));
    });
  }
  body.close("CellData");
}

/// All numbers of an array of arrays, or of points, in a row.
template <class T, class Element>
std::span<const T> numbers_of(std::span<const Element> elements) {
  static_assert(sizeof(Element) % sizeof(T) == 0);
  return {reinterpret_cast<const T*>(elements.data()), elements.size_bytes() / sizeof(T)};
}

void add_cells(const MeshView& mesh, VtuBody& body) {
  const std::size_t nodes = !mesh.is_tet_mesh ? 3 : mesh.second_order() ? 10 : 4;
  const std::size_t count = mesh.is_tet_mesh ? mesh.tets.size() : mesh.triangles.size();
  // Indices as they lie in memory; only meshes of over two thousand million points need another type.
  const bool fits = mesh.points.size() <= std::numeric_limits<std::int32_t>::max();
  body.open("Cells");
  const char* type = fits ? "Int32" : "UInt32";
  if (mesh.second_order()) {
    body.array<std::uint32_t>("connectivity", type, 1, nodes * count, [&](std::size_t i) {
      const std::size_t tet = i / nodes, place = i % nodes;
      return place < 4 ? mesh.tets[tet][place] : mesh.mid_nodes[tet][place - 4];
    });
  } else {
    body.array("connectivity", type, 1,
               mesh.is_tet_mesh ? numbers_of<std::uint32_t>(mesh.tets) : numbers_of<std::uint32_t>(mesh.triangles));
  }
  body.array<std::int64_t>("offsets", "Int64", 1, count,
                           [&](std::size_t i) { return static_cast<std::int64_t>(nodes * (i + 1)); });
  body.array<std::uint8_t>("types", "UInt8", 1, count, [&](std::size_t) {
    return static_cast<std::uint8_t>(!mesh.is_tet_mesh     ? kVtkTriangle
                                     : mesh.second_order() ? kVtkQuadraticTet
                                                           : kVtkTet);
  });
  body.close("Cells");
}

/// 3D Slicer would take the frame from a string array SPACE among the fields, but meshio reads no file with strings.
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
  write_head(mesh, out);
  VtuBody body;
  body.open("PointData");
  if (!mesh.on_surface.empty()) body.array(kOnSurfaceArray, "UInt8", 1, mesh.on_surface);
  add_node_sets(mesh, body);
  body.close("PointData");
  add_cell_data(mesh, body);
  body.open("Points");
  body.array("Points", "Float64", 3, numbers_of<double>(mesh.points));
  body.close("Points");
  add_cells(mesh, body);
  body.write(out);
}

}  // namespace delvox::mesh_io
