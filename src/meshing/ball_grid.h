#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/flat_hash.h"
#include "core/hash.h"
#include "core/round.h"
#include "delvox/core/geometry.h"

namespace delvox {

/// Numbered balls of any radii, to be found by the points in them: those of about one radius in cubes as wide as the
/// widest of them. Finding may go on in many threads at once, if nothing changes meanwhile.
class BallGrid {
 public:
  void add(std::uint32_t ball, const Point3& center, double radius) {
    const int octave = octave_of(radius);
    if (std::find(octaves_.begin(), octaves_.end(), octave) == octaves_.end()) octaves_.push_back(octave);
    for_each_cube(center, radius, [&](std::uint64_t key) {
      std::uint32_t& list = number_[key];
      if (list == FlatHash::kAbsent) {
        list = static_cast<std::uint32_t>(lists_.size());
        lists_.emplace_back();
      }
      lists_[list].push_back(ball);
    });
  }
  /// pre: added with this centre and radius.
  void remove(std::uint32_t ball, const Point3& center, double radius) {
    for_each_cube(center, radius, [&](std::uint64_t key) {
      auto& list = lists_[number_.find(key)];
      list.erase(std::find(list.begin(), list.end(), ball));
    });
  }
  /// Calls visit(ball) for all that hold p, and some others.
  template <class Visit>
  void for_each_near(const Point3& p, const Visit& visit) const {
    for (int octave : octaves_) {
      const double width = std::ldexp(1.0, octave);
      const std::uint32_t list = number_.find(key_of(octave, index(p.x, width), index(p.y, width), index(p.z, width)));
      if (list == FlatHash::kAbsent) continue;
      for (std::uint32_t ball : lists_[list]) visit(ball);
    }
  }

 private:
  /// Of cubes that are at least as wide as the ball.
  static int octave_of(double radius) { return std::ilogb(2 * radius) + 1; }
  static std::int64_t index(double x, double width) { return floor_to_int(x / width); }
  /// Cubes with equal keys share a list, which costs time only.
  static std::uint64_t key_of(int octave, std::int64_t i, std::int64_t j, std::int64_t k) {
    std::uint64_t hash = mix_hash(static_cast<std::uint64_t>(octave) ^ static_cast<std::uint64_t>(i));
    hash = mix_hash(hash + static_cast<std::uint64_t>(j));
    return mix_hash(hash + static_cast<std::uint64_t>(k)) >> 1;
  }
  template <class Visit>
  static void for_each_cube(const Point3& c, double radius, const Visit& visit) {
    const int octave = octave_of(radius);
    const double width = std::ldexp(1.0, octave);
    std::vector<std::uint64_t> keys;
    for (std::int64_t i = index(c.x - radius, width); i <= index(c.x + radius, width); ++i) {
      for (std::int64_t j = index(c.y - radius, width); j <= index(c.y + radius, width); ++j) {
        for (std::int64_t k = index(c.z - radius, width); k <= index(c.z + radius, width); ++k) {
          keys.push_back(key_of(octave, i, j, k));
        }
      }
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    for (std::uint64_t key : keys) visit(key);
  }

  std::vector<int> octaves_;
  FlatHash number_;
  std::vector<std::vector<std::uint32_t>> lists_;
};

}  // namespace delvox
