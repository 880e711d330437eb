#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace delvox {

/// Types of sample that the volume formats store.
enum class SampleType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat32, kFloat64 };

std::size_t size_of(SampleType type);
/// "uint8", "float32", ...
const char* to_string(SampleType type);
std::optional<SampleType> parse_sample_type(std::string_view name);
/// The integer type of this width and sign, or the floating one.
std::optional<SampleType> integer_type(int bits, bool is_signed);
std::optional<SampleType> float_type(int bits);

/// What converting samples to float32 lost.
struct ConversionTally {
  std::size_t not_finite = 0;  ///< NaN, infinite or beyond float32
  std::size_t inexact = 0;     ///< unscaled samples that float32 cannot hold exactly
};

/// out[n] = slope * in[n] + intercept, computed in double. `in` need not be aligned.
void convert_samples(const unsigned char* in, std::size_t count, SampleType type, bool big_endian, double slope,
                     double intercept, float* out, ConversionTally& tally);

}  // namespace delvox
