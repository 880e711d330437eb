// I-DEAS universal files: nodes (2411, 781), elements (2412, 780) and groups (2467, 2477, 2452, 2435).
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"
#include "mesh_io/node_order.h"
#include "mesh_io/numbered_mesh.h"
#include "mesh_io/region_name.h"
#include "mesh_io/set_suffix.h"
#include "mesh_io/unv_types.h"

namespace delvox::mesh_io {
namespace {

class Reader {
 public:
  explicit Reader(const Source& source) : source_(source), cursor_(source, source.bytes) {}

  RawMesh read() {
    while (next_dataset()) {
      switch (dataset_) {
        case kUnvHeader: read_header(); break;
        case 781:
        case kUnvNodes: read_nodes(); break;
        case 780:
        case kUnvElements: read_elements(); break;
        case kUnvGroups:
        case 2477:
        case 2452:
        case 2435: read_groups(); break;
        default: break;
      }
      skip_to_end();
    }
    if (!any_dataset_) source_.fail("has no dataset", "is it an I-DEAS universal file?");
    numbered_.move_into(source_, mesh_);
    return std::move(mesh_);
  }

 private:
  bool next_dataset() {
    while (!cursor_.at_end()) {
      if (trimmed(cursor_.line()) != "-1") continue;
      if (cursor_.at_end()) return false;
      const std::string_view number = trimmed(cursor_.line());
      dataset_ = number.empty() || number.find_first_not_of("0123456789") != std::string_view::npos
                     ? 0
                     : parse_integer(source_, number);
      any_dataset_ = any_dataset_ || dataset_ != 0;
      ended_ = false;
      return true;
    }
    return false;
  }
  /// The next line of the dataset; false at its end.
  bool next_line() {
    if (ended_) return false;
    if (cursor_.at_end()) source_.fail("ends within a dataset");
    line_ = cursor_.line();
    ended_ = trimmed(line_) == "-1";
    return !ended_;
  }
  void skip_to_end() {
    while (!ended_ && !cursor_.at_end()) next_line();
  }

  /// The whole numbers of the current line.
  std::vector<std::int64_t> numbers() const {
    std::vector<std::int64_t> result;
    TextCursor cursor(source_, line_);
    while (cursor.more()) result.push_back(cursor.integer());
    return result;
  }
  std::vector<std::int64_t> numbers(std::size_t least) const {
    std::vector<std::int64_t> result = numbers();
    if (result.size() < least) source_.fail("a record is cut off");
    return result;
  }

  void read_header() {
    while (next_line()) read_header_comment(line_, mesh_.info);
  }

  void read_nodes() {
    while (next_line()) {
      const std::int64_t number = numbers(1)[0];
      if (!next_line()) source_.fail("a node has no coordinates");
      TextCursor cursor(source_, line_);
      const double x = cursor.real(), y = cursor.real(), z = cursor.real();
      numbered_.add_node(number, {x, y, z});
    }
  }

  void read_elements() {
    while (next_line()) {
      const std::vector<std::int64_t> head = numbers(6);
      const std::int64_t type = head[1];
      const bool is_beam = type == 11 || type == 21 || type == 22 || type == 23 || type == 24;
      if (is_beam) next_line();
      if (head[5] < 0 || head[5] > 1000) source_.fail("an element has " + std::to_string(head[5]) + " nodes");
      std::vector<std::int64_t> nodes;
      while (nodes.size() < static_cast<std::size_t>(head[5]) && next_line()) {
        const std::vector<std::int64_t> row = numbers();
        nodes.insert(nodes.end(), row.begin(), row.end());
      }
      if (nodes.size() != static_cast<std::size_t>(head[5])) source_.fail("an element has too few nodes");
      add_element(head[0], type, head[2], nodes);
    }
  }

  void add_element(std::int64_t number, std::int64_t type, std::int64_t property,
                   const std::vector<std::int64_t>& nodes) {
    const auto add = [&](CellKind kind, const auto& order) {
      if (nodes.size() != order.size()) source_.fail("an element has a wrong number of nodes");
      std::vector<std::int64_t> own(nodes.size());
      for (std::size_t i = 0; i < nodes.size(); ++i) own[order[i]] = nodes[i];
      numbered_.add_element(number, kind, own, property);
    };
    switch (type) {
      case kUnvTet4: return add(CellKind::kTet, kUnvOrder.tet4);
      case kUnvTet10: return add(CellKind::kTet, kUnvOrder.tet10);
      case 41:
      case 61:
      case 74:
      case kUnvTriangle3: return add(CellKind::kTriangle, std::array<std::uint8_t, 3>{0, 1, 2});
      case 42:
      case 72:
      case kUnvTriangle6: return add(CellKind::kTriangle, kUnvOrder.triangle6);
      case 44:
      case 94: return add(CellKind::kPolygon, std::array<std::uint8_t, 4>{0, 1, 2, 3});
      default: break;
    }
    const bool other_solid = type >= 101 && type <= 120;
    if (other_solid) mesh_.add_cell(source_, CellKind::kUnsupported, {}, "UNV " + std::to_string(type));
  }

  void read_groups() {
    while (next_line()) {
      const std::vector<std::int64_t> head = numbers(8);
      if (!next_line()) source_.fail("a group has no name");
      const std::string name(trimmed(line_));
      std::vector<std::int64_t> members;
      const std::size_t wanted = source_.checked_count(head[7], 4, cursor_.remaining() + 1, "members of a group");
      while (members.size() < 4 * wanted && next_line()) {
        const std::vector<std::int64_t> row = numbers();
        members.insert(members.end(), row.begin(), row.end());
      }
      add_group(name, members);
    }
  }

  void add_group(const std::string& name, const std::vector<std::int64_t>& members) {
    if (name.empty() || name == "boundary" || region_number(source_, name)) return;
    for (std::size_t i = 0; i + 1 < members.size(); i += 4) {
      const NumberRange number{members[i + 1], members[i + 1], 1};
      if (members[i] == kUnvNode) numbered_.add_nodes_to_set(without_suffix(name, kNodesSuffix), number);
      if (members[i] == kUnvElement) numbered_.add_elements_to_set(without_suffix(name, kTetsSuffix), number);
    }
  }

  const Source& source_;
  TextCursor cursor_;
  RawMesh mesh_;
  NumberedMesh numbered_;
  std::int64_t dataset_ = 0;
  bool any_dataset_ = false, ended_ = true;
  std::string_view line_;
};

}  // namespace

RawMesh read_unv(const Source& source) {
  return Reader(source).read();
}

}  // namespace delvox::mesh_io
