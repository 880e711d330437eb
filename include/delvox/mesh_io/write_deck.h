#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "delvox/core/mesh.h"

namespace delvox {

/// A linear static analysis, on sets of a mesh by name. Units are those of the field names, whatever the file's.
struct StaticDeck {
  /// Displacements of the nodes of a set, along those axes that have one; 0 is a support.
  struct Displacement {
    std::string set;
    std::array<std::optional<double>, 3> mm;
  };
  /// Pressure on the faces of a set; positive pushes.
  struct Pressure {
    std::string set;
    double mpa = 0;
  };
  std::vector<Displacement> displacements;
  std::vector<Pressure> pressures;
  Vector3 gravity_m_s2;  ///< acts on all tets; 0, 0, 0: none
};

/// Writes a mesh with its materials and a step to an .inp that CalculiX and Abaqus run as it is: displacements,
/// stresses and reaction forces go to the result file. Throws IoError; OptionError unless the extension is .inp, every
/// set that the deck names has what it is named for, something holds the body, every region has a material and, with
/// gravity, a density.
void write_deck(const TetMesh& mesh, const StaticDeck& deck, const std::filesystem::path& path);

}  // namespace delvox
