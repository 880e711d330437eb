// Abaqus and CalculiX input. CalculiX reads at most 20 characters per field and silently misreads longer ones, so
// coordinates get 12 significant digits.
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"
#include "mesh_io/numbered_mesh.h"

namespace delvox::mesh_io {
namespace {

constexpr std::string_view kRegionPrefix = "REGION_";
constexpr double kRoundingOf12Digits = 5e-12;

void write_nodes(const MeshView& mesh, Out& out) {
  out.put("*NODE, NSET=NALL\n");
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const Point3& p = mesh.points[i];
    out.put(i + 1, ", ", Digits12{p.x}, ", ", Digits12{p.y}, ", ", Digits12{p.z}, '\n');
  }
}

void write_tets(const MeshView& mesh, Out& out) {
  std::map<Label, std::vector<std::size_t>> by_region;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) by_region[mesh.region(t)].push_back(t);
  for (const auto& [region, tets] : by_region) {
    out.put("*ELEMENT, TYPE=C3D4, ELSET=", kRegionPrefix, region, '\n');
    for (std::size_t t : tets) {
      const Tet& tet = mesh.tets[t];
      out.put(t + 1, ", ", tet[0] + 1, ", ", tet[1] + 1, ", ", tet[2] + 1, ", ", tet[3] + 1, '\n');
    }
  }
}

/// The nodes of the boundary as a set, for boundary conditions.
void write_surface_set(const MeshView& mesh, Out& out) {
  constexpr std::size_t kPerLine = 16;  // what Abaqus takes at most
  std::vector<bool> used(mesh.points.size(), false);
  for (const Triangle& triangle : mesh.triangles) {
    for (std::uint32_t node : triangle) used[node] = true;
  }
  out.put("*NSET, NSET=SURFACE\n");
  std::size_t written = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    if (written > 0) out.put(written % kPerLine == 0 ? ",\n" : ", ");
    out.put(i + 1);
    ++written;
  }
  out.put('\n');
}

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

/// The keyword of a line and its parameters, in capitals: *ELEMENT, TYPE=C3D4, ELSET=A.
struct Keyword {
  std::string name;
  std::map<std::string, std::string> parameters;
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
      keyword.parameters[key] = upper_case(trimmed(part.substr(std::min(equals + 1, part.size()))));
    }
    first = false;
  }
  return keyword;
}

class Reader {
 public:
  explicit Reader(const Source& source) : source_(source), cursor_(source, source.bytes) {}

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
  enum class Section { kOther, kNodes, kElements };

  void begin_section(const Keyword& keyword) {
    finish_section();
    section_ = Section::kOther;
    if (keyword.name == "NODE") section_ = Section::kNodes;
    if (keyword.name == "INCLUDE") source_.fail("includes other files", "merge them into one");
    if (keyword.name != "ELEMENT") return;
    const auto type = keyword.parameters.find("TYPE");
    if (type == keyword.parameters.end()) source_.fail("has an *ELEMENT without a TYPE");
    type_name_ = type->second;
    type_ = element_type(type_name_);
    if (type_.kind == CellKind::kUnsupported) mesh_.add_cell(source_, type_.kind, {}, in_quotes(type_name_));
    if (type_.kind == CellKind::kIgnored) return;
    section_ = Section::kElements;
    const auto elset = keyword.parameters.find("ELSET");
    region_ = region_of(elset == keyword.parameters.end() ? "" : elset->second);
  }

  /// Our own names carry the number; others are counted as they come.
  std::int64_t region_of(const std::string& elset) {
    if (elset.starts_with(kRegionPrefix)) {
      const std::string_view number = std::string_view(elset).substr(kRegionPrefix.size());
      const std::size_t digits = number.starts_with('-') ? 1 : 0;
      if (number.size() > digits && number.find_first_not_of("0123456789", digits) == std::string_view::npos) {
        return parse_integer(source_, number);
      }
    }
    return region_names_.try_emplace(elset, static_cast<std::int64_t>(region_names_.size()) + 1).first->second;
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
    if (section_ == Section::kNodes) {
      add_node();
    } else {
      for (std::string_view field : fields_) add_element_number(parse_integer(source_, field));
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
  std::map<std::string, std::int64_t> region_names_;
  std::vector<std::string_view> fields_;
  std::vector<std::int64_t> pending_;  ///< number and nodes of the element being read
  NumberedMesh numbered_;
};

}  // namespace

void write_abaqus(const MeshView& mesh, Out& out) {
  out.put("** ", header_comment(mesh.info), '\n');
  write_nodes(mesh, out);
  if (mesh.is_tet_mesh) {
    write_tets(mesh, out);
    write_surface_set(mesh, out);
    return;
  }
  out.put("*ELEMENT, TYPE=S3, ELSET=SURFACE\n");
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    out.put(t + 1, ", ", triangle[0] + 1, ", ", triangle[1] + 1, ", ", triangle[2] + 1, '\n');
  }
}

RawMesh read_abaqus(const Source& source) { return Reader(source).read(); }

}  // namespace delvox::mesh_io
