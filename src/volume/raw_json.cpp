// Raw samples described by a JSON file beside them:
//
//   {
//     "file": "scan.raw",            of the samples, relative to this file; gzip is recognised
//     "dims": [256, 256, 100],       along i, j, k; i varies fastest
//     "type": "uint16",              int8 uint8 int16 uint16 int32 uint32 int64 uint64 float32 float64
//     "endian": "little",            or "big"; default little
//     "offset": 0,                   bytes before the first sample (after inflating); default 0
//     "slope": 1, "intercept": 0,    value = slope * stored + intercept
//     "unit": "mm",                  of all lengths below: mm (default), um, cm, m
//     "frame": "RAS",                or "LPS", "unknown" (default)
//     "spacing": [0.5, 0.5, 1.0],    of voxels along i, j, k
//     "origin": [0, 0, 0],           centre of the first voxel; default 0
//     "direction": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],   rows; column n is the unit vector of axis n
//     "affine": [[0.5, 0, 0, 0], ...]    three rows of four, in place of spacing, origin and direction
//   }
//
// Any other key is an error: a misspelt one must not be passed over.
#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/output_file.h"
#include "delvox/core/errors.h"
#include "volume/read_support.h"
#include "volume/readers.h"
#include "volume/sample_type.h"
#include "volume/writers.h"

namespace delvox {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kLongestSidecar = std::size_t{1} << 20;
constexpr const char* kKeys[] = {"file", "dims",  "type",    "endian", "offset",    "slope", "intercept",
                                 "unit", "frame", "spacing", "origin", "direction", "affine"};

class Sidecar {
 public:
  explicit Sidecar(ByteSource& source) : path_(source.path()) {
    std::string text(kLongestSidecar, '\0');
    text.resize(source.read(text.data(), text.size()));
    if (text.size() == kLongestSidecar) fail("longer than a sidecar can be");
    value_ = json::parse(text, nullptr, /*allow_exceptions=*/false);
    if (value_.is_discarded()) fail("not valid JSON", "check commas, quotes and brackets");
    if (!value_.is_object()) fail("not a JSON object");
    for (const auto& [key, unused] : value_.items()) {
      if (std::find(std::begin(kKeys), std::end(kKeys), key) == std::end(kKeys)) {
        std::string known;
        for (const char* name : kKeys) known += known.empty() ? name : std::string(", ") + name;
        fail("unknown key '" + key + "'", "the keys are " + known);
      }
    }
  }

  bool has(const char* key) const { return value_.contains(key); }
  std::string text(const char* key, const char* missing) const {
    if (!has(key) && missing != nullptr) return missing;
    if (!has(key)) fail(std::string("the key '") + key + "' is missing", "add it");
    if (!value_[key].is_string()) fail(std::string("'") + key + "' is no string");
    return value_[key].get<std::string>();
  }
  double real(const char* key, double missing) const { return has(key) ? real(value_[key], key) : missing; }
  std::int64_t integer(const json& value, const char* key) const {
    const bool too_large = value.is_number_unsigned() && value.get<std::uint64_t>() >> 63 != 0;
    if (!value.is_number_integer() || too_large) fail(std::string("'") + key + "' is no integer in range");
    return value.get<std::int64_t>();
  }
  std::uint64_t offset() const {
    const std::int64_t value = has("offset") ? integer(value_["offset"], "offset") : 0;
    if (value < 0) fail("'offset' is negative");
    return static_cast<std::uint64_t>(value);
  }
  std::array<std::int64_t, 3> dims() const {
    if (!has("dims")) fail("the key 'dims' is missing", "add it");
    check_array(value_["dims"], 3, "dims");
    return {integer(value_["dims"][0], "dims"), integer(value_["dims"][1], "dims"), integer(value_["dims"][2], "dims")};
  }
  Vector3 vector(const char* key) const {
    check_array(value_[key], 3, key);
    return {real(value_[key][0], key), real(value_[key][1], key), real(value_[key][2], key)};
  }
  /// Three rows of `columns`.
  std::vector<std::vector<double>> matrix(const char* key, std::size_t columns) const {
    check_array(value_[key], 3, key);
    std::vector<std::vector<double>> rows(3);
    for (std::size_t r = 0; r < 3; ++r) {
      check_array(value_[key][r], columns, key);
      for (const json& entry : value_[key][r]) rows[r].push_back(real(entry, key));
    }
    return rows;
  }
  [[noreturn]] void fail(const std::string& cause, const std::string& mend = "correct the JSON file") const {
    fail_input(path_, cause, mend);
  }

 private:
  double real(const json& value, const char* key) const {
    if (!value.is_number() || !std::isfinite(value.get<double>())) fail(std::string("'") + key + "' is no number");
    return value.get<double>();
  }
  void check_array(const json& value, std::size_t size, const char* key) const {
    if (!value.is_array() || value.size() != size) {
      fail(std::string("'") + key + "' is not an array as expected", "write " + std::to_string(size) + " entries");
    }
  }

