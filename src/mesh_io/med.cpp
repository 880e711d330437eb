// MED 3.0, the HDF5 file of Salome and Code_Aster:
// https://docs.salome-platform.org/latest/dev/MEDCoupling/developer/med-file.html Sets and regions are groups; MED
// knows them by families, which are the distinct lists of groups that a node or a cell belongs to.
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "mesh_io/formats.h"
#include "mesh_io/hdf5_image.h"
#include "mesh_io/header_comment.h"
#include "mesh_io/set_suffix.h"

namespace delvox::mesh_io {
namespace {

constexpr const char* kMesh = "/ENS_MAA/mesh";
constexpr const char* kFamilies = "/FAS/mesh";
// The only time step there is: "no time step, no iteration".
constexpr const char* kStep = "/ENS_MAA/mesh/-0000000000000000001-0000000000000000001";
constexpr const char* kProfile = "MED_NO_PROFILE_INTERNAL";
constexpr std::size_t kNameSize = 64, kShortNameSize = 16, kCommentSize = 200;

using Groups = std::vector<std::string>;

/// Family numbers by lists of groups; those of cells count down from -1, those of nodes up from 1.
class Families {
 public:
  explicit Families(std::int32_t step) : step_(step) {}
  std::int32_t number(const Groups& groups) {
    if (groups.empty()) return 0;
    return numbers_.try_emplace(groups, step_ * (static_cast<std::int32_t>(numbers_.size()) + 1)).first->second;
  }
  void write(const std::string& folder, Hdf5Image& image) const {
    if (numbers_.empty()) return;
    image.group(folder);
    std::vector<std::pair<std::int32_t, Groups>> by_number;
    for (const auto& [groups, number] : numbers_) by_number.emplace_back(number, groups);
    std::sort(by_number.begin(), by_number.end());
    for (const auto& [number, groups] : by_number) {
      const std::string family = folder + "/FAM_" + std::to_string(number);
      image.group(family);
      image.attribute(family, "NUM", number);
      image.group(family + "/GRO");
      image.attribute(family + "/GRO", "NBR", static_cast<std::int32_t>(groups.size()));
      image.names(family + "/GRO/NOM", groups);
    }
  }

