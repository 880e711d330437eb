// FEBio's .feb of versions 2.5, 3 and 4: nodes, tets, shells and sets; the rest of a model is passed over.
#include <string>
#include <vector>

#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"
#include "mesh_io/numbered_mesh.h"
#include "mesh_io/region_name.h"
#include "mesh_io/xml.h"

namespace delvox::mesh_io {
namespace {

class Reader {
 public:
  explicit Reader(const Source& source) : source_(source), regions_(source) {}

  RawMesh read() {
    const std::string_view bytes = source_.bytes;
    const std::size_t comment = bytes.find("<!--");
    if (comment != std::string_view::npos && comment < 200) {
      read_header_comment(bytes.substr(comment, std::min<std::size_t>(200, bytes.size() - comment)), mesh_.info);
    }
    const XmlNode document = parse_xml(source_, bytes);
    const XmlNode* root = document.child("febio_spec");
    if (root == nullptr) source_.fail("has no febio_spec", "is it an FEBio model?");
    const XmlNode* mesh = root->child("Mesh") != nullptr ? root->child("Mesh") : root->child("Geometry");
    if (mesh == nullptr) source_.fail("has neither a Mesh nor a Geometry", "is it an FEBio model with its mesh?");
    for (const XmlNode& part : mesh->children) {
      if (part.name == "Nodes") read_nodes(part);
      if (part.name == "Elements") read_elements(part);
      if (part.name == "NodeSet" || part.name == "ElementSet") read_members(part);
      if (part.name == "Surface") read_surface(part);
    }
    numbered_.move_into(source_, mesh_);
    return std::move(mesh_);
  }

 private:
  /// The pieces of a list with commas.
  std::vector<std::string_view> pieces(std::string_view list) const {
    std::vector<std::string_view> result;
    while (!trimmed(list).empty()) {
      const std::size_t comma = std::min(list.find(','), list.size());
      result.push_back(trimmed(list.substr(0, comma)));
      list.remove_prefix(std::min(comma + 1, list.size()));
    }
    return result;
  }
  std::vector<std::int64_t> integers(std::string_view list) const {
    std::vector<std::int64_t> result;
    for (std::string_view piece : pieces(list)) result.push_back(parse_integer(source_, piece));
    return result;
  }
  std::int64_t id_of(const XmlNode& node) const { return parse_integer(source_, trimmed(node.attribute("id"))); }

  void read_nodes(const XmlNode& part) {
    for (const XmlNode& node : part.children) {
      if (node.name != "node") continue;
      const std::vector<std::string_view> xyz = pieces(node.text);
      if (xyz.size() != 3) source_.fail("a node has not three coordinates");
      numbered_.add_node(id_of(node),
                         {parse_real(source_, xyz[0]), parse_real(source_, xyz[1]), parse_real(source_, xyz[2])});
    }
  }

  void read_elements(const XmlNode& part) {
    const std::string type = upper_case(part.attribute("type"));
    const bool is_tet = type.starts_with("TET4") || type.starts_with("TET10");
    const bool is_triangle = type.starts_with("TRI3") || type.starts_with("TRI6");
    const bool is_quad = type.starts_with("QUAD4");
    if (!is_tet && !is_triangle && !is_quad) mesh_.add_cell(source_, CellKind::kUnsupported, {}, in_quotes(type));
    const CellKind kind = is_tet ? CellKind::kTet : is_triangle ? CellKind::kTriangle : CellKind::kPolygon;
    const std::int64_t region = regions_.number(std::string(part.attribute("name")));
    for (const XmlNode& element : part.children) {
      if (element.name == "elem") numbered_.add_element(id_of(element), kind, integers(element.text), region);
    }
  }

  /// A list, or children with an id each.
  void read_members(const XmlNode& part) {
    std::vector<std::int64_t> members = integers(part.text);
    for (const XmlNode& child : part.children) members.push_back(id_of(child));
    const std::string name(part.attribute("name"));
    for (std::int64_t number : members) {
      if (part.name == "NodeSet") {
        numbered_.add_nodes_to_set(name, {number, number, 1});
      } else {
        numbered_.add_elements_to_set(name, {number, number, 1});
      }
    }
  }

  void read_surface(const XmlNode& part) {
    for (const XmlNode& face : part.children) {
      const std::vector<std::int64_t> nodes = integers(face.text);
      if (nodes.size() < 3) source_.fail("a face has too few nodes");
      if (face.name.starts_with("tri")) {
        numbered_.add_triangle_to_set(std::string(part.attribute("name")), {nodes[0], nodes[1], nodes[2]});
      }
    }
  }

  const Source& source_;
  RawMesh mesh_;
  NumberedMesh numbered_;
  NamedRegions regions_;
};

}  // namespace

RawMesh read_febio(const Source& source) {
  return Reader(source).read();
}

}  // namespace delvox::mesh_io
