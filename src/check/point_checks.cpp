#include "check/point_checks.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace delvox::check {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

std::uint64_t mix(std::uint64_t h, std::uint64_t value) {
  h = (h ^ value) * 0x9E3779B97F4A7C15ull;
  return h ^ (h >> 29);
}

std::uint64_t hash_of(std::int64_t x, std::int64_t y, std::int64_t z) {
  return mix(mix(mix(0, static_cast<std::uint64_t>(x)), static_cast<std::uint64_t>(y)), static_cast<std::uint64_t>(z));
}

std::int64_t bits(double x) { return std::bit_cast<std::int64_t>(x + 0.0); }  // -0 and 0 are the same place

// A chained hash table of points; chains of different cells may meet, the comparison decides.
class PointTable {
 public:
  explicit PointTable(std::size_t capacity)
      : heads_(std::bit_ceil(std::max<std::size_t>(16, capacity)), kNone) {
    entries_.reserve(capacity);
  }
  template <class Same>
  bool contains(std::uint64_t hash, const Same& same) const {
    for (std::uint32_t e = heads_[slot(hash)]; e != kNone; e = entries_[e].next) {
      if (same(entries_[e].point)) return true;
    }
    return false;
  }
  void insert(std::uint64_t hash, std::uint32_t point) {
    std::uint32_t& head = heads_[slot(hash)];
    entries_.push_back({point, head});
    head = static_cast<std::uint32_t>(entries_.size() - 1);
  }

 private:
  struct Entry {
    std::uint32_t point, next;
  };
  std::size_t slot(std::uint64_t hash) const { return (hash >> 7) & (heads_.size() - 1); }
  std::vector<std::uint32_t> heads_;
  std::vector<Entry> entries_;
};

Tally exact_duplicates(const std::vector<Point3>& points) {
  Tally result;
  PointTable table(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Point3& p = points[i];
    const std::uint64_t hash = hash_of(bits(p.x), bits(p.y), bits(p.z));
    if (table.contains(hash, [&](std::uint32_t j) { return points[j] == p; })) result.add(p);
    else table.insert(hash, i);
  }
  return result;
}

}  // namespace

Tally duplicate_points(const std::vector<Point3>& points, double distance) {
  if (!(distance > 0)) return exact_duplicates(points);
  // Cells far larger than `distance`: nearly every point touches one cell only, few share one.
  const double cell = 64 * distance;
  Tally result;
  PointTable table(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Point3& p = points[i];
    const auto near = [&](std::uint32_t j) {
      const Vector3 d = points[j] - p;
      return std::abs(d.x) <= distance && std::abs(d.y) <= distance && std::abs(d.z) <= distance;
    };
    const auto cell_of = [&](double x) { return static_cast<std::int64_t>(std::floor(x / cell)); };
    bool duplicate = false;
    for (std::int64_t x = cell_of(p.x - distance); x <= cell_of(p.x + distance) && !duplicate; ++x) {
      for (std::int64_t y = cell_of(p.y - distance); y <= cell_of(p.y + distance) && !duplicate; ++y) {
        for (std::int64_t z = cell_of(p.z - distance); z <= cell_of(p.z + distance) && !duplicate; ++z) {
          duplicate = table.contains(hash_of(x, y, z), near);
        }
      }
    }
    if (duplicate) result.add(p);
    else table.insert(hash_of(cell_of(p.x), cell_of(p.y), cell_of(p.z)), i);
  }
  return result;
}

}  // namespace delvox::check
