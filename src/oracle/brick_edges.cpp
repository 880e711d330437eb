#include "oracle/brick_edges.h"

#include <cstring>

namespace delvox {
namespace {

constexpr int kBrick = BrickField::kBrick, kBlock = BrickField::kBlock;

/// Eight bytes that are 0 or 1 as eight bits, the first lowest.
BrickEdges::Word bits_of(const std::uint8_t* bytes) {
  static_assert(std::endian::native == std::endian::little);
  BrickEdges::Word word;
  std::memcpy(&word, bytes, sizeof word);
  return word * 0x0102040810204080ull >> 56;
}

}  // namespace

BrickEdges::BrickEdges(const BrickField& field, const std::array<int, 3>& brick) {
  const float* block = field.block(brick);
  const float threshold = field.threshold();
  std::array<std::uint8_t, BrickField::kBlockSize> is_inside;
  for (int n = 0; n < BrickField::kBlockSize; ++n) is_inside[n] = block[n] > threshold;
  for (int k = 0; k < kBlock; ++k) {
    for (int j = 0; j < kBlock; ++j) {
      const std::uint8_t* row = is_inside.data() + (k * kBlock + j) * kBlock;
      const Word here = bits_of(row), next = bits_of(row + 1);
      if (j < kBrick) {
        inside_[0][k] |= here << kBrick * j;
        inside_[1][k] |= next << kBrick * j;
      }
      if (j > 0) {
        inside_[2][k] |= here << kBrick * (j - 1);
        inside_[3][k] |= next << kBrick * (j - 1);
      }
    }
  }
}

}  // namespace delvox
