// A volume from TIFF: the pages of a file, of the files of a folder or of those that match a pattern, in natural
// order, are the slices k = 0, 1, ...; i runs right, j down.
#include <glob.h>

#include <algorithm>
#include <cmath>

#include "delvox/core/errors.h"
#include "volume/natural_order.h"
#include "volume/read_support.h"
#include "volume/readers.h"
#include "volume/tiff_slices.h"

namespace delvox {
namespace {

namespace fs = std::filesystem;

bool has_tiff_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".tif" || extension == ".tiff";
}

void sort_naturally(std::vector<fs::path>& files) {
  std::sort(files.begin(), files.end(),
            [](const fs::path& a, const fs::path& b) { return natural_less(a.native(), b.native()); });
}

/// The TIFF files of a folder; counts what else lies there.
std::vector<fs::path> tiff_files_in(const fs::path& folder, std::vector<std::string>& warnings) {
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  if (error) fail_input(folder, error.message(), "make the folder readable");
  std::vector<fs::path> files;
  std::size_t others = 0;
  for (const fs::directory_entry& entry : entries) {
    // Hidden files are droppings of desktops, macOS's ._slice1.tif among them.
    if (entry.path().filename().native().starts_with('.')) continue;
    const bool is_slice = has_tiff_extension(entry.path()) && !entry.is_directory(error);
    if (is_slice) files.push_back(entry.path());
    others += is_slice ? 0 : 1;
  }
  if (files.empty()) {
    fail_input(folder, "no .tif or .tiff file in this folder, " + std::to_string(others) + " other entries",
               "give a folder of TIFF slices or a volume file");
  }
  if (others > 0) warnings.push_back(std::to_string(others) + " entries of the folder are no TIFF files; ignored");
  sort_naturally(files);
  return files;
}

class TiffStack {
 public:
  TiffStack(fs::path name, std::vector<fs::path> files, std::vector<std::string> warnings) {
    slices_.name = std::move(name);
    slices_.files = std::move(files);
    header_.warnings = std::move(warnings);
  }
  VolumeSourcePtr open(const ReadVolumeOptions& options);

 private:
  void survey();
  void survey_file(std::size_t file);
  void select_slices(const ReadVolumeOptions& options);
  void set_affine(const ReadVolumeOptions& options);
  void warn(const std::string& text) {
    if (std::find(header_.warnings.begin(), header_.warnings.end(), text) == header_.warnings.end()) {
      header_.warnings.push_back(text);
    }
  }
  void check_contiguous();

