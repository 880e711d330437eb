#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "delvox/core/samples.h"

namespace delvox {

/// Scattered samples as a file holds them.
struct SamplesFile {
  Samples samples;         ///< at least four, finite, no two in one place
  std::string format;      ///< "CSV" or "VTU"
  std::string field;       ///< name of the values, if they have one
  std::size_t merged = 0;  ///< samples left out since an earlier one has the same place and value
};

/// Reads places and values from a text of columns, or from the points of a VTU file and one of its point-data arrays.
///
/// Text (any extension but .vtu): one sample per line; cells parted by semicolons, tabs, commas or blanks, whichever of
/// these in this order the first line has; `#` begins a comment; cells may stand in double quotes. A first line with a
/// cell that is no number names the columns: `x`, `y`, `z` in any order and case (or ParaView's `Points:0` to
/// `Points:2`), else the first three; the values are those of column `field`, of `value`, or of the only other column.
/// Without names the first four columns are taken.
///
/// VTU: the array `field`, or the only one of one component (ours, `on_surface` and `set_nodes_*`, do not count). Files
/// of ours that say "in m" are brought to mm.
///
/// Throws InputError, one line with the place in the file: unreadable, cut off, no number in a cell, fewer than four
/// different places, two values in one place, coordinates beyond 1e15 or values beyond 1e30, no or several fields to
/// choose from.
SamplesFile read_samples(const std::filesystem::path& path, const std::string& field = {});

/// Whether `path` has the extension of a text of samples: .csv, .tsv or .txt.
bool is_samples_path(const std::filesystem::path& path);

}  // namespace delvox
