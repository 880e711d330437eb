// Gmsh MSH 4.1 and 2.2, text and binary.
#include <map>
#include <string>
#include <vector>

#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"
#include "mesh_io/node_order.h"
#include "mesh_io/number_type.h"
#include "mesh_io/numbered_mesh.h"
#include "mesh_io/set_suffix.h"

namespace delvox::mesh_io {
namespace {

constexpr std::string_view kBoundaryGroup = "boundary";  // what write_gmsh41 calls all of it

struct ElementType {
  CellKind kind;
  std::size_t nodes;
};

ElementType element_type(const Source& source, std::int64_t type) {
  constexpr auto kNone = CellKind::kIgnored, kTriangle = CellKind::kTriangle, kTet = CellKind::kTet;
  switch (type) {
    case 1: return {kNone, 2};  // lines, then points
    case 8: return {kNone, 3};
    case 26: return {kNone, 4};
    case 27: return {kNone, 5};
    case 28: return {kNone, 6};
    case 15: return {kNone, 1};
    case 2: return {kTriangle, 3};
    case 9: return {kTriangle, 6};
    case 21: return {kTriangle, 10};
    case 3: return {CellKind::kPolygon, 4};
    case 4: return {kTet, 4};
    case 11: return {kTet, 10};
    case 29: return {kTet, 20};
    default:
      source.fail("holds elements of Gmsh type " + std::to_string(type) + ", which are neither tets nor triangles",
                  "split such elements into tets or triangles first");
  }
}

class Reader {
 public:
  explicit Reader(const Source& source) : source_(source), cursor_(source, source.bytes) {}

  RawMesh read() {
    while (cursor_.more()) {
      const std::string section(trimmed(cursor_.line()));
      if (!section.starts_with('$')) continue;
      if (section == "$MeshFormat") {
        read_format();
      } else if (section == "$PhysicalNames") {
        read_names();
      } else if (section == "$Comments") {
        if (!cursor_.at_end()) read_header_comment(cursor_.line(), mesh_.info);
      } else if (version_ == 0) {
        source_.fail("does not begin with $MeshFormat", "is it a Gmsh file of version 4.1 or 2.2?");
      } else if (version_ == 2) {
        read_section22(section);
      } else {
        read_section41(section);
      }
      skip_to_end_of(section);
    }
    if (version_ == 0) source_.fail("has no $MeshFormat", "is it a Gmsh file of version 4.1 or 2.2?");
    numbered_.move_into(source_, mesh_);
    return std::move(mesh_);
  }

 private:
  void read_format() {
    const double version = cursor_.real();
    if (version == 4.1) version_ = 4;
    if (version >= 2 && version < 3) version_ = 2;
    if (version_ == 0) {
      source_.fail("is of MSH version " + std::to_string(version).substr(0, 3), "save it as version 4.1 or 2.2");
    }
    binary_ = cursor_.integer() == 1;
    if (cursor_.integer() != 8) source_.fail("does not use numbers of 8 bytes");
    if (!binary_) return;
    cursor_.line();
    const std::string_view one = cursor_.raw(4, "header");
    order_ = load<std::int32_t>(one.data(), std::endian::little) == 1 ? std::endian::little : std::endian::big;
  }

  void read_names() {
    const std::size_t names = cursor_.count("physical names", 5);
    for (std::size_t i = 0; i < names; ++i) {
      const std::int64_t dimension = cursor_.integer(), group = cursor_.integer();
      const std::string_view name = trimmed(cursor_.line());
      if (name.size() > 2 && name.front() == '"' && name.back() == '"') {
        names_[{dimension, group}] = name.substr(1, name.size() - 2);
      }
    }
  }

  void skip_to_end_of(const std::string& section) {
    const std::string end = "$End" + section.substr(1);
    const std::size_t found = cursor_.rest().find(end);
    if (found == std::string_view::npos) source_.fail("ends before its " + in_quotes(end));
    cursor_.seek(cursor_.position() + found + end.size());
  }

  template <class Stored>
  std::int64_t whole_number() {
    if (!binary_) return cursor_.integer();
    return static_cast<std::int64_t>(load<Stored>(cursor_.raw(sizeof(Stored), "data").data(), order_));
  }
  std::int64_t small() { return whole_number<std::int32_t>(); }
  std::int64_t large() { return whole_number<std::uint64_t>(); }
  double real() { return binary_ ? load<double>(cursor_.raw(8, "data").data(), order_) : cursor_.real(); }

  /// A claimed number of things, each of so many numbers of at least so many bytes.
  std::size_t checked(std::int64_t count, std::size_t numbers, std::size_t bytes_of_number, const char* what) const {
    return source_.checked_count(count, numbers * (binary_ ? bytes_of_number : 2), cursor_.remaining() + 1, what);
  }
  std::size_t count(const char* what) { return checked(large(), 1, 4, what); }

  void read_section41(const std::string& section) {
    if (section == "$Entities") {
      read_entities();
    } else if (section == "$Nodes") {
      read_nodes41();
    } else if (section == "$Elements") {
      read_elements41();
    }
  }

  void read_entities() {
    std::size_t counts[4];
    for (std::size_t& entities : counts) entities = count("entities");
    for (int dimension = 0; dimension < 4; ++dimension) {
      for (std::size_t i = 0; i < counts[dimension]; ++i) read_entity(dimension);
    }
  }

