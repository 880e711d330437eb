// Nastran bulk data in free, small and large fields: nodes, tets, triangles and quadrilaterals, and our own sets.
#include <string>
#include <vector>

#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"
#include "mesh_io/numbered_mesh.h"

namespace delvox::mesh_io {
namespace {

// "%E" in 16 characters, with a sign: ten digits.
constexpr double kRoundingOf16Characters = 5e-10;

/// One entry: its name and its fields, whatever the format and however many lines.
struct Card {
  std::string name;
  std::vector<std::string_view> fields;
};

/// Nastran may leave out the E of an exponent: 1.5-3.
double parse_nastran_real(const Source& source, std::string_view text) {
  std::string number;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool sign = text[i] == '-' || text[i] == '+';
    const bool after_digit = i > 0 && (text[i - 1] == '.' || (text[i - 1] >= '0' && text[i - 1] <= '9'));
    if (sign && after_digit) number += 'E';
    number += text[i];
  }
  return parse_real(source, number);
}

class Reader {
 public:
  explicit Reader(const Source& source) : source_(source), cursor_(source, source.bytes) {}

  RawMesh read() {
    mesh_.coordinate_error = kRoundingOf16Characters;
    while (!cursor_.at_end()) {
      const std::string_view line = cursor_.line();
      if (line.starts_with('$')) {
        comment(line);
      } else if (trimmed(line) == "ENDDATA") {
        break;
      } else if (!trimmed(line).empty()) {
        take(line);
      }
    }
    finish();
    numbered_.move_into(source_, mesh_);
    return std::move(mesh_);
  }

 private:
  void comment(std::string_view line) {
    read_header_comment(line, mesh_.info);
    for (std::string_view kind : {"$ set of nodes: ", "$ set of tets: ", "$ set of faces: "}) {
      if (!line.starts_with(kind)) continue;
      finish();
      set_ = trimmed(line.substr(kind.size()));
      set_of_nodes_ = kind == "$ set of nodes: ";
    }
  }

  void take(std::string_view line) {
    const bool goes_on = line[0] == '+' || line[0] == '*' || line[0] == ' ' || line[0] == ',';
    if (!goes_on) {
      finish();
      pending_ = true;
    } else if (!pending_) {
      return;
    }
    const std::string_view head = line.substr(0, std::min<std::size_t>(8, line.size()));
    if (line.find(',') != std::string_view::npos) {
      take_free(line, goes_on);
      return;
    }
    if (!goes_on) card_.name = upper_case(trimmed(head));
    const bool large = head.find('*') != std::string_view::npos;
    if (!goes_on && large) card_.name.pop_back();
    const std::size_t width = large ? 16 : 8;
    for (std::size_t start = 8; start < 72; start += width) {
      card_.fields.push_back(start < line.size() ? trimmed(line.substr(start, width)) : std::string_view{});
    }
  }

  void take_free(std::string_view line, bool goes_on) {
    std::size_t count = 0;
    for (bool first = true; !line.empty() || first; first = false) {
      const std::size_t comma = std::min(line.find(','), line.size());
      const std::string_view field = trimmed(line.substr(0, comma));
      line.remove_prefix(std::min(comma + 1, line.size()));
      if (first) {
        if (!goes_on) card_.name = upper_case(field);
        if (!goes_on && card_.name.ends_with('*')) card_.name.pop_back();
      } else if (count < 8) {
        card_.fields.push_back(field);
        ++count;
      }
    }
    for (; count < 8; ++count) card_.fields.emplace_back();
  }

  std::string_view field(std::size_t i) const { return i < card_.fields.size() ? card_.fields[i] : std::string_view{}; }

  void finish() {
    if (pending_) interpret();
    pending_ = false;
    card_ = {};
  }

  void interpret() {
    const std::string& name = card_.name;
    if (name == "GRID") {
      add_node();
    } else if (name == "CTETRA") {
      add_cell(CellKind::kTet, 4, 10);
    } else if (name == "CTRIA3" || name == "CTRIAR") {
      add_cell(CellKind::kTriangle, 3, 3);
    } else if (name == "CTRIA6") {
      add_cell(CellKind::kTriangle, 6, 6);
    } else if (name == "CQUAD4" || name == "CQUADR") {
      add_cell(CellKind::kPolygon, 4, 4);
    } else if (name == "CHEXA" || name == "CPENTA" || name == "CPYRA" || name == "CPYRAM" || name == "CQUAD8") {
      mesh_.add_cell(source_, CellKind::kUnsupported, {}, in_quotes(name));
    } else if (name == "SET1" && !set_.empty()) {
      add_set();
    } else if (name == "PLOAD4" && !set_.empty()) {
      add_face();
    } else {
      set_.clear();
    }
  }

  void add_node() {
    const std::string_view system = field(1);
    if (!system.empty() && parse_integer(source_, system) != 0) {
      source_.fail("has nodes in a coordinate system of their own", "write them in the basic system");
    }
    Point3 p;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string_view text = field(2 + axis);
      p[static_cast<int>(axis)] = text.empty() ? 0 : parse_nastran_real(source_, text);
    }
    numbered_.add_node(parse_integer(source_, field(0)), p);
  }

  /// Cells with all `most` nodes given are of higher order, else they have `least`.
  void add_cell(CellKind kind, std::size_t least, std::size_t most) {
    std::vector<std::int64_t> nodes;
    for (std::size_t i = 0; i < most && !field(2 + i).empty(); ++i)
      nodes.push_back(parse_integer(source_, field(2 + i)));
    if (nodes.size() < least) source_.fail("an element has too few nodes");
    if (nodes.size() != most) nodes.resize(least);
    const std::string_view property = field(1);
    numbered_.add_element(parse_integer(source_, field(0)), kind, nodes,
                          property.empty() ? 1 : parse_integer(source_, property));
  }

  void add_set() {
    for (std::size_t i = 1; i < card_.fields.size(); ++i) {
      if (card_.fields[i].empty()) continue;
      const std::int64_t number = parse_integer(source_, card_.fields[i]);
      if (set_of_nodes_) {
        numbered_.add_nodes_to_set(set_, {number, number, 1});
      } else {
        numbered_.add_elements_to_set(set_, {number, number, 1});
      }
    }
  }

  void add_face() {
    numbered_.add_opposite_face_to_set(set_, parse_integer(source_, field(1)), parse_integer(source_, field(7)));
  }

  const Source& source_;
  TextCursor cursor_;
  RawMesh mesh_;
  NumberedMesh numbered_;
  Card card_;
  bool pending_ = false;  ///< card_ is being read
  std::string set_;       ///< of ours, that the next entries belong to
  bool set_of_nodes_ = false;
};

}  // namespace

RawMesh read_nastran(const Source& source) {
  return Reader(source).read();
}

}  // namespace delvox::mesh_io
