#include "meshing/tet_limits.h"

#include <numbers>

namespace delvox {
namespace {

constexpr double kRounding = 1 + 1e-11;  // what refinement left just at a bound stays within it

}  // namespace

TetLimits::TetLimits(double min_dihedral_degrees, const TetCriteria& criteria)
    : goal_(std::cos((min_dihedral_degrees + 1e-6) * std::numbers::pi / 180)),
      squared_radius_edge_(kRounding * criteria.radius_edge * criteria.radius_edge),
      squared_size_(kRounding * criteria.cell_size.maximum() * criteria.cell_size.maximum()),
      constant_(criteria.cell_size.constant()),
      cell_size_(criteria.cell_size) {}

}  // namespace delvox
