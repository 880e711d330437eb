#include "volume/sample_type.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace delvox {
namespace {

struct TypeInfo {
  SampleType type;
  const char* name;
  std::size_t size;
};
constexpr TypeInfo kTypes[] = {
    {SampleType::kInt8, "int8", 1},     {SampleType::kUint8, "uint8", 1},     {SampleType::kInt16, "int16", 2},
    {SampleType::kUint16, "uint16", 2}, {SampleType::kInt32, "int32", 4},     {SampleType::kUint32, "uint32", 4},
    {SampleType::kInt64, "int64", 8},   {SampleType::kUint64, "uint64", 8},   {SampleType::kFloat32, "float32", 4},
    {SampleType::kFloat64, "float64", 8}};

const TypeInfo& info(SampleType type) { return kTypes[static_cast<int>(type)]; }

template <class T, bool swap>
T load(const unsigned char* in) {
  unsigned char bytes[sizeof(T)];
  for (std::size_t b = 0; b < sizeof(T); ++b) bytes[b] = in[swap ? sizeof(T) - 1 - b : b];
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

/// Whether float32 holds the value exactly. Casting an integer back could overflow, so compare in long double.
template <class T>
bool is_exact(T value, float rounded) {
  if constexpr (sizeof(T) <= 2 || std::is_same_v<T, float>) return true;
  return static_cast<long double>(value) == static_cast<long double>(rounded);
}

template <class T, bool swap>
void convert(const unsigned char* in, std::size_t count, double slope, double intercept, float* out,
             ConversionTally& tally) {
  const bool scaled = slope != 1 || intercept != 0;
  for (std::size_t n = 0; n < count; ++n) {
    const T value = load<T, swap>(in + n * sizeof(T));
    out[n] = scaled ? static_cast<float>(slope * static_cast<double>(value) + intercept) : static_cast<float>(value);
  }
  for (std::size_t n = 0; n < count; ++n) tally.not_finite += std::isfinite(out[n]) ? 0 : 1;
  if constexpr (sizeof(T) > 2 && !std::is_same_v<T, float>) {
    if (scaled) return;
    for (std::size_t n = 0; n < count; ++n) {
      tally.inexact += is_exact(load<T, swap>(in + n * sizeof(T)), out[n]) ? 0 : 1;
    }
  }
}

template <class T>
void convert_either_order(const unsigned char* in, std::size_t count, bool big_endian, double slope, double intercept,
                          float* out, ConversionTally& tally) {
  const bool swap = big_endian != (std::endian::native == std::endian::big);
  if (swap) {
    convert<T, true>(in, count, slope, intercept, out, tally);
  } else {
    convert<T, false>(in, count, slope, intercept, out, tally);
  }
}

}  // namespace

std::size_t size_of(SampleType type) { return info(type).size; }
const char* to_string(SampleType type) { return info(type).name; }

std::optional<SampleType> parse_sample_type(std::string_view name) {
  for (const TypeInfo& entry : kTypes) {
    if (name == entry.name) return entry.type;
  }
  return std::nullopt;
}

std::optional<SampleType> integer_type(int bits, bool is_signed) {
  switch (bits) {
    case 8: return is_signed ? SampleType::kInt8 : SampleType::kUint8;
    case 16: return is_signed ? SampleType::kInt16 : SampleType::kUint16;
    case 32: return is_signed ? SampleType::kInt32 : SampleType::kUint32;
    case 64: return is_signed ? SampleType::kInt64 : SampleType::kUint64;
    default: return std::nullopt;
  }
}

std::optional<SampleType> float_type(int bits) {
  if (bits == 32) return SampleType::kFloat32;
  if (bits == 64) return SampleType::kFloat64;
  return std::nullopt;
}

void convert_samples(const unsigned char* in, std::size_t count, SampleType type, bool big_endian, double slope,
                     double intercept, float* out, ConversionTally& tally) {
  const auto run = [&]<class T>(T) {
    convert_either_order<T>(in, count, big_endian, slope, intercept, out, tally);
  };
  switch (type) {
    case SampleType::kInt8: return run(std::int8_t{});
    case SampleType::kUint8: return run(std::uint8_t{});
    case SampleType::kInt16: return run(std::int16_t{});
    case SampleType::kUint16: return run(std::uint16_t{});
    case SampleType::kInt32: return run(std::int32_t{});
    case SampleType::kUint32: return run(std::uint32_t{});
    case SampleType::kInt64: return run(std::int64_t{});
    case SampleType::kUint64: return run(std::uint64_t{});
    case SampleType::kFloat32: return run(float{});
    case SampleType::kFloat64: return run(double{});
  }
}

}  // namespace delvox
