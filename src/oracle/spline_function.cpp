#include "delvox/oracle/spline_function.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "delvox/core/errors.h"

namespace delvox {
namespace {

constexpr int kDegree = 5, kSupport = kDegree + 1;
/// Layers of padding before the image, the least behind it, and coefficients known beyond them.
constexpr int kPadding = 4, kMargin = 4;
/// In samples: boxes that reach no further into a cell are taken for outside it. The polynomials of neighbouring cells
/// and their third derivatives agree there to far less than what rounding can make of them.
constexpr double kSnap = 1e-9;

using Row = std::array<double, kSupport>;

/// Weights that turn the six coefficients of a cell into the Bernstein coefficients, on a part of it, of a derivative.
struct Weights {
  std::array<Row, kSupport> rows;
  int count = 0;
};

/// The blossom at `u` of a spline segment of degree n on the cell [0, 1], from its n + 1 coefficients.
double blossom(std::array<double, kSupport> f, int n, const std::array<double, kDegree>& u) {
  for (int r = 1; r <= n; ++r) {
    for (int i = n; i >= r; --i) {
      const double low = i - n, high = i - r + 1, share = (u[r - 1] - low) / (high - low);
      f[i] = share * f[i] + (1 - share) * f[i - 1];
    }
  }
  return f[n];
}

/// Of the `order`-th derivative on the part [a, b] of the cell. A single row if that is a point.
Weights weights_on(double a, double b, int order) {
  const int n = kDegree - order;
  Weights weights;
  weights.count = a == b ? 1 : n + 1;
  for (int k = 0; k < weights.count; ++k) {
    std::array<double, kDegree> u{};
    for (int i = 0; i < n; ++i) u[i] = i < n - k ? a : b;
    for (int j = 0; j < kSupport; ++j) {
      std::array<double, kSupport> unit{};
      unit[j] = 1;
      for (int d = 0; d < order; ++d) {
        for (int i = 0; i + 1 < kSupport - d; ++i) unit[i] = unit[i + 1] - unit[i];
      }
      weights.rows[k][j] = blossom(unit, n, u);
    }
  }
  return weights;
}

/// Index i reflected at 0 and n - 1 into [0, n).
int mirrored(int i, int n) {
  const int period = 2 * (n - 1);
  i = std::abs(i) % period;
  return i < n ? i : period - i;
}

/// Coefficients of the spline through n samples, `stride` apart, mirrored at both ends: in place of these. The matrix
/// (1, 26, 66, 26, 1) / 120 is dominated by its diagonal, so that elimination needs no pivots.
void interpolate_line(double* samples, std::size_t stride, int n) {
  constexpr double kAtSamples[] = {66.0 / 120, 26.0 / 120, 1.0 / 120};
  std::vector<std::vector<double>> a(n, std::vector<double>(n + 1, 0.0));
  for (int i = 0; i < n; ++i) {
    for (int offset = -2; offset <= 2; ++offset) a[i][mirrored(i + offset, n)] += kAtSamples[std::abs(offset)];
    a[i][n] = samples[i * stride];
  }
  for (int pivot = 0; pivot < n; ++pivot) {
    for (int i = pivot + 1; i < std::min(n, pivot + 5); ++i) {
      const double multiple = a[i][pivot] / a[pivot][pivot];
      if (multiple == 0) continue;
      for (int j = pivot; j <= n; ++j) a[i][j] -= multiple * a[pivot][j];
    }
  }
  for (int i = n - 1; i >= 0; --i) {
    double rest = a[i][n];
    for (int j = i + 1; j < n; ++j) rest -= a[i][j] * samples[j * stride];
    samples[i * stride] = rest / a[i][i];
  }
}

class SplineFunction final : public SmoothFunction {
 public:
  SplineFunction(const Volume& volume, const LevelSet& level_set) : spacing_(volume.header().spacing()) {
    // A power of two of cells: then boxes of an octree lie within cells, or are made of whole ones.
    const auto& dims = volume.dims();
    const int most = std::max({dims[0], dims[1], dims[2]}) + 2 * kPadding - 1;
    samples_ = static_cast<int>(std::bit_ceil(static_cast<unsigned>(most))) + 1;
    interpolate(padded(volume, level_set));
  }

