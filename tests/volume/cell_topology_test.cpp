#include "volume/cell_topology.h"

#include <gtest/gtest.h>

#include <random>

#include "support/brute_force_topology.h"

namespace delvox {
namespace {

using Values = std::array<float, 8>;

double trilinear(const Values& v, double x, double y, double z) {
  double sum = 0;
  for (int c = 0; c < 8; ++c) sum += v[c] * (c & 1 ? x : 1 - x) * (c & 2 ? y : 1 - y) * (c & 4 ? z : 1 - z);
  return sum;
}

unsigned mask_of(const Values& v, double level) {
  unsigned mask = 0;
  for (int c = 0; c < 8; ++c) mask |= (v[c] > level ? 1u : 0u) << c;
  return mask;
}

bool agrees_at(const Values& v, double level, int n, const CellTopology& exact) {
  test::BruteForceTopology brute({n, n, n}, [&](int i, int j, int k) {
    return trilinear(v, i / double(n), j / double(n), k / double(n)) - level;
  });
  if (brute.euler() != exact.euler) return false;
  for (int a = 0; a < 8; ++a) {
    for (int b = a + 1; b < 8; ++b) {
      const auto component = [&](int c) { return brute.component_of(n * (c & 1), n * (c >> 1 & 1), n * (c >> 2)); };
      if ((component(a) == component(b)) != (exact.group[a] == exact.group[b])) return false;
    }
  }
  return true;
}

// The brute force is right once its grid resolves the cell: refine until it agrees.
bool agrees_when_refined(const Values& v, double level, const CellTopology& exact) {
  for (int n : {12, 24, 48, 96, 160}) {
    if (agrees_at(v, level, n, exact)) return true;
  }
  return false;
}

std::string print(const Values& v) {
  std::string text;
  for (float x : v) text += std::to_string(x) + " ";
  return text;
}

CellTopology exact_topology(const Values& v, double level) { return cell_topology(v, level); }

// Renames the corners by a symmetry of the cube: axes permuted, some turned round.
std::array<int, 8> symmetry(int which) {
  static constexpr int kAxes[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  std::array<int, 8> map;
  for (int c = 0; c < 8; ++c) {
    map[c] = 0;
    for (int axis = 0; axis < 3; ++axis) {
      map[c] |= ((c >> axis & 1) ^ (which / 6 >> axis & 1)) << kAxes[which % 6][axis];
    }
  }
  return map;
}

void expect_symmetric(const Values& v, double level) {
  const CellTopology reference = exact_topology(v, level);
  for (int s = 1; s < 48; ++s) {
    const std::array<int, 8> map = symmetry(s);
    Values w;
    for (int c = 0; c < 8; ++c) w[map[c]] = v[c];
    const CellTopology turned = exact_topology(w, level);
    ASSERT_EQ(turned.euler, reference.euler) << print(v);
    ASSERT_EQ(turned.face_parts, reference.face_parts) << print(v);
    for (int a = 0; a < 8; ++a) {
      for (int b = 0; b < 8; ++b) {
        ASSERT_EQ(turned.group[map[a]] == turned.group[map[b]], reference.group[a] == reference.group[b]) << print(v);
      }
    }
  }
}

TEST(CellTopology, RandomCellsAgreeWithBruteForceForAllSigns) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> magnitude(0.05f, 1.0f);
  int mismatches = 0;
  for (unsigned mask = 0; mask < 256; ++mask) {
    for (int repeat = 0; repeat < (is_ambiguous(mask) ? 40 : 4); ++repeat) {
      Values v;
      for (int c = 0; c < 8; ++c) v[c] = (mask >> c & 1 ? 1 : -1) * magnitude(random);
      if (agrees_when_refined(v, 0, exact_topology(v, 0))) continue;
      ++mismatches;
      ADD_FAILURE() << "mask " << mask << ": " << print(v);
    }
  }
  EXPECT_EQ(mismatches, 0);
}

TEST(CellTopology, AlternatingCornersAgreeWithBruteForce) {
  // Chernyaev's case 13, where nearly all tunnels live.
  std::mt19937 random(2);
  std::uniform_real_distribution<float> magnitude(0.2f, 1.0f);
  int tunnels = 0;
  for (int repeat = 0; repeat < 1500; ++repeat) {
    Values v;
    for (int c = 0; c < 8; ++c) v[c] = (0x96 >> c & 1 ? 1 : -1) * magnitude(random);
    const CellTopology exact = exact_topology(v, 0);
    int groups = 0;
    for (int c = 0; c < 8; ++c) groups += (0x96 >> c & 1) != 0 && exact.group[c] == c ? 1 : 0;
    tunnels += groups - exact.euler;
    EXPECT_TRUE(agrees_when_refined(v, 0, exact)) << print(v);
  }
  EXPECT_GT(tunnels, 5);
}

TEST(CellTopology, IntegerCellsAgreeWithBruteForceAtAShiftedLevel) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> integer(0, 3);
  for (int repeat = 0; repeat < 2000; ++repeat) {
    Values v;
    for (float& x : v) x = static_cast<float>(integer(random));
    if (!is_ambiguous(mask_of(v, 1.93))) continue;
    EXPECT_TRUE(agrees_when_refined(v, 1.93, exact_topology(v, 1.93))) << print(v);
  }
}

TEST(CellTopology, TiesAreSettledAsIfTheLevelWereALittleLower) {
  std::mt19937 random(4);
  std::uniform_int_distribution<int> integer(0, 3);
  const double half_step = 2.0 - std::ldexp(1.0, -24);
  for (int repeat = 0; repeat < 200000; ++repeat) {
    Values v;
    for (float& x : v) x = static_cast<float>(integer(random));
    const CellTopology nudged = exact_topology(v, half_step), lower = exact_topology(v, 2 - 1e-4);
    ASSERT_EQ(nudged.euler, lower.euler) << print(v);
    ASSERT_EQ(nudged.face_parts, lower.face_parts) << print(v);
    ASSERT_EQ(nudged.group, lower.group) << print(v);
  }
}

TEST(CellTopology, DoesNotDependOnTheAxisOfTheSweep) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> integer(0, 3);
  std::normal_distribution<float> normal;
  const double half_step = 2.0 - std::ldexp(1.0, -24);
  for (int repeat = 0; repeat < 4000; ++repeat) {
    Values integers, reals, alternating;
    for (float& x : integers) x = static_cast<float>(integer(random));
    for (float& x : reals) x = normal(random);
    for (int c = 0; c < 8; ++c) alternating[c] = (0x96 >> c & 1 ? 1 : -1) * (0.2f + std::abs(normal(random)));
    expect_symmetric(integers, half_step);
    expect_symmetric(reals, 0);
    expect_symmetric(alternating, 0);
  }
}

