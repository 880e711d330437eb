#pragma once

#include "delvox/volume/level_set.h"
#include "delvox/volume/volume.h"

namespace delvox {

/// The volume with its partial-volume layer peeled off: samples inside the isosurface that have one outside within
/// `layers` voxels (also diagonally), and those outside up to three voxels beyond, take the mean of their neighbours
/// further in, layer by layer. Where an organ is too thin to have an inside that deep, samples stay as they are.
/// Holds all samples at once. pre: layers >= 1.
Volume peeled(const Volume& volume, const Isosurface& surface, int layers);

}  // namespace delvox
