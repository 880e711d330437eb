#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "delvox/oracle/formula.h"
#include "delvox/volume/voxel_topology.h"
#include "support/random.h"

namespace delvox::test {

/// Formulas of any larger genus are as welcome as of this.
inline constexpr long kMostGenus = 5;

/// A smooth formula whose surface lies inside the box, and what that surface is, known apart from the meshers.
struct KnownFormula {
  std::string text;
  Box3 box;
  VoxelTopology topology;
};

/// Of all components together.
inline long genus_of(const VoxelTopology& topology) {
  return static_cast<long>(topology.surface_components) - topology.euler / 2;
}

/// Writes random smooth formulas of several kinds for the box [-2, 2]^3.
class FormulaWriter {
 public:
  explicit FormulaWriter(Random& random) : random_(random) {}

  std::string write() {
    switch (random_.below(6)) {
      case 0: return blobs();
      case 1: return waves();
      case 2: return product_of_rings();
      case 3: return nested();
      case 4: return handles();
      default: return quartic();
    }
  }

 private:
  std::string number(double value) const {
    char text[32];
    std::snprintf(text, sizeof text, value < 0 ? "(%.4f)" : "%.4f", value);
    return text;
  }
  std::string between(double low, double high) { return number(random_.between(low, high)); }

  /// A linear form; `unit`: of a random direction.
  std::string linear(const Vector3& a, const Point3& from) const {
    const std::string x = "(x-" + number(from.x) + ")", y = "(y-" + number(from.y) + ")",
                      z = "(z-" + number(from.z) + ")";
    return "(" + number(a.x) + "*" + x + "+" + number(a.y) + "*" + y + "+" + number(a.z) + "*" + z + ")";
  }
  std::string squared_distance(const Point3& from) const {
    return "((x-" + number(from.x) + ")^2+(y-" + number(from.y) + ")^2+(z-" + number(from.z) + ")^2)";
  }
  Point3 center(double reach) { return random_.in({{-reach, -reach, -reach}, {reach, reach, reach}}); }

  /// Metaballs, some of them negative.
  std::string blobs() {
    const int count = 3 + random_.below(6);
    std::string sum = between(0.25, 0.6);
    for (int i = 0; i < count; ++i) {
      const bool hollow = i > 2 && random_.below(3) == 0;
      sum += std::string(hollow ? "+" : "-") + between(0.7, 1.2) + "*exp(-" + between(2.5, 8) + "*" +
             squared_distance(center(1)) + ")";
    }
    return sum;
  }

  /// Trigonometric, held together by a power of the distance from the middle.
  std::string waves() {
    std::string sum = "(x^2+y^2+z^2)^2/" + between(5, 9) + "-" + between(0.2, 1);
    for (int i = 0; i < 3; ++i) {
      const Vector3 k = random_.between(2, 4.5) * random_.direction(),
                    l = random_.between(2, 4.5) * random_.direction();
      sum += "+" + between(0.6, 1.2) + "*sin(" + linear(k, {}) + ")*cos(" + linear(l, center(1)) + ")";
    }
    return sum;
  }

  /// Zero on a ring, positive elsewhere.
  std::string ring(const Point3& c, const Vector3& axis, double radius) {
    return "((" + squared_distance(c) + "-" + number(radius * radius) + ")^2+" + number(4 * radius * radius) + "*" +
           linear(axis, c) + "^2)";
  }

  /// Two or three rings, linked, apart or grown together.
  std::string product_of_rings() {
    const int count = 2 + random_.below(2);
    std::string product;
    for (int i = 0; i < count; ++i) {
      const double radius = random_.between(0.5, 0.9);
      const double thickness = random_.between(0.1, 0.25);
      const std::string tube = "(" + ring(center(0.6), random_.direction(), radius) + "-" +
                               number(4 * radius * radius * thickness * thickness) + ")";
      product += (i > 0 ? "*" : "") + tube;
    }
    return product + (random_.below(2) == 0 ? "-" : "+") + between(0.002, 0.03);
  }

  /// Shells in each other, wavy.
  std::string nested() {
    const double inner = random_.between(0.3, 0.5), middle = inner + random_.between(0.25, 0.4);
    const double outer = middle + random_.between(0.25, 0.4);
    std::string product;
    for (double radius : {inner, middle, outer}) {
      product += (product.empty() ? "" : "*") + std::string("(") + squared_distance(center(0.05)) + "+" +
                 between(-0.05, 0.05) + "*sin(" + between(2, 5) + "*x)-" + number(radius * radius) + ")";
    }
    return product;
  }

  /// A plate with holes: planar curves of a chain of rings, thickened.
  std::string handles() {
    const int holes = 2 + random_.below(5);
    std::string product;
    const double turn = random_.between(0, 1);
    for (int i = 0; i < holes; ++i) {
      const double angle = 2 * std::numbers::pi * (i + turn) / holes;
      const double reach = holes < 4 ? 0.45 : 0.8, radius = random_.between(0.4, 0.55);
      const std::string circle = "((x-" + number(reach * std::cos(angle)) + ")^2+(y-" +
                                 number(reach * std::sin(angle)) + ")^2-" + number(radius * radius) + ")";
      product += (i > 0 ? "*" : "") + circle;
    }
    return "(" + product + ")^2+" + between(0.3, 1) + "*z^2-" + between(0.002, 0.02);
  }

