#include "volume/grid_editor.h"

#include <algorithm>

#include "volume/volume_impl.h"

namespace delvox {

using openvdb::Coord;
using Leaf = openvdb::FloatTree::LeafNodeType;

struct GridEditor::State {
  explicit State(const Volume& volume)
      : impl(std::make_shared<Volume::Impl>(
            Volume::Impl{volume.header(), volume.impl().grid->deepCopy(), volume.min(), volume.max()})),
        accessor(impl->grid->getAccessor()) {}
  std::shared_ptr<Volume::Impl> impl;
  openvdb::FloatGrid::Accessor accessor;
};

GridEditor::GridEditor(const Volume& volume) : state_(std::make_unique<State>(volume)) {}
GridEditor::~GridEditor() = default;

void GridEditor::set_run(const std::array<int, 3>& begin, int length, float value) {
  constexpr int kLeaf = static_cast<int>(Leaf::DIM);
  state_->impl->min = std::min(state_->impl->min, value);
  state_->impl->max = std::max(state_->impl->max, value);
  for (int i = begin[0]; i < begin[0] + length;) {
    const int next = std::min((i / kLeaf + 1) * kLeaf, begin[0] + length);
    const Coord at(i, begin[1], begin[2]);
    if (Leaf* leaf = state_->accessor.probeLeaf(at)) {
      for (; i < next; ++i) leaf->setValueOn(Leaf::coordToOffset(Coord(i, begin[1], begin[2])), value);
    } else {
      // One sign, hence one region: other runs will ask the same.
      if (state_->accessor.getValue(at) != value) state_->accessor.addTile(1, at, value, true);
      i = next;
    }
  }
}

Volume GridEditor::finish() { return Volume(std::move(state_->impl)); }

}  // namespace delvox
