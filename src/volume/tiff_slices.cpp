#include "volume/tiff_slices.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "volume/byte_source.h"

namespace delvox {
namespace {

class TiffReader final : public SliceReader {
 public:
  explicit TiffReader(const TiffSlices& slices) : slices_(slices) {}

  void read(int count, float* out) override {
    const std::size_t area = slices_.first.pixel_count();
    for (int n = 0; n < count; ++n, ++next_) {
      if (slices_.contiguous) {
        read_contiguous(out + n * area);
      } else {
        read_page(out + n * area);
      }
    }
    calibrate(out, area * count);
    check_finite(slices_.name, tally_);
  }

  std::vector<std::string> warnings() const override {
    std::vector<std::string> all = warnings_;
    const std::vector<std::string> tally = tally_warnings(tally_, slices_.first.type);
    all.insert(all.end(), tally.begin(), tally.end());
    return all;
  }

 private:
  void read_page(float* out) {
    const TiffPageRef at = slices_.pages[next_];
    const std::filesystem::path& path = slices_.files[at.file];
    if (!tiff_ || file_ != at.file) {
      tiff_.emplace(path);
      file_ = at.file;
      page_ = 1;
    }
    for (; page_ < at.page; ++page_) {
      if (!tiff_->next_page()) fail_input(path, "it changed while it was read", "try again");
    }
    const TiffPage page = tiff_->page();
    slices_.compare(page, at.file, at.page);
    tiff_->read_page(page, out, tally_);
    for (const std::string& text : tiff_->warnings()) {
      if (std::find(warnings_.begin(), warnings_.end(), text) == warnings_.end()) warnings_.push_back(text);
    }
  }

  void read_contiguous(float* out) {
    const std::size_t area = slices_.first.pixel_count();
    const std::uint64_t bytes = std::uint64_t{area} * size_of(slices_.layout.type);
    if (!source_) source_.emplace(slices_.files[0]);
    const std::uint64_t begin = slices_.layout.offset + bytes * static_cast<std::uint64_t>(slices_.pages[next_].page - 1);
    source_->skip(begin - source_->position(), "the slices before");
    read_sample_run(*source_, slices_.layout, area, out, tally_);
  }

  void calibrate(float* samples, std::size_t count) {
    if (slices_.slope == 1 && slices_.intercept == 0) return;
    for (std::size_t n = 0; n < count; ++n) {
      samples[n] = static_cast<float>(slices_.slope * static_cast<double>(samples[n]) + slices_.intercept);
      tally_.not_finite += std::isfinite(samples[n]) ? 0 : 1;
    }
  }

  const TiffSlices& slices_;
  std::size_t next_ = 0;
  std::optional<TiffFile> tiff_;
  std::size_t file_ = 0;
  int page_ = 1;
  std::optional<ByteSource> source_;
  ConversionTally tally_;
  std::vector<std::string> warnings_;
};

class TiffSource final : public VolumeSource {
 public:
  TiffSource(VolumeHeader header, TiffSlices slices) : VolumeSource(std::move(header)), slices_(std::move(slices)) {}
  std::unique_ptr<SliceReader> start() const override { return std::make_unique<TiffReader>(slices_); }

 private:
  TiffSlices slices_;
};

}  // namespace

void TiffSlices::compare(const TiffPage& page, std::size_t file, int number) const {
  const bool same = page.width == first.width && page.height == first.height && page.type == first.type &&
                    page.bits == first.bits && page.min_is_white == first.min_is_white;
  if (same) return;
  const auto describe = [&](std::size_t f, int n) {
    return files.size() > 1 ? files[f].filename().string() : "page " + std::to_string(n);
  };
  fail_input(name,
             "the slices differ: " + describe(pages[0].file, pages[0].page) + " is " + first.summary() + ", " +
                 describe(file, number) + " is " + page.summary() +
                 (page.min_is_white != first.min_is_white ? " with black and white swapped" : ""),
             "give slices of one size and type");
}

VolumeSourcePtr tiff_source(VolumeHeader header, TiffSlices slices) {
  check_volume_header(slices.name, header);
  return std::make_shared<TiffSource>(std::move(header), std::move(slices));
}

}  // namespace delvox
