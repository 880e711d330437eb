#include "delvox/meshing/graded_size.h"

#include <algorithm>

#include "meshing/depth_tree.h"

namespace delvox {
namespace {

/// Of the samples of the surface in units of its size; nearer ones would cost more than what they tell is worth.
constexpr double kSpacing = 0.7;
/// Of the samples in units of their spacing: most of the surface is nearer to one than that, some a little farther.
constexpr double kReach = 0.7;

}  // namespace

DepthField::DepthField(const Oracle& oracle, const SizeField& size, const GoOn& go_on) {
  const SizeField spacing = scaled(size, kSpacing);
  const Seeds seeds = oracle.seeds(spacing, go_on);
  std::vector<SurfaceSample> samples;
  samples.reserve(seeds.points.size());
  for (const Point3& p : seeds.points) samples.push_back({p, kReach * spacing(p)});
  tree_ = std::make_shared<DepthTree>(oracle, samples, size);
}

double DepthField::operator()(const Point3& p) const { return (*tree_)(p); }
double DepthField::maximum() const { return tree_->maximum(); }

TetCriteria graded(TetCriteria tets, const SizeField& size, const DepthField& depth, double grade) {
  const SizeField largest = tets.cell_size;
  const auto bound = [=](const Point3& p) { return std::min(largest(p), size(p) + grade * depth(p)); };
  tets.cell_size = SizeField(bound, std::min(largest.minimum(), size.minimum()),
                             std::min(largest.maximum(), size.maximum() + grade * depth.maximum()));
  tets.grade = grade;
  return tets;
}

}  // namespace delvox
