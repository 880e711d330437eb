#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

namespace delvox {

/// Threads that stay at hand for many short rounds of work, shorter than what it takes to wake a thread: between two
/// rounds they spin for a while before they sleep. A thread that comes late to a round, as on a machine with other work
/// to do, keeps nobody waiting: the others do its pieces.
class Team {
 public:
  /// The calling thread is one of them.
  explicit Team(int threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// Is the calling thread the only one?
  bool alone() const { return members_.empty(); }

  /// Calls work(i) for each i below count, by all threads; returns once all is done. Throws what work throws, of several
  /// one. pre: count < 2^16.
  void for_each(std::size_t count, const std::function<void(std::size_t)>& work);

 private:
  /// The pieces of a round, in one word so that a thread that takes one knows of which round it is: the round's number
  /// in the upper half, then the next piece, then how many there are.
  using Pieces = std::uint64_t;
  static constexpr int kNext = 16, kRound = 32;
  static constexpr std::uint64_t kMask = 0xffff;

  void serve();
  void take_part();
  void do_piece(std::size_t i);

  const std::function<void(std::size_t)>* work_ = nullptr;
  std::atomic<Pieces> pieces_ = 0;
  std::atomic<std::size_t> done_ = 0;      // pieces, of the present round
  std::atomic<std::uint32_t> rounds_ = 0;  // so far
  std::atomic<bool> dismissed_ = false;
  std::atomic<bool> failed_ = false;
  std::exception_ptr failure_;
  std::vector<std::thread> members_;
};

}  // namespace delvox
