#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "delvox/core/mesh.h"

namespace delvox::check {

/// A simplex filed under its smallest vertex: `rest` holds its other vertices, sorted, `flipped` the parity of the
/// permutation that sorted it.
struct SimplexKey {
  std::uint32_t first = 0;
  std::uint64_t rest = 0;
  bool flipped = false;
};

inline SimplexKey edge_key(std::uint32_t a, std::uint32_t b) {
  return a < b ? SimplexKey{a, b, false} : SimplexKey{b, a, true};
}

inline SimplexKey face_key(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  bool flipped = false;
  const auto order = [&flipped](std::uint32_t& low, std::uint32_t& high) {
    const bool swap = high < low;
    const std::uint32_t smaller = swap ? high : low;  // random order: better no branch
    high = swap ? low : high;
    low = smaller;
    flipped ^= swap;
  };
  order(a, b);
  order(b, c);
  order(a, b);
  return {a, static_cast<std::uint64_t>(b) << 32 | c, flipped};
}

/// Of a whole triangle, as the one simplex of a cell.
inline constexpr auto triangle_key = [](const Triangle& t, int) { return face_key(t[0], t[1], t[2]); };

/// One of the items that share a simplex.
struct Incidence {
  std::uint32_t item_and_parity = 0;
  std::uint32_t item() const { return item_and_parity >> 1; }
  bool flipped() const { return (item_and_parity & 1) != 0; }
};

/// The simplices of cells: item i is simplex i % kPerCell of cell i / kPerCell.
template <std::size_t kPerCell, class Cell, class KeyOf>
struct SimplexItems {
  std::span<const Cell> cells;
  KeyOf key_of;  ///< SimplexKey of (cell, number of the simplex)
  std::size_t size() const { return kPerCell * cells.size(); }
  SimplexKey operator[](std::size_t item) const {
    return key_of(cells[item / kPerCell], static_cast<int>(item % kPerCell));
  }
  void prefetch(std::size_t item) const { __builtin_prefetch(&cells[item / kPerCell]); }
};

/// Items by the smallest vertex of their simplex, ascending: a stable counting sort, so the same for any number of
/// threads. Four bytes per item and up to twenty per point: it runs while the mesher's memory may still be held.
class SimplexBuckets {
 public:
  template <class Items>
  SimplexBuckets(std::size_t point_count, const Items& items)
      : begin_(point_count + 1), items_(std::make_unique_for_overwrite<std::uint32_t[]>(items.size())) {
    constexpr std::size_t kMostBlocks = 4;  // each counts for itself
    const std::size_t block = std::max(items.size() / kMostBlocks + 1, 2 * point_count);
    auto next = map_chunks(items.size(), block, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> sizes(point_count, 0);
      for (std::size_t item = begin; item < end; ++item) ++sizes[items[item].first];
      return sizes;
    });
    std::uint32_t total = 0;
    for (std::size_t point = 0; point < point_count; ++point) {
      begin_[point] = total;
      for (auto& of_block : next) total += std::exchange(of_block[point], total);
    }
    begin_[point_count] = total;
    for_each_chunk(items.size(), block, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t>& at = next[begin / block];
      for (std::size_t item = begin; item < end; ++item) {
        items_[at[items[item].first]++] = static_cast<std::uint32_t>(item);
      }
    });
  }
  /// Where the bucket of `point` begins and that of the point before ends.
  const std::uint32_t* begin_of(std::size_t point) const { return items_.get() + begin_[point]; }
  const std::uint32_t* end() const { return items_.get() + begin_.back(); }

 private:
  std::vector<std::uint32_t> begin_;
  std::unique_ptr<std::uint32_t[]> items_;
};

