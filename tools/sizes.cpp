#include "sizes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/parallel.h"
#include "delvox/core/errors.h"
#include "delvox/volume/read_volume.h"
#include "format.h"
#include "volume/block_sides.h"

namespace delvox::tools {
namespace {

constexpr double kSizesPerDiagonal = 60;
constexpr double kVoxelsPerSize = 1.5;
constexpr double kTetsPerCubedSize = 5;  // tets in a piece of organ of size^3, about (liver, head MR)

bool looks_like_number(const std::string& text) {
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return end != text.c_str() && *end == '\0';
}

double voxel_mm3(const Volume& volume) { return std::abs(volume.header().index_to_world.determinant()); }

// Trilinear interpolation of all samples of a volume, at any place of space.
class SampledSize {
 public:
  SampledSize(const Volume& volume, bool turned)
      : dims_(volume.dims()),
        world_to_index_(volume.header().index_to_world.inverse()),
        samples_(volume.samples()),
        turned_(turned) {}

  double operator()(const Point3& p) const {
    const Point3 at = world_to_index_(turned_ ? Point3{-p.x, -p.y, p.z} : p);
    std::array<std::size_t, 3> low, high;
    Point3 fraction;
    for (int axis = 0; axis < 3; ++axis) {
      const double clamped = std::clamp(at[axis], 0.0, static_cast<double>(dims_[axis] - 1));
      low[axis] = static_cast<std::size_t>(clamped);
      high[axis] = std::min<std::size_t>(low[axis] + 1, static_cast<std::size_t>(dims_[axis]) - 1);
      fraction[axis] = clamped - static_cast<double>(low[axis]);
    }
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1;
      std::array<std::size_t, 3> index;
      for (int axis = 0; axis < 3; ++axis) {
        const bool upper = (corner >> axis) & 1;
        index[axis] = upper ? high[axis] : low[axis];
        weight *= upper ? fraction[axis] : 1 - fraction[axis];
      }
      sum += weight * sample(index);
    }
    return sum;
  }

 private:
  double sample(const std::array<std::size_t, 3>& i) const {
    return samples_[(i[2] * static_cast<std::size_t>(dims_[1]) + i[1]) * static_cast<std::size_t>(dims_[0]) + i[0]];
  }

  std::array<int, 3> dims_;
  Affine3 world_to_index_;
  std::vector<float> samples_;
  bool turned_;
};

SizeField size_volume(const std::string& path, const std::string& option, Frame frame) {
  const Volume volume = read_volume(path);
  if (!(volume.min() > 0)) {
    throw InputError(path + ": as " + option + ": holds sizes of " + number(volume.min()) +
                     "; every sample must be positive, in mm");
  }
  const Frame own = volume.header().frame;
  const bool turned = own != Frame::kUnknown && frame != Frame::kUnknown && own != frame;
  const auto sampled = std::make_shared<SampledSize>(volume, turned);
  const double low = volume.min(), high = volume.max();
  return SizeField([sampled, low, high](const Point3& p) { return std::clamp((*sampled)(p), low, high); }, low, high);
}

// What of a volume lies inside: a box along its own axes, which may be oblique, in mm, and the number of samples.
struct Inside {
  double diagonal = 0;
  double volume_mm3 = 0;
};

struct InsideSamples {
  Box3 indices;
  std::size_t count = 0;

  void add(const InsideSamples& more) {
    if (more.count == 0) return;
    indices.extend(more.indices.min);
    indices.extend(more.indices.max);
    count += more.count;
  }
};

// Of a block whose samples lie on both sides, from `low` on.
InsideSamples inside_samples(const Volume& volume, const LevelSet& level_set, const std::array<int, 3>& low,
                             const std::array<int, 3>& size) {
  std::array<float, BlockSides::kBlock * BlockSides::kBlock * BlockSides::kBlock> samples;
  volume.copy_block(low, size, samples.data());
  InsideSamples result;
  const float* sample = samples.data();
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        if (!level_set.inside(level_set.sign * *sample++)) continue;
        result.indices.extend({double(low[0] + i), double(low[1] + j), double(low[2] + k)});
        ++result.count;
      }
    }
  }
  return result;
}

// Of a row of blocks along i.
InsideSamples inside_samples(const Volume& volume, const LevelSet& level_set, const BlockSides& blocks, int j, int k) {
  InsideSamples result;
  for (int i = 0; i < blocks.counts[0]; ++i) {
    std::array<int, 3> low{i * BlockSides::kBlock, j * BlockSides::kBlock, k * BlockSides::kBlock}, size;
    for (int axis = 0; axis < 3; ++axis) size[axis] = std::min(BlockSides::kBlock, volume.dims()[axis] - low[axis]);
    const Side side = blocks.at(i, j, k);
    if (side == Side::kBoth) {
      result.add(inside_samples(volume, level_set, low, size));
    } else if (side == Side::kInside) {
      const Point3 first{double(low[0]), double(low[1]), double(low[2])};
      const Vector3 steps{size[0] - 1.0, size[1] - 1.0, size[2] - 1.0};
      result.add({{first, first + steps}, static_cast<std::size_t>(size[0]) * size[1] * size[2]});
    }
  }
  return result;
}

Inside measure_inside(const Volume& volume, const Isosurface& surface) {
  constexpr std::size_t kRows = 16;
  const LevelSet level_set(surface);
  const BlockSides blocks = block_sides(volume, level_set);
  const int rows = blocks.counts[1];
  InsideSamples all;
  for (const InsideSamples& part : map_chunks(
           static_cast<std::size_t>(rows) * blocks.counts[2], kRows, [&](std::size_t begin, std::size_t end) {
             InsideSamples found;
             for (auto row = static_cast<int>(begin); row < static_cast<int>(end); ++row) {
               found.add(inside_samples(volume, level_set, blocks, row % rows, row / rows));
             }
             return found;
           })) {
    all.add(part);
  }
  if (all.count == 0) throw NothingToMesh("no sample of the volume is inside; choose another --iso, see delvox info");
  const Vector3 spacing = volume.header().spacing(), steps = all.indices.max - all.indices.min;
  return {norm({steps.x * spacing.x, steps.y * spacing.y, steps.z * spacing.z}),
          static_cast<double>(all.count) * voxel_mm3(volume)};
}

}  // namespace

double default_size(const Volume& volume, const Isosurface& surface) {
  return std::max(measure_inside(volume, surface).diagonal / kSizesPerDiagonal,
                  kVoxelsPerSize * std::cbrt(voxel_mm3(volume)));
}

double guess_size(std::size_t tets, double inside_mm3) {
  return std::cbrt(kTetsPerCubedSize * inside_mm3 / static_cast<double>(tets));
}

double guess_size(std::size_t tets, const Volume& volume, const Isosurface& surface) {
  return guess_size(tets, measure_inside(volume, surface).volume_mm3);
}

bool is_size_field(const std::string& text) {
  return looks_like_number(text) || std::filesystem::exists(text);
}

SizeField parse_size(const std::string& text, const std::string& option, Frame frame) {
  if (!looks_like_number(text)) {
    if (std::filesystem::exists(text)) return size_volume(text, option, frame);
    throw OptionError(option + ": '" + text + "' is neither a number nor a volume file");
  }
  const double size = parse_number(text, option);
  if (!(size > 0)) throw OptionError(option + ": " + text + " is not positive; give a length in mm");
  return SizeField(size);
}

}  // namespace delvox::tools
