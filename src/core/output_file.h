#pragma once

#include <filesystem>
#include <fstream>
#include <ostream>

namespace delvox {

/// Throws IoError unless `path` can become an output file: its folder exists and is writable, and what stands
/// there already, if anything, is a regular file. Called before any work starts. Folders are never created.
void check_output_path(const std::filesystem::path& path);

/// A file that appears whole or not at all: written under a temporary name in the same folder, renamed by commit().
/// Destroyed without commit() it leaves nothing behind.
class OutputFile {
 public:
  /// Throws IoError as check_output_path does, or if the temporary file cannot be made.
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  std::ostream& stream() { return stream_; }
  /// The temporary name, for libraries that open files themselves (they may overwrite it).
  const std::filesystem::path& temporary() const { return temporary_; }
  /// Flushes, verifies that every byte was taken, renames. Throws IoError (no space left, ...).
  void commit();
  /// For files written by a library under temporary(): renames only.
  void commit_external();

 private:
  void rename_into_place();

  std::filesystem::path path_, temporary_;
  std::ofstream stream_;
  bool committed_ = false;
};

/// Removes the temporary files of all OutputFiles alive. Async-signal-safe.
void remove_unfinished_outputs() noexcept;

}  // namespace delvox
