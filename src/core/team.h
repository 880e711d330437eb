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
  static constexpr int kBits = 20;

 public:
  static constexpr std::size_t kMostPieces = std::size_t{1} << kBits;

  /// The calling thread is one of them. It has to end the team, too.
  explicit Team(int threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// The first that the calling thread has made, unless it is at work in it; nullptr if there is none. Who has work for
  /// several threads gives it to these rather than wake others that would get in their way.
  static Team* at_hand();

  /// Is the calling thread the only one?
  bool alone() const { return members_.empty(); }

  /// Calls work(i) for each i below count, by all threads; returns once all is done. Throws what work throws, of several
  /// one. Each thread gets neighbouring pieces, the same in each round of as many, so that what they work on stays near
  /// it; who is done helps the others. pre: count < kMostPieces.
  void for_each(std::size_t count, const std::function<void(std::size_t)>& work);

 private:
  /// What is left of a member's share of a round, in one word so that whoever takes a piece knows of which round it is:
  /// the round's number, then the next piece, then the end.
  using Pieces = std::uint64_t;
  struct alignas(64) Share {
    std::atomic<Pieces> pieces = 0;
  };
  static constexpr std::uint64_t kMask = kMostPieces - 1;

  void serve(std::size_t member);
  void take_part(std::size_t member);
  bool take_piece(Share& share, bool own);
  void do_piece(std::size_t i);

  std::vector<Share> shares_;  // the caller's first
  const std::function<void(std::size_t)>* work_ = nullptr;
  std::atomic<std::size_t> done_ = 0;      // pieces, of the present round
  std::atomic<std::uint32_t> rounds_ = 0;  // so far
  std::atomic<bool> dismissed_ = false;
  std::atomic<bool> failed_ = false;
  std::exception_ptr failure_;
  std::vector<std::thread> members_;
};

}  // namespace delvox
