// PLY: https://paulbourke.net/dataformats/ply/
#include <optional>
#include <string>
#include <vector>

#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"
#include "mesh_io/number_type.h"

namespace delvox::mesh_io {
namespace {

struct Property {
  std::string name;
  NumberType type;
  std::optional<NumberType> length_type;  ///< set if it is a list
};

struct Element {
  std::string name;
  std::int64_t count;
  std::vector<Property> properties;
};

NumberType number_type(const Source& source, std::string_view name) {
  constexpr std::pair<std::string_view, NumberType> kTypes[] = {
      {"char", NumberType::kInt8},      {"int8", NumberType::kInt8},       {"uchar", NumberType::kUInt8},
      {"uint8", NumberType::kUInt8},    {"short", NumberType::kInt16},     {"int16", NumberType::kInt16},
      {"ushort", NumberType::kUInt16},  {"uint16", NumberType::kUInt16},   {"int", NumberType::kInt32},
      {"int32", NumberType::kInt32},    {"uint", NumberType::kUInt32},     {"uint32", NumberType::kUInt32},
      {"int64", NumberType::kInt64},    {"uint64", NumberType::kUInt64},   {"float", NumberType::kFloat32},
      {"float32", NumberType::kFloat32}, {"double", NumberType::kFloat64}, {"float64", NumberType::kFloat64},
  };
  for (const auto& [type_name, type] : kTypes) {
    if (name == type_name) return type;
  }
  source.fail("has a property of the unknown type " + in_quotes(name));
}

class Reader {
 public:
  explicit Reader(const Source& source) : source_(source), cursor_(source, source.bytes) {}

  RawMesh read() {
    read_header();
    for (const Element& element : elements_) {
      check_count(element);
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else if (element.name == "tristrips") {
        source_.fail("holds triangle strips", "save it with triangles");
      } else {
        for (std::int64_t i = 0; i < element.count; ++i) skip_row(element);
      }
    }
    return std::move(mesh_);
  }

 private:
  void read_header() {
    if (cursor_.token() != "ply") source_.fail("does not begin like a PLY file", "is it a .ply file?");
    while (true) {
      const std::string_view word = cursor_.token();
      if (word == "end_header") break;
      if (word == "comment") {
        read_header_comment(cursor_.line(), mesh_.info);
      } else if (word == "format") {
        read_format(cursor_.token());
        cursor_.line();
      } else if (word == "element") {
        const std::string name(cursor_.token());
        elements_.push_back({name, cursor_.integer(), {}});
      } else if (word == "property") {
        read_property();
      } else {
        cursor_.line();  // obj_info and the like
      }
    }
    cursor_.line();
    if (!format_known_) source_.fail("does not name its format");
  }

  void read_format(std::string_view format) {
    format_known_ = true;
    binary_ = format != "ascii";
    order_ = format == "binary_big_endian" ? std::endian::big : std::endian::little;
    if (binary_ && format != "binary_big_endian" && format != "binary_little_endian") {
      source_.fail("has the unknown format " + in_quotes(format));
    }
  }

  void read_property() {
    if (elements_.empty()) source_.fail("has a property before any element");
    std::string_view type = cursor_.token();
    std::optional<NumberType> length_type;
    if (type == "list") {
      length_type = number_type(source_, cursor_.token());
      type = cursor_.token();
    }
    const NumberType value_type = number_type(source_, type);
    elements_.back().properties.push_back({std::string(cursor_.token()), value_type, length_type});
  }

  void check_count(const Element& element) const {
    std::size_t least = 0;
    for (const Property& property : element.properties) {
      least += binary_ ? size_of(property.length_type.value_or(property.type)) : 2;
    }
    if (least == 0 && element.count != 0) source_.fail("has an element without properties");
    if (least > 0) source_.checked_count(element.count, least, cursor_.remaining() + 1, "elements");
  }

  template <class T>
  T number(NumberType type) {
    if (binary_) return load_as<T>(source_, cursor_.raw(size_of(type), "data").data(), type, order_);
    if constexpr (std::is_integral_v<T>) {
      return cursor_.integer();
    } else {
      return cursor_.real();
    }
  }

  std::size_t list_length(const Property& property) {
    const auto claimed = number<std::int64_t>(*property.length_type);
    const std::size_t each = binary_ ? size_of(property.type) : 2;
    return source_.checked_count(claimed, each, cursor_.remaining() + 1, "list entries");
  }

  void skip(const Property& property) {
    const std::size_t count = property.length_type ? list_length(property) : 1;
    if (binary_) {
      cursor_.raw(count * size_of(property.type), "data");
    } else {
      for (std::size_t i = 0; i < count; ++i) cursor_.token();
    }
  }

  void skip_row(const Element& element) {
    for (const Property& property : element.properties) skip(property);
  }

  void read_vertices(const Element& element) {
    std::vector<int> axes;
    int found = 0;
    for (const Property& property : element.properties) {
      const bool is_axis = !property.length_type && property.name.size() == 1 && property.name >= "x" &&
                           property.name <= "z";
      axes.push_back(is_axis ? property.name[0] - 'x' : -1);
      if (is_axis) found |= 1 << axes.back();
      if (is_axis && property.type == NumberType::kFloat32) mesh_.coordinate_error = kFloat32Error;
    }
    if (found != 7) source_.fail("its vertices have no x, y and z");
    mesh_.points.reserve(static_cast<std::size_t>(element.count));
    for (std::int64_t i = 0; i < element.count; ++i) {
      Point3 p;
      for (std::size_t j = 0; j < axes.size(); ++j) {
        if (axes[j] < 0) {
          skip(element.properties[j]);
        } else {
          p[axes[j]] = number<double>(element.properties[j].type);
        }
      }
      mesh_.points.push_back(p);
    }
  }

  void read_faces(const Element& element) {
    std::vector<std::int64_t> nodes;
    for (std::int64_t i = 0; i < element.count; ++i) {
      for (const Property& property : element.properties) {
        const bool is_face = property.name == "vertex_indices" || property.name == "vertex_index";
        if (!is_face || !property.length_type) {
          skip(property);
          continue;
        }
        nodes.resize(list_length(property));
        for (std::int64_t& node : nodes) node = number<std::int64_t>(property.type);
        mesh_.add_cell(source_, CellKind::kPolygon, nodes, "face");
      }
    }
  }

  const Source& source_;
  TextCursor cursor_;
  RawMesh mesh_;
  bool format_known_ = false, binary_ = false;
  std::endian order_ = std::endian::little;
  std::vector<Element> elements_;
};

}  // namespace

void write_ply(const MeshView& mesh, Out& out) {
  constexpr auto kOrder = std::endian::little;
  out.put("ply\nformat binary_little_endian 1.0\ncomment ", header_comment(mesh.info));
  out.put("\nelement vertex ", mesh.points.size(), "\nproperty double x\nproperty double y\nproperty double z");
  out.put("\nelement face ", mesh.triangles.size(), "\nproperty list uchar int vertex_indices\nend_header\n");
  for (const Point3& p : mesh.points) {
    for (int axis = 0; axis < 3; ++axis) out.binary(p[axis], kOrder);
  }
  for (const Triangle& triangle : mesh.triangles) {
    out.binary(std::uint8_t{3}, kOrder);
    for (std::uint32_t node : triangle) out.binary(node, kOrder);
  }
}

RawMesh read_ply(const Source& source) { return Reader(source).read(); }

}  // namespace delvox::mesh_io
