#include "delvox/volume/peel.h"

#include <array>
#include <cstdint>
#include <vector>

namespace delvox {
namespace {

constexpr int kBeyond = 3;  // voxels outside that tets of a mesh may touch

class Peeler {
 public:
  Peeler(const Volume& volume, const Isosurface& surface) : dims_(volume.dims()), samples_(volume.samples()) {
    const LevelSet level_set(surface);
    trusted_.reserve(samples_.size());
    for (float sample : samples_) trusted_.push_back(level_set.inside(level_set.sign * sample) ? 1 : 0);
  }

  std::vector<float> run(int layers) {
    for (int i = 0; i < layers; ++i) erode();
    const int front = layers + kBeyond;
    for (int i = 0; i < front; ++i) grow();
    return std::move(samples_);
  }

 private:
  template <class Visit>
  void for_each_neighbour(std::size_t at, const Visit& visit) const {
    const auto nx = static_cast<std::size_t>(dims_[0]), ny = static_cast<std::size_t>(dims_[1]);
    const int i = static_cast<int>(at % nx), j = static_cast<int>(at / nx % ny), k = static_cast<int>(at / nx / ny);
    for (int dk = -1; dk <= 1; ++dk) {
      for (int dj = -1; dj <= 1; ++dj) {
        for (int di = -1; di <= 1; ++di) {
          const int x = i + di, y = j + dj, z = k + dk;
          if (x < 0 || y < 0 || z < 0 || x >= dims_[0] || y >= dims_[1] || z >= dims_[2]) continue;
          visit((static_cast<std::size_t>(z) * ny + static_cast<std::size_t>(y)) * nx + static_cast<std::size_t>(x));
        }
      }
    }
  }

  void erode() {
    std::vector<std::uint8_t> next = trusted_;
    for (std::size_t at = 0; at < trusted_.size(); ++at) {
      if (trusted_[at] == 0) continue;
      for_each_neighbour(at, [&](std::size_t other) { next[at] &= trusted_[other]; });
    }
    trusted_ = std::move(next);
  }

  /// Gives samples next to trusted ones the mean of these.
  void grow() {
    std::vector<std::uint8_t> next = trusted_;
    for (std::size_t at = 0; at < trusted_.size(); ++at) {
      if (trusted_[at] != 0) continue;
      double sum = 0;
      int count = 0;
      for_each_neighbour(at, [&](std::size_t other) {
        if (trusted_[other] == 0) return;
        sum += static_cast<double>(samples_[other]);
        ++count;
      });
      if (count == 0) continue;
      samples_[at] = static_cast<float>(sum / count);  // not read again in this round: it is not trusted yet
      next[at] = 1;
    }
    trusted_ = std::move(next);
  }

  const std::array<int, 3> dims_;
  std::vector<float> samples_;
  std::vector<std::uint8_t> trusted_;  ///< deep inside, or filled from there
};

}  // namespace

Volume peeled(const Volume& volume, const Isosurface& surface, int layers) {
  return {volume.header(), Peeler(volume, surface).run(layers)};
}

}  // namespace delvox
