#pragma once

#ifdef __SSE2__
#include <emmintrin.h>
#else
#include <cmath>
#endif

#include "delvox/core/geometry.h"

namespace delvox {

/// Two numbers that are computed with at a time; each is rounded as it would be alone.
using Pair = double __attribute__((vector_size(16)));

/// Two points or vectors.
struct PairVector {
  Pair x, y, z;

  static PairVector of(const Point3& a, const Point3& b) { return {Pair{a.x, b.x}, Pair{a.y, b.y}, Pair{a.z, b.z}}; }
};

inline PairVector operator+(const PairVector& a, const PairVector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline PairVector operator-(const PairVector& a, const PairVector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline PairVector operator*(Pair s, const PairVector& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Pair dot(const PairVector& a, const PairVector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline PairVector cross(const PairVector& a, const PairVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Pair squared_norm(const PairVector& a) { return dot(a, a); }
inline Pair min(Pair a, Pair b) { return b < a ? b : a; }
inline Pair max(Pair a, Pair b) { return a < b ? b : a; }
inline Pair abs(Pair a) { return a < 0 ? -a : a; }
inline Pair sqrt(Pair a) {
#ifdef __SSE2__
  return _mm_sqrt_pd(a);
#else
  return {std::sqrt(a[0]), std::sqrt(a[1])};
#endif
}
inline Pair norm(const PairVector& a) { return sqrt(squared_norm(a)); }

}  // namespace delvox
