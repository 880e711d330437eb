#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "mesh_io/source.h"

namespace delvox::mesh_io {

/// From the numbers that a file gives its nodes to indices. Numbers in a row, the usual case, need no table.
class TagMap {
 public:
  /// tags[i] is the number of node i. Throws InputError if a number occurs twice.
  TagMap(const Source& source, const std::vector<std::int64_t>& tags, const char* what);

  /// Throws InputError if no node has that number.
  std::int64_t operator()(std::int64_t tag) const;

 private:
  const Source& source_;
  const char* what_;
  std::int64_t first_ = 0, count_ = 0;
  std::vector<std::pair<std::int64_t, std::int64_t>> sorted_;
};

}  // namespace delvox::mesh_io
