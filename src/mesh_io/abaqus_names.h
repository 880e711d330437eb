#pragma once

#include <string_view>

namespace delvox::mesh_io {

/// Sets that every .inp of tets has: all nodes, all tets, the boundary (nodes and faces), the tets of each region.
inline constexpr std::string_view kAllNodes = "NALL", kAllTets = "EALL", kBoundary = "SURFACE",
                                  kRegionPrefix = "REGION_";

}  // namespace delvox::mesh_io
