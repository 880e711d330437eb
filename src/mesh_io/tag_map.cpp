#include "mesh_io/tag_map.h"

#include <algorithm>
#include <limits>
#include <string>

namespace delvox::mesh_io {

TagMap::TagMap(const Source& source, const std::vector<std::int64_t>& tags, const char* what)
    : source_(source), what_(what), count_(static_cast<std::int64_t>(tags.size())) {
  if (!tags.empty()) first_ = tags.front();
  const bool may_be_in_a_row = first_ >= 0 && first_ <= std::numeric_limits<std::int64_t>::max() - count_;
  bool in_a_row = may_be_in_a_row;
  for (std::int64_t i = 0; i < count_ && in_a_row; ++i) in_a_row = tags[static_cast<std::size_t>(i)] == first_ + i;
  if (in_a_row) return;
  for (std::size_t i = 0; i < tags.size(); ++i) sorted_.emplace_back(tags[i], static_cast<std::int64_t>(i));
  std::sort(sorted_.begin(), sorted_.end());
  const auto twice = std::adjacent_find(sorted_.begin(), sorted_.end(),
                                        [](const auto& a, const auto& b) { return a.first == b.first; });
  if (twice != sorted_.end()) {
    source.fail("two of its " + std::string(what) + " have the number " + std::to_string(twice->first),
                "does it hold several parts? write them to files of their own");
  }
}

std::int64_t TagMap::operator()(std::int64_t tag) const {
  if (sorted_.empty()) {
    if (tag >= first_ && tag < first_ + count_) return tag - first_;
  } else {
    const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(tag, std::int64_t{0}));
    if (found != sorted_.end() && found->first == tag) return found->second;
  }
  source_.fail("a cell names number " + std::to_string(tag) + ", which none of its " + what_ + " has");
}

}  // namespace delvox::mesh_io
