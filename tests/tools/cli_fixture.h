#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/run_delvox.h"

namespace delvox::test {

/// Runs the program on files of a folder of its own.
class CliFixture : public ::testing::Test {
 protected:
  /// What a run that succeeds prints with --json.
  static nlohmann::json run(std::vector<std::string> arguments) {
    arguments.push_back("--json");
    const Outcome outcome = run_delvox(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  }

  /// With --quiet: the code, one line on stderr that mentions all of `words`, and no file.
  void expect_failure(int code, std::vector<std::string> arguments, const std::vector<std::string>& words) {
    const auto before = folder_.names();
    arguments.push_back("--quiet");
    const Outcome outcome = run_delvox(arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(line_count(outcome.err), 1u) << outcome.err;
    for (const std::string& word : words) EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_EQ(folder_.names(), before);
  }

  TemporaryFolder folder_;
};

}  // namespace delvox::test
