#pragma once

#include <optional>
#include <string>
#include <vector>

namespace delvox {

/// Young's modulus of bone by its density, as measured by someone: E = a rho^b + c, in pieces.
struct DensityLaw {
  /// One piece, for densities up to `up_to` g/cm3; E in MPa.
  struct Piece {
    double up_to, a, b, c;
  };
  std::string name;     ///< "morgan-femoral-neck"
  std::string source;   ///< who measured it, on what
  std::string density;  ///< which density it takes: "apparent" or "ash", g/cm3
  std::vector<Piece> pieces;

  /// MPa at a density in g/cm3. pre: density > 0.
  double modulus_mpa(double density) const;
};

/// The laws known by name.
const std::vector<DensityLaw>& density_laws();

/// The law that a text spells: a name of these, or "E=a*rho^b". Nothing if it spells none.
std::optional<DensityLaw> find_density_law(const std::string& text);

}  // namespace delvox
