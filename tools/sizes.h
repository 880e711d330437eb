#pragma once

#include <string>

#include "delvox/core/size_field.h"
#include "delvox/volume/level_set.h"

namespace delvox::tools {

/// A size for a run that was given none: 1/60 of the diagonal of the box around the inside samples, but at least 1.5
/// voxel (geometric mean of the spacings). Throws NothingToMesh if no sample is inside.
double default_size(const Volume& volume, const Isosurface& surface);

/// What --size and --cell-size take: a positive number, or the name of a volume file whose trilinear interpolation is
/// the size field (its samples must be positive; beyond its edges the nearest sample holds). A size volume in the other
/// patient frame is turned to `frame`. Throws OptionError, InputError.
SizeField parse_size(const std::string& text, const std::string& option, Frame frame);
/// Whether a text is meant as one of those: looks like a number, or names a file.
bool is_size_field(const std::string& text);

/// A guess at the size that gives `tets` tets in so much volume.
double guess_size(std::size_t tets, double inside_mm3);
/// The same for the inside of a volume. Throws NothingToMesh if no sample is inside.
double guess_size(std::size_t tets, const Volume& volume, const Isosurface& surface);

}  // namespace delvox::tools
