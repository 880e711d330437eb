// Abaqus and CalculiX input: nodes, elements and sets; the rest of a deck is passed over.
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "mesh_io/abaqus_names.h"
#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"
#include "mesh_io/node_order.h"
#include "mesh_io/numbered_mesh.h"
#include "mesh_io/region_name.h"

namespace delvox::mesh_io {
namespace {

constexpr double kRoundingOf12Digits = 5e-12;

struct ElementType {
  CellKind kind = CellKind::kIgnored;
  std::size_t nodes = 0;
};

ElementType element_type(const std::string& name) {
  static const std::map<std::string, ElementType, std::less<>> kExact{
      {"C3D4", {CellKind::kTet, 4}},        {"C3D10", {CellKind::kTet, 10}},     {"S3", {CellKind::kTriangle, 3}},
      {"STRI3", {CellKind::kTriangle, 3}},  {"DS3", {CellKind::kTriangle, 3}},   {"CPS3", {CellKind::kTriangle, 3}},
      {"CPE3", {CellKind::kTriangle, 3}},   {"CAX3", {CellKind::kTriangle, 3}},  {"M3D3", {CellKind::kTriangle, 3}},
      {"SFM3D3", {CellKind::kTriangle, 3}}, {"R3D3", {CellKind::kTriangle, 3}},  {"S6", {CellKind::kTriangle, 6}},
      {"STRI65", {CellKind::kTriangle, 6}}, {"M3D6", {CellKind::kTriangle, 6}},  {"CPS6", {CellKind::kTriangle, 6}},
      {"CPE6", {CellKind::kTriangle, 6}},   {"SFM3D6", {CellKind::kTriangle, 6}}, {"S4", {CellKind::kPolygon, 4}},
      {"CPS4", {CellKind::kPolygon, 4}},    {"CPE4", {CellKind::kPolygon, 4}},   {"M3D4", {CellKind::kPolygon, 4}},
      {"R3D4", {CellKind::kPolygon, 4}},    {"SFM3D4", {CellKind::kPolygon, 4}}, {"DC3D4", {CellKind::kTet, 4}},
      {"DC3D10", {CellKind::kTet, 10}},
  };
  // Letters at the end mark variants of the element with the same nodes: C3D10M, S4R, CPE4H.
  std::string_view stem = name;
  while (!stem.empty() && stem.back() >= 'A' && stem.back() <= 'Z') stem.remove_suffix(1);
  if (const auto found = kExact.find(stem); found != kExact.end()) return found->second;
  const bool solid = stem.starts_with("C3D") || stem.starts_with("DC3D") || stem.starts_with("SC");
  const bool shell = stem.starts_with("S8") || stem.starts_with("S9") || stem.starts_with("M3D8");
  return {solid || shell ? CellKind::kUnsupported : CellKind::kIgnored, 0};
}

/// The keyword of a line and its parameters, in capitals: *ELEMENT, TYPE=C3D4, ELSET=A; and as they are spelt.
struct Keyword {
  std::string name;
  std::map<std::string, std::string> parameters, spelt;
};

Keyword parse_keyword(std::string_view line) {
  Keyword keyword;
  line.remove_prefix(1);
  bool first = true;
  while (!line.empty() || first) {
    const std::size_t comma = std::min(line.find(','), line.size());
    const std::string_view part = trimmed(line.substr(0, comma));
    line.remove_prefix(std::min(comma + 1, line.size()));
    const std::size_t equals = std::min(part.find('='), part.size());
    const std::string key = upper_case(trimmed(part.substr(0, equals)));
    if (first) {
      keyword.name = key;
    } else {
      const std::string_view value = trimmed(part.substr(std::min(equals + 1, part.size())));
      keyword.parameters[key] = upper_case(value);
      keyword.spelt[key] = value;
    }
    first = false;
  }
  return keyword;
}

class Reader {
 public:
  explicit Reader(const Source& source) : source_(source), cursor_(source, source.bytes), regions_(source) {}

  RawMesh read() {
    mesh_.coordinate_error = kRoundingOf12Digits;
    while (!cursor_.at_end()) {
      const std::string_view line = trimmed(cursor_.line());
      if (line.starts_with("**")) {
        read_header_comment(line, mesh_.info);
      } else if (line.starts_with('*')) {
        begin_section(parse_keyword(line));
      } else if (!line.empty()) {
        data_line(line);
      }
    }
    finish_section();
    numbered_.move_into(source_, mesh_);
    return std::move(mesh_);
  }

 private:
  enum class Section { kOther, kNodes, kElements, kNodeSet, kElementSet, kSurface };

  void begin_section(const Keyword& keyword) {
    finish_section();
    section_ = Section::kOther;
    if (keyword.name == "NODE") section_ = Section::kNodes;
    if (keyword.name == "INCLUDE") source_.fail("includes other files", "merge them into one");
    if (keyword.name == "NSET") begin_set(Section::kNodeSet, keyword, "NSET");
    if (keyword.name == "ELSET") begin_set(Section::kElementSet, keyword, "ELSET");
    if (keyword.name == "SURFACE") begin_set(Section::kSurface, keyword, "NAME");
    if (keyword.name == "ELEMENT") begin_elements(keyword);
  }

  /// Those that write_abaqus makes of itself say nothing new.
  void begin_set(Section section, const Keyword& keyword, const char* parameter) {
    const auto name = keyword.parameters.find(parameter);
    if (name == keyword.parameters.end()) return;
    const auto type = keyword.parameters.find("TYPE");
    if (section == Section::kSurface && type != keyword.parameters.end() && type->second != "ELEMENT") return;
    if (name->second == kAllNodes || name->second == kAllTets || name->second == kBoundary) return;
    section_ = section;
    set_ = name->second;
    set_name_ = spelling_.try_emplace(set_, keyword.spelt.at(parameter)).first->second;
    generate_ = keyword.parameters.contains("GENERATE");
  }

