#include "set_rules.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>

#include "delvox/core/errors.h"
#include "format.h"

namespace delvox::tools {
namespace {

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

[[noreturn]] void fail(const std::string& text, const std::string& cause) {
  throw OptionError("--set " + text + ": " + cause);
}

/// The numbers after "kind:", as many as one of the two counts.
class Numbers {
 public:
  Numbers(const std::string& text, const std::string& list, std::size_t count, std::size_t other_count,
          const std::string& form)
      : text_(text) {
    for (const std::string& piece : split(list, ',')) values_.push_back(parse_number(piece, "--set " + text));
    if (values_.size() != count && values_.size() != other_count) fail(text, "write " + form);
  }
  std::size_t size() const { return values_.size(); }
  double operator[](std::size_t i) const { return values_[i]; }
  Point3 point(std::size_t first) const { return {values_[first], values_[first + 1], values_[first + 2]}; }
  Vector3 direction(std::size_t first) const {
    const Vector3 v = point(first);
    if (!(norm(v) > 0)) fail(text_, "the direction has no length");
    return v;
  }
  double positive(std::size_t i) const {
    if (!(values_[i] > 0)) fail(text_, "the last number must be above 0");
    return values_[i];
  }

 private:
  const std::string& text_;
  std::vector<double> values_;
};

BoxRule parse_box(const std::string& text, const std::string& list) {
  const std::vector<std::string> ranges = split(list, ',');
  if (ranges.size() != 3) fail(text, "write box:x0:x1,y0:y1,z0:z1");
  BoxRule rule;
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<std::string> ends = split(ranges[static_cast<std::size_t>(axis)], ':');
    if (ends.size() != 2) fail(text, "write box:x0:x1,y0:y1,z0:z1");
    rule.box.min[axis] = parse_number(ends[0], "--set " + text);
    rule.box.max[axis] = parse_number(ends[1], "--set " + text);
    if (!(rule.box.min[axis] <= rule.box.max[axis])) fail(text, "a range of the box ends before it begins");
  }
  return rule;
}

/// The side of the image that looks most along an axis of the output frame.
BorderRule border_rule(int world_axis, bool high, const MeshedImage& image) {
  constexpr double kBeyond = 0.25;  // voxel: the padding closes the organ half a voxel outside the last voxel centres
  const VolumeHeader& header = image.header;
  const Affine3 to_index = header.index_to_world.inverse();
  Vector3 wanted;
  wanted[world_axis] = high ? 1 : -1;
  BorderRule rule;
  double best = -1;
  for (int axis = 0; axis < 3; ++axis) {
    for (double sign : {-1.0, 1.0}) {
      // Rows of the inverse are the normals of the planes of constant index.
      const auto& row = to_index.rows[static_cast<std::size_t>(axis)];
      const Vector3 gradient = image.frame(Vector3{row[0], row[1], row[2]});
      const Vector3 outward = (sign / norm(gradient)) * gradient;
      if (dot(outward, wanted) <= best) continue;
      best = dot(outward, wanted);
      Point3 index;
      index[axis] = sign < 0 ? -kBeyond : header.dims[static_cast<std::size_t>(axis)] - 1 + kBeyond;
      rule = {image.frame(header.index_to_world(index)), outward};
    }
  }
  return rule;
}

SetRule parse_border(const std::string& text, const std::string& side, const MeshedImage* image, bool images_later) {
  const std::string axes = "xyz";
  const std::size_t axis = side.empty() ? std::string::npos : axes.find(side[0]);
  const std::string end = side.empty() ? "" : side.substr(1);
  if (axis == std::string::npos || (end != "min" && end != "max")) {
    fail(text, "write border:xmin, or xmax, ymin, ymax, zmin, zmax");
  }
  if (image != nullptr) return border_rule(static_cast<int>(axis), end == "max", *image);
  if (!images_later) {
    fail(text, "only a volume has a border, known only while `delvox tet` meshes it; choose another rule, as plane");
  }
  return AllRule{};
}

SetRule parse_rule(const std::string& text, const std::string& rule, const MeshedImage* image, bool images_later) {
  const std::size_t colon = std::min(rule.find(':'), rule.size());
  const std::string kind = rule.substr(0, colon), rest = rule.substr(std::min(colon + 1, rule.size()));
  if (kind == "plane") {
    const Numbers n(text, rest, 6, 7, "plane:x,y,z,nx,ny,nz, or plane:x,y,z,nx,ny,nz,MM");
    PlaneRule plane{n.point(0), n.direction(3)};
    if (n.size() == 7) plane.thickness = n.positive(6);
    return plane;
  }
  if (kind == "box") return parse_box(text, rest);
  if (kind == "sphere") {
    const Numbers n(text, rest, 4, 4, "sphere:x,y,z,MM");
    return SphereRule{n.point(0), n.positive(3)};
  }
  if (kind == "normal") {
    const Numbers n(text, rest, 4, 4, "normal:x,y,z,DEG");
    return NormalRule{n.direction(0), n.positive(3)};
  }
  if (kind == "near") {
    const Numbers n(text, rest, 4, 4, "near:x,y,z,MM");
    return NearRule{n.point(0), n.positive(3)};
  }
  if (kind == "border") return parse_border(text, rest, image, images_later);
  if (kind == "all" && colon == rule.size()) return AllRule{};
  fail(text, "no rule '" + kind + "'; there are plane, box, sphere, normal, border, near, all");
}

}  // namespace

