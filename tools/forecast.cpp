#include "forecast.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "delvox/core/errors.h"
#include "format.h"

namespace delvox::tools {
namespace {

constexpr double kSpare = 0.03;  // of the memory: so much may the next run's own differ from this one's
constexpr double kFewestVertices = 100;
constexpr std::string_view kUnits = "KMGT";

Estimate operator*(double part, const Estimate& whole) {
  return {part * whole.vertices, part * whole.triangles, part * whole.tets, part * whole.seconds, part * whole.bytes};
}

// Two digits of a count, which is a guess anyway.
std::string about(double count) {
  if (!(count < 1e15)) return "countless";
  const double unit = count < 100 ? 1 : std::pow(10, std::floor(std::log10(count)) - 1);
  return grouped(static_cast<std::size_t>(std::llround(count / unit) * std::llround(unit)));
}

std::string elements(const Estimate& estimate) {
  return about(estimate.vertices) + " vertices, " +
         (estimate.tets != 0 ? about(estimate.tets) + " tets" : about(estimate.triangles) + " triangles");
}

}  // namespace

double ProcessForecast::peak_bytes() const {
  return std::max(before.now + mesh.likely.bytes, before.peak);  // in this order what is no number stays none
}

Forecast limited(Forecast forecast, std::size_t max_vertices) {
  for (Estimate* estimate : {&forecast.least, &forecast.likely}) {
    const double most = static_cast<double>(max_vertices);
    if (max_vertices > 0 && estimate->vertices > most) *estimate = most / estimate->vertices * *estimate;
  }
  return forecast;
}

std::string elements(const Forecast& forecast) {
  const std::string likely = "about " + elements(forecast.likely);
  if (!forecast.thin()) return likely;
  return "at least " + elements(forecast.least) + ", " + likely + " if parts thinner than the size are resolved";
}

std::string describe(const ProcessForecast& forecast, const std::string& extra) {
  const double seconds = forecast.mesh.likely.seconds;
  return "forecast: " + elements(forecast.mesh) + "; " + (seconds < 100 ? number(seconds, 2) : about(seconds)) +
         " s, " + memory_text(forecast.peak_bytes()) + " of memory in all" +
         (extra.empty() ? "" : ", and more for " + extra);
}

std::string memory_text(double bytes) {
  if (!(bytes < 1e18)) return "exabytes";
  std::size_t unit = 0;
  for (bytes /= 1024; bytes >= 1000 && unit + 1 < kUnits.size(); ++unit) bytes /= 1024;
  return number(bytes, 3) + " " + kUnits[unit] + "B";
}

double parse_memory(const std::string& text, const std::string& option) {
  std::string digits = text;
  double factor = 1;
  if (!digits.empty() && (digits.back() == 'B' || digits.back() == 'b')) digits.pop_back();
  if (!digits.empty()) {
    const std::size_t unit = kUnits.find(static_cast<char>(digits.back() & ~0x20));  // either case
    if (unit != std::string_view::npos) {
      factor = std::pow(1024, static_cast<double>(unit + 1));
      digits.pop_back();
    }
  }
  const bool is_number = !digits.empty() && digits.find_first_not_of("0123456789.") == std::string::npos;
  const double bytes = is_number ? factor * parse_number(digits, option) : 0;
  if (!(bytes > 0)) throw OptionError(option + ": '" + text + "' is no amount of memory; give one as 4G or 800M");
  return bytes;
}

std::optional<double> factor_that_fits(const std::function<ProcessForecast(double factor)>& forecast_at,
                                       double max_bytes) {
  constexpr double kLargestFactor = 1000, kPercent = 1.01;
  const auto fits = [&](const ProcessForecast& f) { return f.peak_bytes() <= (1 - kSpare) * max_bytes; };
  double low = 1, high = 1;
  for (;;) {
    high *= 2;
    const ProcessForecast forecast = forecast_at(high);
    if (fits(forecast)) break;
    if (high > kLargestFactor || forecast.mesh.least.vertices < kFewestVertices) return std::nullopt;
    low = high;
  }
  while (high > kPercent * low) {
    const double middle = std::sqrt(low * high);
    (fits(forecast_at(middle)) ? high : low) = middle;
  }
  if (forecast_at(high).mesh.least.vertices < kFewestVertices) return std::nullopt;
  return high;
}

}  // namespace delvox::tools