  void begin_elements(const Keyword& keyword) {
    const auto type = keyword.parameters.find("TYPE");
    if (type == keyword.parameters.end()) source_.fail("has an *ELEMENT without a TYPE");
    type_name_ = type->second;
    type_ = element_type(type_name_);
    if (type_.kind == CellKind::kUnsupported) mesh_.add_cell(source_, type_.kind, {}, in_quotes(type_name_));
    if (type_.kind == CellKind::kIgnored) return;
    section_ = Section::kElements;
    const auto elset = keyword.parameters.find("ELSET");
    region_ = regions_.number(elset == keyword.parameters.end() ? "" : elset->second);
  }

  void finish_section() {
    if (!pending_.empty()) source_.fail("an element has too few nodes");
  }

  void data_line(std::string_view line) {
    if (section_ == Section::kOther) return;
    fields_.clear();
    while (!line.empty()) {
      const std::size_t comma = std::min(line.find(','), line.size());
      fields_.push_back(trimmed(line.substr(0, comma)));
      line.remove_prefix(std::min(comma + 1, line.size()));
    }
    while (!fields_.empty() && fields_.back().empty()) fields_.pop_back();
    switch (section_) {
      case Section::kNodes: return add_node();
      case Section::kElements:
        for (std::string_view field : fields_) add_element_number(parse_integer(source_, field));
        return;
      case Section::kNodeSet:
      case Section::kElementSet: return add_to_set();
      case Section::kSurface: return add_face();
      case Section::kOther: return;
    }
  }

  /// Members by number, by ranges (GENERATE), or by the name of an earlier set.
  void add_to_set() {
    auto& ranges = ranges_of_[{section_, set_}];
    const std::size_t first = ranges.size();
    if (generate_ && fields_.size() >= 2) {
      const std::int64_t step = fields_.size() > 2 ? parse_integer(source_, fields_[2]) : 1;
      if (step < 1) source_.fail("a set is generated in steps of " + std::to_string(step));
      ranges.push_back({parse_integer(source_, fields_[0]), parse_integer(source_, fields_[1]), step});
    } else {
      for (std::string_view field : fields_) {
        const bool is_number = !field.empty() && field.find_first_not_of("+0123456789") == std::string_view::npos;
        if (is_number) {
          const std::int64_t number = parse_integer(source_, field);
          ranges.push_back({number, number, 1});
          continue;
        }
        const auto earlier = ranges_of_.find({section_, upper_case(field)});
        if (earlier == ranges_of_.end() || &earlier->second == &ranges) continue;
        if (ranges.size() + earlier->second.size() > source_.bytes.size()) {
          source_.fail("its sets name each other too often");
        }
        ranges.insert(ranges.end(), earlier->second.begin(), earlier->second.end());
      }
    }
    for (std::size_t i = first; i < ranges.size(); ++i) {
      if (section_ == Section::kNodeSet) {
        numbered_.add_nodes_to_set(set_name_, ranges[i]);
      } else {
        numbered_.add_elements_to_set(set_name_, ranges[i]);
      }
    }
  }

  /// "12, S1"; surfaces of whole element sets are passed over.
  void add_face() {
    if (fields_.size() < 2 || fields_[0].empty()) return;
    if (fields_[0].find_first_not_of("+0123456789") != std::string_view::npos) return;
    const std::string face = upper_case(fields_[1]);
    for (std::uint8_t own = 0; own < 4; ++own) {
      if (face == "S" + std::to_string(kAbaqusFace[own])) {
        numbered_.add_face_to_set(set_name_, parse_integer(source_, fields_[0]), own);
      }
    }
  }

  void add_node() {
    if (fields_.size() < 2) source_.fail("a node has no coordinates");
    Point3 p;
    for (std::size_t axis = 0; axis < 3 && axis + 1 < fields_.size(); ++axis) {
      const std::string_view field = fields_[axis + 1];
      p[static_cast<int>(axis)] = field.empty() ? 0.0 : parse_real(source_, field);
    }
    numbered_.add_node(parse_integer(source_, fields_[0]), p);
  }

  /// Elements may run over several lines.
  void add_element_number(std::int64_t number) {
    pending_.push_back(number);
    if (pending_.size() < type_.nodes + 1) return;
    numbered_.add_element(pending_[0], type_.kind, std::span(pending_).subspan(1), region_);
    pending_.clear();
  }

  const Source& source_;
  TextCursor cursor_;
  RawMesh mesh_;
  Section section_ = Section::kOther;
  std::string type_name_;
  ElementType type_;
  std::int64_t region_ = 1;
  NamedRegions regions_;
  std::string set_;        ///< being listed, in capitals
  std::string set_name_;   ///< the same, as it was spelt first
  std::map<std::string, std::string> spelling_;  ///< of sets, by their names in capitals
  bool generate_ = false;  ///< as ranges
  std::map<std::pair<Section, std::string>, std::vector<NumberRange>> ranges_of_;
  std::vector<std::string_view> fields_;
  std::vector<std::int64_t> pending_;  ///< number and nodes of the element being read
  NumberedMesh numbered_;
};

}  // namespace

RawMesh read_abaqus(const Source& source) { return Reader(source).read(); }

}  // namespace delvox::mesh_io
