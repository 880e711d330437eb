#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace delvox::tools {

/// Reads --config files for CLI11: one JSON object whose keys are flag names without the dashes, whose values are
/// strings, numbers, booleans or arrays of these. Flags given on the command line win.
class ConfigJson : public CLI::Config {
 public:
  std::string to_config(const CLI::App* app, bool defaults, bool descriptions, std::string prefix) const override;
  /// Throws OptionError: not JSON, not an object, a value that no flag can have.
  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override;
};

}  // namespace delvox::tools
