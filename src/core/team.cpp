#include "core/team.h"

#include <algorithm>
#include <utility>

namespace delvox {
namespace {

thread_local Team* own_team = nullptr;
thread_local bool at_work = false;

constexpr int kSpins = 20000;  // some hundred microseconds

/// As long as there is one, the thread's team is not at hand.
class AtWork {
 public:
  AtWork() { at_work = true; }
  ~AtWork() { at_work = before_; }
  AtWork(const AtWork&) = delete;
  AtWork& operator=(const AtWork&) = delete;

 private:
  const bool before_ = at_work;
};

/// Lets the processor know that this is a loop that waits.
void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

Team* Team::at_hand() {
  return at_work ? nullptr : own_team;
}

Team::Team(int threads) : shares_(static_cast<std::size_t>(std::max(threads, 1))) {
  for (std::size_t i = 1; i < shares_.size(); ++i) members_.emplace_back([this, i] { serve(i); });
  if (own_team == nullptr) own_team = this;
}

Team::~Team() {
  if (own_team == this) own_team = nullptr;
  dismissed_ = true;
  rounds_.fetch_add(1);
  rounds_.notify_all();
  for (std::thread& member : members_) member.join();
}

void Team::for_each(std::size_t count, const std::function<void(std::size_t)>& work) {
  if (alone()) {
    const AtWork guard;
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  work_ = &work;
  done_ = 0;
  const std::uint32_t round = rounds_.load() + 1;
  for (std::size_t m = 0; m < shares_.size(); ++m) {
    const std::size_t begin = count * m / shares_.size(), end = count * (m + 1) / shares_.size();
    shares_[m].pieces = (Pieces{round} << kBits | begin) << kBits | end;
  }
  rounds_ = round;
  rounds_.notify_all();
  {
    const AtWork guard;
    take_part(0);
  }
  // Others are about to end their last pieces: to ask the system for anything would take longer.
  for (int spin = 0; spin < kSpins && done_.load() < count; ++spin) pause();
  while (done_.load() < count) std::this_thread::yield();
  if (failed_.exchange(false)) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Team::take_part(std::size_t member) {
  std::size_t done = 0;
  for (std::size_t m = 0; m < shares_.size(); ++m) {
    const std::size_t of = (member + m) % shares_.size();
    while (take_piece(shares_[of], m == 0)) ++done;
  }
  if (done > 0) done_.fetch_add(done);  // until then the round lasts, and with it work_
}

/// Does the first piece left of a thread's own share, or the last of another's. False if there is none.
bool Team::take_piece(Share& share, bool own) {
  Pieces pieces = share.pieces.load();
  while (true) {
    const Pieces next = pieces >> kBits & kMask, end = pieces & kMask;
    if (next >= end) return false;
    if (!share.pieces.compare_exchange_weak(pieces, own ? pieces + (Pieces{1} << kBits) : pieces - 1)) continue;
    do_piece(own ? next : end - 1);
    return true;
  }
}

void Team::do_piece(std::size_t i) {
  try {
    if (!failed_) (*work_)(i);
  } catch (...) {
    if (!failed_.exchange(true)) failure_ = std::current_exception();
  }
}

void Team::serve(std::size_t member) {
  std::uint32_t seen = 0;
  while (true) {
    for (int spin = 0; spin < kSpins && rounds_.load() == seen; ++spin) pause();
    rounds_.wait(seen);
    seen = rounds_.load();
    if (dismissed_) return;
    take_part(member);
  }
}

}  // namespace delvox