  /// A quartic with random lower terms.
  std::string quartic() {
    std::string sum = "x^4+y^4+z^4-" + between(0.2, 0.8);
    for (const char* term : {"x^2", "y^2", "z^2"}) sum += "-" + between(0.8, 2) + "*" + std::string(term);
    for (const char* term : {"x*y", "y*z", "z*x", "x*y*z", "x^2*y", "y^2*z", "z^2*x"}) {
      sum += "+" + between(-0.5, 0.5) + "*" + std::string(term);
    }
    return sum + "+" + between(0.3, 1.2);
  }

  Random& random_;
};

/// The formula on n^3 points of the box, positive inside.
inline Volume sampled(const Formula& formula, const Box3& box, int n) {
  VolumeHeader header;
  header.dims = {n, n, n};
  for (int axis = 0; axis < 3; ++axis) {
    header.index_to_world.rows[axis][axis] = (box.max[axis] - box.min[axis]) / (n - 1);
    header.index_to_world.rows[axis][3] = box.min[axis];
  }
  std::vector<float> samples;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        samples.push_back(static_cast<float>(-formula.value(header.index_to_world({double(i), double(j), double(k)}))));
      }
    }
  }
  return Volume(header, samples);
}

/// How far trilinear interpolation is off in the middle of the cells that the surface crosses, at most.
inline double interpolation_error(const Formula& formula, const Volume& volume) {
  const int n = volume.dims()[0];
  const std::vector<float> samples = volume.samples();
  const auto at = [&](int i, int j, int k) { return samples[static_cast<std::size_t>((k * n + j) * n + i)]; };
  double error = 0;
  for (int k = 0; k + 1 < n; ++k) {
    for (int j = 0; j + 1 < n; ++j) {
      for (int i = 0; i + 1 < n; ++i) {
        double sum = 0;
        int inside = 0;
        for (int corner = 0; corner < 8; ++corner) {
          const float sample = at(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2));
          sum += static_cast<double>(sample);
          inside += sample > 0;
        }
        if (inside == 0 || inside == 8) continue;
        const Point3 middle = volume.header().index_to_world({i + 0.5, j + 0.5, k + 0.5});
        error = std::max(error, std::abs(-formula.value(middle) - sum / 8));
      }
    }
  }
  return error;
}

/// A count without the volume, which moves as the grid gets finer.
inline VoxelTopology count_at(const Volume& volume, double isovalue) {
  VoxelTopology found = count_topology(volume, {isovalue, false});
  found.volume_mm3 = 0;
  return found;
}

/// Is the domain neither empty nor everything, and away from the border of the volume?
inline bool lies_inside(const Volume& volume) {
  if (!(volume.max() > 0) || !(volume.min() < 0)) return false;
  const int n = volume.dims()[0];
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int end : {0, n - 1}) {
        if (std::max({volume.value(i, j, end), volume.value(i, end, j), volume.value(end, i, j)}) > 0) return false;
      }
    }
  }
  return true;
}

/// What the surface of a formula is, by exact counts on trilinear functions (voxel_topology.h) that agree over two
/// doublings of the grid, and if the level is moved up and down by twice what interpolation errs on the finest; none if
/// they do not, if the domain is empty or reaches the border of the box, or if the genus is not that wanted, if any: from
/// kMostGenus on, or exactly that.
inline std::optional<VoxelTopology> topology_by_voxels(const Formula& formula, const Box3& box,
                                                       std::optional<long> genus) {
  std::optional<VoxelTopology> known;
  for (int n : {31, 61, 121}) {
    const Volume volume = sampled(formula, box, n);
    if (!lies_inside(volume)) return std::nullopt;
    const VoxelTopology found = count_at(volume, 0);
    if (genus && std::min(genus_of(found), kMostGenus) != *genus) return std::nullopt;
    if (known && *known != found) return std::nullopt;
    known = found;
    if (n < 121) continue;
    const double error = 2 * interpolation_error(formula, volume);
    for (double level : {-error, error}) {
      if (count_at(volume, level) != found) return std::nullopt;
    }
  }
  return known;
}

/// The formula of that number: the first of a sequence that is not ambiguous. Of the first ones, each genus from 1 on
/// in its turn: left to chance, nine of ten have none.
inline KnownFormula known_formula(std::uint64_t number) {
  Random random(1000 * number + 1);
  constexpr std::uint64_t kOfEachGenus = 4;
  std::optional<long> genus;
  if (number < kOfEachGenus * kMostGenus) genus = 1 + static_cast<long>(number % kMostGenus);
  const Box3 box{{-2, -2, -2}, {2, 2, 2}};
  for (;;) {
    const std::string text = FormulaWriter(random).write();
    if (const auto topology = topology_by_voxels(Formula(text), box, genus)) return {text, box, *topology};
  }
}

}  // namespace delvox::test
