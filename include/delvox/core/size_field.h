#pragma once

#include <functional>

#include "delvox/core/geometry.h"

namespace delvox {

/// Upper bound on something's radius as a function of place, mm: the size field lambda of the book (14.1).
class SizeField {
 public:
  /// The same everywhere. pre: size > 0.
  SizeField(double size) : minimum_(size), maximum_(size) {}  // NOLINT: a number is a size field
  /// `field` must be deterministic, thread-safe and lie within [minimum, maximum], minimum > 0.
  SizeField(std::function<double(const Point3&)> field, double minimum, double maximum)
      : field_(std::move(field)), minimum_(minimum), maximum_(maximum) {}

  double operator()(const Point3& p) const { return field_ ? field_(p) : maximum_; }
  bool constant() const { return !field_; }
  double minimum() const { return minimum_; }
  double maximum() const { return maximum_; }

 private:
  std::function<double(const Point3&)> field_;
  double minimum_, maximum_;
};

/// A size field `factor` times as large. pre: factor > 0.
inline SizeField scaled(const SizeField& size, double factor) {
  if (size.constant()) return SizeField(factor * size.maximum());
  return SizeField([size, factor](const Point3& p) { return factor * size(p); }, factor * size.minimum(),
                   factor * size.maximum());
}

}  // namespace delvox
