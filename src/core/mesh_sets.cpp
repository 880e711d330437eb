#include "delvox/core/mesh_sets.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace delvox {
namespace {

Vector3 unit(const Vector3& v) {
  return (1 / norm(v)) * v;
}

class Selector {
 public:
  explicit Selector(const TetMesh& mesh) : mesh_(mesh), faces_(boundary_faces(mesh.tets)) {}

  MeshSet select(const PlaneRule& rule) const {
    const Vector3 normal = unit(rule.normal);
    return in_space([&](const Point3& p) {
      const double height = dot(p - rule.point, normal);
      return std::isfinite(rule.thickness) ? std::abs(height) <= rule.thickness : height >= 0;
    });
  }
  MeshSet select(const BoxRule& rule) const {
    return in_space([&](const Point3& p) { return rule.box.contains(p); });
  }
  MeshSet select(const SphereRule& rule) const {
    return in_space([&](const Point3& p) { return distance(p, rule.center) <= rule.radius; });
  }
  MeshSet select(const AllRule&) const {
    return in_space([](const Point3&) { return true; });
  }
  MeshSet select(const NormalRule& rule) const { return of_faces(facing(rule.direction, rule.degrees)); }
  MeshSet select(const BorderRule& rule) const {
    constexpr double kDegrees = 45;  // what is left of the sides of the organ there is steeper
    std::vector<TetFace> faces = facing(rule.outward, kDegrees);
    std::erase_if(faces, [&](TetFace face) {
      const Triangle corners = face_corners(mesh_.tets, face);
      return std::any_of(corners.begin(), corners.end(),
                         [&](std::uint32_t v) { return dot(mesh_.points[v] - rule.point, rule.outward) < 0; });
    });
    return of_faces(std::move(faces));
  }
  MeshSet select(const NearRule& rule) const;

 private:
  template <class Inside>
  MeshSet in_space(const Inside& inside) const {
    MeshSet set;
    const std::vector<Point3>& points = mesh_.points;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if (inside(points[i])) set.nodes.push_back(i);
    }
    for (std::uint32_t t = 0; t < mesh_.tets.size(); ++t) {
      const Tet& v = mesh_.tets[t];
      if (inside(0.25 * ((points[v[0]] + points[v[1]]) + (points[v[2]] + points[v[3]])))) set.tets.push_back(t);
    }
    for (TetFace face : faces_) {
      const Triangle v = face_corners(mesh_.tets, face);
      if (inside(points[v[0]]) && inside(points[v[1]]) && inside(points[v[2]])) set.faces.push_back(face);
    }
    return set;
  }

  std::vector<TetFace> facing(const Vector3& direction, double degrees) const {
    const Vector3 axis = unit(direction);
    const double least = std::cos(std::min(degrees, 180.0) * std::numbers::pi / 180) - 1e-12;
    std::vector<TetFace> result;
    for (TetFace face : faces_) {
      const Triangle v = face_corners(mesh_.tets, face);
      const Vector3 normal = cross(mesh_.points[v[1]] - mesh_.points[v[0]], mesh_.points[v[2]] - mesh_.points[v[0]]);
      if (dot(normal, axis) >= least * norm(normal)) result.push_back(face);
    }
    return result;
  }

  MeshSet of_faces(std::vector<TetFace> faces) const {
    MeshSet set;
    set.faces = std::move(faces);
    for (TetFace face : set.faces) {
      const Triangle corners = face_corners(mesh_.tets, face);
      set.nodes.insert(set.nodes.end(), corners.begin(), corners.end());
      if (!mesh_.mid_nodes.empty()) {
        const auto middles = face_mid_nodes(mesh_.mid_nodes[face.tet], face.face);
        set.nodes.insert(set.nodes.end(), middles.begin(), middles.end());
      }
      set.tets.push_back(face.tet);
    }
    for (std::vector<std::uint32_t>* list : {&set.nodes, &set.tets}) {
      std::sort(list->begin(), list->end());
      list->erase(std::unique(list->begin(), list->end()), list->end());
    }
    return set;
  }

  const TetMesh& mesh_;
  std::vector<TetFace> faces_;
};

// From the nearest boundary node over shared edges, as far as the radius reaches: a gap is not jumped.
MeshSet Selector::select(const NearRule& rule) const {
  if (faces_.empty()) return {};
  std::uint32_t nearest = face_corners(mesh_.tets, faces_[0])[0];
  std::map<std::uint32_t, std::vector<std::size_t>> faces_at;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    for (std::uint32_t v : face_corners(mesh_.tets, faces_[f])) {
      faces_at[v].push_back(f);
      const double here = squared_distance(mesh_.points[v], rule.point);
      const double best = squared_distance(mesh_.points[nearest], rule.point);
      if (here < best || (here == best && v < nearest)) nearest = v;
    }
  }
  const Point3 place = mesh_.points[nearest];
  std::vector<bool> taken(faces_.size(), false), seen(mesh_.points.size(), false);
  std::vector<std::uint32_t> waiting{nearest};
  seen[nearest] = true;
  while (!waiting.empty()) {
    const std::uint32_t at = waiting.back();
    waiting.pop_back();
    for (std::size_t f : faces_at[at]) {
      const Triangle corners = face_corners(mesh_.tets, faces_[f]);
      if (taken[f] || std::any_of(corners.begin(), corners.end(),
                                  [&](std::uint32_t v) { return distance(mesh_.points[v], place) > rule.radius; })) {
        continue;
      }
      taken[f] = true;
      for (std::uint32_t v : corners) {
        if (!seen[v]) waiting.push_back(v);
        seen[v] = true;
      }
    }
  }
  std::vector<TetFace> faces;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (taken[f]) faces.push_back(faces_[f]);
  }
  return of_faces(std::move(faces));
}

}  // namespace

std::vector<MeshSet> select_sets(const TetMesh& mesh, const std::vector<NamedRule>& rules) {
  if (rules.empty()) return {};
  const Selector selector(mesh);
  std::vector<MeshSet> sets;
  for (const NamedRule& named : rules) {
    sets.push_back(std::visit([&](const auto& rule) { return selector.select(rule); }, named.rule));
    sets.back().name = named.name;
  }
  return sets;
}

}  // namespace delvox
