#include "mesh_io/vtk_common.h"

namespace delvox::mesh_io {
namespace {

struct NumberField {
  const char* name;
  std::optional<double>& (*in)(MeshInfo&);
};
constexpr NumberField kNumbers[] = {
    {"delvox_isovalue", [](MeshInfo& i) -> std::optional<double>& { return i.isovalue; }},
    {"delvox_min_angle_degrees", [](MeshInfo& i) -> std::optional<double>& { return i.promises.min_angle_degrees; }},
    {"delvox_radius_edge", [](MeshInfo& i) -> std::optional<double>& { return i.promises.radius_edge; }},
    {"delvox_size", [](MeshInfo& i) -> std::optional<double>& { return i.promises.size; }},
    {"delvox_cell_size", [](MeshInfo& i) -> std::optional<double>& { return i.promises.cell_size; }},
    {"delvox_grade", [](MeshInfo& i) -> std::optional<double>& { return i.promises.grade; }},
    {"delvox_max_deviation", [](MeshInfo& i) -> std::optional<double>& { return i.promises.max_deviation; }},
    {"delvox_max_roughness_degrees",
     [](MeshInfo& i) -> std::optional<double>& { return i.promises.max_roughness_degrees; }},
    {"delvox_min_dihedral_degrees",
     [](MeshInfo& i) -> std::optional<double>& { return i.promises.min_dihedral_degrees; }},
    {"delvox_feature_angle_degrees",
     [](MeshInfo& i) -> std::optional<double>& { return i.promises.feature_angle_degrees; }},
};

struct FlagField {
  const char* name;
  bool MeshInfo::*member;
};
constexpr FlagField kFlags[] = {
    {"delvox_below", &MeshInfo::below},
    {"delvox_open_border", &MeshInfo::open_border},
    {"delvox_complete", &MeshInfo::complete},
};

constexpr const char* kFrame = "delvox_frame";  // 0 unknown, 1 RAS, 2 LPS
constexpr const char* kUnit = "delvox_unit_is_metre";

}  // namespace

CellKind vtk_cell_kind(std::int64_t vtk_type) {
  switch (vtk_type) {
    case 0:                                              // empty
    case 1: case 2: case 3: case 4: case 21: case 35:    // vertices and lines
    case 68: case 75: return CellKind::kIgnored;         // curves
    case kVtkTriangle: case 22: return CellKind::kTriangle;
    case 6: return CellKind::kStrip;
    case 7: case 9: return CellKind::kPolygon;
    case kVtkTet:
    case kVtkQuadraticTet: return CellKind::kTet;
    default: return CellKind::kUnsupported;
  }
}

std::vector<std::pair<std::string, double>> info_fields(const MeshInfo& info) {
  std::vector<std::pair<std::string, double>> result{{kFrame, static_cast<double>(info.frame)}};
  for (const FlagField& field : kFlags) result.emplace_back(field.name, info.*field.member ? 1.0 : 0.0);
  if (info.unit == LengthUnit::kMetre) result.emplace_back(kUnit, 1.0);
  MeshInfo copy = info;
  for (const NumberField& field : kNumbers) {
    if (const std::optional<double>& value = field.in(copy)) result.emplace_back(field.name, *value);
  }
  return result;
}

void read_info_field(const std::string& name, double value, MeshInfo& info) {
  if (name == kFrame) info.frame = value == 1 ? Frame::kRas : value == 2 ? Frame::kLps : Frame::kUnknown;
  if (name == kUnit) info.unit = value != 0 ? LengthUnit::kMetre : LengthUnit::kMillimetre;
  for (const FlagField& field : kFlags) {
    if (name == field.name) info.*field.member = value != 0;
  }
  for (const NumberField& field : kNumbers) {
    if (name == field.name) field.in(info) = value;
  }
}

}  // namespace delvox::mesh_io
