#include "format.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "delvox/core/errors.h"

namespace delvox::tools {

std::string grouped(std::size_t count) {
  std::string digits = std::to_string(count);
  for (int i = static_cast<int>(digits.size()) - 3; i > 0; i -= 3) digits.insert(static_cast<std::size_t>(i), 1, ',');
  return digits;
}

std::string number(double value, int digits) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*g", digits, value);
  return buffer;
}

std::string rounded_up(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  const double rounded = std::ceil(value / unit * (1 - 1e-12)) * unit;
  return number(rounded, rounded < 1000 ? 3 : 15);
}

std::string point(const Point3& p, int digits) {
  return number(p.x, digits) + ", " + number(p.y, digits) + ", " + number(p.z, digits);
}

std::string plural(std::size_t count, const std::string& noun) {
  return grouped(count) + " " + noun + (count == 1 ? "" : "s");
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> pieces;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find(separator, begin)) != std::string_view::npos; begin = end + 1) {
    pieces.emplace_back(text.substr(begin, end - begin));
  }
  pieces.emplace_back(text.substr(begin));
  return pieces;
}

double parse_number(std::string_view text, const std::string& option) {
  double value = 0;
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (begin != end && *begin == '+') ++begin;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) {
    throw OptionError(option + ": '" + std::string(text) + "' is not a number");
  }
  return value;
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

}  // namespace delvox::tools
