#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "delaunay/ids.h"
#include "delvox/core/geometry.h"

namespace delvox {

/// A circumball of a restricted triangle, centred on the surface (book, definition 14.1).
struct SurfaceBall {
  Point3 center;
  double squared_radius = 0;
};

/// The balls of facets, each known from both of its sides. A cell costs four bytes until one of its facets has a ball.
class SurfaceBalls {
 public:
  /// Room for cells up to `capacity`.
  void grow_to(std::size_t capacity) {
    if (capacity > entries_.size()) entries_.resize(capacity, kNone);
  }
  bool any(CellId cell) const { return entries_[cell] != kNone; }
  const SurfaceBall* find(FacetId facet) const {
    const std::uint32_t number = number_of(facet);
    return number == kNone ? nullptr : &balls_[number];
  }
  std::uint32_t number_of(FacetId facet) const {
    const std::uint32_t entry = entries_[facet.cell];
    return entry == kNone ? kNone : numbers_[entry][facet.index];
  }

  std::uint32_t add(const SurfaceBall& ball) { return take(free_balls_, balls_, ball); }
  void free(std::uint32_t number) { free_balls_.push_back(number); }
  const SurfaceBall& operator[](std::uint32_t number) const { return balls_[number]; }

  /// Says which ball a facet has, seen from its cell: kNone for none.
  void set(FacetId facet, std::uint32_t number) {
    std::uint32_t& entry = entries_[facet.cell];
    if (entry == kNone) {
      if (number == kNone) return;
      entry = take(free_entries_, numbers_, {kNone, kNone, kNone, kNone});
    }
    auto& numbers = numbers_[entry];
    numbers[facet.index] = number;
    if (numbers == std::array<std::uint32_t, 4>{kNone, kNone, kNone, kNone}) forget(facet.cell);
  }
  /// The cell has no balls any more; they are not freed.
  void forget(CellId cell) {
    std::uint32_t& entry = entries_[cell];
    if (entry != kNone) free_entries_.push_back(entry);
    entry = kNone;
  }

 private:
  template <class T>
  static std::uint32_t take(std::vector<std::uint32_t>& unused, std::vector<T>& all, const T& value) {
    if (unused.empty()) {
      all.push_back(value);
      return static_cast<std::uint32_t>(all.size() - 1);
    }
    const std::uint32_t number = unused.back();
    unused.pop_back();
    all[number] = value;
    return number;
  }

  std::vector<std::uint32_t> entries_;                 // per cell: its place in numbers_
  std::vector<std::array<std::uint32_t, 4>> numbers_;  // per facet of such a cell: its ball
  std::vector<SurfaceBall> balls_;
  std::vector<std::uint32_t> free_entries_, free_balls_;
};

}  // namespace delvox