  /// Where it is defined: the padding included, the first sample of the image at the origin.
  Box3 box() const {
    Box3 box;
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] = -kPadding * spacing_[axis];
      box.max[axis] = (samples_ - 1 - kPadding) * spacing_[axis];
    }
    return box;
  }

  void evaluate(const Point3& p, int order, double* results) const override {
    std::array<Interval, kResults[3]> enclosures;
    enclose({Interval(p.x), Interval(p.y), Interval(p.z)}, order, enclosures.data());
    for (std::size_t i = 0; i < kResults[order]; ++i) results[i] = enclosures[i].middle();
  }

  bool enclose(const IntervalBox& box, int order, Interval* results) const override {
    IntervalBox place;  // in units of samples, the first of the padding at 0
    std::array<int, 3> first, last;
    int cells = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      place[axis] = box[axis] / Interval(spacing_[static_cast<int>(axis)]) + Interval(kPadding);
      if (box[axis].low == box[axis].high) place[axis] = place[axis].middle();
      if (!(place[axis].low > 1 - kMargin && place[axis].high < samples_ - 2 + kMargin)) {
        std::fill(results, results + kResults[order], Interval::all());
        return false;
      }
      first[axis] = static_cast<int>(std::floor(place[axis].low + kSnap));
      last[axis] = std::max(first[axis], static_cast<int>(std::ceil(place[axis].high - kSnap)) - 1);
      cells *= last[axis] - first[axis] + 1;
    }
    constexpr int kFewCells = 8;
    std::fill(results, results + kResults[order], nothing());
    if (cells <= kFewCells) {
      for_each(first, last, [&](const std::array<int, 3>& cell) { enclose_in_cell(cell, place, order, results); });
    } else {
      enclose_by_coefficients(first, last, order, results);
    }
    to_millimetres(order, results);
    return true;
  }

 private:
  /// An enclosure of no number.
  static Interval nothing() { return {Interval::all().high, Interval::all().low}; }

  /// level - g, so that inside is at most 0, with layers of padding that rise outward: far enough that no oscillation
  /// of the spline comes back to 0.
  std::vector<double> padded(const Volume& volume, const LevelSet& level_set) const {
    const std::array<int, 3> size{volume.dims()[0] + 2, volume.dims()[1] + 2, volume.dims()[2] + 2};
    std::vector<float> once(static_cast<std::size_t>(size[0]) * size[1] * size[2]);
    copy_padded_block(volume, level_set, {-1, -1, -1}, size, once.data());
    double highest = 0;
    for (float g : once) highest = std::max(highest, std::abs(level_set.level - static_cast<double>(g)));
    std::vector<double> all;
    for_each({0, 0, 0}, {samples_ - 1, samples_ - 1, samples_ - 1}, [&](const std::array<int, 3>& at) {
      std::array<std::size_t, 3> from;
      int beyond = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const int wanted = at[axis] - kPadding + 1, there = std::clamp(wanted, 0, size[axis] - 1);
        from[axis] = static_cast<std::size_t>(there);
        beyond = std::max(beyond, std::abs(wanted - there));
      }
      const auto g = static_cast<double>(once[(from[2] * size[1] + from[1]) * size[0] + from[0]]);
      all.push_back(level_set.level - g + highest * std::min(beyond, kPadding - 1) / (kPadding - 1));
    });
    return all;
  }

  void interpolate(std::vector<double> values) {
    const auto n = static_cast<std::size_t>(samples_);
    const std::array<std::size_t, 3> stride{1, n, n * n};
    for (int axis = 0; axis < 3; ++axis) {
      std::array<int, 3> end{samples_ - 1, samples_ - 1, samples_ - 1};
      end[axis] = 0;
      for_each({0, 0, 0}, end, [&](const std::array<int, 3>& at) {
        double* line = values.data() + at[0] * stride[0] + at[1] * stride[1] + at[2] * stride[2];
        interpolate_line(line, stride[axis], samples_);
      });
    }
    double largest = 0;
    known_ = samples_ + 2 * (kMargin + 2);
    for_each({0, 0, 0}, {known_ - 1, known_ - 1, known_ - 1}, [&](const std::array<int, 3>& at) {
      std::size_t from = 0;
      for (int axis = 0; axis < 3; ++axis) from += mirrored(at[axis] - kMargin - 2, samples_) * stride[axis];
      coefficients_.push_back(values[from]);
      largest = std::max(largest, std::abs(values[from]));
    });
    // Enclosures are sums of some hundred products with weights that add up to 8 at most.
    rounding_ = 1e-13 * largest;
  }

  /// Calls visit(i, j, k) from first to last, i fastest.
  template <class Visit>
  static void for_each(const std::array<int, 3>& first, const std::array<int, 3>& last, const Visit& visit) {
    for (int k = first[2]; k <= last[2]; ++k) {
      for (int j = first[1]; j <= last[1]; ++j) {
        for (int i = first[0]; i <= last[0]; ++i) visit(std::array<int, 3>{i, j, k});
      }
    }
  }

  /// The coefficient at sample (i, j, k) of the padded grid.
  const double& coefficient(int i, int j, int k) const {
    constexpr int kShift = kMargin + 2;
    return coefficients_[(static_cast<std::size_t>(k + kShift) * known_ + (j + kShift)) * known_ + i + kShift];
  }

  /// Calls visit(number, axes) for the derivatives up to an order: how often along each axis.
  template <class Visit>
  static void for_each_derivative(int order, const Visit& visit) {
    std::size_t number = 0;
    for (int total = 0; total <= order; ++total) {
      for (int x = total; x >= 0; --x) {
        for (int y = total - x; y >= 0; --y) visit(number++, std::array<int, 3>{x, y, total - x - y});
      }
    }
  }

  static void include(Interval& enclosure, double low, double high) {
    enclosure = {std::min(enclosure.low, low), std::max(enclosure.high, high)};
  }

  void enclose_in_cell(const std::array<int, 3>& cell, const IntervalBox& place, int order, Interval* results) const {
    std::array<std::array<Weights, 4>, 3> weights;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = std::max(place[axis].low - cell[axis], -kSnap);
      const double b = std::min(place[axis].high - cell[axis], 1 + kSnap);
      for (int d = 0; d <= order; ++d) weights[axis][d] = weights_on(a, b, d);
    }
    std::array<double, kSupport * kSupport * kSupport> c;
    for (int k = 0, at = 0; k < kSupport; ++k) {
      for (int j = 0; j < kSupport; ++j) {
        for (int i = 0; i < kSupport; ++i, ++at) {
          c[at] = coefficient(cell[0] - 2 + i, cell[1] - 2 + j, cell[2] - 2 + k);
        }
      }
    }
    for (int z = 0; z <= order; ++z) {
      for (int row = 0; row < weights[2][z].count; ++row) {
        Plane plane{};
        for (int k = 0; k < kSupport; ++k) {
          const double weight = weights[2][z].rows[row][k];
          const double* layer = c.data() + k * plane.size();
          for (std::size_t i = 0; i < plane.size(); ++i) plane[i] += weight * layer[i];
        }
        enclose_in_plane(plane, weights, z, order, results);
      }
    }
  }

  using Plane = std::array<double, kSupport * kSupport>;

  /// What is left once a derivative along z, at one of its Bernstein coefficients, is taken.
  void enclose_in_plane(const Plane& plane, const std::array<std::array<Weights, 4>, 3>& weights, int z, int order,
                        Interval* results) const {
    for (int y = 0; y <= order - z; ++y) {
      for (int row = 0; row < weights[1][y].count; ++row) {
        Row line{};
        for (int j = 0; j < kSupport; ++j) {
          const double weight = weights[1][y].rows[row][j];
          for (int i = 0; i < kSupport; ++i) line[i] += weight * plane[j * kSupport + i];
        }
        for (int x = 0; x <= order - z - y; ++x) {
          Interval& result = results[number_of(x, y, z)];
          for (int at = 0; at < weights[0][x].count; ++at) {
            double coefficient = 0;
            for (int i = 0; i < kSupport; ++i) coefficient += weights[0][x].rows[at][i] * line[i];
            include(result, coefficient - rounding_, coefficient + rounding_);
          }
        }
      }
    }
  }

  /// Where SmoothFunction has the derivative taken so often along each axis.
  static std::size_t number_of(int x, int y, int z) {
    const int total = x + y + z;
    return (total > 0 ? kResults[total - 1] : 0) + static_cast<std::size_t>((y + z) * (y + z + 1) / 2 + z);
  }

  /// Splines lie within the hull of their coefficients; those of derivatives are differences.
  void enclose_by_coefficients(const std::array<int, 3>& first, const std::array<int, 3>& last, int order,
                               Interval* results) const {
    for_each_derivative(order, [&](std::size_t number, const std::array<int, 3>& d) {
      const std::array<int, 3> from{first[0] - 2, first[1] - 2, first[2] - 2};
      const std::array<int, 3> to{last[0] + 3 - d[0], last[1] + 3 - d[1], last[2] + 3 - d[2]};
      for_each(from, to, [&](const std::array<int, 3>& at) {
        const double c = difference(at, d);
        include(results[number], c - rounding_, c + rounding_);
      });
    });
  }

  double difference(const std::array<int, 3>& at, const std::array<int, 3>& d) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (d[axis] == 0) continue;
      std::array<int, 3> next = at, fewer = d;
      ++next[axis], --fewer[axis];
      return difference(next, fewer) - difference(at, fewer);
    }
    return coefficient(at[0], at[1], at[2]);
  }

  void to_millimetres(int order, Interval* results) const {
    for_each_derivative(order, [&](std::size_t number, const std::array<int, 3>& d) {
      double unit = 1;
      for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < d[axis]; ++i) unit *= spacing_[axis];
      }
      results[number] = results[number] / widened(unit, unit, 4);
    });
  }

  Vector3 spacing_;
  int samples_ = 0, known_ = 0;  // along each axis: with padding, and the coefficients
  std::vector<double> coefficients_;
  double rounding_ = 0;
};

