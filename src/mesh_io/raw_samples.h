#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "delvox/core/samples.h"
#include "mesh_io/source.h"

namespace delvox::mesh_io {

/// Samples as a file states them, unchecked.
struct RawSamples {
  Samples samples;
  std::string field;
  std::vector<std::uint32_t> line_of;  ///< of each sample, from 1; empty: the file has no lines
};

/// Columns of text, as read_samples says. Throws InputError.
RawSamples read_samples_text(const Source& source, const std::string& field);
/// Points of a VTU file and an array on them. Throws InputError.
RawSamples read_samples_vtu(const Source& source, const std::string& field);

}  // namespace delvox::mesh_io
