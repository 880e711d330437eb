#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace delvox::tools {

/// How a search for a size ended.
enum class SearchEnd {
  kFound,     ///< within 3 %
  kFloor,     ///< a larger size hardly gives fewer tets: what is thinner than the size takes them
  kJump,      ///< between two all but equal sizes the number jumps over the wanted one
  kOutOfTries,
  kStopped,   ///< a limit ended a run
};

/// What a search found.
struct SizeSearch {
  double size = 0;       ///< of the try that came closest
  std::size_t tets = 0;  ///< at that size; 0 if no try gave any
  int tries = 0;
  SearchEnd end = SearchEnd::kOutOfTries;
};

/// Finds the size that gives about `wanted` tets: their number goes about with size^-3, so each try corrects the last,
/// and once one try had too many and another too few, the next lies between them. `mesh_at(size)` returns how many
/// there are at a size (0: all components were taken out as too small), or nothing to end the search (a limit stopped
/// the run). The first try is at `first_size`; ends after eight at most.
SizeSearch find_size(std::size_t wanted, double first_size,
                     const std::function<std::optional<std::size_t>(double size)>& mesh_at);

/// "size 2.36 mm, found in 2 runs for 20,000 tets", or why there is none, and what to do.
std::string describe(const SizeSearch& search, std::size_t wanted);

}  // namespace delvox::tools
