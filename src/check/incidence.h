#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

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
    if (high < low) {
      std::swap(low, high);
      flipped = !flipped;
    }
  };
  order(a, b);
  order(b, c);
  order(a, b);
  return {a, static_cast<std::uint64_t>(b) << 32 | c, flipped};
}

/// One of the items that share a simplex.
struct Incidence {
  std::uint64_t rest;
  std::uint32_t item_and_parity;
  std::uint32_t item() const { return item_and_parity >> 1; }
  bool flipped() const { return (item_and_parity & 1) != 0; }
};

/// Calls visit(span<const Incidence>) once for each distinct simplex among key_of(0) .. key_of(item_count - 1), items
/// ascending. Buckets by smallest vertex instead of one big sort, in passes that keep the scratch memory near 32 MB:
/// it runs while the mesher's memory is still held. pre: item_count < 2^31.
template <class KeyOf, class Visit>
void for_each_shared_simplex(std::size_t point_count, std::size_t item_count, const KeyOf& key_of, const Visit& visit) {
  constexpr std::size_t kPassSize = std::size_t{1} << 21;
  std::vector<std::uint32_t> bucket_size(point_count, 0);
  for (std::size_t item = 0; item < item_count; ++item) ++bucket_size[key_of(item).first];
  std::vector<Incidence> entries;
  std::vector<std::uint32_t> bucket_end;
  for (std::size_t begin = 0; begin < point_count;) {
    std::size_t end = begin, total = 0;
    bucket_end.clear();
    while (end < point_count && (end == begin || total + bucket_size[end] <= kPassSize)) {
      bucket_end.push_back(static_cast<std::uint32_t>(total));
      total += bucket_size[end++];
    }
    entries.resize(total);
    for (std::size_t item = 0; item < item_count; ++item) {
      const SimplexKey key = key_of(item);
      if (key.first < begin || key.first >= end) continue;
      const auto item_and_parity = static_cast<std::uint32_t>(item << 1 | (key.flipped ? 1 : 0));
      entries[bucket_end[key.first - begin]++] = {key.rest, item_and_parity};
    }
    auto bucket = entries.begin();
    for (std::uint32_t bucket_stop : bucket_end) {
      const auto stop = entries.begin() + bucket_stop;
      std::sort(bucket, stop, [](const Incidence& a, const Incidence& b) {
        return a.rest != b.rest ? a.rest < b.rest : a.item_and_parity < b.item_and_parity;
      });
      while (bucket != stop) {
        auto group_end = bucket + 1;
        while (group_end != stop && group_end->rest == bucket->rest) ++group_end;
        visit(std::span<const Incidence>(bucket, group_end));
        bucket = group_end;
      }
    }
    begin = end;
  }
}

/// Sets of items that were found to be joined, with path halving. The smaller root wins, so results do not depend on
/// anything but the items.
class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) {
    for (std::size_t i = 0; i < count; ++i) parent_[i] = static_cast<std::uint32_t>(i);
  }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    if (a < b) parent_[b] = a;
    else parent_[a] = b;
  }
  std::size_t set_count() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < parent_.size(); ++i) count += parent_[i] == i ? 1 : 0;
    return count;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace delvox::check
