#include "delvox/core/run.h"

#include <gtest/gtest.h>

namespace delvox {
namespace {

TEST(RunReport, SucceedsUnlessALimitOrABrokenPromiseSaysOtherwise) {
  RunReport report;
  EXPECT_TRUE(report.succeeded());
  report.unmet.push_back({"deviation", 3, {}, "counted only", false});
  EXPECT_TRUE(report.succeeded());
  report.unmet.push_back({"topology", 1, {}, "no disk", true});
  EXPECT_FALSE(report.succeeded());
  RunReport stopped;
  stopped.stop = StopReason::kMaxSeconds;
  EXPECT_FALSE(stopped.succeeded());
  EXPECT_STREQ(to_string(stopped.stop), "max-seconds reached");
}

}  // namespace
}  // namespace delvox
