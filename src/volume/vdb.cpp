// OpenVDB files. The library trusts what it reads: lengths from the file become allocations, and loops run on counts
// whether or not the data have ended. So the header is walked here first with every length checked, only the grid
// wanted is read, and from a stream that throws at the end of the file.
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "core/output_file.h"
#include "delvox/core/errors.h"
#include "volume/read_support.h"
#include "volume/readers.h"
#include "volume/volume_impl.h"
#include "volume/writers.h"

namespace delvox {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMagic = 0x56444220;
constexpr std::uint32_t kOldestVersion = 222;  // OpenVDB 2.0, 2013
constexpr std::streamoff kUuidOffset = 8 + 4 + 4 + 4 + 1;
constexpr std::size_t kUuidLength = 36;
constexpr const char* kDimsKey = "delvox_dims";
constexpr const char* kFrameKey = "delvox_frame";

/// A grid as the file lists it.
struct GridEntry {
  std::streamoff descriptor = 0;  // where its descriptor begins
  std::string name, type, parent;
  std::int64_t end = 0;           // where the next descriptor begins; 0 if the file does not say
};

/// Walks the header with every length checked.
class VdbHeader {
 public:
  VdbHeader(const fs::path& path, std::istream& stream, std::uint64_t file_size)
      : path_(path), stream_(stream), size_(static_cast<std::int64_t>(file_size)) {}

  /// The first grid of scalars; the stream is left anywhere.
  GridEntry first_scalar_grid();

 private:
  template <class T>
  T read() {
    T value;
    if (!stream_.read(reinterpret_cast<char*>(&value), sizeof value)) fail_damaged();
    return value;
  }
  std::string read_string() {
    std::string text(checked_length(read<std::uint32_t>()), '\0');
    if (!stream_.read(text.data(), static_cast<std::streamsize>(text.size()))) fail_damaged();
    return text;
  }
  std::size_t checked_length(std::uint32_t length) {
    if (static_cast<std::int64_t>(length) > size_ - stream_.tellg()) fail_damaged();
    return length;
  }
  void skip_metadata();
  void skip_transform();
  GridEntry read_descriptor();
  [[noreturn]] void fail_damaged() const {
    fail_input(path_, "damaged or truncated OpenVDB file", "copy or download the file again");
  }

  fs::path path_;
  std::istream& stream_;
  std::int64_t size_;
};

void VdbHeader::skip_metadata() {
  const std::uint32_t entries = read<std::uint32_t>();
  for (std::uint32_t n = 0; n < entries; ++n) {
    read_string();
    read_string();
    stream_.seekg(static_cast<std::streamoff>(checked_length(read<std::uint32_t>())), std::ios::cur);
  }
}

void VdbHeader::skip_transform() {
  const std::string type = read_string();
  constexpr std::streamoff kVector = 3 * sizeof(double), kMatrix = 16 * sizeof(double);
  std::streamoff size = 0;
  if (type == "TranslationMap") size = kVector;
  if (type == "ScaleMap" || type == "UniformScaleMap") size = 5 * kVector;
  if (type == "ScaleTranslateMap" || type == "UniformScaleTranslateMap") size = 6 * kVector;
  if (type == "AffineMap" || type == "UnitaryMap") size = kMatrix;
  if (type == "NonlinearFrustumMap") {
    fail_input(path_, "its grid lies in a frustum, not on a regular lattice", "resample it to a linear transform");
  }
  if (size == 0) fail_damaged();
  stream_.seekg(size, std::ios::cur);
}

GridEntry VdbHeader::read_descriptor() {
  GridEntry entry;
  entry.descriptor = stream_.tellg();
  entry.name = read_string();
  entry.type = read_string();
  entry.parent = read_string();
  const std::int64_t grid_position = read<std::int64_t>();
  read<std::int64_t>();
  entry.end = read<std::int64_t>();
  if (grid_position > size_ || entry.end > size_) fail_damaged();
  return entry;
}

bool is_scalar_type(std::string type) {
  const std::string half = "_HalfFloat";
  if (type.ends_with(half)) type.resize(type.size() - half.size());
  return type == openvdb::FloatGrid::gridType() || type == openvdb::DoubleGrid::gridType() ||
         type == openvdb::Int32Grid::gridType() || type == openvdb::Int64Grid::gridType();
}

GridEntry VdbHeader::first_scalar_grid() {
  if (read<std::int64_t>() != kMagic) fail_damaged();
  const std::uint32_t version = read<std::uint32_t>();
  if (version < kOldestVersion || version > openvdb::OPENVDB_FILE_VERSION) {
    fail_input(path_, "its file version " + std::to_string(version) + " is not read",
               "save it with a current OpenVDB (versions " + std::to_string(kOldestVersion) + " to " +
                   std::to_string(openvdb::OPENVDB_FILE_VERSION) + ")");
  }
  read<std::uint32_t>();
  read<std::uint32_t>();
  const bool has_offsets = read<std::uint8_t>() != 0;
  stream_.seekg(kUuidLength, std::ios::cur);
  skip_metadata();
  const std::int32_t grids = read<std::int32_t>();
  for (std::int32_t n = 0; n < grids; ++n) {
    GridEntry entry = read_descriptor();
    if (is_scalar_type(entry.type) && entry.parent.empty()) {
      read<std::uint32_t>();  // compression
      skip_metadata();
      skip_transform();
      // Any other number of buffers would be warned of on stderr.
      if (read<std::int32_t>() != 1) fail_damaged();
      return entry;
    }
    if (!has_offsets || entry.end <= entry.descriptor) break;
    stream_.seekg(entry.end);
  }
  fail_input(path_, "no grid of scalars in it", "give a file with a float, double, int32 or int64 grid");
}

/// io::Archive keeps its parts for derived classes; io::File and io::Stream offer no stream of ours.
class VdbArchive : public openvdb::io::Archive {
 public:
  Ptr copy() const override { return std::make_shared<VdbArchive>(*this); }

