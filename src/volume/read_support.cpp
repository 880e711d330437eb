#include "volume/read_support.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/available_memory.h"
#include "delvox/core/errors.h"
#include "volume/byte_source.h"
#include "volume/grid_builder.h"
#include "volume/sample_type.h"

namespace delvox {
namespace {

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return text;
}

std::string gigabytes(double bytes) {
  const double value = bytes / (1 << 30);
  char text[32];
  std::snprintf(text, sizeof text, value < 10 ? "%.1f GB" : "%.0f GB", value);
  return text;
}

std::string text_of(const std::array<std::int64_t, 3>& dims) {
  return std::to_string(dims[0]) + " x " + std::to_string(dims[1]) + " x " + std::to_string(dims[2]);
}

void check_memory(const std::filesystem::path& path, const std::string& what, double needed) {
  const auto memory = static_cast<double>(available_memory());
  if (needed <= memory && needed <= std::ldexp(1.0, 40)) return;
  fail_input(path,
             what + " needs about " + gigabytes(needed) + " of memory, " + gigabytes(memory) + " are available",
             "crop or resample the file first, check its header, or free some memory");
}

}  // namespace

void fail_input(const std::filesystem::path& path, const std::string& cause, const std::string& mend) {
  throw InputError(one_line(path.string() + ": " + cause + "; " + mend));
}

std::size_t checked_voxel_count(const std::filesystem::path& path, const std::array<std::int64_t, 3>& dims) {
  for (std::int64_t n : dims) {
    if (n < 1) {
      fail_input(path, "the dimensions are " + text_of(dims), "the header is damaged: copy or convert the file again");
    }
    if (n > std::numeric_limits<int>::max()) {
      fail_input(path, "the dimensions are " + text_of(dims) + ", above 2^31-1 along an axis",
                 "crop or resample it first");
    }
  }
  const double area = static_cast<double>(dims[0]) * static_cast<double>(dims[1]);
  if (area * static_cast<double>(dims[2]) > std::ldexp(1.0, 40)) {
    fail_input(path, "the dimensions are " + text_of(dims) + ", above 2^40 voxels", "crop or resample it first");
  }
  constexpr double kSlabsInMemory = 3;
  const double slices = kSlabsInMemory * static_cast<double>(std::min<std::int64_t>(dims[2], kSlabSlices));
  check_memory(path, "a volume of " + text_of(dims), area * slices * sizeof(float));
  return static_cast<std::size_t>(dims[0]) * static_cast<std::size_t>(dims[1]) * static_cast<std::size_t>(dims[2]);
}

void check_fits_whole(const std::filesystem::path& path, const std::array<std::int64_t, 3>& dims) {
  // One dense copy and, at worst, as much again in the grid.
  const double count = static_cast<double>(dims[0]) * static_cast<double>(dims[1]) * static_cast<double>(dims[2]);
  check_memory(path, "a volume of " + text_of(dims) + " as a whole", count * 2 * sizeof(float));
}

void check_finite(const std::filesystem::path& path, const ConversionTally& tally) {
  if (tally.not_finite == 0) return;
  fail_input(path, std::to_string(tally.not_finite) + " samples are NaN, infinite or beyond float32",
             "replace them first, e.g. by the background value");
}

std::vector<std::string> tally_warnings(const ConversionTally& tally, SampleType type) {
  if (tally.inexact == 0) return {};
  return {std::to_string(tally.inexact) + " samples of type " + to_string(type) + " were rounded to float32"};
}

void check_payload(const ByteSource& source, const SampleLayout& layout, std::size_t count) {
  const std::uint64_t payload = static_cast<std::uint64_t>(count) * size_of(layout.type);
  const std::uint64_t capacity = source.capacity();
  if (layout.offset <= capacity && payload <= capacity - layout.offset) return;
  fail_input(source.path(),
             "truncated: the header declares " + std::to_string(payload) + " bytes of samples from byte " +
                 std::to_string(layout.offset) + ", the file can hold " + std::to_string(capacity),
             "copy or download the file again");
}

