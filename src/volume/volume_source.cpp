#include "delvox/volume/volume_source.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <utility>

#include "volume/grid_builder.h"
#include "volume/read_support.h"

namespace delvox {
namespace {

class VolumeReader final : public SliceReader {
 public:
  explicit VolumeReader(const Volume& volume) : volume_(volume) {}
  void read(int count, float* out) override {
    volume_.copy_block({0, 0, next_}, {volume_.dims()[0], volume_.dims()[1], count}, out);
    next_ += count;
  }

 private:
  Volume volume_;
  int next_ = 0;
};

class VolumeAsSource final : public VolumeSource {
 public:
  explicit VolumeAsSource(const Volume& volume) : VolumeSource(volume.header()), volume_(volume) {}
  std::unique_ptr<SliceReader> start() const override { return std::make_unique<VolumeReader>(volume_); }

 private:
  Volume volume_;
};

class MemoryReader final : public SliceReader {
 public:
  MemoryReader(const float* next, std::size_t area) : next_(next), area_(area) {}
  void read(int count, float* out) override {
    std::copy_n(next_, area_ * count, out);
    next_ += area_ * count;
  }

 private:
  const float* next_;
  std::size_t area_;
};

class MemorySource final : public VolumeSource {
 public:
  MemorySource(VolumeHeader header, std::vector<float> samples)
      : VolumeSource(std::move(header)), samples_(std::move(samples)) {}
  std::unique_ptr<SliceReader> start() const override {
    return std::make_unique<MemoryReader>(samples_.data(), static_cast<std::size_t>(dims()[0]) * dims()[1]);
  }
  const float* samples() const override { return samples_.data(); }

 private:
  std::vector<float> samples_;
};

void add_warnings(const std::vector<std::string>& warnings, VolumeHeader& header) {
  for (const std::string& text : warnings) {
    const auto& known = header.warnings;
    if (std::find(known.begin(), known.end(), text) == known.end()) header.warnings.push_back(text);
  }
}

}  // namespace

VolumeSourcePtr source_of(const Volume& volume) { return std::make_shared<VolumeAsSource>(volume); }

VolumeSourcePtr source_of(VolumeHeader header, std::vector<float> samples) {
  return std::make_shared<MemorySource>(std::move(header), std::move(samples));
}

VolumeSourcePtr in_memory(const VolumeSource& source) {
  std::vector<float> samples(source.voxel_count());
  const auto reader = source.start();
  reader->read(source.dims()[2], samples.data());
  VolumeHeader header = source.header();
  add_warnings(reader->warnings(), header);
  return source_of(std::move(header), std::move(samples));
}

std::vector<std::string> for_each_slab(const VolumeSource& source,
                                       const std::function<void(const float*, int, int)>& visit) {
  const int depth = source.dims()[2];
  const std::size_t area = static_cast<std::size_t>(source.dims()[0]) * source.dims()[1];
  const auto slices_from = [depth](int k) { return std::min(kSlabSlices, depth - k); };
  if (const float* samples = source.samples()) {
    for (int k = 0; k < depth; k += kSlabSlices) visit(samples + k * area, k, slices_from(k));
    return {};
  }
  // One is being read, one visited, one still in place from the visit before.
  std::array<std::vector<float>, 3> slabs;
  const auto reader = source.start();
  const auto read_slab = [&](int k) {
    std::vector<float>& slab = slabs[k / kSlabSlices % 3];
    slab.resize(area * std::min(kSlabSlices, depth));
    reader->read(slices_from(k), slab.data());
  };
  read_slab(0);
  for (int k = 0; k < depth; k += kSlabSlices) {
    const int next = k + kSlabSlices;
    tbb::parallel_invoke(
        [&] {
          if (next < depth) read_slab(next);
        },
        [&] { visit(slabs[k / kSlabSlices % 3].data(), k, slices_from(k)); });
  }
  return reader->warnings();
}

Volume load(const VolumeSource& source, const std::optional<Isosurface>& surface, Ties* ties) {
  const std::array<int, 3>& n = source.dims();
  if (!surface) check_fits_whole("volume", {n[0], n[1], n[2]});
  const auto level_set = surface ? std::optional<LevelSet>(*surface) : std::nullopt;
  GridBuilder builder(source.header(), level_set);
  const std::vector<std::string> warnings =
      for_each_slab(source, [&](const float* samples, int, int slices) {
        builder.add(samples, slices);
        if (ties != nullptr) ties->add(samples, static_cast<std::size_t>(n[0]) * n[1] * slices);
      });
  const std::shared_ptr<Volume::Impl> impl = builder.finish();
  add_warnings(warnings, impl->header);
  return Volume(impl);
}

}  // namespace delvox