  openvdb::GridBase::Ptr read_grid(std::istream& stream, const GridEntry& entry) {
    readHeader(stream);
    openvdb::io::StreamMetadata::Ptr metadata(new openvdb::io::StreamMetadata);
    openvdb::io::setStreamMetadataPtr(stream, metadata, /*transfer=*/true);
    setFormatVersion(stream);
    setLibraryVersion(stream);
    setDataCompression(stream);
    stream.seekg(entry.descriptor);
    openvdb::io::GridDescriptor descriptor;
    const openvdb::GridBase::Ptr grid = descriptor.read(stream);
    readGrid(grid, descriptor, stream);
    return grid;
  }
  void write_grid(std::ostream& stream, openvdb::GridBase::ConstPtr grid) {
    setCompression(openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK);
    setGridStatsMetadataEnabled(false);
    write(stream, openvdb::GridCPtrVec{std::move(grid)}, /*seekable=*/true);
  }
};

openvdb::GridBase::Ptr load_grid(const fs::path& path, std::uint64_t file_size) {
  initialize_openvdb();
  std::ifstream stream(path, std::ios::binary);
  const GridEntry entry = VdbHeader(path, stream, file_size).first_scalar_grid();
  stream.clear();
  stream.seekg(0);
  stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
  try {
    return VdbArchive().read_grid(stream, entry);
  } catch (const std::bad_alloc&) {
    fail_input(path, "damaged OpenVDB file, or too large for this machine's memory", "copy or resample it");
  } catch (const std::exception&) {
    fail_input(path, "damaged or truncated OpenVDB file", "copy or download the file again");
  }
}

/// Ours say their extent; in others' it is the box of active voxels.
openvdb::CoordBBox extent(const fs::path& path, const openvdb::GridBase& grid) {
  if (const auto dims = grid.getMetadata<openvdb::Vec3IMetadata>(kDimsKey)) {
    const openvdb::Vec3i n = dims->value();
    checked_voxel_count(path, {n[0], n[1], n[2]});
    return {openvdb::Coord(0), openvdb::Coord(n[0] - 1, n[1] - 1, n[2] - 1)};
  }
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (box.empty()) fail_input(path, "the grid has no active voxel", "give a file with samples");
  std::array<std::int64_t, 3> dims;
  for (int axis = 0; axis < 3; ++axis) dims[axis] = std::int64_t{box.max()[axis]} - box.min()[axis] + 1;
  checked_voxel_count(path, dims);
  return box;
}

Affine3 affine_of(const openvdb::GridBase& grid, const openvdb::Coord& first) {
  const openvdb::math::MapBase::ConstPtr map = grid.transform().baseMap();
  const openvdb::math::Mat4d matrix = map->getAffineMap()->getMat4();
  Affine3 affine;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) affine.rows[row][column] = matrix(column, row);
  }
  const Point3 origin = affine({double(first[0]), double(first[1]), double(first[2])});
  for (int row = 0; row < 3; ++row) affine.rows[row][3] = origin[row];
  return affine;
}

template <class Grid>
bool copy_samples(const openvdb::GridBase::Ptr& base, const openvdb::CoordBBox& box, std::vector<float>& samples) {
  const typename Grid::Ptr grid = openvdb::gridPtrCast<Grid>(base);
  if (!grid) return false;
  samples.resize(box.volume());
  openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box, samples.data());
  openvdb::tools::copyToDense(*grid, dense, /*serial=*/true);
  return true;
}

