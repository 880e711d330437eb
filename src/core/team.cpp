#include "core/team.h"

#include <utility>

namespace delvox {
namespace {

constexpr int kSpins = 20000;  // some hundred microseconds

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
  rounds_.fetch_add(1);
  rounds_.notify_all();
  for (std::thread& member : members_) member.join();
}

void Team::for_each(std::size_t count, const std::function<void(std::size_t)>& work) {
  if (alone()) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  work_ = &work;
  done_ = 0;
  const std::uint32_t round = rounds_.load() + 1;
  pieces_ = Pieces{round} << kRound | count;
  rounds_ = round;
  rounds_.notify_all();
  take_part();
  // Others are about to end their last pieces: to ask the system for anything would take longer.
  for (int spin = 0; done_.load() < count; ++spin) spin < kSpins ? pause() : std::this_thread::yield();
  if (failed_.exchange(false)) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Team::take_part() {
  Pieces pieces = pieces_.load();
  while ((pieces >> kNext & kMask) < (pieces & kMask)) {
    if (!pieces_.compare_exchange_weak(pieces, pieces + (Pieces{1} << kNext))) continue;
    // Until this piece is done its round lasts, and with it work_.
    do_piece(pieces >> kNext & kMask);
    pieces = pieces_.load();
  }
}

void Team::do_piece(std::size_t i) {
  try {
    if (!failed_) (*work_)(i);
  } catch (...) {
    if (!failed_.exchange(true)) failure_ = std::current_exception();
  }
  done_.fetch_add(1);
}

void Team::serve() {
  std::uint32_t seen = 0;
  while (true) {
    for (int spin = 0; spin < kSpins && rounds_.load() == seen; ++spin) pause();
    rounds_.wait(seen);
    seen = rounds_.load();
    if (dismissed_) return;
    take_part();
  }
}

}  // namespace delvox