 private:
  std::int32_t step_;
  std::map<Groups, std::int32_t> numbers_;
};

void write_head(const MeshView& mesh, Hdf5Image& image) {
  image.group("/INFOS_GENERALES");
  image.attribute("/INFOS_GENERALES", "MAJ", 3);
  image.attribute("/INFOS_GENERALES", "MIN", 0);
  image.attribute("/INFOS_GENERALES", "REL", 0);
  image.group("/ENS_MAA");
  image.group(kMesh);
  const std::string unit = mesh.info.unit == LengthUnit::kMetre ? "m" : "mm";
  std::string axes, units;
  for (const char* axis : {"X", "Y", "Z"}) {
    axes += axis + std::string(kShortNameSize - 1, ' ');
    units += unit + std::string(kShortNameSize - unit.size(), ' ');
  }
  image.attribute(kMesh, "DIM", mesh.is_tet_mesh ? 3 : 2);
  image.attribute(kMesh, "ESP", 3);
  image.attribute(kMesh, "REP", 0);
  image.attribute(kMesh, "SRT", 1);
  image.attribute(kMesh, "TYP", 0);
  image.attribute(kMesh, "UNT", "", kShortNameSize);
  image.attribute(kMesh, "UNI", units, 3 * kShortNameSize);
  image.attribute(kMesh, "NOM", axes, 3 * kShortNameSize);
  image.attribute(kMesh, "DES", header_comment(mesh.info), kCommentSize);
  image.group(kStep);
  image.attribute(kStep, "CGT", 1);
  image.attribute(kStep, "NDT", -1);
  image.attribute(kStep, "NOR", -1);
  image.attribute(kStep, "PDT", -1.0);
}

/// An array of something for each entity, with the attributes that each has.
template <class T>
void write_entities(const std::string& path, const std::vector<T>& values, std::size_t count, Hdf5Image& image) {
  image.array(path, std::span<const T>(values));
  image.attribute(path, "CGT", 1);
  image.attribute(path, "NBR", static_cast<std::int32_t>(count));
}

void write_entity_group(const std::string& path, Hdf5Image& image) {
  image.group(path);
  image.attribute(path, "CGT", 1);
  image.attribute(path, "CGS", 1);
  image.attribute(path, "PFL", kProfile, kNameSize);
}

void write_nodes(const MeshView& mesh, Families& families, Hdf5Image& image) {
  const std::string path = std::string(kStep) + "/NOE";
  write_entity_group(path, image);
  std::vector<double> coordinates;  // all x, then all y, then all z
  for (int axis = 0; axis < 3; ++axis) {
    for (const Point3& p : mesh.points) coordinates.push_back(p[axis]);
  }
  write_entities(path + "/COO", coordinates, mesh.points.size(), image);
  std::vector<Groups> groups(mesh.points.size());
  for (const MeshSet& set : mesh.sets) {
    for (std::uint32_t node : set.nodes) groups[node].push_back(set.name);
  }
  std::vector<std::int32_t> numbers;
  for (const Groups& of_node : groups) numbers.push_back(families.number(of_node));
  write_entities(path + "/FAM", numbers, mesh.points.size(), image);
}

/// Cells of one type. `columns`: their nodes, cell by cell.
template <class NodesOf>
void write_cells(const std::string& type, std::size_t count, const NodesOf& nodes_of,
                 const std::vector<std::int32_t>& families, Hdf5Image& image) {
  if (count == 0) return;
  const std::string path = std::string(kStep) + "/MAI/" + type;
  write_entity_group(path, image);
  const std::size_t nodes = nodes_of(0).size();
  std::vector<std::int32_t> columns(count * nodes);  // all first nodes, then all second ones, ...
  for (std::size_t i = 0; i < count; ++i) {
    const CellNodes cell = nodes_of(i);
    for (std::size_t k = 0; k < nodes; ++k) columns[k * count + i] = static_cast<std::int32_t>(cell[k] + 1);
  }
  write_entities(path + "/NOD", columns, count, image);
  write_entities(path + "/FAM", families, count, image);
}

std::vector<std::int32_t> triangle_families(const MeshView& mesh, Families& families) {
  std::vector<std::int32_t> numbers(mesh.triangles.size(), 0);
  for (const Membership& part : triangles_by_sets(mesh)) {
    Groups groups{"boundary"};
    for (std::size_t set : part.sets) groups.push_back(mesh.sets[set].name);
    for (std::size_t triangle : part.cells) numbers[triangle] = families.number(groups);
  }
  return numbers;
}

std::vector<std::int32_t> tet_families(const MeshView& mesh, Families& families) {
  std::vector<std::int32_t> numbers(mesh.tets.size(), 0);
  for (const auto& [region, tets] : regions_of(mesh)) {
    for (const Membership& part : tets_by_sets(mesh, tets)) {
      Groups groups{mesh.region_name(region)};
      for (std::size_t set : part.sets) groups.push_back(mesh.sets[set].name + kTetsSuffix);
      for (std::size_t tet : part.cells) numbers[tet] = families.number(groups);
    }
  }
  return numbers;
}

}  // namespace

void write_med(const MeshView& mesh, Out& out) {
  Hdf5Image image;
  write_head(mesh, image);
  Families of_nodes(1), of_cells(-1);
  write_nodes(mesh, of_nodes, image);
  image.group(std::string(kStep) + "/MAI");
  image.attribute(std::string(kStep) + "/MAI", "CGT", 1);
  const bool second = mesh.second_order();
  write_cells(
      second ? "TR6" : "TR3", mesh.triangles.size(), [&](std::size_t i) { return mesh.triangle_nodes(i); },
      triangle_families(mesh, of_cells), image);
  write_cells(
      second ? "T10" : "TE4", mesh.tets.size(), [&](std::size_t i) { return mesh.tet_nodes(i, kMedOrder); },
      tet_families(mesh, of_cells), image);
  image.group("/FAS");
  image.group(kFamilies);
  image.group(std::string(kFamilies) + "/FAMILLE_ZERO");
  image.attribute(std::string(kFamilies) + "/FAMILLE_ZERO", "NUM", 0);
  of_nodes.write(std::string(kFamilies) + "/NOEUD", image);
  of_cells.write(std::string(kFamilies) + "/ELEME", image);
  out.bytes(image.bytes());
}

}  // namespace delvox::mesh_io
