#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/page_array.h"

namespace delvox {

/// Sets of items that were found to be joined, with path halving. The smaller root wins, so the roots depend on nothing
/// but the sets, and threads may join at the same time (Anderson, Woll, Wait-free parallel algorithms for the
/// union-find problem, 1991).
class UnionFind {
 public:
  explicit UnionFind(std::size_t count) {
    parent_.grow_to(count);
    for (std::size_t i = 0; i < count; ++i) parent_[i] = static_cast<std::uint32_t>(i);
  }
  std::uint32_t root(std::uint32_t i) {
    while (true) {
      const std::uint32_t parent = load(i), grandparent = load(parent);
      if (parent == grandparent) return parent;
      at(i).store(grandparent, std::memory_order_relaxed);  // not a root, and never again
      i = grandparent;
    }
  }
  void join(std::uint32_t a, std::uint32_t b) {
    while (true) {
      a = root(a);
      b = root(b);
      if (a == b) return;
      if (a < b) std::swap(a, b);
      std::uint32_t expected = a;  // still a root?
      if (at(a).compare_exchange_strong(expected, b, std::memory_order_relaxed)) return;
    }
  }
  void prefetch(std::uint32_t i) const { parent_.prefetch(i); }
  std::size_t set_count() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < parent_.size(); ++i) count += parent_[i] == i ? 1 : 0;
    return count;
  }

 private:
  std::atomic_ref<std::uint32_t> at(std::uint32_t i) { return std::atomic_ref<std::uint32_t>(parent_[i]); }
  std::uint32_t load(std::uint32_t i) { return at(i).load(std::memory_order_relaxed); }
  PageArray<std::uint32_t> parent_;
};

}  // namespace delvox
