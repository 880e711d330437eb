#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace delvox::test {

/// Topology of {f > 0} for f sampled at the (n[0]+1)(n[1]+1)(n[2]+1) points of a fine grid and taken as linear in the
/// six Kuhn tets of each fine cell: the inside retracts to the full subcomplex of the inside vertices, which is
/// counted simplex by simplex. No deciders, no saddles: what the exact count is held against.
class BruteForceTopology {
 public:
  BruteForceTopology(std::array<int, 3> n, const std::function<double(int, int, int)>& f) : n_(n) {
    inside_.resize(static_cast<std::size_t>(n[0] + 1) * (n[1] + 1) * (n[2] + 1));
    for (int k = 0, at = 0; k <= n[2]; ++k) {
      for (int j = 0; j <= n[1]; ++j) {
        for (int i = 0; i <= n[0]; ++i) inside_[at++] = f(i, j, k) > 0;
      }
    }
    parent_.resize(inside_.size());
    for (std::uint32_t v = 0; v < parent_.size(); ++v) parent_[v] = v;
    count();
  }

  long euler() const { return euler_; }
  int inside_components() { return components(1); }
  int outside_components() { return components(0); }
  std::uint32_t component_of(int i, int j, int k) { return root(index(i, j, k)); }

 private:
  std::uint32_t index(int i, int j, int k) const {
    return static_cast<std::uint32_t>((k * (n_[1] + 1) + j) * (n_[0] + 1) + i);
  }
  std::uint32_t root(std::uint32_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void count() {
    // Simplices of the Kuhn (Freudenthal) triangulation are chains of corners, each above the last in all axes.
    for (int k = 0; k <= n_[2]; ++k) {
      for (int j = 0; j <= n_[1]; ++j) {
        for (int i = 0; i <= n_[0]; ++i) count_chains(i, j, k);
      }
    }
  }
  void count_chains(int i, int j, int k) {
    const std::uint32_t base = index(i, j, k);
    std::array<std::int64_t, 8> corner;
    for (int c = 0; c < 8; ++c) {
      const int x = i + (c & 1), y = j + (c >> 1 & 1), z = k + (c >> 2);
      corner[c] = x > n_[0] || y > n_[1] || z > n_[2] ? -1 : std::int64_t{index(x, y, z)};
    }
    for (int c = 1; c < 8; ++c) {
      if (corner[c] < 0 || inside_[base] != inside_[corner[c]]) continue;
      parent_[root(base)] = root(static_cast<std::uint32_t>(corner[c]));
    }
    const auto in = [&](int c) { return corner[c] >= 0 && inside_[corner[c]]; };
    if (!inside_[base]) return;
    ++euler_;
    for (int a = 1; a < 8; ++a) {
      if (!in(a)) continue;
      --euler_;
      for (int b = a + 1; b < 8; ++b) {
        if ((a & b) != a || !in(b)) continue;
        ++euler_;
        for (int c = b + 1; c < 8; ++c) {
          if ((b & c) == b && in(c)) --euler_;
        }
      }
    }
  }
  int components(std::uint8_t which) {
    int found = 0;
    for (std::uint32_t v = 0; v < parent_.size(); ++v) found += inside_[v] == which && root(v) == v ? 1 : 0;
    return found;
  }

  std::array<int, 3> n_;
  std::vector<std::uint8_t> inside_;
  std::vector<std::uint32_t> parent_;
  long euler_ = 0;
};

}  // namespace delvox::test
