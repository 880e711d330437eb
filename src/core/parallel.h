#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace delvox {

/// Calls visit(begin, end) in parallel for the chunks of [0, count), each of `chunk` items but the last.
template <class Visit>
void for_each_chunk(std::size_t count, std::size_t chunk, const Visit& visit) {
  tbb::parallel_for(std::size_t{0}, (count + chunk - 1) / chunk,
                    [&](std::size_t i) { visit(i * chunk, std::min(count, (i + 1) * chunk)); });
}

/// What map(begin, end) returns for each chunk, in order. The chunks do not depend on the number of threads, so
/// neither does what is folded from their results, to the last bit.
template <class Map>
auto map_chunks(std::size_t count, std::size_t chunk, const Map& map) {
  std::vector<decltype(map(count, count))> results((count + chunk - 1) / chunk);
  for_each_chunk(count, chunk, [&](std::size_t begin, std::size_t end) { results[begin / chunk] = map(begin, end); });
  return results;
}

}  // namespace delvox