std::vector<float> samples_of(const openvdb::GridBase::Ptr& grid, const openvdb::CoordBBox& box) {
  std::vector<float> samples;
  const bool copied = copy_samples<openvdb::FloatGrid>(grid, box, samples) ||
                      copy_samples<openvdb::DoubleGrid>(grid, box, samples) ||
                      copy_samples<openvdb::Int32Grid>(grid, box, samples) ||
                      copy_samples<openvdb::Int64Grid>(grid, box, samples);
  return copied ? samples : std::vector<float>();
}

void check_finite(const fs::path& path, const std::vector<float>& samples) {
  std::size_t bad = 0;
  for (float sample : samples) bad += std::isfinite(sample) ? 0 : 1;
  if (bad == 0) return;
  fail_input(path, std::to_string(bad) + " samples are NaN, infinite or beyond float32",
             "replace them first, e.g. by the background value");
}

/// FNV-1a of the file's content stands in for the random UUID that OpenVDB writes: same volume, same bytes.
class ContentId {
 public:
  void add(const void* data, std::size_t size) {
    for (std::size_t n = 0; n < size; ++n) {
      hash_ = (hash_ ^ static_cast<const unsigned char*>(data)[n]) * 0x100000001b3u;
    }
  }
  std::string uuid() const {
    char text[kUuidLength + 1];
    const auto part = [&](int shift, std::uint64_t mask) { return static_cast<unsigned>(hash_ >> shift & mask); };
    std::snprintf(text, sizeof text, "%08x-%04x-4%03x-8000-000000000000", part(32, 0xffffffff), part(16, 0xffff),
                  part(0, 0xfff));
    return text;
  }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

std::string content_uuid(const Volume& volume) {
  ContentId id;
  const VolumeHeader& header = volume.header();
  id.add(header.dims.data(), sizeof header.dims);
  id.add(header.index_to_world.rows.data(), sizeof header.index_to_world.rows);
  for_each_slab(volume, [&](const float* samples, int, std::size_t count) { id.add(samples, count * sizeof(float)); });
  return id.uuid();
}

}  // namespace

bool looks_like_vdb(std::string_view start) {
  std::int64_t magic = 0;
  if (start.size() < sizeof magic) return false;
  std::memcpy(&magic, start.data(), sizeof magic);
  return magic == kMagic;
}

Volume read_vdb(ByteSource source, const ReadVolumeOptions& options) {
  const fs::path path = source.path();
  refuse_spacing(path, options);
  VolumeHeader header;
  check_volume_index(path, options, 1, header);
  const openvdb::GridBase::Ptr grid = load_grid(path, source.capacity());
  const openvdb::CoordBBox box = extent(path, *grid);
  header.dims = {box.dim()[0], box.dim()[1], box.dim()[2]};
  header.index_to_world = affine_of(*grid, box.min());
  header.format = "OpenVDB";
  header.sample_type = grid->saveFloatAsHalf() ? "float16" : grid->valueType();
  if (header.sample_type == "float") header.sample_type = "float32";
  if (header.sample_type == "double") header.sample_type = "float64";
  const bool ours = grid->getMetadata<openvdb::Vec3IMetadata>(kDimsKey) != nullptr;
  if (const auto frame = grid->getMetadata<openvdb::StringMetadata>(kFrameKey)) {
    if (frame->value() == "RAS") header.frame = Frame::kRas;
    if (frame->value() == "LPS") header.frame = Frame::kLps;
  }
  if (!ours) header.warnings.push_back("OpenVDB states no unit of length; millimetres assumed");
  const std::vector<float> samples = samples_of(grid, box);
  check_finite(path, samples);
  return make_volume(path, std::move(header), samples);
}

void write_vdb(const Volume& volume, const fs::path& path) {
  initialize_openvdb();
  const openvdb::FloatGrid::Ptr grid = volume.impl().grid->copy();
  const std::array<int, 3>& dims = volume.dims();
  grid->insertMeta(kDimsKey, openvdb::Vec3IMetadata(openvdb::Vec3i(dims[0], dims[1], dims[2])));
  grid->insertMeta(kFrameKey, openvdb::StringMetadata(to_string(volume.header().frame)));
  OutputFile file(path);
  try {
    VdbArchive().write_grid(file.stream(), grid);
  } catch (const openvdb::Exception& error) {
    throw IoError(path.string() + ": cannot be written: " + error.what() + "; free some space or choose another place");
  }
  file.stream().seekp(kUuidOffset);
  file.stream() << content_uuid(volume);
  file.commit();
}

}  // namespace delvox
