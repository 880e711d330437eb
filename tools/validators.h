#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

namespace delvox::tools {

/// Accepts finite numbers above 0, or from 0 on.
enum class Zero { kAllowed, kExcluded };
inline CLI::Validator finite_number(Zero zero) {
  return CLI::Validator(
      [zero](const std::string& text) -> std::string {
        double value = 0;
        const bool is_number = CLI::detail::lexical_cast(text, value);
        if (is_number && std::isfinite(value) && (value > 0 || (zero == Zero::kAllowed && value == 0))) return "";
        return "'" + text + "' is not a number " + (zero == Zero::kAllowed ? ">= 0" : "> 0");
      },
      "");
}

/// Accepts degrees above 0 and up to `most`.
inline CLI::Validator angle_above_zero(double most) {
  return finite_number(Zero::kExcluded) & CLI::Range(0.0, most);
}

}  // namespace delvox::tools
