// Legacy VTK: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
// Binary parts are big-endian. Tets are written as an unstructured grid, surfaces as polygonal data.
#include <bit>
#include <string>
#include <vector>

#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"
#include "mesh_io/number_type.h"
#include "mesh_io/vtk_common.h"

namespace delvox::mesh_io {
namespace {

constexpr auto kOrder = std::endian::big;

void write_polygons(const MeshView& mesh, Out& out) {
  out.put("POLYGONS ", mesh.triangles.size(), ' ', mesh.triangles.size() * 4, '\n');
  for (const Triangle& triangle : mesh.triangles) {
    out.binary(std::int32_t{3}, kOrder);
    for (std::uint32_t node : triangle) out.binary(node, kOrder);
  }
  out.put('\n');
}

void write_tet_cells(const MeshView& mesh, Out& out) {
  const std::size_t nodes = mesh.second_order() ? 10 : 4;
  out.put("CELLS ", mesh.tets.size(), ' ', mesh.tets.size() * (nodes + 1), '\n');
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    out.binary(static_cast<std::int32_t>(nodes), kOrder);
    for (std::uint32_t node : mesh.tet_nodes(t)) out.binary(node, kOrder);
  }
  out.put("\nCELL_TYPES ", mesh.tets.size(), '\n');
  const std::int32_t type = mesh.second_order() ? kVtkQuadraticTet : kVtkTet;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) out.binary(type, kOrder);
  out.put("\nCELL_DATA ", mesh.tets.size(), "\nSCALARS ", kRegionArray, " int 1\nLOOKUP_TABLE default\n");
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) out.binary(std::int32_t{mesh.region(t)}, kOrder);
  out.put('\n');
  if (mesh.on_surface.empty()) return;
  out.put("POINT_DATA ", mesh.points.size(), "\nSCALARS ", kOnSurfaceArray, " unsigned_char 1\nLOOKUP_TABLE default\n");
  for (std::uint8_t flag : mesh.on_surface) out.binary(flag, kOrder);
  out.put('\n');
}

NumberType number_type(const Source& source, std::string_view name) {
  // vtkIdType is stored as int here, whatever its size in memory.
  constexpr std::pair<std::string_view, NumberType> kTypes[] = {
      {"DOUBLE", NumberType::kFloat64}, {"FLOAT", NumberType::kFloat32},        {"INT", NumberType::kInt32},
      {"LONG", NumberType::kInt64},     {"UNSIGNED_LONG", NumberType::kUInt64}, {"UNSIGNED_INT", NumberType::kUInt32},
      {"SHORT", NumberType::kInt16},    {"UNSIGNED_SHORT", NumberType::kUInt16}, {"VTKIDTYPE", NumberType::kInt32},
      {"CHAR", NumberType::kInt8},      {"UNSIGNED_CHAR", NumberType::kUInt8},  {"INT8", NumberType::kInt8},
      {"UINT8", NumberType::kUInt8},    {"INT16", NumberType::kInt16},          {"UINT16", NumberType::kUInt16},
      {"INT32", NumberType::kInt32},    {"UINT32", NumberType::kUInt32},        {"INT64", NumberType::kInt64},
      {"UINT64", NumberType::kUInt64},
  };
  std::string capitals = upper_case(name);
  if (capitals.starts_with("VTKTYPE")) capitals.erase(0, 7);
  for (const auto& [type_name, type] : kTypes) {
    if (capitals == type_name) return type;
  }
  source.fail("has numbers of the unknown type " + in_quotes(name));
}

class Reader {
 public:
  explicit Reader(const Source& source) : source_(source), cursor_(source, source.bytes) {}

  RawMesh read() {
    read_head();
    while (cursor_.more() && read_section(upper_case(cursor_.token()))) {
    }
    add_cells();
    return std::move(mesh_);
  }

