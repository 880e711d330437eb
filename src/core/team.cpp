#include "core/team.h"

#include <utility>

namespace delvox {
namespace {

/// Lets the processor know that this is a loop that waits.
void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

Team::Team(int threads) {
  for (int i = 1; i < threads; ++i) members_.emplace_back([this] { serve(); });
}

Team::~Team() {
  dismissed_ = true;
  pieces_.fetch_add(1);
  pieces_.notify_all();
  for (std::thread& member : members_) member.join();
}

void Team::for_each(std::size_t count, const std::function<void(std::size_t)>& work) {
  work_ = &work;
  count_ = count;
  next_ = 0;
  finished_ = 0;
  pieces_.fetch_add(1);
  pieces_.notify_all();
  take_part();
  while (finished_.load() < members_.size()) std::this_thread::yield();
  if (failed_.exchange(false)) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Team::take_part() {
  try {
    for (std::size_t i = next_.fetch_add(1); i < count_; i = next_.fetch_add(1)) (*work_)(i);
  } catch (...) {
    if (!failed_.exchange(true)) failure_ = std::current_exception();
  }
}

void Team::serve() {
  constexpr int kSpins = 20000;  // some tens of microseconds
  for (std::uint32_t seen = 0;;) {
    for (int spin = 0; spin < kSpins && pieces_.load() == seen; ++spin) pause();
    pieces_.wait(seen);
    ++seen;
    if (dismissed_) return;
    take_part();
    finished_.fetch_add(1);
  }
}

}  // namespace delvox