  void read_entity(int dimension) {
    const std::int64_t tag = small();
    for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i) real();
    const std::size_t groups = count("physical groups");
    for (std::size_t i = 0; i < groups; ++i) {
      const std::int64_t group = small();
      if (dimension == 3 && i == 0) {
        region_of_volume_[tag] = group;
      } else if (const auto name = names_.find({dimension, group}); dimension >= 2 && name != names_.end()) {
        if (name->second == kBoundaryGroup) continue;
        sets_of_entity_[{dimension, tag}].push_back(dimension == 3 ? without_suffix(name->second, kTetsSuffix)
                                                                   : name->second);
      }
    }
    if (dimension == 0) return;
    const std::size_t bounding = count("bounding entities");
    for (std::size_t i = 0; i < bounding; ++i) small();
  }

  void read_nodes41() {
    const std::size_t blocks = count("blocks of nodes");
    for (int i = 0; i < 3; ++i) large();
    std::vector<std::int64_t> numbers;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::int64_t dimension = small();
      small();
      const bool parametric = small() != 0;
      numbers.resize(checked(large(), 4, 8, "nodes"));
      for (std::int64_t& number : numbers) number = large();
      for (std::int64_t number : numbers) {
        const double x = real(), y = real(), z = real();
        for (std::int64_t i = 0; parametric && i < std::min<std::int64_t>(dimension, 3); ++i) real();
        numbered_.add_node(number, {x, y, z});
      }
    }
  }

  void read_elements41() {
    const std::size_t blocks = count("blocks of elements");
    for (int i = 0; i < 3; ++i) large();
    std::vector<std::int64_t> nodes;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::int64_t dimension = small(), entity = small();
      const ElementType type = element_type(source_, small());
      const auto group = region_of_volume_.find(entity);
      const std::int64_t region = dimension == 3 && group != region_of_volume_.end() ? group->second : entity;
      nodes.resize(type.nodes);
      const std::size_t elements = checked(large(), 1 + type.nodes, 8, "elements");
      const auto sets = sets_of_entity_.find({dimension, entity});
      for (std::size_t i = 0; i < elements; ++i) {
        const std::int64_t number = large();
        for (std::int64_t& node : nodes) node = large();
        add_element(number, type, nodes, region);
        if (sets == sets_of_entity_.end()) continue;
        for (const std::string& set : sets->second) numbered_.add_elements_to_set(set, {number, number, 1});
      }
    }
  }

  void read_section22(const std::string& section) {
    if (section == "$Nodes") {
      const std::size_t nodes = begin_list22(4);
      for (std::size_t i = 0; i < nodes; ++i) {
        const std::int64_t number = small();
        const double x = real(), y = real(), z = real();
        numbered_.add_node(number, {x, y, z});
      }
    } else if (section == "$Elements") {
      read_elements22();
    }
  }

  /// The length of a list is text even in binary files.
  std::size_t begin_list22(std::size_t numbers_each) {
    const std::int64_t claimed = cursor_.integer();
    if (binary_) cursor_.line();
    return checked(claimed, numbers_each, 4, "nodes or elements");
  }

  void read_elements22() {
    const std::size_t elements = begin_list22(2);
    for (std::size_t i = 0; i < elements;) {
      if (binary_) {
        // Blocks of elements of one type: type, how many, how many tags each.
        const ElementType type = element_type(source_, small());
        const std::size_t in_block = checked(small(), 1 + type.nodes, 4, "elements");
        if (in_block == 0) source_.fail("has an empty block of elements");
        const std::int64_t tags = small();
        for (std::size_t j = 0; j < in_block; ++j) read_element22(small(), type, tags);
        i += in_block;
      } else {
        const std::int64_t number = small();
        const ElementType type = element_type(source_, small());
        read_element22(number, type, small());
        ++i;
      }
    }
  }

  void read_element22(std::int64_t number, const ElementType& type, std::int64_t claimed_tags) {
    const std::size_t tags = checked(claimed_tags, 1, 4, "tags");
    std::int64_t physical = 0, elementary = 0;
    for (std::size_t i = 0; i < tags; ++i) {
      const std::int64_t tag = small();
      if (i == 0) physical = tag;
      if (i == 1) elementary = tag;
    }
    nodes_.resize(type.nodes);
    for (std::int64_t& node : nodes_) node = small();
    add_element(number, type, nodes_, physical != 0 ? physical : elementary);
  }

  void add_element(std::int64_t number, const ElementType& type, std::span<const std::int64_t> nodes,
                   std::int64_t region) {
    if (type.kind == CellKind::kIgnored) return;
    if (type.kind != CellKind::kTet || nodes.size() != kGmshOrder.tet10.size()) {
      numbered_.add_element(number, type.kind, nodes, region);
      return;
    }
    std::array<std::int64_t, 10> own{};
    for (std::size_t i = 0; i < own.size(); ++i) own[kGmshOrder.tet10[i]] = nodes[i];
    numbered_.add_element(number, type.kind, own, region);
  }

  const Source& source_;
  TextCursor cursor_;
  RawMesh mesh_;
  NumberedMesh numbered_;
  int version_ = 0;  ///< 2 or 4 once it is known
  bool binary_ = false;
  std::endian order_ = std::endian::little;
  std::map<std::int64_t, std::int64_t> region_of_volume_;  ///< its first physical group
  std::map<std::pair<std::int64_t, std::int64_t>, std::string> names_;  ///< of physical groups, by dimension and number
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::string>> sets_of_entity_;
  std::vector<std::int64_t> nodes_;
};

}  // namespace

RawMesh read_gmsh(const Source& source) { return Reader(source).read(); }

}  // namespace delvox::mesh_io
