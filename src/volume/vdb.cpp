#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <cstring>
#include <sstream>

#include "core/output_file.h"
#include "delvox/core/errors.h"
#include "volume/read_support.h"
#include "volume/readers.h"
#include "volume/vdb_extract.h"
#include "volume/volume_impl.h"
#include "volume/writers.h"

namespace delvox {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMagic = 0x56444220;
constexpr std::streamoff kUuidOffset = 8 + 4 + 4 + 4 + 1;
constexpr std::size_t kUuidLength = 36;

/// io::Archive keeps its parts for derived classes; io::File and io::Stream offer no stream of ours.
class VdbArchive : public openvdb::io::Archive {
 public:
  Ptr copy() const override { return std::make_shared<VdbArchive>(*this); }

  openvdb::GridBase::Ptr read_grid(std::istream& stream, std::streamoff begin) {
    readHeader(stream);
    openvdb::io::StreamMetadata::Ptr metadata(new openvdb::io::StreamMetadata);
    openvdb::io::setStreamMetadataPtr(stream, metadata, /*transfer=*/true);
    setFormatVersion(stream);
    setLibraryVersion(stream);
    setDataCompression(stream);
    stream.seekg(begin);
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

openvdb::GridBase::Ptr load_grid(const fs::path& path, VdbGrid& vdb) {
  initialize_openvdb();
  std::istringstream stream(std::move(vdb.bytes), std::ios::binary);
  // OpenVDB does not look whether its reads succeed.
  stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
  try {
    return VdbArchive().read_grid(stream, vdb.descriptor);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    fail_input(path, "damaged OpenVDB file", "copy or download the file again");
  }
}

/// Ours say their extent; in others' it is the box of active voxels. A file of a kilobyte may hold tiles of 4096^3
/// voxels: nothing is allocated for the box before it is known to fit. (The tree itself takes no more than some thirty
/// times the file.)
openvdb::CoordBBox extent(const fs::path& path, const VdbGrid& vdb, const openvdb::GridBase& grid) {
  if (vdb.dims) {
    const std::array<std::int64_t, 3>& n = *vdb.dims;
    checked_voxel_count(path, n);
    check_fits_whole(path, n);
    const auto last = [&](int axis) { return static_cast<int>(n[axis] - 1); };
    return {openvdb::Coord(0), openvdb::Coord(last(0), last(1), last(2))};
  }
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (box.empty()) fail_input(path, "the grid has no active voxel", "give a file with samples");
  std::array<std::int64_t, 3> dims;
  for (int axis = 0; axis < 3; ++axis) dims[axis] = std::int64_t{box.max()[axis]} - box.min()[axis] + 1;
  check_fits_whole(path, dims);
  checked_voxel_count(path, dims);
  return box;
}

Affine3 affine_of(const fs::path& path, const openvdb::GridBase& grid, const openvdb::Coord& first) try {
  const openvdb::math::MapBase::ConstPtr map = grid.transform().baseMap();
  const openvdb::math::Mat4d matrix = map->getAffineMap()->getMat4();
  Affine3 affine;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) affine.rows[row][column] = matrix(column, row);
  }
  const Point3 origin = affine({double(first[0]), double(first[1]), double(first[2])});
  for (int row = 0; row < 3; ++row) affine.rows[row][3] = origin[row];
  return affine;
} catch (const openvdb::ArithmeticError&) {
  fail_input(path, "the grid's transform is singular", "correct its voxel size");
}

/// Writes value_at(coord) for every coord of `block` to its place in samples, which cover `box`, i fastest.
template <class ValueAt>
void fill_block(const openvdb::CoordBBox& block, const openvdb::CoordBBox& box, const ValueAt& value_at,
                std::vector<float>& samples) {
  const openvdb::Coord first = box.min(), dims = box.dim();
  for (int k = block.min()[2]; k <= block.max()[2]; ++k) {
    for (int j = block.min()[1]; j <= block.max()[1]; ++j) {
      const std::size_t row = static_cast<std::size_t>(k - first[2]) * dims[1] + (j - first[1]);
      for (int i = block.min()[0]; i <= block.max()[0]; ++i) {
        samples[row * dims[0] + (i - first[0])] = static_cast<float>(value_at(openvdb::Coord(i, j, k)));
      }
    }
  }
}

/// Leaf by leaf; tools::copyToDense does it too, but with it this file compiles for minutes under sanitizers.
template <class Grid>
bool copy_samples(const openvdb::GridBase::Ptr& base, const openvdb::CoordBBox& box, std::vector<float>& samples) {
  const typename Grid::Ptr grid = openvdb::gridPtrCast<Grid>(base);
  if (!grid) return false;
  using Leaf = typename Grid::TreeType::LeafNodeType;
  samples.resize(box.volume());
  constexpr int kLeaf = 8;
  const auto leaf_begin = [](int i) { return i & ~(kLeaf - 1); };
  for (int z = leaf_begin(box.min()[2]); z <= box.max()[2]; z += kLeaf) {
    for (int y = leaf_begin(box.min()[1]); y <= box.max()[1]; y += kLeaf) {
      for (int x = leaf_begin(box.min()[0]); x <= box.max()[0]; x += kLeaf) {
        openvdb::CoordBBox block = openvdb::CoordBBox::createCube({x, y, z}, kLeaf);
        block.intersect(box);
        if (const Leaf* leaf = grid->tree().probeConstLeaf({x, y, z})) {
          const auto voxel = [&](const openvdb::Coord& at) { return leaf->getValue(Leaf::coordToOffset(at)); };
          fill_block(block, box, voxel, samples);
        } else {
          const auto tile = grid->tree().getValue({x, y, z});
          fill_block(block, box, [&](const openvdb::Coord&) { return tile; }, samples);
        }
      }
    }
  }
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
  ConversionTally tally;
  for (float sample : samples) tally.not_finite += std::isfinite(sample) ? 0 : 1;
  check_finite(path, tally);
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

VolumeSourcePtr open_vdb(ByteSource source, const ReadVolumeOptions& options) {
  const fs::path path = source.path();
  refuse_spacing(path, options);
  VolumeHeader header;
  check_volume_index(path, options, 1, header);
  VdbGrid vdb = extract_vdb_grid(path);
  const openvdb::GridBase::Ptr grid = load_grid(path, vdb);
  const openvdb::CoordBBox box = extent(path, vdb, *grid);
  header.dims = {box.dim()[0], box.dim()[1], box.dim()[2]};
  header.index_to_world = affine_of(path, *grid, box.min());
  header.format = "OpenVDB";
  header.sample_type = vdb.sample_type;
  header.frame = vdb.frame;
  if (!vdb.dims) header.warnings.push_back("OpenVDB states no unit of length; millimetres assumed");
  check_volume_header(path, header);
  std::vector<float> samples = samples_of(grid, box);
  check_finite(path, samples);
  return source_of(std::move(header), std::move(samples));
}

void write_vdb(const Volume& volume, const fs::path& path) {
  initialize_openvdb();
  // Through the base class: naming FloatGrid's own functions would compile all of it, which takes minutes.
  const openvdb::GridBase::Ptr samples = volume.impl().grid;
  const openvdb::GridBase::Ptr grid = samples->copyGrid();
  const std::array<int, 3>& dims = volume.dims();
  grid->insertMeta(kVdbDimsKey, openvdb::Vec3IMetadata(openvdb::Vec3i(dims[0], dims[1], dims[2])));
  grid->insertMeta(kVdbFrameKey, openvdb::StringMetadata(to_string(volume.header().frame)));
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
