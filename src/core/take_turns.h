#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace delvox {

/// Walks through memory, each of whose steps waits for what the last one has asked for: several take turns, so that
/// while one waits the others go on. start(n) gives walk n of `count`, or none if there is nothing to walk; step(walk)
/// takes its next step, or returns false if it has ended.
template <class Start, class Step>
void take_turns(std::size_t count, const Start& start, const Step& step) {
  constexpr std::size_t kAtATime = 8;
  std::vector<typename decltype(start(count))::value_type> walks;
  std::size_t next = 0;
  const auto start_next = [&] {
    auto walk = decltype(start(count)){};
    while (!walk && next < count) walk = start(next++);
    return walk;
  };
  while (walks.size() < kAtATime) {
    auto walk = start_next();
    if (!walk) break;
    walks.push_back(std::move(*walk));
  }
  for (std::size_t i = 0; !walks.empty(); i = i + 1 < walks.size() ? i + 1 : 0) {
    if (step(walks[i])) continue;
    if (auto walk = start_next()) {
      walks[i] = std::move(*walk);
    } else {
      walks[i] = std::move(walks.back());
      walks.pop_back();
    }
  }
}

}  // namespace delvox
