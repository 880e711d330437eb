#include "isolated.h"

#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace delvox::bench {

namespace {

[[noreturn]] void fail(const char* what) {
  throw std::runtime_error(std::string(what) + ": " + std::strerror(errno));
}

void write_all(int descriptor, const std::byte* data, std::size_t size) {
  while (size > 0) {
    const ssize_t n = ::write(descriptor, data, size);
    if (n < 0) fail("write");
    data += n, size -= static_cast<std::size_t>(n);
  }
}

/// Whether all of `size` bytes came.
bool read_all(int descriptor, std::byte* data, std::size_t size) {
  while (size > 0) {
    const ssize_t n = ::read(descriptor, data, size);
    if (n < 0) fail("read");
    if (n == 0) return false;
    data += n, size -= static_cast<std::size_t>(n);
  }
  return true;
}

/// Touches memory and gives it back. The host of a virtual machine may have taken back what lay idle, and getting it
/// again costs several times what clearing it does: the contender after a pause must not be the one to pay for that.
void touch_memory() {
  constexpr std::size_t kBytes = std::size_t{1} << 30, kPage = 4096;
  const pid_t child = fork();
  if (child < 0) fail("fork");
  if (child == 0) {
    void* const memory = mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) _exit(1);
    madvise(memory, kBytes, MADV_HUGEPAGE);
    for (std::size_t at = 0; at < kBytes; at += kPage) static_cast<volatile char*>(memory)[at] = 1;
    _exit(0);
  }
  waitpid(child, nullptr, 0);
}

Outcome guarded(const std::function<Outcome()>& work) {
  try {
    return work();
  } catch (const std::exception& error) {
    Outcome outcome;
    set_note(outcome, error.what());
    return outcome;
  }
}

}  // namespace

void set_note(Outcome& outcome, const std::string& text) {
  outcome.note.fill(0);
  std::strncpy(outcome.note.data(), text.c_str(), outcome.note.size() - 1);
}

Outcome run_isolated(const std::function<Outcome()>& work) {
  static_assert(std::is_trivially_copyable_v<Outcome>);
  touch_memory();
  int ends[2];
  if (pipe(ends) != 0) fail("pipe");
  const pid_t child = fork();
  if (child < 0) fail("fork");
  if (child == 0) {
    close(ends[0]);
    const Outcome outcome = guarded(work);
    write_all(ends[1], reinterpret_cast<const std::byte*>(&outcome), sizeof(outcome));
    _exit(0);  // no destructors: nobody needs the memory back
  }
  close(ends[1]);
  Outcome outcome;
  const bool complete = read_all(ends[0], reinterpret_cast<std::byte*>(&outcome), sizeof(outcome));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!complete) {
    outcome = Outcome{};
    set_note(outcome, WIFSIGNALED(status) ? "killed by signal " + std::to_string(WTERMSIG(status)) : "died");
  }
  return outcome;
}

SharedBytes::SharedBytes() : descriptor_(memfd_create("compare_mesh3", 0)) {
  if (descriptor_ < 0) fail("memfd_create");
}

SharedBytes::~SharedBytes() {
  close(descriptor_);
}

void SharedBytes::write(std::span<const std::byte> bytes) const {
  if (ftruncate(descriptor_, 0) != 0 || lseek(descriptor_, 0, SEEK_SET) != 0) fail("memfd");
  write_all(descriptor_, bytes.data(), bytes.size());
}

std::vector<std::byte> SharedBytes::read() const {
  struct stat info {};
  if (fstat(descriptor_, &info) != 0 || lseek(descriptor_, 0, SEEK_SET) != 0) fail("memfd");
  std::vector<std::byte> bytes(static_cast<std::size_t>(info.st_size));
  if (!read_all(descriptor_, bytes.data(), bytes.size())) throw std::runtime_error("memfd: short read");
  return bytes;
}

}  // namespace delvox::bench
