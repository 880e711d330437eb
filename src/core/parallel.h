#pragma once

#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/team.h"

namespace delvox {

/// How many threads may work at a time.
inline int thread_count() {
  return std::min(tbb::this_task_arena::max_concurrency(),
                  static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)));
}

/// Calls visit(begin, end) in parallel for the chunks of [0, count), each of `chunk` items but the last: by the thread's
/// team if it has one at hand.
template <class Visit>
void for_each_chunk(std::size_t count, std::size_t chunk, const Visit& visit) {
  const std::size_t chunks = (count + chunk - 1) / chunk;
  const auto visit_chunk = [&](std::size_t i) { visit(i * chunk, std::min(count, (i + 1) * chunk)); };
  if (chunks == 0) return;
  if (chunks == 1) return visit(std::size_t{0}, count);  // no round for that
  Team* const team = Team::at_hand();
  if (team != nullptr && chunks < Team::kMostPieces) return team->for_each(chunks, visit_chunk);
  tbb::parallel_for(std::size_t{0}, chunks, visit_chunk);
}

/// What map(begin, end) returns for each chunk, in order. The chunks do not depend on the number of threads, so
/// neither does what is folded from their results, to the last bit.
template <class Map>
auto map_chunks(std::size_t count, std::size_t chunk, const Map& map) {
  std::vector<decltype(map(count, count))> results((count + chunk - 1) / chunk);
  for_each_chunk(count, chunk, [&](std::size_t begin, std::size_t end) { results[begin / chunk] = map(begin, end); });
  return results;
}

/// What collect(begin, end, found) appends to `found` for each chunk, in order.
template <class T, class Collect>
std::vector<T> gather_chunks(std::size_t count, std::size_t chunk, const Collect& collect) {
  const auto parts = map_chunks(count, chunk, [&](std::size_t begin, std::size_t end) {
    std::vector<T> found;
    collect(begin, end, found);
    return found;
  });
  std::vector<std::size_t> first(parts.size() + 1, 0);
  for (std::size_t i = 0; i < parts.size(); ++i) first[i + 1] = first[i] + parts[i].size();
  std::vector<T> all(first.back());
  for_each_chunk(parts.size(), 1, [&](std::size_t i, std::size_t) {
    std::copy(parts[i].begin(), parts[i].end(), all.begin() + static_cast<std::ptrdiff_t>(first[i]));
  });
  return all;
}

/// Is the calling thread the only one that works its loops?
inline bool works_alone() {
  const Team* const team = Team::at_hand();
  return team != nullptr ? team->alone() : thread_count() == 1;
}

/// One T for each thread that asks for one, made when it first does.
template <class T>
using PerThread = tbb::enumerable_thread_specific<T>;

}  // namespace delvox
