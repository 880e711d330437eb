#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "contender.h"
#include "mesh_measures.h"

namespace delvox::bench {

/// What a contender's process sends home. Plain bytes: it goes through a pipe.
struct Outcome {
  bool ok = false;
  double seconds = 0, cpu_seconds = 0, peak_bytes = 0;
  std::size_t all_cells = 0;
  MeshMeasures mesh;
  std::array<char, 400> note{};  ///< what it has to say, or why it failed
};

void set_note(Outcome& outcome, const std::string& text);

/// Runs `work` in a forked process, so that its memory peak, allocator state and threads are its own. An exception or
/// the death of the process gives an outcome that is not ok.
/// The calling process must never have used TBB: its worker threads do not survive a fork.
Outcome run_isolated(const std::function<Outcome()>& work);

/// Bytes that outlive the process that wrote them, without a file's name (memfd).
class SharedBytes {
 public:
  SharedBytes();
  ~SharedBytes();
  SharedBytes(const SharedBytes&) = delete;
  SharedBytes& operator=(const SharedBytes&) = delete;

  /// Replaces the content.
  void write(std::span<const std::byte> bytes) const;
  std::vector<std::byte> read() const;

  template <class T>
  void write_array(const std::vector<T>& items) const {
    write(std::as_bytes(std::span(items)));
  }
  template <class T>
  std::vector<T> read_array() const {
    const std::vector<std::byte> bytes = read();
    const T* first = reinterpret_cast<const T*>(bytes.data());
    return std::vector<T>(first, first + bytes.size() / sizeof(T));
  }

 private:
  int descriptor_;
};

}  // namespace delvox::bench
