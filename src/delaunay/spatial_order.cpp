#include "delaunay/spatial_order.h"

#include <algorithm>
#include <array>
#include <bit>

#include "core/hash.h"
#include "core/parallel.h"
#include "core/sort_by_key.h"

namespace delvox {
namespace {

constexpr int kBits = 12;  // per axis: of points nearer to each other than that, any may come first

/// The low 21 bits of x, two free ones between each and the next.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffff;
  x = (x | x << 16) & 0x001f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

/// Where a cell of the 2^kBits grid comes along Hilbert's curve (Skilling, "Programming the Hilbert curve", 2004): the
/// coordinates are turned, level by level, into those of the curve's own frame. Without branches: which way each would
/// go is as good as random.
std::uint64_t hilbert_index(std::array<std::uint32_t, 3> x) {
  for (int level = kBits - 1; level > 0; --level) {
    const std::uint32_t below = (1u << level) - 1;
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t set = 0 - (x[axis] >> level & 1);  // all ones or all zeros
      const std::uint32_t swapped = (x[0] ^ x[axis]) & below & ~set;
      x[0] ^= swapped | (below & set);
      x[axis] ^= swapped;
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t parity = x[2] >> 1;  // of the bits above each
  for (int step = 1; step < kBits; step *= 2) parity ^= parity >> step;
  return spread(x[0] ^ parity) << 2 | spread(x[1] ^ parity) << 1 | spread(x[2] ^ parity);
}

/// Rounds go to a quarter in size going back from the last: the last holds three quarters of the points. (Of halves
/// there are twice as many, each a walk through all of the triangulation.)
std::uint64_t round_of(const Point3& p, int last_round) {
  return static_cast<std::uint64_t>(std::max(0, last_round - std::countr_zero(hash_point(p) | (1ull << 63)) / 2));
}

}  // namespace

std::uint64_t place_along_curve(const Point3& p, const Box3& box) {
  const double extent = std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z, 1e-300});
  const Vector3 u = (((1u << kBits) - 1) / extent) * (p - box.min);
  const auto place = [](double coordinate) { return static_cast<std::uint32_t>(std::max(coordinate, 0.0)); };
  return hilbert_index({place(u.x), place(u.y), place(u.z)});
}

SpatialOrder spatial_order(const std::vector<Point3>& points) {
  Box3 box;
  for (const Point3& p : points) box.extend(p);
  const int last_round = std::bit_width(points.size() / 64) / 2;
  std::vector<KeyedIndex> entries(points.size());
  for_each_chunk(points.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      entries[i] = {round_of(points[i], last_round) << 3 * kBits | place_along_curve(points[i], box),
                    static_cast<std::uint32_t>(i)};
    }
  });
  sort_by_key(entries);
  SpatialOrder order;
  order.indices.resize(points.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    order.indices[i] = entries[i].index;
    if (i + 1 == entries.size() || entries[i].key >> 3 * kBits != entries[i + 1].key >> 3 * kBits) {
      order.round_ends.push_back(i + 1);
    }
  }
  return order;
}

std::uint64_t hash_point(const Point3& p) {
  std::uint64_t h = 0;
  for (int axis = 0; axis < 3; ++axis) h = mix_hash(h ^ std::bit_cast<std::uint64_t>(p[axis] + 0.0));
  return h;
}

}  // namespace delvox
