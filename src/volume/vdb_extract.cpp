// The layout of OpenVDB files of versions 222 to 224: header, metadata, then for each grid a descriptor, compression
// flags, metadata, transform, the tree's topology (masks and tiles, depth first) and its leaf buffers in the same
// order.
#include "volume/vdb_extract.h"

#include <bit>
#include <cstring>
#include <fstream>
#include <vector>

#include "volume/read_support.h"

namespace delvox {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kOldestVersion = 222, kNewestVersion = 224;  // OpenVDB 2.0 (2013) to 12
constexpr std::size_t kHeaderSize = 8 + 4 + 4 + 4 + 1 + 36;          // ends with the UUID
constexpr std::uint32_t kZip = 1, kActiveMask = 2, kBlosc = 4;
constexpr const char* kHalfKey = "is_saved_as_half_float";

struct ScalarType {
  const char* name;
  const char* tree;
  std::size_t size;
  bool is_real;
};
constexpr ScalarType kScalarTypes[] = {{"float32", "Tree_float_5_4_3", 4, true},
                                       {"float64", "Tree_double_5_4_3", 8, true},
                                       {"int32", "Tree_int32_5_4_3", 4, false},
                                       {"int64", "Tree_int64_5_4_3", 8, false}};

/// Bits of a mask that are on.
std::size_t count_on(std::string_view mask) {
  std::size_t count = 0;
  for (char byte : mask) count += static_cast<std::size_t>(std::popcount(static_cast<unsigned char>(byte)));
  return count;
}

class VdbWalker {
 public:
  VdbWalker(const fs::path& path, std::vector<char> bytes) : path_(path), bytes_(std::move(bytes)) {}
  VdbGrid extract();

 private:
  struct Metadata {
    std::optional<std::array<std::int64_t, 3>> dims;
    std::string frame;
    bool half = false;
  };

