#include "delvox/oracle/polygon_oracle.h"

#include <algorithm>
#include <cmath>

#include "delvox/core/sharp_edges.h"
#include "oracle/clip_segment.h"
#include "oracle/polygon_blocks.h"
#include "oracle/polygon_seeds.h"
#include "oracle/polygon_surface.h"
#include "oracle/polygon_tree.h"

namespace delvox {
namespace {

/// What every clone shares: nothing of it changes.
struct Polygons {
  explicit Polygons(PolygonSurface sound) : surface(std::move(sound)), tree(surface), blocks(surface, tree) {
    for (const Point3& p : surface.points) box.extend(p);
    const Vector3 margin = (0.01 * box.diagonal()) * Vector3{1, 1, 1};
    bounds = {box.min - margin, box.max + margin};
  }

  PolygonSurface surface;
  PolygonTree tree;
  PolygonBlocks blocks;
  Box3 box, bounds;
};

class PolygonOracle final : public Oracle {
 public:
  explicit PolygonOracle(std::shared_ptr<const Polygons> polygons) : polygons_(std::move(polygons)) {}

  Box3 bounds() const override { return polygons_->bounds; }
  Label label(const Point3& p) const override { return polygons_->blocks.inside(p) ? 1 : 0; }

  Point3 intersect(const Point3& a, const Point3& b) const override {
    // Labels count points on the surface as inside, crossings may not.
    const std::vector<Point3> all = intersect_all(a, b);
    if (!all.empty()) return all.front();
    return label(a) != 0 ? a : b;
  }

  std::vector<Point3> intersect_all(const Point3& a, const Point3& b) const override {
    Point3 near = a, far = b;
    if (!clip_segment(polygons_->bounds, near, far)) return {};
    std::vector<Point3> result;
    for (const PolygonTree::Crossing& crossing : polygons_->tree.crossings(near, far)) result.push_back(crossing.point);
    return result;
  }

  Seeds seeds(const SizeField& size, const GoOn& go_on) const override {
    return polygon_seeds(polygons_->surface, size, go_on);
  }

  std::optional<SurfaceTopology> topology() const override {
    const PolygonSurface& s = polygons_->surface;
    // A closed surface has three edges for every two triangles.
    return SurfaceTopology{s.components, static_cast<long>(s.points.size()) - static_cast<long>(s.triangles.size() / 2)};
  }

  std::optional<FeatureEdges> feature_edges(double degrees) const override;

  void for_each_patch(const std::function<void(const DomainPatch&)>& visit) const override;

  std::unique_ptr<Oracle> clone() const override { return std::make_unique<PolygonOracle>(polygons_); }

 private:
  std::shared_ptr<const Polygons> polygons_;
};

/// Adds a triangle's area, piece by piece no wider than a block, to the blocks that hold the pieces.
void spread(const PolygonBlocks& blocks, const Point3& a, const Point3& b, const Point3& c,
            std::vector<DomainPatch>& patches) {
  const double ab = squared_distance(a, b), bc = squared_distance(b, c), ca = squared_distance(c, a);
  if (std::max({ab, bc, ca}) <= blocks.width() * blocks.width()) {
    const Vector3 normal = 0.5 * cross(b - a, c - a);
    DomainPatch& patch = patches[blocks.block_at((1.0 / 3) * (a + b + c))];
    for (int axis = 0; axis < 3; ++axis) {
      (normal[axis] > 0 ? patch.area_up : patch.area_down)[axis] += std::abs(normal[axis]);
    }
  } else if (ab >= bc && ab >= ca) {
    spread(blocks, a, midpoint(a, b), c, patches);
    spread(blocks, midpoint(a, b), b, c, patches);
  } else if (bc >= ca) {
    spread(blocks, a, b, midpoint(b, c), patches);
    spread(blocks, a, midpoint(b, c), c, patches);
  } else {
    spread(blocks, a, b, midpoint(c, a), patches);
    spread(blocks, midpoint(c, a), b, c, patches);
  }
}

std::optional<FeatureEdges> PolygonOracle::feature_edges(double degrees) const {
  const PolygonSurface& surface = polygons_->surface;
  FeatureEdges result{surface.points, {}};
  for (const SharpEdge& sharp : sharp_edges(surface.points, surface.triangles, degrees)) {
    FeatureEdges::Edge edge{sharp.ends, {}, {}, surface.component_of[sharp.triangles[0]]};
    const Vector3 along = surface.points[sharp.ends[1]] - surface.points[sharp.ends[0]];
    for (std::size_t side = 0; side < 2; ++side) {
      const Triangle& t = surface.triangles[sharp.triangles[side]];
      const Vector3 normal = cross(surface.points[t[1]] - surface.points[t[0]], surface.points[t[2]] - surface.points[t[0]]);
      edge.normals[side] = (1 / norm(normal)) * normal;
      // The facet lies to the left of its edges as it runs through them.
      const std::size_t from = t[0] == sharp.ends[0] ? 0 : t[1] == sharp.ends[0] ? 1 : 2;
      const double left = t[(from + 1) % 3] == sharp.ends[1] ? 1 : -1;
      const Vector3 into = left * cross(edge.normals[side], along);
      edge.into[side] = (1 / norm(into)) * into;
    }
    result.edges.push_back(edge);
  }
  return result;
}

void PolygonOracle::for_each_patch(const std::function<void(const DomainPatch&)>& visit) const {
  const PolygonBlocks& blocks = polygons_->blocks;
  const PolygonSurface& surface = polygons_->surface;
  std::vector<DomainPatch> patches(blocks.count());
  // Components have positive volume of their own; those with an odd number of others around them are cavities.
  const std::vector<bool> cavity = polygons_->tree.cavities(surface);
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const bool turned = cavity[surface.component_of[t]];
    spread(blocks, surface.corner(t, 0), surface.corner(t, turned ? 2 : 1), surface.corner(t, turned ? 1 : 2), patches);
  }
  std::size_t i = 0;
  blocks.for_each([&](const Point3& center, bool is_inside) {
    DomainPatch& patch = patches[i++];
    patch.center = center;
    patch.width = blocks.width();
    if (is_inside) patch.inside_mm3 = patch.width * patch.width * patch.width;
    if (is_inside || norm(patch.area_up + patch.area_down) > 0) visit(patch);
  });
}

}  // namespace

std::unique_ptr<Oracle> make_polygon_oracle(const SurfaceMesh& mesh) {
  return std::make_unique<PolygonOracle>(std::make_shared<const Polygons>(sound_surface(mesh)));
}

}  // namespace delvox
