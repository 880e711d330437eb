#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "delvox/core/geometry.h"

namespace delvox {

constexpr const char* kVdbDimsKey = "delvox_dims";
constexpr const char* kVdbFrameKey = "delvox_frame";

/// One grid of an OpenVDB file, every length in it checked.
struct VdbGrid {
  std::string bytes;               ///< the file's header, then this grid alone, its metadata left out
  std::streamoff descriptor = 0;   ///< where the grid begins in bytes
  std::string sample_type;         ///< "float32", "float16", "int32", ...
  std::optional<std::array<std::int64_t, 3>> dims;  ///< as write_volume notes them
  Frame frame = Frame::kUnknown;
};

/// The first grid of floats, doubles, int32 or int64 of the file. OpenVDB trusts its files: sizes become allocations,
/// a chunk stored plainly is read whatever its size into a buffer of the size expected, counts drive loops after the
/// data have ended. So the file is walked here before OpenVDB sees any of it, and compressed chunks must have the
/// sizes that their nodes call for. Throws InputError.
VdbGrid extract_vdb_grid(const std::filesystem::path& path);

}  // namespace delvox
