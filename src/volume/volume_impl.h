#pragma once

#include <openvdb/openvdb.h>

#include "delvox/volume/volume.h"

namespace delvox {

struct Volume::Impl {
  VolumeHeader header;
  openvdb::FloatGrid::Ptr grid;  // voxel (i, j, k) at Coord(i, j, k)
  float min = 0, max = 0;
};

/// openvdb::initialize() once per process.
void initialize_openvdb();

/// The transform of OpenVDB, which acts on row vectors, for an affine that acts on column vectors.
openvdb::math::Transform::Ptr to_openvdb_transform(const Affine3& index_to_world);

}  // namespace delvox