/// From millimetres along the image's axes to the world.
Affine3 image_to_world(const VolumeHeader& header) {
  Affine3 result = header.index_to_world;
  const Vector3 spacing = header.spacing();
  for (int axis = 0; axis < 3; ++axis) {
    for (int row = 0; row < 3; ++row) result.rows[row][axis] /= spacing[axis];
    for (int other = 0; other < axis; ++other) {
      if (std::abs(dot(result.column(axis), result.column(other))) > 1e-4) {
        throw OptionError("DelSurf2: the axes of the volume are not orthogonal; --resample it");
      }
    }
  }
  return result;
}

}  // namespace

SmoothDomain make_spline_domain(const Volume& volume, const Isosurface& surface) {
  const auto& dims = volume.dims();
  if (std::max({dims[0], dims[1], dims[2]}) > kMostSplineSamples) {
    throw OptionError("DelSurf2: " + std::to_string(dims[0]) + " x " + std::to_string(dims[1]) + " x " +
                      std::to_string(dims[2]) +
                      " voxels are too many for its searches, 32 x 32 x 32 is the most; "
                      "--crop or --resample the volume, or take delsurf");
  }
  const Affine3 to_world = image_to_world(volume.header());
  auto spline = std::make_unique<SplineFunction>(volume, LevelSet(surface));
  const Box3 box = spline->box();
  return {std::move(spline), box, to_world};
}

}  // namespace delvox