 private:
  /// Cells of one section: cell i has connectivity[offsets[i]] up to offsets[i + 1].
  struct Cells {
    std::vector<std::int64_t> offsets, connectivity;
  };
  enum class Data { kMesh, kPoints, kCells };

  void read_head() {
    constexpr std::string_view kMagic = "# VTK DATAFILE VERSION ";
    const std::string first = upper_case(cursor_.line());
    if (!first.starts_with(kMagic)) source_.fail("does not begin like a legacy VTK file", "is it a .vtk file?");
    has_offsets_ = parse_real(source_, trimmed(std::string_view(first).substr(kMagic.size()))) >= 5;
    if (cursor_.at_end()) source_.fail("ends too early");
    read_header_comment(cursor_.line(), mesh_.info);
    const std::string encoding = upper_case(cursor_.token());
    if (encoding != "ASCII" && encoding != "BINARY") source_.fail("is neither ASCII nor BINARY", "is it a .vtk file?");
    binary_ = encoding == "BINARY";
  }

  /// False where the mesh ends and data begin that say nothing to us.
  bool read_section(const std::string& keyword) {
    if (keyword == "DATASET") {
      const std::string kind = upper_case(cursor_.token());
      if (kind != "UNSTRUCTURED_GRID" && kind != "POLYDATA") {
        source_.fail("holds " + in_quotes(kind), "save it as UNSTRUCTURED_GRID or POLYDATA");
      }
    } else if (keyword == "POINTS") {
      read_points();
    } else if (keyword == "CELLS") {
      cells_ = read_cells();
    } else if (keyword == "CELL_TYPES") {
      types_ = numbers<std::int64_t>(cursor_.integer(), NumberType::kInt32);
    } else if (keyword == "POLYGONS") {
      add_polygonal_cells(CellKind::kPolygon);
    } else if (keyword == "TRIANGLE_STRIPS") {
      add_polygonal_cells(CellKind::kStrip);
    } else if (keyword == "VERTICES" || keyword == "LINES") {
      read_cells();
    } else if (keyword == "METADATA") {
      cursor_.line();
      while (!cursor_.at_end() && !trimmed(cursor_.line()).empty()) {
      }
    } else {
      return read_attribute(keyword);
    }
    return true;
  }

  bool read_attribute(const std::string& keyword) {
    if (keyword == "POINT_DATA" || keyword == "CELL_DATA") {
      data_ = keyword == "POINT_DATA" ? Data::kPoints : Data::kCells;
      data_count_ = cursor_.integer();
    } else if (keyword == "FIELD") {
      read_field();
    } else if (keyword == "SCALARS") {
      read_scalars();
    } else if (keyword == "VECTORS" || keyword == "NORMALS" || keyword == "TENSORS") {
      cursor_.token();
      const NumberType type = number_type(source_, cursor_.token());
      numbers<double>(times(data_count_, keyword == "TENSORS" ? 9 : 3), type);
    } else {
      return false;
    }
    return true;
  }

  /// A product that cannot overflow; what is too large for the file stays too large.
  std::int64_t times(std::int64_t count, std::int64_t factor) const {
    const auto limit = static_cast<std::int64_t>(source_.bytes.size()) + 1;
    const bool possible = count >= 0 && factor >= 0 && count <= limit && factor <= limit;
    if (!possible) source_.fail("claims more numbers than it can hold");
    return count * factor;
  }