  std::string_view take(std::uint64_t size) {
    if (size > bytes_.size() - at_) fail_damaged();
    const std::string_view taken = std::string_view(bytes_.data() + at_, size);
    at_ += size;
    return taken;
  }
  template <class T>
  T read() {
    T value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::string_view read_string() { return take(read<std::uint32_t>()); }
  bool read_header();
  Metadata read_metadata();
  void walk_transform();
  void walk_tree();
  void walk_upper_node();
  void walk_lower_node();
  void walk_values(std::string_view value_mask);
  void walk_chunk(std::size_t raw_size);
  VdbGrid take_grid(std::size_t descriptor_begin, std::size_t descriptor_end);
  [[noreturn]] void fail_damaged() const {
    fail_input(path_, "damaged or truncated OpenVDB file", "copy or download the file again");
  }

  fs::path path_;
  std::vector<char> bytes_;
  std::size_t at_ = 0;
  const ScalarType* type_ = nullptr;
  bool half_ = false;
  std::uint32_t compression_ = 0;
  std::size_t leaves_ = 0;
};

/// Returns whether grids state where they end.
bool VdbWalker::read_header() {
  take(8);
  const std::uint32_t version = read<std::uint32_t>();
  if (version < kOldestVersion || version > kNewestVersion) {
    fail_input(path_, "its file version " + std::to_string(version) + " is not read",
               "save it with an OpenVDB that writes versions " + std::to_string(kOldestVersion) + " to " +
                   std::to_string(kNewestVersion));
  }
  take(8);
  const bool has_offsets = read<std::uint8_t>() != 0;
  take(kHeaderSize - at_);
  return has_offsets;
}

VdbWalker::Metadata VdbWalker::read_metadata() {
  Metadata result;
  const std::uint32_t entries = read<std::uint32_t>();
  for (std::uint32_t n = 0; n < entries; ++n) {
    const std::string_view key = read_string(), type = read_string(), value = read_string();
    if (key == kVdbDimsKey && type == "vec3i" && value.size() == 12) {
      std::int32_t dims[3];
      std::memcpy(dims, value.data(), sizeof dims);
      result.dims = {dims[0], dims[1], dims[2]};
    }
    if (key == kVdbFrameKey && type == "string") result.frame = value;
    if (key == kHalfKey && type == "bool" && value.size() == 1) result.half = value[0] != 0;
  }
  return result;
}

void VdbWalker::walk_transform() {
  const std::string_view type = read_string();
  constexpr std::size_t kVector = 3 * sizeof(double), kMatrix = 16 * sizeof(double);
  if (type == "NonlinearFrustumMap") {
    fail_input(path_, "its grid lies in a frustum, not on a regular lattice", "resample it to a linear transform");
  }
  if (type == "TranslationMap") {
    take(kVector);
  } else if (type == "ScaleMap" || type == "UniformScaleMap") {
    take(5 * kVector);
  } else if (type == "ScaleTranslateMap" || type == "UniformScaleTranslateMap") {
    take(6 * kVector);
  } else if (type == "AffineMap" || type == "UnitaryMap") {
    take(kMatrix);
  } else {
    fail_damaged();
  }
}

/// Samples of one node: plain, zipped or by Blosc.
void VdbWalker::walk_chunk(std::size_t raw_size) {
  if ((compression_ & (kZip | kBlosc)) == 0) {
    take(raw_size);
    return;
  }
  const std::int64_t size = read<std::int64_t>();
  if (size <= 0) {  // stored plainly because that was smaller
    if (size != -static_cast<std::int64_t>(raw_size)) fail_damaged();
    take(raw_size);
    return;
  }
  constexpr std::size_t kBloscHeader = 16;
  if (static_cast<std::uint64_t>(size) > 2 * raw_size + 1024) fail_damaged();
  const std::string_view chunk = take(static_cast<std::uint64_t>(size));
  if ((compression_ & kBlosc) == 0) return;
  // Blosc believes the sizes in its own header.
  if (chunk.size() < kBloscHeader) fail_damaged();
  std::uint32_t sizes[3];
  std::memcpy(sizes, chunk.data() + 4, sizeof sizes);  // of the raw data, of a block, of the chunk
  if (sizes[0] > raw_size || sizes[2] != chunk.size()) fail_damaged();
}

void VdbWalker::walk_values(std::string_view value_mask) {
  // 0 and 1 say that inactive values are the background, or its negative too.
  constexpr int kOneInactive = 2, kMaskOnly = 3, kMaskOneInactive = 4, kMaskTwoInactive = 5, kAllValues = 6;
  const int layout = read<std::int8_t>();
  if (layout < 0 || layout > kAllValues) fail_damaged();
  if (layout == kOneInactive || layout == kMaskOneInactive) take(type_->size);
  if (layout == kMaskTwoInactive) take(2 * type_->size);
  if (layout == kMaskOnly || layout == kMaskOneInactive || layout == kMaskTwoInactive) take(value_mask.size());
  const bool active_only = (compression_ & kActiveMask) != 0 && layout != kAllValues;
  const std::size_t count = active_only ? count_on(value_mask) : 8 * value_mask.size();
  if (half_ && count == 0) return;
  walk_chunk(count * (half_ ? 2 : type_->size));
}

/// A node of 16^3 leaves: child mask, value mask, values, then the leaves' masks.
void VdbWalker::walk_lower_node() {
  constexpr std::size_t kMask = 16 * 16 * 16 / 8, kLeafMask = 8 * 8 * 8 / 8;
  const std::size_t leaves = count_on(take(kMask));
  walk_values(take(kMask));
  take(leaves * kLeafMask);
  leaves_ += leaves;
}

/// A node of 32^3 lower nodes.
void VdbWalker::walk_upper_node() {
  constexpr std::size_t kMask = 32 * 32 * 32 / 8;
  const std::size_t children = count_on(take(kMask));
  walk_values(take(kMask));
  for (std::size_t n = 0; n < children; ++n) walk_lower_node();
}

void VdbWalker::walk_tree() {
  // Any other number of buffers would be warned of on stderr.
  if (read<std::uint32_t>() != 1) fail_damaged();
  take(type_->size);  // background
  const std::uint32_t tiles = read<std::uint32_t>(), children = read<std::uint32_t>();
  take(std::uint64_t{tiles} * (3 * 4 + type_->size + 1));
  for (std::uint32_t n = 0; n < children; ++n) {
    for (int axis = 0; axis < 3; ++axis) {
      // Upper nodes span 4096 voxels; far out, coordinates would overflow.
      const std::int32_t origin = read<std::int32_t>();
      if (origin % 4096 != 0 || origin > (1 << 30) || origin < -(1 << 30)) fail_damaged();
    }
    walk_upper_node();
  }
  constexpr std::size_t kLeafMask = 8 * 8 * 8 / 8;
  for (std::size_t n = 0; n < leaves_; ++n) walk_values(take(kLeafMask));
}

VdbGrid VdbWalker::take_grid(std::size_t descriptor_begin, std::size_t descriptor_end) {
  VdbGrid grid;
  const std::size_t compression_at = at_;
  compression_ = read<std::uint32_t>();
  if (compression_ > (kZip | kActiveMask | kBlosc)) fail_damaged();
  const Metadata metadata = read_metadata();
  if (metadata.half != half_) fail_damaged();
  half_ = half_ && type_->is_real;
  const std::size_t transform_at = at_;
  walk_transform();
  walk_tree();
  const auto append = [&](std::size_t begin, std::size_t end) {
    grid.bytes.append(bytes_.data() + begin, end - begin);
  };
  const auto append_text = [&](const std::string& text) {
    const std::uint32_t size = static_cast<std::uint32_t>(text.size());
    grid.bytes.append(reinterpret_cast<const char*>(&size), sizeof size).append(text);
  };
  append(0, kHeaderSize);
  grid.descriptor = static_cast<std::streamoff>(grid.bytes.size());
  append(descriptor_begin, descriptor_end);
  append(compression_at, compression_at + sizeof compression_);
  const std::uint32_t entries = 1;
  grid.bytes.append(reinterpret_cast<const char*>(&entries), sizeof entries);
  append_text(kHalfKey);
  append_text("bool");
  append_text(std::string(1, metadata.half ? '\1' : '\0'));
  append(transform_at, at_);
  grid.sample_type = half_ ? "float16" : type_->name;
  grid.dims = metadata.dims;
  if (metadata.frame == "RAS") grid.frame = Frame::kRas;
  if (metadata.frame == "LPS") grid.frame = Frame::kLps;
  return grid;
}

VdbGrid VdbWalker::extract() {
  const bool has_offsets = read_header();
  read_metadata();
  const std::int32_t grids = read<std::int32_t>();
  for (std::int32_t n = 0; n < grids; ++n) {
    const std::size_t begin = at_;
    read_string();  // name
    std::string_view tree = read_string();
    const bool is_instance = !read_string().empty();
    take(16);  // positions of the grid and its blocks
    const std::int64_t next = read<std::int64_t>();
    const std::size_t end = at_;
    const std::string_view half_suffix = "_HalfFloat";
    half_ = tree.ends_with(half_suffix);
    if (half_) tree.remove_suffix(half_suffix.size());
    for (const ScalarType& type : kScalarTypes) {
      if (tree == type.tree && !is_instance) type_ = &type;
    }
    if (type_ != nullptr) return take_grid(begin, end);
    if (!has_offsets) break;
    if (next <= static_cast<std::int64_t>(at_) || next > static_cast<std::int64_t>(bytes_.size())) fail_damaged();
    at_ = static_cast<std::size_t>(next);
  }
  fail_input(path_, "no grid of scalars in it", "give a file with a float, double, int32 or int64 grid");
}

}  // namespace

VdbGrid extract_vdb_grid(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  std::vector<char> bytes(error ? 0 : size);
  if (error || !stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
    fail_input(path, "it cannot be read", "check the disk and copy the file again");
  }
  return VdbWalker(path, std::move(bytes)).extract();
}

}  // namespace delvox
