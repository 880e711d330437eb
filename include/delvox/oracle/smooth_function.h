#pragma once

#include <cstddef>
#include <memory>

#include "delvox/core/geometry.h"
#include "delvox/oracle/interval.h"

namespace delvox {

/// A function of space with three continuous derivatives, given by its values and by enclosures of them over boxes:
/// what it takes to find every critical point of its zero set, and to know that none is missed (delsurf2.h).
/// Calls are thread-safe.
class SmoothFunction {
 public:
  virtual ~SmoothFunction() = default;

  /// How many results there are up to each order of derivatives, in the order value, x, y, z, xx, xy, xz, yy, yz, zz,
  /// xxx, xxy, xxz, xyy, xyz, xzz, yyy, yyz, yzz, zzz.
  static constexpr std::size_t kResults[] = {1, 4, 10, 20};
  /// Which of these the second and third derivatives along some axes are.
  static constexpr std::size_t kSecond[3][3] = {{4, 5, 6}, {5, 7, 8}, {6, 8, 9}};
  static constexpr std::size_t kThird[3][3][3] = {{{10, 11, 12}, {11, 13, 14}, {12, 14, 15}},
                                                  {{11, 13, 14}, {13, 16, 17}, {14, 17, 18}},
                                                  {{12, 14, 15}, {14, 17, 18}, {15, 18, 19}}};

  /// The value at a point, and the derivatives up to `order` (0 to 3): kResults[order] numbers.
  virtual void evaluate(const Point3& p, int order, double* results) const = 0;
  /// The same as enclosures of what they are anywhere in a box. False if the function may have a kink, jump or pole
  /// there: then only the first result means anything.
  virtual bool enclose(const IntervalBox& box, int order, Interval* results) const = 0;
};

/// A domain {function <= 0} inside a box, and where it lies in the world.
struct SmoothDomain {
  std::unique_ptr<SmoothFunction> function;
  Box3 box;
  Affine3 to_world;  ///< an isometry from the function's coordinates, mm; it may mirror
};

}  // namespace delvox
