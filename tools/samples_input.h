#pragma once

#include <optional>
#include <span>
#include <string>

#include "console.h"
#include "delvox/mesh_io/read_samples.h"
#include "delvox/oracle/samples_oracle.h"
#include "volume_input.h"

namespace delvox::tools {

/// Which samples of a file, and what is between them.
struct SamplesInputOptions {
  std::string field;                     ///< name of a column or of an array on points; empty: the only one
  std::string interpolation = "linear";  ///< linear or natural
};

/// --field.
void add_field_option(CLI::App& app, SamplesInputOptions& options);
/// --interpolation.
void add_interpolation_option(CLI::App& app, SamplesInputOptions& options);

/// A file of scattered samples, triangulated.
struct SamplesInput {
  std::string path, format, field_name;
  std::size_t merged = 0;
  SampleField field;

  /// "samples.csv: CSV, 20,000 samples of 'value', 133,000 tets between them".
  std::string sentence() const;
  /// What was left out; empty if nothing was.
  std::string warning() const;
};

/// Reads and triangulates. Throws InputError.
SamplesInput read_samples_input(const std::string& path, const SamplesInputOptions& options);

/// The values, rounded, for statistics.
std::vector<float> rounded_values(const SampleField& field);

/// Resolves --iso; a point given as at:x,y,z is one of `frame`. Throws OptionError, NothingToMesh unless the isovalue
/// lies in the range of the values.
ChosenIsosurface choose_isosurface(const SampleField& field, const IsosurfaceOptions& options,
                                   const FrameChange& frame);

/// What to do about samples that equal the isovalue; empty if there are none.
std::string advice_on_ties(const SampleField& field, const Isosurface& surface);

}  // namespace delvox::tools