TEST(CellTopology, ComplementHasTheSameGroups) {
  std::mt19937 random(6);
  std::normal_distribution<float> normal;
  for (int repeat = 0; repeat < 20000; ++repeat) {
    Values v, negated;
    for (int c = 0; c < 8; ++c) {
      v[c] = normal(random);
      negated[c] = -v[c];
    }
    ASSERT_EQ(exact_topology(v, 0).group, exact_topology(negated, 0).group) << print(v);
  }
}

TEST(CellTopology, FarFromTheLevelAndNearItTheSignsHold) {
  // All products cancel to the last bits: the integers decide, in every symmetry the same.
  std::mt19937 random(7);
  std::uniform_int_distribution<int> step(0, 300);
  for (int repeat = 0; repeat < 2000; ++repeat) {
    Values v;
    for (int c = 0; c < 8; ++c) {
      float x = 1.0f;
      for (int s = step(random); s > 0; --s) x = std::nextafter(x, 2.0f);
      v[c] = 0x96 >> c & 1 ? x : -x;
    }
    expect_symmetric(v, 0);
  }
}

TEST(CellTopology, SimpleMasksNeedNoValues) {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> magnitude(0.01f, 1.0f);
  for (unsigned mask = 0; mask < 256; ++mask) {
    if (is_ambiguous(mask)) continue;
    for (int repeat = 0; repeat < 50; ++repeat) {
      Values v;
      for (int c = 0; c < 8; ++c) v[c] = (mask >> c & 1 ? 1 : -1) * magnitude(random);
      ASSERT_EQ(exact_topology(v, 0).weight(mask), weight_of_simple_cell(mask));
    }
  }
}

TEST(CellTopology, InsideFractionIsExactForPlanesAndCloseOtherwise) {
  EXPECT_NEAR(inside_fraction({0, 1, 0, 1, 0, 1, 0, 1}, 0.3), 0.7, 1e-7);
  EXPECT_NEAR(inside_fraction({0, 0, 1, 1, 0, 0, 1, 1}, 0.5), 0.5, 1e-7);
  std::mt19937 random(9);
  std::normal_distribution<float> normal;
  for (int repeat = 0; repeat < 200; ++repeat) {
    Values v;
    for (float& x : v) x = normal(random);
    int inside = 0;
    constexpr int kN = 40;
    for (int s = 0; s < kN * kN * kN; ++s) {
      inside += trilinear(v, (s % kN + 0.5) / kN, (s / kN % kN + 0.5) / kN, (s / kN / kN + 0.5) / kN) > 0 ? 1 : 0;
    }
    EXPECT_NEAR(inside_fraction(v, 0), inside / double(kN * kN * kN), 0.06) << print(v);
  }
}

}  // namespace
}  // namespace delvox
