#pragma once

#include <map>
#include <string>
#include <vector>

#include "delvox/core/mesh.h"
#include "delvox/mesh_io/write_deck.h"

namespace delvox::tools {

/// A --deck file: the analysis, and the material of the whole body if it states one.
struct DeckFile {
  StaticDeck deck;
  std::vector<Material> material;  ///< at most one, of no region yet
};

/// Reads {"material": ..., "supports": [...], "displacements": [...], "pressures": [...], "gravity_m_s2": [...]}; see
/// the README. A material is an object, or a name in `known`. Throws InputError (not JSON), OptionError (unknown keys,
/// wrong types): one line with the file's name.
DeckFile read_deck(const std::string& path, const std::map<std::string, Material>& known);

/// Reads a --materials file: {"bone": {"youngs_modulus_mpa": 17000, "poisson_ratio": 0.3, "density_kg_m3": 1900}, ...}.
/// Throws as read_deck.
std::map<std::string, Material> read_materials(const std::string& path);

/// Names of the sets that a deck speaks of, each once.
std::vector<std::string> sets_of(const StaticDeck& deck);

}  // namespace delvox::tools