  TiffSlices slices_;
  VolumeHeader header_;
  TiffGeometry geometry_;
};

void TiffStack::survey_file(std::size_t file) {
  // Opening by ByteSource first: its messages for missing or unreadable files are clearer than libtiff's.
  ByteSource probe(slices_.files[file]);
  TiffFile tiff(slices_.files[file]);
  std::uint64_t bytes = 0;
  int number = 0;
  do {
    const TiffPage page = tiff.page();
    ++number;
    if (page.auxiliary) {
      warn("thumbnail or mask pages were left out");
      continue;
    }
    if (slices_.pages.empty()) slices_.first = page;
    slices_.compare(page, file, number);
    if (page.orientation != 1) warn("the orientation tag is ignored: rows and columns are as stored");
    if (page.min_is_white && !page.inverted()) {
      warn("black and white are swapped (MinIsWhite), which is ignored for floating samples");
    }
    slices_.pages.push_back({file, number});
    bytes += page.pixel_count() * page.bits / 8;
    // Pages may not share samples: a small file could then claim any number of slices.
    if (bytes > tiff.capacity()) fail_input(slices_.files[file], "its pages hold more than the file can", "copy it again");
  } while (tiff.next_page());
  for (const std::string& text : tiff.warnings()) warn(text);
}

void TiffStack::survey() {
  for (std::size_t file = 0; file < slices_.files.size(); ++file) survey_file(file);
  if (slices_.pages.empty()) fail_input(slices_.name, "it holds thumbnails or masks only", "give the images themselves");
  geometry_ = parse_tiff_geometry(slices_.first, header_.warnings);
  slices_.contiguous = slices_.pages.size() == 1 && geometry_.images > 1 && !slices_.first.compressed && slices_.first.bits >= 8;
  if (slices_.contiguous) {
    check_contiguous();
  } else if (geometry_.images > 1 && static_cast<std::size_t>(geometry_.images) != slices_.pages.size()) {
    warn("ImageJ's description counts " + std::to_string(geometry_.images) + " images, there are " +
         std::to_string(slices_.pages.size()));
  }
}

void TiffStack::check_contiguous() {
  const TiffFile tiff(slices_.files[0]);
  const ByteSource source(slices_.files[0]);
  slices_.layout = SampleLayout{slices_.first.type, tiff.big_endian(), tiff.first_sample_offset()};
  slices_.layout.slope = slices_.first.slope();
  slices_.layout.intercept = slices_.first.intercept();
  check_payload(source, slices_.layout, slices_.first.pixel_count() * static_cast<std::size_t>(geometry_.images));
}

/// Picks one channel and frame of an ImageJ hyperstack, whose pages run through channels, then slices, then frames.
void TiffStack::select_slices(const ReadVolumeOptions& options) {
  const std::uint64_t total = slices_.contiguous ? static_cast<std::uint64_t>(geometry_.images) : slices_.pages.size();
  const std::uint64_t channels = static_cast<std::uint64_t>(geometry_.channels);
  const std::uint64_t frames = static_cast<std::uint64_t>(geometry_.frames);
  std::uint64_t slices = total;
  std::uint64_t volumes = 1;
  if (channels * frames > 1) {
    // A stack whose third axis ImageJ calls time is one volume all the same.
    volumes = channels * frames == total ? channels : channels * frames;
    if (total % volumes != 0) volumes = 1;
    slices = total / volumes;
  }
  check_volume_index(slices_.name, options, volumes, header_);
  const std::uint64_t index = static_cast<std::uint64_t>(options.volume_index);
  const std::uint64_t start = index % channels + index / channels * slices * channels;
  std::vector<TiffPageRef> chosen;
  checked_voxel_count(slices_.name, {slices_.first.width, slices_.first.height, static_cast<std::int64_t>(slices)});
  for (std::uint64_t k = 0; k < slices; ++k) {
    const std::uint64_t n = volumes == 1 ? k : start + k * channels;
    chosen.push_back(slices_.contiguous ? TiffPageRef{0, static_cast<int>(n) + 1} : slices_.pages[n]);
  }
  slices_.pages = std::move(chosen);
}

void TiffStack::set_affine(const ReadVolumeOptions& options) {
  Vector3 spacing{geometry_.spacing[0], geometry_.spacing[1], geometry_.spacing[2]};
  if (options.spacing) {
    spacing = *options.spacing;
  } else if (spacing.x == 0 && spacing.y == 0 && spacing.z == 0) {
    spacing = {1, 1, 1};
    warn("the file states no spacing; 1 mm assumed (--spacing)");
  } else {
    if (spacing.x == 0) spacing.x = spacing.y != 0 ? spacing.y : spacing.z;
    if (spacing.y == 0) spacing.y = spacing.x;
    if (spacing.z == 0) {
      spacing.z = spacing.x;
      warn("the file states no spacing between slices; the same as along a row assumed (--spacing)");
    }
  }
  Point3 origin{geometry_.origin[0], geometry_.origin[1], geometry_.origin[2]};
  if (options.spacing) origin = {};
  header_.index_to_world = axis_aligned(slices_.name, spacing, origin);
  if (geometry_.frame == "RAS") header_.frame = Frame::kRas;
  if (geometry_.frame == "LPS") header_.frame = Frame::kLps;
}

VolumeSourcePtr TiffStack::open(const ReadVolumeOptions& options) {
  survey();
  select_slices(options);
  const TiffPage& first = slices_.first;
  header_.dims = {static_cast<int>(first.width), static_cast<int>(first.height),
                  static_cast<int>(slices_.pages.size())};
  header_.format = "TIFF";
  header_.sample_type = first.bits < 8 ? "uint" + std::to_string(first.bits) : to_string(first.type);
  set_affine(options);
  slices_.slope = geometry_.slope;
  slices_.intercept = geometry_.intercept;
  return tiff_source(std::move(header_), std::move(slices_));
}

}  // namespace

bool looks_like_tiff(std::string_view start) {
  using namespace std::string_view_literals;
  for (std::string_view magic : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv}) {
    if (start.starts_with(magic)) return true;
  }
  return false;
}

std::vector<fs::path> files_matching(const fs::path& pattern) {
  glob_t found{};
  const int status = ::glob(pattern.c_str(), GLOB_NOSORT, nullptr, &found);
  std::vector<fs::path> files(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  ::globfree(&found);
  if (status != 0 || files.empty()) fail_input(pattern, "no such file, nor files that match", "check the path");
  sort_naturally(files);
  return files;
}

VolumeSourcePtr open_tiff_files(const fs::path& name, std::vector<fs::path> files, const ReadVolumeOptions& options) {
  return TiffStack(name, std::move(files), {}).open(options);
}

VolumeSourcePtr open_tiff_folder(const fs::path& folder, const ReadVolumeOptions& options) {
  std::vector<std::string> warnings;
  std::vector<fs::path> files = tiff_files_in(folder, warnings);
  return TiffStack(folder, std::move(files), std::move(warnings)).open(options);
}

}  // namespace delvox
