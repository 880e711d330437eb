#include <gtest/gtest.h>

#include "against_cgal.h"

// Hundreds of thousands of steps against CGAL, some of them on many vertices.

namespace delvox {
namespace {

using test::AgainstCgal;
using test::Placement;

class Delaunay3Heavy : public testing::TestWithParam<Placement> {};

INSTANTIATE_TEST_SUITE_P(Placements, Delaunay3Heavy, testing::ValuesIn(test::kPlacements),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(Delaunay3Heavy, IsCgalsComplexThroughFiftyThousandSteps) {
  AgainstCgal pair(test::kUnitBox, 21);
  for (int n = 0; n < 50000; ++n) {
    // Grows, stays as it is, shrinks, and so on.
    constexpr double kRemovals[] = {0.1, 0.5, 0.8, 0.5};
    pair.step(GetParam().next, kRemovals[n / 2500 % 4]);
    if (n % 500 == 499) pair.expect_equal();
    if (n % 5000 == 4999) pair.expect_locally_delaunay();
    ASSERT_FALSE(HasFailure()) << n;
  }
}

}  // namespace
}  // namespace delvox
