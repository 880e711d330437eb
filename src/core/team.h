#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

namespace delvox {

/// Threads that stay at hand for many short pieces of work, shorter than what it takes to wake a thread: between two of
/// them they spin for a while before they sleep.
class Team {
 public:
  /// The calling thread is one of them.
  explicit Team(int threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// Calls work(i) for each i below count, by all threads; returns once all is done. Throws what work throws, of several
  /// one.
  void for_each(std::size_t count, const std::function<void(std::size_t)>& work);

 private:
  void serve();
  void take_part();

  const std::function<void(std::size_t)>* work_ = nullptr;
  std::size_t count_ = 0;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<std::size_t> finished_ = 0;    // members, of the present piece of work
  std::atomic<std::uint32_t> pieces_ = 0;    // of work, so far
  std::atomic<bool> dismissed_ = false;
  std::atomic<bool> failed_ = false;
  std::exception_ptr failure_;
  std::vector<std::thread> members_;
};

}  // namespace delvox
