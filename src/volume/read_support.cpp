#include "volume/read_support.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "delvox/core/errors.h"
#include "volume/byte_source.h"
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

}  // namespace

void fail_input(const std::filesystem::path& path, const std::string& cause, const std::string& mend) {
  throw InputError(one_line(path.string() + ": " + cause + "; " + mend));
}

std::size_t checked_voxel_count(const std::filesystem::path& path, const std::array<std::int64_t, 3>& dims) {
  const std::string text =
      std::to_string(dims[0]) + " x " + std::to_string(dims[1]) + " x " + std::to_string(dims[2]);
  double count = 1;
  for (std::int64_t n : dims) {
    if (n < 1) fail_input(path, "the dimensions are " + text, "the header is damaged: copy or convert the file again");
    if (n > std::numeric_limits<int>::max()) {
      fail_input(path, "the dimensions are " + text + ", above 2^31-1 along an axis", "crop or resample it first");
    }
    count *= static_cast<double>(n);
  }
  // One dense copy and, at worst, as much again in the grid.
  const double needed = count * 2 * sizeof(float);
  const double memory = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  if (needed > memory || needed > std::ldexp(1.0, 40)) {
    fail_input(path,
               "a volume of " + text + " needs about " + gigabytes(needed) + " of memory, this machine has " +
                   gigabytes(memory),
               "crop or resample the file first, or check its header");
  }
  return static_cast<std::size_t>(dims[0]) * static_cast<std::size_t>(dims[1]) * static_cast<std::size_t>(dims[2]);
}

void check_tally(const std::filesystem::path& path, const ConversionTally& tally, SampleType type,
                 VolumeHeader& header) {
  if (tally.not_finite > 0) {
    fail_input(path,
               std::to_string(tally.not_finite) + " samples are NaN, infinite or beyond float32",
               "replace them first, e.g. by the background value");
  }
  if (tally.inexact > 0) {
    header.warnings.push_back(std::to_string(tally.inexact) + " samples of type " + to_string(type) +
                              " were rounded to float32");
  }
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
  check_payload(source, layout, count);
  if (layout.offset < source.position()) {
    fail_input(source.path(), "the samples overlap the header", "convert the file again");
  }
  source.skip(layout.offset - source.position(), "the data before the samples");
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

std::vector<float> read_samples(ByteSource& source, const SampleLayout& layout, std::size_t count,
                                VolumeHeader& header) {
  check_payload(source, layout, count);
  std::vector<float> samples(count);
  ConversionTally tally;
  read_sample_run(source, layout, count, samples.data(), tally);
  check_tally(source.path(), tally, layout.type, header);
  return samples;
}

Volume make_volume(const std::filesystem::path& path, VolumeHeader header, const std::vector<float>& samples) {
  try {
    return Volume(std::move(header), samples);
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
