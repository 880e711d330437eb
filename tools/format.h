#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "delvox/core/geometry.h"

namespace delvox::tools {

/// 1234567 -> "1,234,567".
std::string grouped(std::size_t count);

/// A number for people: up to `digits` significant digits, no trailing zeros.
std::string number(double value, int digits = 4);

/// A positive number to three significant digits, never less than it is.
std::string rounded_up(double value);

/// "x, y, z" with `digits` significant digits.
std::string point(const Point3& p, int digits = 5);

/// "1 place", "3 places".
std::string plural(std::size_t count, const std::string& noun);

/// The pieces of `text` between separators; an empty text is one empty piece.
std::vector<std::string> split(std::string_view text, char separator);

/// The number that `text` spells, all of it, finite. Throws OptionError that names `option`.
double parse_number(std::string_view text, const std::string& option);

/// `text` in one line: line ends become spaces.
std::string one_line(std::string text);

}  // namespace delvox::tools