void add_set_option(CLI::App& app, std::vector<std::string>& sets) {
  app.add_option(
         "--set", sets,
         "Name a place, as nodes, tets and boundary faces: NAME=plane:x,y,z,nx,ny,nz[,MM], box:x0:x1,y0:y1,z0:z1, "
         "sphere:x,y,z,MM, normal:x,y,z,DEG, border:xmin (.. zmax), near:x,y,z,MM or all; repeat for several")
      ->allow_extra_args(false)
      ->type_name("NAME=RULE");
}

void check_name(const std::string& name, const std::string& what) {
  constexpr std::size_t kLongest = 40;
  const auto allowed = [](unsigned char c) { return c < 128 && (std::isalnum(c) || c == '_' || c == '-'); };
  const bool good = !name.empty() && name.size() <= kLongest && std::isalpha(static_cast<unsigned char>(name[0])) &&
                    std::all_of(name.begin(), name.end(), allowed);
  if (!good) {
    throw OptionError(what + ": a name is a letter, then letters, digits, _ and -, at most 40 in all");
  }
  const std::string lower = lower_case(name);
  for (const char* own : {"nall", "eall", "surface", "boundary"}) {
    if (lower == own) throw OptionError(what + ": our own files use the name " + name + "; choose another");
  }
  if (lower.starts_with("region_")) throw OptionError(what + ": our own files use names that begin with region_");
}

std::vector<NamedRule> parse_sets(const std::vector<std::string>& texts, const MeshedImage* image, bool images_later) {
  std::vector<NamedRule> rules;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) fail(text, "write NAME=RULE");
    const std::string name = text.substr(0, equals);
    check_name(name, "--set " + text);
    for (const NamedRule& other : rules) {
      if (lower_case(other.name) == lower_case(name)) fail(text, "the name is given twice (solvers ignore case)");
    }
    rules.push_back({name, parse_rule(text, text.substr(equals + 1), image, images_later)});
  }
  return rules;
}

std::string apply_sets(TetMesh& mesh, const std::vector<NamedRule>& rules) {
  std::string fault;
  for (MeshSet& set : select_sets(mesh, rules)) {
    if (set.nodes.empty() && set.tets.empty() && fault.empty()) {
      fault = "set " + set.name + " holds nothing; move it to where the mesh is (`delvox info` tells where)";
    }
    std::erase_if(mesh.sets, [&](const MeshSet& old) { return lower_case(old.name) == lower_case(set.name); });
    mesh.sets.push_back(std::move(set));
  }
  return fault;
}

}  // namespace delvox::tools
