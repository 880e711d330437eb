// NIfTI-1 and NIfTI-2, single files and pairs.
#include <cmath>
#include <optional>

#include "volume/nifti_header.h"
#include "volume/read_support.h"
#include "volume/readers.h"
#include "volume/sample_type.h"

namespace delvox {
namespace {

namespace fs = std::filesystem;

SampleType sample_type(const fs::path& path, int datatype) {
  switch (datatype) {
    case 2: return SampleType::kUint8;
    case 4: return SampleType::kInt16;
    case 8: return SampleType::kInt32;
    case 16: return SampleType::kFloat32;
    case 64: return SampleType::kFloat64;
    case 256: return SampleType::kInt8;
    case 512: return SampleType::kUint16;
    case 768: return SampleType::kUint32;
    case 1024: return SampleType::kInt64;
    case 1280: return SampleType::kUint64;
    case 32:
    case 1792:
    case 2048: fail_input(path, "its samples are complex numbers", "convert it to magnitudes first");
    case 128:
    case 2304: fail_input(path, "its samples are RGB colours", "convert it to one grey value per voxel first");
    case 1536: fail_input(path, "its samples are 128-bit floats", "convert it to float32 first");
    case 1: fail_input(path, "its samples are single bits", "convert it to uint8 first");
    default:
      fail_input(path, "datatype " + std::to_string(datatype) + " is unknown", "convert it to float32 first");
  }
}

/// Checks dim[0..7]; returns the dims in space and how many volumes follow each other.
std::array<std::int64_t, 3> checked_dims(const fs::path& path, const NiftiHeader& nifti, std::uint64_t& volumes) {
  const std::int64_t dimension = nifti.dim[0];
  if (dimension < 1 || dimension > 7) {
    fail_input(path, "dim[0] is " + std::to_string(dimension) + ", not 1 to 7", "the header is damaged: copy it again");
  }
  std::array<std::int64_t, 3> dims{1, 1, 1};
  volumes = 1;
  for (int n = 1; n <= static_cast<int>(dimension); ++n) {
    const std::int64_t size = nifti.dim[n];
    if (size < 1) {
      fail_input(path, "dim[" + std::to_string(n) + "] is " + std::to_string(size),
                 "the header is damaged: copy or convert it again");
    }
    if (n <= 3) {
      dims[n - 1] = size;
    } else if (__builtin_mul_overflow(volumes, static_cast<std::uint64_t>(size), &volumes)) {
      fail_input(path, "dim[4] to dim[7] overflow", "the header is damaged: copy it again");
    }
  }
  return dims;
}

/// Where the samples begin.
std::uint64_t payload_offset(const fs::path& path, const NiftiHeader& nifti) {
  const double least = nifti.pair ? 0 : nifti.version == 1 ? 352 : 544;
  const double offset = nifti.vox_offset;
  if (offset == 0) return static_cast<std::uint64_t>(least);
  if (!(offset >= least) || offset > 1e15 || offset != std::floor(offset)) {
    fail_input(path, "vox_offset makes no sense", "the header is damaged: copy or convert it again");
  }
  return static_cast<std::uint64_t>(offset);
}

/// The file of samples that belongs to a header x.hdr or x.hdr.gz: x.img or x.img.gz.
fs::path image_of_pair(const fs::path& header_path) {
  fs::path stem = header_path;
  if (stem.extension() == ".gz") stem.replace_extension();
  for (const char* extension : {".img", ".img.gz"}) {
    fs::path candidate = stem;
    candidate.replace_extension(extension);
    std::error_code error;
    if (fs::exists(candidate, error)) return candidate;
  }
  stem.replace_extension(".img");
  fail_input(header_path, "its samples are missing: no " + stem.filename().string() + " beside it",
             "keep .hdr and .img together");
}

void apply_scaling(const NiftiHeader& nifti, SampleLayout& layout, std::vector<std::string>& warnings) {
  // The standard: slope 0 means none. NaN and infinity are found in real files and mean the same.
  if (nifti.slope == 0 || !std::isfinite(nifti.slope)) return;
  layout.slope = nifti.slope;
  if (std::isfinite(nifti.intercept)) {
    layout.intercept = nifti.intercept;
  } else {
    warnings.push_back("scl_inter is not finite; 0 assumed");
  }
}

/// Throws InputError unless `samples` can hold all volumes, whichever is asked for: a header that promises more is
/// damaged or the file cut short, and either puts the rest in doubt too. Gzipped files are not inflated to learn it.
void check_all_volumes(const fs::path& path, const fs::path& samples, const SampleLayout& layout, std::size_t count,
                       std::uint64_t volumes) {
  std::uint64_t all = 0, bytes = 0;
  if (__builtin_mul_overflow(std::uint64_t{count}, volumes, &all) ||
      __builtin_mul_overflow(all, std::uint64_t{size_of(layout.type)}, &bytes)) {
    fail_input(path, "the sizes of its " + std::to_string(volumes) + " volumes overflow",
               "the header is damaged: copy or convert it again");
  }
  check_payload(ByteSource(samples), layout, all);
}

/// Moves layout.offset to the volume asked for. pre: check_all_volumes
void select_volume(int index, std::size_t count, SampleLayout& layout) {
  layout.offset += static_cast<std::uint64_t>(count) * size_of(layout.type) * static_cast<std::uint64_t>(index);
}

NiftiHeader read_header(ByteSource& source) {
  const bool first = nifti_version(source.peek(kNifti1HeaderSize)) == 1;
  std::string bytes(first ? kNifti1HeaderSize : kNifti2HeaderSize, '\0');
  source.read_exactly(bytes.data(), bytes.size(), "the header");
  return parse_nifti_header(bytes);
}

}  // namespace

bool looks_like_nifti(std::string_view start) { return nifti_version(start) != 0; }

VolumeSourcePtr open_nifti(ByteSource source, const ReadVolumeOptions& options) {
  const fs::path path = source.path();
  refuse_spacing(path, options);
  const NiftiHeader nifti = read_header(source);
  std::uint64_t volumes = 1;
  const std::array<std::int64_t, 3> dims = checked_dims(path, nifti, volumes);
  const std::size_t count = checked_voxel_count(path, dims);
  VolumeHeader header;
  check_volume_index(path, options, volumes, header);
  SampleLayout layout{sample_type(path, nifti.datatype), nifti.big_endian, payload_offset(path, nifti)};
  const fs::path samples = nifti.pair ? image_of_pair(path) : path;
  check_all_volumes(path, samples, layout, count, volumes);
  select_volume(options.volume_index, count, layout);
  apply_scaling(nifti, layout, header.warnings);
  for (int axis = 0; axis < 3; ++axis) header.dims[axis] = static_cast<int>(dims[axis]);
  header.index_to_world = nifti_affine(path, nifti, header.dims, header.warnings);
  header.frame = Frame::kRas;
  header.format = nifti.version == 1 ? "NIfTI-1" : "NIfTI-2";
  header.sample_type = to_string(layout.type);
  if (nifti.bitpix != static_cast<int>(8 * size_of(layout.type))) {
    header.warnings.push_back("bitpix is " + std::to_string(nifti.bitpix) + ", datatype says " + header.sample_type +
                              "; datatype was taken");
  }
  return payload_source(path, std::move(header), samples, layout);
}

}  // namespace delvox
