#include "volume/cell_topology.h"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>

#include "core/pair_geometry.h"

namespace delvox {
namespace {

using Integer = boost::multiprecision::cpp_int;

// Corners of a face in circular order.
constexpr int kFaces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
constexpr int kEdges[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3},
                               {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
// Lower corners of the four strands (edges along z), in circular order.
constexpr int kStrands[4] = {0, 1, 3, 2};

bool bit(unsigned mask, int corner) { return (mask >> corner & 1) != 0; }

// Thrown where the interval arithmetic cannot tell a sign.
struct Uncertain {};

// A double and a bound on its distance from the true value.
struct Bounded {
  double value = 0, error = 0;
  friend Bounded operator+(Bounded a, Bounded b) { return rounded(a.value + b.value, a.error + b.error); }
  friend Bounded operator-(Bounded a, Bounded b) { return rounded(a.value - b.value, a.error + b.error); }
  friend Bounded operator*(Bounded a, Bounded b) {
    return rounded(a.value * b.value,
                   std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error);
  }
  static Bounded rounded(double value, double error) {
    constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
    return {value, (error + kEpsilon * std::abs(value)) * (1 + 8 * kEpsilon)};
  }
};

int sign(const Bounded& x) {
  if (!(std::abs(x.value) > x.error)) throw Uncertain();
  return x.value > 0 ? 1 : -1;
}
int sign(const Integer& x) { return x.sign(); }

// A place on (0, 1) as p / (p + q): roots of linear functions need no division then.
template <class Number>
struct Place {
  Number p, q;
  int known_sign = 0;  // of Q (see sign_beside) there; 0: must be evaluated
  bool closed = false;
};

template <class Number>
bool before(const Place<Number>& a, const Place<Number>& b) { return sign(a.p * b.q - b.p * a.q) < 0; }

enum class Slab {
  kEmpty,     // at no height are two opposite strands inside and the other two outside
  kJoined,    // the two inside strands are joined at all such heights
  kSeparate,  // at none
  kHalf,      // separate up to some height, joined beyond
  kInsideTunnel,   // joined, separate, joined
  kOutsideTunnel,  // separate, joined, separate
};

// What happens at the heights where strands a and c are inside, b and d outside.
template <class Number>
class SlabAnalysis {
 public:
  SlabAnalysis(const std::array<Number, 8>& values, unsigned mask, int first)
      : values_(values), mask_(mask), strands_{kStrands[first], kStrands[(first + 1) % 4], kStrands[(first + 2) % 4],
                                               kStrands[(first + 3) % 4]} {}

  Slab run() {
    if (!find_ends()) return Slab::kEmpty;
    const auto [a, b, c, d] = strands_;
    constant_ = v(a) * v(c) - v(b) * v(d);
    half_linear_ = v(a) * v(c + 4) + v(a + 4) * v(c) - v(b) * v(d + 4) - v(b + 4) * v(d);  // twice the half
    quadratic_ = v(a + 4) * v(c + 4) - v(b + 4) * v(d + 4);
    const int at_low = sign_beside(low_, +1), at_high = sign_beside(high_, -1);
    if (at_low != at_high) return Slab::kHalf;
    const bool turns = at_low * slope_sign(low_) < 0 && at_low * slope_sign(high_) > 0;
    const int discriminant = turns ? sign(half_linear_ * half_linear_ - four() * constant_ * quadratic_) : -1;
    if (at_low > 0) return discriminant >= 0 ? Slab::kInsideTunnel : Slab::kJoined;
    return discriminant > 0 ? Slab::kOutsideTunnel : Slab::kSeparate;
  }

 private:
  const Number& v(int corner) const { return values_[corner]; }
  static Number two() { return number(2); }
  static Number four() { return number(4); }
  static Number number(int n) {
    if constexpr (std::is_same_v<Number, Bounded>) return {static_cast<double>(n), 0};
    else return n;
  }

  // The heights in question form an interval between roots of the strands, open where an inside strand ends.
  bool find_ends() {
    low_ = {number(0), number(1), 0, false};
    high_ = {number(1), number(0), 0, false};
    for (int s = 0; s < 4; ++s) {
      const bool wants_inside = s % 2 == 0;
      const bool bottom = bit(mask_, strands_[s]) == wants_inside, top = bit(mask_, strands_[s] + 4) == wants_inside;
      if (!bottom && !top) return false;
      if (bottom && top) continue;
      const Number below = v(strands_[s]), above = v(strands_[s] + 4);
      const bool positive_below = bit(mask_, strands_[s]);
      const Place<Number> root{positive_below ? below : number(0) - below, positive_below ? number(0) - above : above,
                               wants_inside ? -1 : +1, !wants_inside};
      if (bottom) narrow(high_, root, before(root, high_), before(high_, root));
      else narrow(low_, root, before(low_, root), before(root, low_));
    }
    if (before(low_, high_)) return true;
    return !before(high_, low_) && low_.closed && high_.closed;
  }

  static void narrow(Place<Number>& end, const Place<Number>& root, bool tighter, bool looser) {
    if (tighter) {
      end = root;
    } else if (!looser && end.known_sign != root.known_sign) {  // both at once: Q vanishes there
      end.known_sign = 0;
      end.closed = end.closed && root.closed;
    }
  }

  // Sign of dQ/dt, t = p / q, up to a positive factor.
  int slope_sign(const Place<Number>& at) const { return sign(two() * quadratic_ * at.p + half_linear_ * at.q); }

  // Sign of Q next to an end, going up or down.
  int sign_beside(const Place<Number>& end, int direction) const {
    if (end.known_sign != 0) return end.known_sign;
    const int here =
        sign(constant_ * end.q * end.q + half_linear_ * end.p * end.q + quadratic_ * end.p * end.p);
    if (here != 0) return here;
    const int slope = direction * slope_sign(end);
    if (slope != 0) return slope;
    return sign(quadratic_) > 0 ? 1 : -1;
  }

  const std::array<Number, 8>& values_;
  unsigned mask_;
  std::array<int, 4> strands_;
  Place<Number> low_, high_;
  Number constant_, half_linear_, quadratic_;
};

void join(std::array<std::uint8_t, 8>& group, int a, int b) {
  const std::uint8_t from = std::max(group[a], group[b]), to = std::min(group[a], group[b]);
  for (std::uint8_t& g : group) {
    if (g == from) g = to;
  }
}

// Number of maximal height intervals at which some strand is inside.
template <class Number>
int inhabited_intervals(const std::array<Number, 8>& values, unsigned mask) {
  bool from_below = false, from_above = false;
  for (int s : kStrands) {
    if (bit(mask, s) && bit(mask, s + 4)) return 1;
    from_below |= bit(mask, s);
    from_above |= bit(mask, s + 4);
  }
  if (!from_below || !from_above) return from_below || from_above ? 1 : 0;
  for (int s : kStrands) {
    for (int r : kStrands) {
      if (!bit(mask, s) || !bit(mask, r + 4)) continue;
      // s ends at values[s] / (values[s] - values[s + 4]), r begins at its own root: do they overlap?
      if (sign(values[s] * values[r + 4] - values[s + 4] * values[r]) > 0) return 1;
    }
  }
  return 2;
}

template <class Number>
CellTopology topology_of(const std::array<Number, 8>& values, unsigned mask) {
  CellTopology result;
  for (int corner = 0; corner < 8; ++corner) result.group[corner] = static_cast<std::uint8_t>(corner);
  for (const auto& e : kEdges) {
    if (bit(mask, e[0]) == bit(mask, e[1])) join(result.group, e[0], e[1]);
  }
  for (const auto& f : kFaces) {
    const bool a = bit(mask, f[0]), b = bit(mask, f[1]), c = bit(mask, f[2]), d = bit(mask, f[3]);
    result.face_parts += a || b || c || d ? 1 : 0;
    if (a != c || b != d || a == b) continue;
    const int decider = sign(values[f[0]] * values[f[2]] - values[f[1]] * values[f[3]]);
    if (decider > 0) join(result.group, f[0], f[2]);
    if (decider < 0) join(result.group, f[1], f[3]);
    if (a ? decider <= 0 : decider >= 0) ++result.face_parts;
  }
  result.euler = inhabited_intervals(values, mask);
  for (int first : {0, 1}) {
    const Slab slab = SlabAnalysis<Number>(values, mask, first).run();
    if (slab == Slab::kEmpty) continue;
    if (slab == Slab::kSeparate) ++result.euler;
    if (slab == Slab::kInsideTunnel) --result.euler;
    // A strand is outside or inside at some height of the slab: its end with that sign stands for it.
    const auto end_of = [&](int s, bool inside) {
      return bit(mask, kStrands[s]) == inside ? kStrands[s] : kStrands[s] + 4;
    };
    if (slab != Slab::kSeparate) join(result.group, end_of(first, true), end_of(first + 2, true));
    if (slab != Slab::kJoined) join(result.group, end_of(first + 1, false), end_of((first + 3) % 4, false));
  }
  return result;
}

std::array<Integer, 8> as_integers(const std::array<float, 8>& values, double level) {
  // Scaled by a common power of two, floats and level are integers; the scale keeps every sign.
  constexpr int kMantissaBits = 53;
  std::array<long long, 9> mantissas;
  std::array<int, 9> exponents;
  int lowest = std::numeric_limits<int>::max();
  for (int i = 0; i < 9; ++i) {
    const double x = i < 8 ? static_cast<double>(values[i]) : level;
    mantissas[i] = static_cast<long long>(std::ldexp(std::frexp(x, &exponents[i]), kMantissaBits));
    if (x != 0) lowest = std::min(lowest, exponents[i]);
  }
  std::array<Integer, 9> scaled;
  for (int i = 0; i < 9; ++i) {
    scaled[i] = mantissas[i];
    if (mantissas[i] != 0) scaled[i] <<= exponents[i] - lowest;
  }
  std::array<Integer, 8> result;
  for (int i = 0; i < 8; ++i) result[i] = scaled[i] - scaled[8];
  return result;
}

unsigned mask_of(const std::array<float, 8>& values, double level) {
  unsigned mask = 0;
  for (int corner = 0; corner < 8; ++corner) mask |= (values[corner] > level ? 1u : 0u) << corner;
  return mask;
}

bool slab_possible(unsigned mask, int first) {
  for (int s = 0; s < 4; ++s) {
    const int strand = kStrands[(first + s) % 4];
    const bool wants_inside = s % 2 == 0;
    if (bit(mask, strand) != wants_inside && bit(mask, strand + 4) != wants_inside) return false;
  }
  return true;
}

struct MaskTables {
  std::array<bool, 256> ambiguous{};
  std::array<std::int8_t, 256> weight{};
  MaskTables() {
    for (unsigned mask = 0; mask < 256; ++mask) {
      for (const auto& f : kFaces) {
        const bool a = bit(mask, f[0]), b = bit(mask, f[1]);
        ambiguous[mask] |= a == bit(mask, f[2]) && b == bit(mask, f[3]) && a != b;
      }
      ambiguous[mask] |= slab_possible(mask, 0) || slab_possible(mask, 1);
      if (ambiguous[mask]) continue;
      // Any values with these signs will do.
      std::array<Bounded, 8> values;
      for (int corner = 0; corner < 8; ++corner) values[corner].value = bit(mask, corner) ? 1 + 0.01 * corner : -1;
      weight[mask] = static_cast<std::int8_t>(topology_of(values, mask).weight(mask));
    }
  }
};

const MaskTables& tables() {
  static const MaskTables instance;
  return instance;
}

}  // namespace

int CellTopology::weight(unsigned mask) const {
  int corners = 0, edges = 0;
  for (int corner = 0; corner < 8; ++corner) corners += bit(mask, corner) ? 1 : 0;
  for (const auto& e : kEdges) edges += bit(mask, e[0]) || bit(mask, e[1]) ? 1 : 0;
  return corners - 2 * edges + 4 * face_parts - 8 * euler;
}

CellTopology cell_topology(const std::array<float, 8>& values, double level) {
  const unsigned mask = mask_of(values, level);
  std::array<Bounded, 8> bounded;
  for (int corner = 0; corner < 8; ++corner) bounded[corner] = Bounded::rounded(values[corner] - level, 0);
  try {
    return topology_of(bounded, mask);
  } catch (const Uncertain&) {
    return topology_of(as_integers(values, level), mask);
  }
}

bool is_ambiguous(unsigned mask) { return tables().ambiguous[mask]; }

int weight_of_simple_cell(unsigned mask) { return tables().weight[mask]; }

double inside_fraction(const std::array<float, 8>& values, double level) {
  static constexpr double kAbscissa[4] = {0.069431844202973713, 0.330009478207571868, 0.669990521792428132,
                                          0.930568155797026287};
  static constexpr double kWeight[4] = {0.173927422568726929, 0.326072577431273071, 0.326072577431273071,
                                        0.173927422568726929};
  Pair fraction{};
  for (int k = 0; k < 4; ++k) {
    const double z = kAbscissa[k];
    double edge[4];
    for (int c = 0; c < 4; ++c) edge[c] = (1 - z) * values[c] + z * values[c + 4] - level;
    for (int j = 0; j < 4; j += 2) {  // two points at a time, without branches
      const Pair y{kAbscissa[j], kAbscissa[j + 1]};
      const Pair left = (1 - y) * edge[0] + y * edge[2], right = (1 - y) * edge[1] + y * edge[3];
      const Pair high = max(left, right), low = min(left, right), all{1, 1}, none{};
      const Pair inside = low >= 0 ? all : high <= 0 ? none : high / (high - low);
      fraction += kWeight[k] * (Pair{kWeight[j], kWeight[j + 1]} * inside);
    }
  }
  return fraction[0] + fraction[1];
}

}  // namespace delvox
