#include "core/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "delvox/core/errors.h"

namespace delvox {
namespace {

namespace fs = std::filesystem;

// Names of unfinished files for remove_unfinished_outputs(): fixed storage, since a signal handler may read it.
constexpr int kMaxUnfinished = 64;
constexpr std::size_t kMaxName = 4096;
struct Slot {
  std::atomic<bool> used{false};
  std::atomic<bool> ready{false};
  char name[kMaxName];
};
Slot g_unfinished[kMaxUnfinished];

void register_unfinished(const std::string& name) {
  if (name.size() >= kMaxName) return;
  for (Slot& slot : g_unfinished) {
    bool expected = false;
    if (!slot.used.compare_exchange_strong(expected, true)) continue;
    std::memcpy(slot.name, name.c_str(), name.size() + 1);
    slot.ready.store(true, std::memory_order_release);
    return;
  }
}

void unregister_unfinished(const std::string& name) {
  for (Slot& slot : g_unfinished) {
    if (!slot.ready.load(std::memory_order_acquire) || name != slot.name) continue;
    slot.ready.store(false);
    slot.used.store(false);
    return;
  }
}

[[noreturn]] void fail(const fs::path& path, const std::string& cause, const std::string& mend) {
  throw IoError(path.string() + ": cannot be written: " + cause + "; " + mend);
}

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

}  // namespace

void check_output_path(const fs::path& path) {
  if (!path.has_filename()) fail(path, "no file name", "give the name of a file");
  const fs::path folder = folder_of(path);
  std::error_code error;
  const fs::file_status folder_status = fs::status(folder, error);
  if (!fs::exists(folder_status)) fail(path, "folder " + folder.string() + " does not exist", "create it first");
  if (!fs::is_directory(folder_status)) fail(path, folder.string() + " is not a folder", "choose another place");
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    fail(path, "it exists and is not a regular file", "choose another name");
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    fail(path, "folder " + folder.string() + ": " + std::strerror(errno), "choose a writable folder");
  }
}

OutputFile::OutputFile(fs::path path) : path_(std::move(path)) {
  check_output_path(path_);
  static std::atomic<unsigned> counter{0};
  const std::string name = "." + path_.filename().string() + "." + std::to_string(::getpid()) + "." +
                           std::to_string(counter++) + ".part";
  temporary_ = folder_of(path_) / name;
  const int descriptor = ::open(temporary_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor < 0) fail(path_, std::strerror(errno), "choose a writable folder");
  ::close(descriptor);
  register_unfinished(temporary_.string());
  stream_.open(temporary_, std::ios::binary | std::ios::trunc);
  if (!stream_) {
    const std::string cause = std::strerror(errno);
    ::unlink(temporary_.c_str());
    unregister_unfinished(temporary_.string());
    fail(path_, cause, "choose a writable folder");
  }
}

OutputFile::~OutputFile() {
  if (committed_) return;
  stream_.close();
  ::unlink(temporary_.c_str());
  unregister_unfinished(temporary_.string());
}

void OutputFile::commit() {
  errno = 0;
  stream_.close();
  if (!stream_) {
    const std::string cause = errno != 0 ? std::strerror(errno) : "not every byte was taken";
    fail(path_, cause, "free some space or choose another place");
  }
  rename_into_place();
}

void OutputFile::commit_external() {
  stream_.close();
  rename_into_place();
}

void OutputFile::rename_into_place() {
  // Data must be on disk before the name is: some file systems report a full disk only here.
  const int descriptor = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  const bool synced = descriptor >= 0 && ::fsync(descriptor) == 0;
  const int sync_error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!synced) fail(path_, std::strerror(sync_error), "free some space or choose another place");
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) fail(path_, error.message(), "choose another place");
  committed_ = true;
  unregister_unfinished(temporary_.string());
}

void remove_unfinished_outputs() noexcept {
  for (Slot& slot : g_unfinished) {
    if (slot.ready.load(std::memory_order_acquire)) ::unlink(slot.name);
  }
}

}  // namespace delvox