/// The items of one bucket grouped by their simplex, by a hash table that stays in the nearest cache.
class SimplexGroups {
 public:
  /// Empties it, for up to `most` items.
  void restart(std::size_t most) {
    const std::size_t size = std::bit_ceil(2 * most + 2);
    shift_ = 64 - std::countr_zero(size);
    slots_.assign(size, 0);
    groups_.clear();
    more_.clear();
  }
  void add(std::uint64_t rest, std::uint32_t item, bool flipped) {
    const Incidence incidence{item << 1 | (flipped ? 1u : 0u)};
    std::size_t slot = rest * 0x9E3779B97F4A7C15ull >> shift_;
    while (slots_[slot] != 0 && groups_[slots_[slot] - 1].rest != rest) slot = (slot + 1) & (slots_.size() - 1);
    if (slots_[slot] == 0) {
      groups_.push_back({rest, {incidence, {}}, 1, kEnd, kEnd});
      slots_[slot] = static_cast<std::uint32_t>(groups_.size());
      return;
    }
    Group& group = groups_[slots_[slot] - 1];
    if (group.few < group.items.size()) {
      group.items[group.few++] = incidence;
    } else {
      add_to_list(group, incidence);
    }
  }
  /// visit(span<const Incidence>) for each simplex in the order of its first item, items in the order they came.
  template <class Visit>
  void for_each(const Visit& visit) {
    for (const Group& group : groups_) {
      visit(group.first_more == kEnd ? std::span<const Incidence>(group.items.data(), group.few) : all_of(group));
    }
  }

 private:
  static constexpr std::uint32_t kEnd = ~std::uint32_t{0};
  struct Group {
    std::uint64_t rest;
    std::array<Incidence, 2> items;  // more than two share a simplex of a bad mesh only
    std::uint32_t few;               // of them
    std::uint32_t first_more, last_more;
  };
  struct More {
    Incidence incidence;
    std::uint32_t next;
  };

  void add_to_list(Group& group, Incidence incidence) {
    const auto place = static_cast<std::uint32_t>(more_.size());
    more_.push_back({incidence, kEnd});
    (group.first_more == kEnd ? group.first_more : more_[group.last_more].next) = place;
    group.last_more = place;
  }
  std::span<const Incidence> all_of(const Group& group) {
    all_.assign(group.items.begin(), group.items.end());
    for (std::uint32_t m = group.first_more; m != kEnd; m = more_[m].next) all_.push_back(more_[m].incidence);
    return all_;
  }

  int shift_ = 0;
  std::vector<std::uint32_t> slots_;  // 0, or 1 + a group
  std::vector<Group> groups_;
  std::vector<More> more_;
  std::vector<Incidence> all_;  // of the group in hand
};

/// Calls visit(span<const Incidence>, Result&) once for each distinct simplex, items ascending, in parallel; returns
/// the results of fixed ranges of vertices, in order. prefetch(item) is called some time before the visit, for what it
/// will need. pre: fewer than 2^31 items.
template <class Result, std::size_t kPerCell, class Cell, class KeyOf, class Visit, class Prefetch>
std::vector<Result> map_shared_simplices(std::size_t point_count, std::span<const Cell> cells, const KeyOf& key_of,
                                         const Visit& visit, const Prefetch& prefetch) {
  constexpr std::size_t kChunk = 4096;
  constexpr std::ptrdiff_t kAhead = 32;  // cells lie anywhere: without fetching ahead most of the time goes waiting
  const SimplexItems<kPerCell, Cell, KeyOf> items{cells, key_of};
  const SimplexBuckets buckets(point_count, items);
  return map_chunks(point_count, kChunk, [&](std::size_t begin, std::size_t end) {
    Result result;
    SimplexGroups groups;
    for (std::size_t point = begin; point < end; ++point) {
      const std::uint32_t *first = buckets.begin_of(point), *last = buckets.begin_of(point + 1);
      if (first == last) continue;
      groups.restart(static_cast<std::size_t>(last - first));
      for (const std::uint32_t* item = first; item != last; ++item) {
        if (buckets.end() - item > kAhead) items.prefetch(item[kAhead]);
        prefetch(*item);
        const SimplexKey key = items[*item];
        groups.add(key.rest, *item, key.flipped);
      }
      groups.for_each([&](std::span<const Incidence> sharing) { visit(sharing, result); });
    }
    return result;
  });
}

template <class Result, std::size_t kPerCell, class Cell, class KeyOf, class Visit>
std::vector<Result> map_shared_simplices(std::size_t point_count, std::span<const Cell> cells, const KeyOf& key_of,
                                         const Visit& visit) {
  return map_shared_simplices<Result, kPerCell>(point_count, cells, key_of, visit, [](std::uint32_t) {});
}

}  // namespace delvox::check