  /// Numbers that follow the current line.
  template <class T>
  std::vector<T> numbers(std::int64_t claimed, NumberType type) {
    if (binary_) {
      cursor_.line();
      const std::size_t count = source_.checked_count(claimed, size_of(type), cursor_.remaining(), "numbers");
      return load_all_as<T>(source_, cursor_.raw(count * size_of(type), "numbers"), type, kOrder);
    }
    const std::size_t count = source_.checked_count(claimed, 2, cursor_.remaining() + 1, "numbers");
    std::vector<T> result;
    result.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      if constexpr (std::is_integral_v<T>) {
        result.push_back(cursor_.integer());
      } else {
        result.push_back(cursor_.real());
      }
    }
    return result;
  }

  void read_points() {
    const std::int64_t count = cursor_.integer();
    const NumberType type = number_type(source_, cursor_.token());
    if (type == NumberType::kFloat32) mesh_.coordinate_error = kFloat32Error;
    const std::vector<double> xyz = numbers<double>(times(count, 3), type);
    for (std::size_t i = 0; i < xyz.size(); i += 3) mesh_.points.push_back({xyz[i], xyz[i + 1], xyz[i + 2]});
  }

  Cells read_cells() {
    Cells cells;
    const std::int64_t count = cursor_.integer(), size = cursor_.integer();
    if (has_offsets_) {
      cells.offsets = named_numbers("OFFSETS", count);
      cells.connectivity = named_numbers("CONNECTIVITY", size);
    } else {
      cells.connectivity = numbers<std::int64_t>(size, NumberType::kInt32);
      cells.offsets = drop_lengths(cells.connectivity, count);
    }
    std::int64_t last = 0;
    for (std::int64_t offset : cells.offsets) {
      if (offset < last || offset > static_cast<std::int64_t>(cells.connectivity.size())) {
        source_.fail("the offsets of its cells lie");
      }
      last = offset;
    }
    return cells;
  }

  std::vector<std::int64_t> named_numbers(const char* keyword, std::int64_t count) {
    if (upper_case(cursor_.token()) != keyword) source_.fail(std::string("has cells without ") + keyword);
    const NumberType type = number_type(source_, cursor_.token());
    return numbers<std::int64_t>(count, type);
  }

  /// Takes the lengths out of a list "3 a b c 4 d e f g ..." and returns the offsets instead.
  std::vector<std::int64_t> drop_lengths(std::vector<std::int64_t>& list, std::int64_t count) const {
    std::vector<std::int64_t> offsets{0};
    std::size_t from = 0, to = 0;
    while (from < list.size()) {
      const std::int64_t length = list[from++];
      if (length < 0 || static_cast<std::size_t>(length) > list.size() - from) source_.fail("a cell is cut off");
      for (std::int64_t i = 0; i < length; ++i) list[to++] = list[from++];
      offsets.push_back(static_cast<std::int64_t>(to));
    }
    if (static_cast<std::int64_t>(offsets.size()) - 1 != count) source_.fail("its cells are not as many as it says");
    list.resize(to);
    return offsets;
  }

  static std::span<const std::int64_t> cell(const Cells& cells, std::size_t i) {
    const auto start = static_cast<std::size_t>(cells.offsets[i]), end = static_cast<std::size_t>(cells.offsets[i + 1]);
    return std::span(cells.connectivity).subspan(start, end - start);
  }

  void add_polygonal_cells(CellKind kind) {
    const Cells cells = read_cells();
    for (std::size_t i = 0; i + 1 < cells.offsets.size(); ++i) {
      mesh_.add_cell(source_, kind, cell(cells, i), "polygon or strip");
    }
  }

  void add_cells() {
    const std::size_t count = cells_.offsets.empty() ? 0 : cells_.offsets.size() - 1;
    if (types_.size() != count) source_.fail("its cells and their types are not equally many");
    if (!regions_.empty() && regions_.size() != count) regions_.clear();
    for (std::size_t i = 0; i < count; ++i) {
      const CellKind kind = vtk_cell_kind(types_[i]);
      const std::string name = kind == CellKind::kUnsupported ? "VTK " + std::to_string(types_[i]) : "";
      if (regions_.empty()) {
        mesh_.add_cell(source_, kind, cell(cells_, i), name);
      } else {
        mesh_.add_cell(source_, kind, cell(cells_, i), name, regions_[i]);
      }
    }
  }

  void read_field() {
    cursor_.token();
    const std::int64_t arrays = cursor_.integer();
    for (std::int64_t i = 0; i < arrays; ++i) {
      const std::string name(cursor_.token());
      if (name == "METADATA") {  // VTK puts it between arrays at times
        --i;
        read_section(name);
        continue;
      }
      const std::int64_t components = cursor_.integer(), tuples = cursor_.integer();
      const std::string_view type = cursor_.token();
      if (type == "string") {
        skip_strings(times(components, tuples));
        continue;
      }
      keep(name, numbers<double>(times(components, tuples), number_type(source_, type)));
    }
  }

  /// In binary, the top bits of a string's first byte tell how many bytes its length takes.
  void skip_strings(std::int64_t count) {
    cursor_.line();
    for (std::int64_t i = 0; i < count; ++i) {
      if (cursor_.at_end()) source_.fail("ends within strings");
      if (!binary_) {
        cursor_.line();
        continue;
      }
      const std::size_t length_bytes = std::size_t{8} >> (static_cast<unsigned char>(cursor_.peek()) >> 6);
      std::uint64_t length = 0;
      for (char c : cursor_.raw(length_bytes, "strings")) length = length << 8 | static_cast<unsigned char>(c);
      length &= ~std::uint64_t{0} >> (length_bytes == 8 ? 2 : 66 - 8 * length_bytes);
      cursor_.raw(length, "strings");
    }
  }

  void read_scalars() {
    const std::string name(cursor_.token());
    const NumberType type = number_type(source_, cursor_.token());
    const std::string_view components = trimmed(cursor_.line());
    const std::int64_t count = times(data_count_, components.empty() ? 1 : parse_integer(source_, components));
    if (upper_case(cursor_.token()) != "LOOKUP_TABLE") source_.fail("has SCALARS without a LOOKUP_TABLE");
    cursor_.token();
    keep(name, numbers<double>(count, type));
  }

  /// Keeps those data that say something to us.
  void keep(const std::string& name, const std::vector<double>& values) {
    if (data_ == Data::kMesh && values.size() == 1) read_info_field(name, values[0], mesh_.info);
    if (data_ == Data::kCells && name == kRegionArray) {
      regions_.clear();
      for (double value : values) {
        if (!(std::abs(value) < 9e15)) source_.fail("a region is no whole number");
        regions_.push_back(static_cast<std::int64_t>(value));
      }
    }
    if (data_ == Data::kPoints && name == kOnSurfaceArray) {
      mesh_.on_surface.clear();
      for (double value : values) mesh_.on_surface.push_back(value != 0);
    }
  }

  const Source& source_;
  TextCursor cursor_;
  RawMesh mesh_;
  bool binary_ = false, has_offsets_ = false;
  Data data_ = Data::kMesh;
  std::int64_t data_count_ = 0;
  Cells cells_;
  std::vector<std::int64_t> types_, regions_;
};

}  // namespace

void write_legacy_vtk(const MeshView& mesh, Out& out) {
  out.put("# vtk DataFile Version 3.0\n", header_comment(mesh.info), "\nBINARY\nDATASET ",
          mesh.is_tet_mesh ? "UNSTRUCTURED_GRID" : "POLYDATA", '\n');
  const auto fields = info_fields(mesh.info);
  out.put("FIELD FieldData ", fields.size(), '\n');
  for (const auto& [name, value] : fields) {
    out.put(name, " 1 1 double\n");
    out.binary(value, kOrder);
    out.put('\n');
  }
  out.put("POINTS ", mesh.points.size(), " double\n");
  for (const Point3& p : mesh.points) {
    for (int axis = 0; axis < 3; ++axis) out.binary(p[axis], kOrder);
  }
  out.put('\n');
  if (mesh.is_tet_mesh) {
    write_tet_cells(mesh, out);
  } else {
    write_polygons(mesh, out);
  }
}

RawMesh read_legacy_vtk(const Source& source) { return Reader(source).read(); }

}  // namespace delvox::mesh_io
