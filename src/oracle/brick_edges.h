#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "oracle/brick_field.h"

namespace delvox {

/// Which samples of a mixed brick are inside, and which of its grid edges are crossed, as words of 64 bits: bit 8 j + i
/// of layer k stands for the sample (i, j, k) of the brick, or for the edge that begins there.
class BrickEdges {
 public:
  using Word = std::uint64_t;

  BrickEdges(const BrickField& field, const std::array<int, 3>& brick);

  /// Samples of a layer moved by one along the axes whose bits are set in `corner` (bit 0: i).
  Word inside(int corner, int layer) const { return inside_[corner & 3][layer + (corner >> 2)]; }
  /// Crossed edges along an axis that begin at the samples of inside(corner, layer).
  Word crossed(int axis, int corner, int layer) const {
    return inside(corner, layer) ^ inside(corner | 1 << axis, layer);
  }

  /// Calls visit(layer, axis, bit) for the crossed edges that belong to the brick: those that begin below its upper
  /// faces. They come in one fixed order.
  template <class Visit>
  void for_each_crossed(const Visit& visit) const {
    for (int layer = 0; layer < BrickField::kBrick; ++layer) {
      for (int axis = 0; axis < 3; ++axis) {
        for_each_bit(crossed(axis, 0, layer), [&](int bit) { visit(layer, axis, bit); });
      }
    }
  }

  template <class Visit>
  static void for_each_bit(Word word, const Visit& visit) {
    for (; word != 0; word &= word - 1) visit(std::countr_zero(word));
  }

 private:
  std::array<std::array<Word, BrickField::kBlock>, 4> inside_{};
};

}  // namespace delvox
