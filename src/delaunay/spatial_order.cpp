#include "delaunay/spatial_order.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>
#include <vector>

#include "core/hash.h"
#include "core/parallel.h"
#include "core/sort_by_key.h"

namespace delvox {
namespace {

constexpr int kBits = 12;  // per axis: of points nearer to each other than that, any may come first

/// Hilbert's curve through space, level by level (Skilling, "Programming the Hilbert curve", 2004): in each octant of a
/// cube it runs through the eight smaller ones in the same way, but for a turn of the axes and of their directions. All
/// turns that occur, and for each octant of each, where it comes and how the curve is turned inside it.
class HilbertTurns {
 public:
  struct Octant {
    std::uint8_t place, turn;
  };

  HilbertTurns() {
    turns_.push_back({});
    for (std::size_t turn = 0; turn < turns_.size(); ++turn) {
      octants_.emplace_back();
      for (unsigned octant = 0; octant < 8; ++octant) octants_[turn][octant] = enter(turns_[turn], octant);
    }
  }
  /// `octant`: a bit for each axis, x highest.
  Octant operator()(unsigned turn, unsigned octant) const { return octants_[turn][octant]; }

 private:
  /// The curve's axis i runs along axis[i], downward if flipped; if odd, gray codes are counted from their other end.
  struct Turn {
    std::array<std::uint8_t, 3> axis{0, 1, 2};
    std::array<bool, 3> flipped{};
    bool odd = false;
    bool operator==(const Turn&) const = default;
  };

  Octant enter(Turn turn, unsigned octant) {
    std::array<unsigned, 3> bit;
    for (int i = 0; i < 3; ++i) bit[i] = (octant >> (2 - turn.axis[i]) & 1) ^ turn.flipped[i];
    const unsigned gray1 = bit[1] ^ bit[0], gray2 = bit[2] ^ gray1, odd = turn.odd;
    const auto place = static_cast<std::uint8_t>((bit[0] ^ odd) << 2 | (gray1 ^ odd) << 1 | (gray2 ^ odd));
    for (int i = 0; i < 3; ++i) {
      if (bit[i] != 0) {
        turn.flipped[0] = !turn.flipped[0];
      } else {
        std::swap(turn.axis[0], turn.axis[i]);
        std::swap(turn.flipped[0], turn.flipped[i]);
      }
    }
    turn.odd ^= gray2 != 0;
    const auto known = std::find(turns_.begin(), turns_.end(), turn);
    const auto number = static_cast<std::uint8_t>(known - turns_.begin());
    if (known == turns_.end()) turns_.push_back(turn);
    return {place, number};
  }

  std::vector<Turn> turns_;
  std::vector<std::array<Octant, 8>> octants_;
};

/// Where a cell of the 2^kBits grid comes along the curve.
std::uint64_t hilbert_index(const std::array<std::uint32_t, 3>& x) {
  static const HilbertTurns turns;
  std::uint64_t index = 0;
  unsigned turn = 0;
  for (int level = kBits - 1; level >= 0; --level) {
    const unsigned octant = (x[0] >> level & 1) << 2 | (x[1] >> level & 1) << 1 | (x[2] >> level & 1);
    const HilbertTurns::Octant at = turns(turn, octant);
    index = index << 3 | at.place;
    turn = at.turn;
  }
  return index;
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