void read_sample_run(ByteSource& source, const SampleLayout& layout, std::size_t count, float* out,
                     ConversionTally& tally) {
  constexpr std::size_t kSamplesPerPiece = std::size_t{1} << 16;
  const std::size_t sample_size = size_of(layout.type);
  std::vector<unsigned char> piece(std::min(kSamplesPerPiece, count) * sample_size);
  for (std::size_t done = 0; done < count;) {
    const std::size_t n = std::min(kSamplesPerPiece, count - done);
    source.read_exactly(piece.data(), n * sample_size, "the samples");
    convert_samples(piece.data(), n, layout.type, layout.big_endian, layout.slope, layout.intercept, out + done, tally);
    done += n;
  }
}

namespace {

class PayloadReader final : public SliceReader {
 public:
  PayloadReader(const std::filesystem::path& payload, const SampleLayout& layout, const std::array<int, 3>& dims)
      : source_(payload), layout_(layout), area_(static_cast<std::size_t>(dims[0]) * dims[1]), left_(dims[2]) {
    source_.skip(layout_.offset, "the data before the samples");
  }
  void read(int count, float* out) override {
    read_sample_run(source_, layout_, area_ * count, out, tally_);
    check_finite(source_.path(), tally_);
    left_ -= count;
    if (left_ == 0) source_.verify_end();
  }
  std::vector<std::string> warnings() const override { return tally_warnings(tally_, layout_.type); }

 private:
  ByteSource source_;
  SampleLayout layout_;
  ConversionTally tally_;
  std::size_t area_;
  int left_;
};

class PayloadSource final : public VolumeSource {
 public:
  PayloadSource(VolumeHeader header, std::filesystem::path payload, const SampleLayout& layout)
      : VolumeSource(std::move(header)), payload_(std::move(payload)), layout_(layout) {
    check_payload(ByteSource(payload_), layout_, voxel_count());
  }
  std::unique_ptr<SliceReader> start() const override {
    return std::make_unique<PayloadReader>(payload_, layout_, dims());
  }

 private:
  std::filesystem::path payload_;
  SampleLayout layout_;
};

}  // namespace

VolumeSourcePtr payload_source(const std::filesystem::path& path, VolumeHeader header,
                               const std::filesystem::path& payload, const SampleLayout& layout) {
  check_volume_header(path, header);
  return std::make_shared<PayloadSource>(std::move(header), payload, layout);
}

void check_volume_header(const std::filesystem::path& path, const VolumeHeader& header) {
  try {
    check_header(header);
  } catch (const InputError& error) {
    const std::string text = error.what(), prefix = "volume: ";
    throw InputError(one_line(path.string() + ": " + (text.starts_with(prefix) ? text.substr(prefix.size()) : text)));
  }
}

void refuse_spacing(const std::filesystem::path& path, const ReadVolumeOptions& options) {
  if (options.spacing) throw OptionError(path.string() + ": the file states its own spacing; leave --spacing out");
}

void check_volume_index(const std::filesystem::path& path, const ReadVolumeOptions& options, std::uint64_t volumes,
                        VolumeHeader& header) {
  if (options.volume_index < 0 || static_cast<std::uint64_t>(options.volume_index) >= volumes) {
    fail_input(path,
               "there is no volume " + std::to_string(options.volume_index) + " in it, it holds " +
                   std::to_string(volumes),
               "choose --volume-index from 0 to " + std::to_string(volumes - 1));
  }
  if (volumes > 1) {
    header.warnings.push_back("the file holds " + std::to_string(volumes) + " volumes; number " +
                              std::to_string(options.volume_index) + " was read (--volume-index)");
  }
}

Affine3 axis_aligned(const std::filesystem::path& path, const Vector3& spacing, const Point3& origin) {
  Affine3 affine;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(spacing[axis] > 0) || !std::isfinite(spacing[axis])) {
      fail_input(path, "the voxel spacing along " + std::string(1, "ijk"[axis]) + " is " +
                           std::to_string(spacing[axis]), "correct the header: spacings are positive, in mm");
    }
    if (!std::isfinite(origin[axis])) fail_input(path, "the origin is not finite", "correct the header");
    affine.rows[axis][axis] = spacing[axis];
    affine.rows[axis][3] = origin[axis];
  }
  return affine;
}

}  // namespace delvox