  fs::path path_;
  json value_;
};

double unit_in_mm(const Sidecar& sidecar) {
  const std::string unit = sidecar.text("unit", "mm");
  if (unit == "mm") return 1;
  if (unit == "um") return 1e-3;
  if (unit == "cm") return 10;
  if (unit == "m") return 1000;
  sidecar.fail("unit '" + unit + "' is unknown", "use mm, um, cm or m");
}

Frame frame(const Sidecar& sidecar) {
  const std::string name = sidecar.text("frame", "unknown");
  if (name == "RAS") return Frame::kRas;
  if (name == "LPS") return Frame::kLps;
  if (name == "unknown") return Frame::kUnknown;
  sidecar.fail("frame '" + name + "' is unknown", "use RAS, LPS or unknown");
}

Affine3 affine_of_rows(const Sidecar& sidecar) {
  if (sidecar.has("spacing") || sidecar.has("origin") || sidecar.has("direction")) {
    sidecar.fail("'affine' stands beside spacing, origin or direction", "state one or the other");
  }
  const std::vector<std::vector<double>> rows = sidecar.matrix("affine", 4);
  Affine3 affine;
  for (int r = 0; r < 3; ++r) std::copy(rows[r].begin(), rows[r].end(), affine.rows[r].begin());
  return affine;
}

Affine3 affine(const fs::path& path, const Sidecar& sidecar, const ReadVolumeOptions& options,
               std::vector<std::string>& warnings) {
  const bool states_spacing = sidecar.has("affine") || sidecar.has("spacing");
  if (states_spacing) refuse_spacing(path, options);
  Affine3 result;
  if (sidecar.has("affine")) {
    result = affine_of_rows(sidecar);
  } else {
    Vector3 spacing{1, 1, 1};
    if (sidecar.has("spacing")) spacing = sidecar.vector("spacing");
    if (!states_spacing && !options.spacing) warnings.push_back("the file states no spacing; 1 mm assumed (--spacing)");
    result = axis_aligned(path, spacing, sidecar.has("origin") ? sidecar.vector("origin") : Point3{});
    if (sidecar.has("direction")) {
      const std::vector<std::vector<double>> direction = sidecar.matrix("direction", 3);
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) result.rows[r][c] = direction[r][c] * spacing[c];
      }
    }
  }
  const double unit = unit_in_mm(sidecar);
  for (auto& row : result.rows) {
    for (double& entry : row) entry *= unit;
  }
  if (options.spacing && !states_spacing) {
    for (auto& row : result.rows) {
      for (int c = 0; c < 3; ++c) row[c] *= (*options.spacing)[c] / unit;
    }
  }
  return result;
}

}  // namespace

bool looks_like_raw_json(std::string_view start) {
  const std::size_t first = start.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && start[first] == '{';
}

VolumeSourcePtr open_raw_json(ByteSource source, const ReadVolumeOptions& options) {
  const fs::path path = source.path();
  const Sidecar sidecar(source);
  VolumeHeader header;
  check_volume_index(path, options, 1, header);
  const std::array<std::int64_t, 3> dims = sidecar.dims();
  checked_voxel_count(path, dims);
  const std::string type_name = sidecar.text("type", nullptr), endian = sidecar.text("endian", "little");
  const std::optional<SampleType> type = parse_sample_type(type_name);
  if (!type) sidecar.fail("type '" + type_name + "' is unknown", "use int8 to uint64, float32 or float64");
  if (endian != "little" && endian != "big") sidecar.fail("endian '" + endian + "' is unknown", "use little or big");
  SampleLayout layout{*type, endian == "big", sidecar.offset(), sidecar.real("slope", 1), sidecar.real("intercept", 0)};
  for (int axis = 0; axis < 3; ++axis) header.dims[axis] = static_cast<int>(dims[axis]);
  header.index_to_world = affine(path, sidecar, options, header.warnings);
  header.frame = frame(sidecar);
  header.format = "raw+JSON";
  header.sample_type = to_string(*type);
  return payload_source(path, std::move(header), path.parent_path() / sidecar.text("file", nullptr), layout);
}

void write_raw_json(const Volume& volume, const fs::path& path) {
  fs::path raw_path = path;
  raw_path.replace_extension(".raw");
  const VolumeHeader& header = volume.header();
  nlohmann::ordered_json sidecar;
  sidecar["file"] = raw_path.filename().string();
  sidecar["dims"] = header.dims;
  sidecar["type"] = "float32";
  sidecar["endian"] = std::endian::native == std::endian::big ? "big" : "little";
  sidecar["unit"] = "mm";
  sidecar["frame"] = to_string(header.frame);
  sidecar["affine"] = header.index_to_world.rows;
  OutputFile raw(raw_path), json_file(path);
  for_each_slab(volume, [&](const float* samples, int, std::size_t count) {
    raw.stream().write(reinterpret_cast<const char*>(samples), static_cast<std::streamsize>(count * sizeof(float)));
  });
  try {
    json_file.stream() << sidecar.dump(2) << '\n';
  } catch (const json::exception&) {
    throw OptionError(path.string() + ": JSON cannot state a file name that is not UTF-8; choose another");
  }
  // The sidecar last: where it stands, its samples are there.
  raw.commit();
  json_file.commit();
}

}  // namespace delvox
