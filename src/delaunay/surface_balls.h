#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/page_array.h"
#include "delaunay/ids.h"
#include "delvox/core/geometry.h"

namespace delvox {

/// A circumball of a restricted triangle, centred on the surface (book, definition 14.1).
struct SurfaceBall {
  Point3 center;
  double squared_radius = 0;
};

/// The balls of facets, each known from both of its sides. A cell costs four bytes until two of its facets have balls.
/// Different cells can be changed at the same time, each with a room of its own.
class SurfaceBalls {
 public:
  /// Places set aside for changes, and those that changes have left.
  struct Room {
    std::vector<std::uint32_t> entries, balls;
  };

  /// Places for the cells up to `capacity`.
  void grow_to(std::size_t capacity) {
    const std::size_t before = entries_.size();
    entries_.grow_to(capacity);
    for (std::size_t cell = before; cell < capacity; ++cell) entries_[cell] = kNone;
  }
  /// Frees all memory, once nothing is asked any more. pre: no room is in use.
  void retire() {
    entries_.free();
    numbers_.free();
    balls_.free();
    free_ = Room();
  }

  void prefetch(CellId cell) const { entries_.prefetch(cell); }
  /// As prefetch(), of the balls themselves.
  void prefetch_balls(CellId cell) const {
    const std::uint32_t entry = entries_[cell];
    if (entry == kNone) return;
    entry < kSeveral ? balls_.prefetch(entry / 4) : numbers_.prefetch(entry - kSeveral);
  }
  bool any(CellId cell) const { return entries_[cell] != kNone; }
  const SurfaceBall* find(FacetId facet) const {
    const std::uint32_t number = number_of(facet);
    return number == kNone ? nullptr : &balls_[number];
  }
  std::uint32_t number_of(FacetId facet) const {
    const std::uint32_t entry = entries_[facet.cell];
    if (entry < kSeveral) return entry % 4 == static_cast<std::uint32_t>(facet.index) ? entry / 4 : kNone;
    return entry == kNone ? kNone : numbers_[entry - kSeveral][facet.index];
  }

  /// Puts into the room what so many cells and balls may take. Not to be called beside anything else.
  void furnish(Room& room, std::size_t cells, std::size_t balls) {
    fill(room.entries, cells, free_.entries, numbers_);
    fill(room.balls, balls, free_.balls, balls_);
  }
  /// Gives back what is left in the room.
  void clear_out(Room& room) {
    free_.entries.insert(free_.entries.end(), room.entries.begin(), room.entries.end());
    free_.balls.insert(free_.balls.end(), room.balls.begin(), room.balls.end());
    room = {};
  }

  std::uint32_t add(const SurfaceBall& ball, Room& room) {
    const std::uint32_t number = take(room.balls);
    balls_[number] = ball;
    return number;
  }
  void free(std::uint32_t number, Room& room) { room.balls.push_back(number); }
  const SurfaceBall& operator[](std::uint32_t number) const { return balls_[number]; }

  /// Says which ball a facet has, seen from its cell: kNone for none.
  void set(FacetId facet, std::uint32_t number, Room& room) {
    std::uint32_t& entry = entries_[facet.cell];
    const auto index = static_cast<std::uint32_t>(facet.index);
    if (entry == kNone || (entry < kSeveral && entry % 4 == index)) {
      entry = number == kNone ? kNone : 4 * number + index;
      return;
    }
    if (entry < kSeveral) {
      if (number == kNone) return;
      const std::uint32_t only = std::exchange(entry, kSeveral + take(room.entries));
      numbers_[entry - kSeveral] = kNoBalls;
      numbers_[entry - kSeveral][only % 4] = only / 4;
    }
    auto& numbers = numbers_[entry - kSeveral];
    numbers[facet.index] = number;
    if (numbers == kNoBalls) forget(facet.cell, room);
  }
  /// The cell has no balls any more; they are not freed.
  void forget(CellId cell, Room& room) {
    std::uint32_t& entry = entries_[cell];
    if (entry >= kSeveral && entry != kNone) room.entries.push_back(entry - kSeveral);
    entry = kNone;
  }

 private:
  static constexpr std::array<std::uint32_t, 4> kNoBalls{kNone, kNone, kNone, kNone};
  static constexpr std::uint32_t kSeveral = 1u << 31;

  static std::uint32_t take(std::vector<std::uint32_t>& unused) {
    const std::uint32_t number = unused.back();
    unused.pop_back();
    return number;
  }

  template <class T>
  static void fill(std::vector<std::uint32_t>& room, std::size_t count, std::vector<std::uint32_t>& unused,
                   PageArray<T>& all) {
    constexpr std::size_t kSpare = 16;
    if (room.size() >= count) return;
    while (room.size() < count + kSpare) {
      if (unused.empty()) {
        room.push_back(static_cast<std::uint32_t>(all.size()));
        all.grow_to(all.size() + 1);
      } else {
        room.push_back(take(unused));
      }
    }
  }

  // Per cell: none; four times its only ball, plus the facet; or kSeveral, plus its place in numbers_.
  PageArray<std::uint32_t> entries_;
  PageArray<std::array<std::uint32_t, 4>> numbers_;  // per facet of such a cell: its ball
  PageArray<SurfaceBall> balls_;
  Room free_;
};

}  // namespace delvox
