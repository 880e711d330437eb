// Inrimage-4: a text header of KEY=VALUE lines that ends with a line "##}", then the samples, x fastest.
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "volume/read_support.h"
#include "volume/readers.h"
#include "volume/sample_type.h"

namespace delvox {
namespace {

constexpr std::string_view kMagic = "#INRIMAGE-4#{";
constexpr std::size_t kLongestHeader = std::size_t{1} << 16;

class InrimageReader {
 public:
  explicit InrimageReader(ByteSource source) : source_(std::move(source)) {}
  VolumeSourcePtr open();

 private:
  void read_fields();
  std::array<std::int64_t, 3> dims() const;
  SampleType sample_type() const;
  bool big_endian();
  Affine3 affine();
  void warn_of_ignored_fields();
  double number(const std::string& key, double missing) const;
  std::string text(const std::string& key) const;
  [[noreturn]] void fail(const std::string& cause, const std::string& mend = "correct the header") const {
    fail_input(source_.path(), cause, mend);
  }

  ByteSource source_;
  std::map<std::string, std::string> fields_;
  VolumeHeader header_;
};

std::string trimmed(std::string text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\r' || text.back() == '\t')) text.pop_back();
  text.erase(0, text.find_first_not_of(" \t"));
  return text;
}

void InrimageReader::read_fields() {
  // The format pads headers to a multiple of 256 bytes, but some writers (CGAL's among them) do not: the end is the
  // newline after "##}", wherever it stands.
  std::string line;
  bool first = true;
  for (std::size_t length = 0;; ++length) {
    char c;
    if (length == kLongestHeader) fail("the header does not end with ##}");
    source_.read_exactly(&c, 1, "the header");
    if (c != '\n') {
      line += c;
      continue;
    }
    line = trimmed(line);
    if (first && line != kMagic) fail("not Inrimage-4: the first line is not " + std::string(kMagic));
    if (line.starts_with("##}")) return;
    const std::size_t equals = line.find('=');
    if (!first && equals != std::string::npos && line[0] != '#') {
      fields_[trimmed(line.substr(0, equals))] = trimmed(line.substr(equals + 1));
    }
    first = false;
    line.clear();
  }
}

std::string InrimageReader::text(const std::string& key) const {
  const auto found = fields_.find(key);
  if (found == fields_.end()) fail("the header lacks " + key);
  return found->second;
}

double InrimageReader::number(const std::string& key, double missing) const {
  const auto found = fields_.find(key);
  if (found == fields_.end()) return missing;
  const std::string& text = found->second;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) fail(key + "=" + text + " is not a number");
  return value;
}

std::array<std::int64_t, 3> InrimageReader::dims() const {
  std::array<std::int64_t, 3> result{};
  const char* keys[3] = {"XDIM", "YDIM", "ZDIM"};
  for (int axis = 0; axis < 3; ++axis) {
    const std::string value = text(keys[axis]);
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), result[axis]);
    if (error != std::errc{} || end != value.data() + value.size()) {
      fail(std::string(keys[axis]) + "=" + value + " is not a number of voxels");
    }
  }
  if (number("VDIM", 1) != 1) {
    fail("it has VDIM=" + text("VDIM") + " values per voxel (colour, complex or vectors)",
         "convert it to one value per voxel");
  }
  return result;
}

SampleType InrimageReader::sample_type() const {
  const std::string type = text("TYPE"), size = text("PIXSIZE");
  int bits = 0;
  const auto [end, error] = std::from_chars(size.data(), size.data() + size.size(), bits);
  const std::string unit = trimmed(std::string(end, size.data() + size.size()));
  std::optional<SampleType> result;
  if (error == std::errc{} && (unit.empty() || unit == "bits")) {
    if (type == "float") result = float_type(bits);
    if (type == "unsigned fixed") result = integer_type(bits, false);
    if (type == "signed fixed") result = integer_type(bits, true);
  }
  if (!result) fail("TYPE=" + type + " with PIXSIZE=" + size + " is not supported", "convert it to float of 32 bits");
  return *result;
}

bool InrimageReader::big_endian() {
  if (!fields_.contains("CPU")) {
    header_.warnings.push_back("the header lacks CPU; little-endian assumed");
    return false;
  }
  const std::string cpu = text("CPU");
  if (cpu == "decm" || cpu == "alpha" || cpu == "pc") return false;
  if (cpu == "sun" || cpu == "sgi") return true;
  fail("CPU=" + cpu + " is unknown", "write decm (little-endian) or sun (big-endian)");
}

Affine3 InrimageReader::affine() {
  if (!fields_.contains("VX") || !fields_.contains("VY") || !fields_.contains("VZ")) {
    header_.warnings.push_back("the header lacks VX, VY or VZ; a spacing of 1 mm assumed there");
  }
  // T is a translation of the whole image, as CGAL takes it; the first voxel's centre lies there.
  return axis_aligned(source_.path(), {number("VX", 1), number("VY", 1), number("VZ", 1)},
                      {number("TX", 0), number("TY", 0), number("TZ", 0)});
}

void InrimageReader::warn_of_ignored_fields() {
  for (const char* key : {"RX", "RY", "RZ", "XO", "YO", "ZO"}) {
    if (number(key, 0) != 0) header_.warnings.push_back(std::string(key) + " (rotation or centre) is ignored");
  }
  const auto scale = fields_.find("SCALE");
  if (scale != fields_.end() && scale->second != "2**0") {
    header_.warnings.push_back("SCALE=" + scale->second + " is ignored: samples are as stored");
  }
}

VolumeSourcePtr InrimageReader::open() {
  read_fields();
  const std::array<std::int64_t, 3> size = dims();
  checked_voxel_count(source_.path(), size);
  SampleLayout layout{sample_type()};
  layout.big_endian = size_of(layout.type) > 1 && big_endian();
  layout.offset = source_.position();
  for (int axis = 0; axis < 3; ++axis) header_.dims[axis] = static_cast<int>(size[axis]);
  header_.format = "Inrimage-4";
  header_.sample_type = to_string(layout.type);
  header_.index_to_world = affine();
  warn_of_ignored_fields();
  return payload_source(source_.path(), std::move(header_), source_.path(), layout);
}

}  // namespace

bool looks_like_inrimage(std::string_view start) { return start.starts_with(kMagic); }

VolumeSourcePtr open_inrimage(ByteSource source, const ReadVolumeOptions& options) {
  refuse_spacing(source.path(), options);
  VolumeHeader unused;
  check_volume_index(source.path(), options, 1, unused);
  return InrimageReader(std::move(source)).open();
}

}  // namespace delvox
