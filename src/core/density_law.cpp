#include "delvox/core/density_law.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace delvox {
namespace {

constexpr double kAny = std::numeric_limits<double>::infinity();

/// Takes a number off the front of the text.
bool take_number(std::string_view& text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || !std::isfinite(value)) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

bool take(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

}  // namespace

double DensityLaw::modulus_mpa(double density) const {
  const auto piece = std::find_if(pieces.begin(), pieces.end() - 1, [&](const Piece& p) { return density <= p.up_to; });
  return piece->a * std::pow(density, piece->b) + piece->c;
}

// What could be read of the sources: the pieces of `keyak`, as table 1 of PMC6069821 (2018) quotes them from the two
// papers; of Morgan's, in the abstract, that densities are apparent and that the exponents range from 1.49 to 2.18. The
// other figures are those by which the papers are commonly quoted. (The table has 10500 rho^2.51 for a law of Keller's
// whose site it does not name.)
const std::vector<DensityLaw>& density_laws() {
  static const std::string kMorgan = "Morgan, Bayraktar, Keaveny, J Biomech 36:897, 2003, trabecular bone of the ";
  static const std::vector<DensityLaw> kLaws{
      {"morgan-femoral-neck", kMorgan + "femoral neck", "apparent", {{kAny, 6850, 1.49, 0}}},
      {"morgan-trochanter", kMorgan + "greater trochanter", "apparent", {{kAny, 15010, 2.18, 0}}},
      {"morgan-tibia", kMorgan + "proximal tibia", "apparent", {{kAny, 15520, 1.93, 0}}},
      {"morgan-vertebra", kMorgan + "vertebrae", "apparent", {{kAny, 4730, 1.56, 0}}},
      {"morgan-pooled", kMorgan + "four sites together", "apparent", {{kAny, 8920, 1.83, 0}}},
      {"carter-hayes",
       "Carter, Hayes, J Bone Joint Surg Am 59:954, 1977, 3790 rate^0.06 rho^3 at a strain rate of 0.01/s",
       "apparent",
       {{kAny, 2875, 3, 0}}},
      {"keller", "Keller, J Biomech 27:1159, 1994, spine and femur", "ash", {{kAny, 10500, 2.29, 0}}},
      {"keyak",
       "Keyak, Lee, Skinner, J Biomed Mater Res 28:1329, 1994, with Keyak and Falkinstein, Med Eng Phys 25:781, 2003",
       "ash",
       {{0.27, 33900, 2.20, 0}, {0.6, 5307, 1, 469}, {kAny, 10200, 2.01, 0}}},
  };
  return kLaws;
}

std::optional<DensityLaw> find_density_law(const std::string& text) {
  for (const DensityLaw& law : density_laws()) {
    if (law.name == text) return law;
  }
  std::string packed = text;
  std::erase(packed, ' ');
  std::string_view rest = packed;
  DensityLaw law{text, "the user", "of the calibration", {{kAny, 0, 0, 0}}};
  DensityLaw::Piece& piece = law.pieces[0];
  const bool spelt =
      take(rest, "E=") && take_number(rest, piece.a) && take(rest, "*rho^") && take_number(rest, piece.b);
  if (!spelt || !rest.empty() || !(piece.a > 0)) return std::nullopt;
  return law;
}

}  // namespace delvox
