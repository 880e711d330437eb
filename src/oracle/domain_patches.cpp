#include "oracle/domain_patches.h"

#include <bit>
#include <cmath>

#include "oracle/brick_edges.h"

namespace delvox {
namespace {

using Index3 = std::array<int, 3>;
using Word = BrickEdges::Word;
constexpr int kBrick = BrickField::kBrick, kHalf = kBrick / 2;

class PatchMaker {
 public:
  PatchMaker(const BrickField& field, const Affine3& grid_to_world,
             const std::function<void(const DomainPatch&)>& visit)
      : field_(field), to_world_(grid_to_world), visit_(visit), voxel_mm3_(std::abs(grid_to_world.determinant())) {
    for (int axis = 0; axis < 3; ++axis) {
      face_mm2_[axis] = norm(cross(to_world_.column((axis + 1) % 3), to_world_.column((axis + 2) % 3)));
    }
  }

  void run() const {
    const Index3& n = field_.brick_counts();
    Index3 brick;
    for (brick[2] = 0; brick[2] < n[2]; ++brick[2]) {
      for (brick[1] = 0; brick[1] < n[1]; ++brick[1]) {
        for (brick[0] = 0; brick[0] < n[0]; ++brick[0]) visit_brick(brick);
      }
    }
  }

 private:
  void visit_brick(const Index3& brick) const {
    switch (field_.state(brick)) {
      case BrickField::State::kOutside: return;
      case BrickField::State::kInside: {
        DomainPatch whole = box(brick, 0, kBrick);
        whole.inside_mm3 = kBrick * kBrick * kBrick * voxel_mm3_;
        return visit_(whole);
      }
      case BrickField::State::kMixed: break;
    }
    const BrickEdges edges(field_, brick);
    for (int octant = 0; octant < 8; ++octant) visit_octant(brick, octant, edges);
  }

  void visit_octant(const Index3& brick, int octant, const BrickEdges& edges) const {
    // The 16 bits of an octant within a layer: four of eight samples of four of eight rows.
    const Word mask = Word{0x0f0f0f0f} << (octant & 1 ? kHalf : 0) << (octant & 2 ? kHalf * kBrick : 0);
    const int first = octant & 4 ? kHalf : 0;
    int inside = 0, any = 0;
    Index3 up{}, down{};
    for (int layer = first; layer < first + kHalf; ++layer) {
      const Word here = edges.inside(0, layer);
      inside += std::popcount(here & mask);
      for (int axis = 0; axis < 3; ++axis) {
        const Word crossed = edges.crossed(axis, 0, layer) & mask;
        if (crossed == 0) continue;
        any = 1;
        up[axis] += std::popcount(crossed & here);
        down[axis] += std::popcount(crossed & ~here);
      }
    }
    if (inside + any == 0) return;
    DomainPatch patch = box(brick, octant, kHalf);
    patch.inside_mm3 = inside * voxel_mm3_;
    for (int axis = 0; axis < 3; ++axis) {
      patch.area_up[axis] = up[axis] * face_mm2_[axis];
      patch.area_down[axis] = down[axis] * face_mm2_[axis];
    }
    visit_(patch);
  }

  DomainPatch box(const Index3& brick, int octant, int samples) const {
    Point3 center;
    for (int axis = 0; axis < 3; ++axis) {
      center[axis] = brick[axis] * kBrick + (octant >> axis & 1) * kHalf + 0.5 * (samples - 1);
    }
    DomainPatch patch;
    patch.center = to_world_(center);
    patch.width = samples * std::cbrt(voxel_mm3_);
    return patch;
  }

  const BrickField& field_;
  const Affine3& to_world_;
  const std::function<void(const DomainPatch&)>& visit_;
  double voxel_mm3_;
  Vector3 face_mm2_;  // of a voxel, across each axis
};

}  // namespace

void visit_patches(const BrickField& field, const Affine3& grid_to_world,
                   const std::function<void(const DomainPatch&)>& visit) {
  PatchMaker(field, grid_to_world, visit).run();
}

}  // namespace delvox
