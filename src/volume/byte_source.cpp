#include "volume/byte_source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include "volume/read_support.h"

namespace delvox {
namespace {

constexpr std::size_t kBufferSize = std::size_t{1} << 18;
constexpr std::uint64_t kMostDeflateExpands = 1032;

}  // namespace

struct ByteSource::State {
  std::filesystem::path path;
  int descriptor = -1;
  std::uint64_t file_size = 0;
  std::uint64_t position = 0;
  bool compressed = false;
  bool stream_open = false;       // zlib is in the middle of a gzip member
  z_stream stream{};
  std::vector<unsigned char> buffer;  // compressed bytes
  std::string peeked;                 // handed out by peek(), not yet by read()

  ~State() {
    if (compressed) inflateEnd(&stream);
    if (descriptor >= 0) ::close(descriptor);
  }
  void open();
  std::size_t read_file(void* out, std::size_t size);
  std::size_t read_inflated(void* out, std::size_t size);
  std::size_t read(void* out, std::size_t size) {
    return compressed ? read_inflated(out, size) : read_file(out, size);
  }
  bool next_member();
};

void ByteSource::State::open() {
  // O_NONBLOCK: a pipe must be refused below, not waited for.
  descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) {
    const int error = errno;
    if (error == ENOENT || error == ENOTDIR) fail_input(path, "no such file", "check the path");
    if (error == EACCES) fail_input(path, "permission denied", "make the file readable");
    fail_input(path, std::strerror(error), "check the path");
  }
  struct stat status;
  if (::fstat(descriptor, &status) != 0) fail_input(path, std::strerror(errno), "check the file system");
  if (S_ISDIR(status.st_mode)) fail_input(path, "it is a folder", "give a file");
  if (!S_ISREG(status.st_mode)) fail_input(path, "it is not a regular file", "copy the data to a file first");
  file_size = static_cast<std::uint64_t>(status.st_size);
  if (file_size == 0) fail_input(path, "the file is empty", "copy it again");
}

std::size_t ByteSource::State::read_file(void* out, std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got = ::read(descriptor, static_cast<char*>(out) + done, size - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail_input(path, std::strerror(errno), "check the disk and copy the file again");
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

/// Prepares zlib for the gzip member that begins at the buffered input; false if there is none.
bool ByteSource::State::next_member() {
  if (stream.avail_in < 2) {
    std::memmove(buffer.data(), stream.next_in, stream.avail_in);
    const std::size_t got = read_file(buffer.data() + stream.avail_in, kBufferSize - stream.avail_in);
    stream.next_in = buffer.data();
    stream.avail_in += static_cast<uInt>(got);
  }
  // Bytes after the last member that are no gzip are ignored, as gzip itself does.
  if (stream.avail_in < 2 || stream.next_in[0] != 0x1f || stream.next_in[1] != 0x8b) return false;
  inflateReset(&stream);
  stream_open = true;
  return true;
}

std::size_t ByteSource::State::read_inflated(void* out, std::size_t size) {
  constexpr std::size_t kLargestPiece = std::size_t{1} << 30;  // zlib counts in 32 bits
  std::size_t done = 0;
  while (done < size) {
    if (!stream_open && !next_member()) break;
    if (stream.avail_in == 0) {
      stream.next_in = buffer.data();
      stream.avail_in = static_cast<uInt>(read_file(buffer.data(), kBufferSize));
      if (stream.avail_in == 0) {
        fail_input(path, "truncated: the gzip data end after " + std::to_string(position + done) + " bytes of content",
                   "copy or download the file again");
      }
    }
    const std::size_t piece = std::min(size - done, kLargestPiece);
    stream.next_out = static_cast<unsigned char*>(out) + done;
    stream.avail_out = static_cast<uInt>(piece);
    const int status = inflate(&stream, Z_NO_FLUSH);
    done += piece - stream.avail_out;
    if (status == Z_STREAM_END) {
      stream_open = false;
    } else if (status != Z_OK && status != Z_BUF_ERROR) {
      const std::string detail = stream.msg != nullptr ? std::string(" (") + stream.msg + ")" : std::string();
      fail_input(path, "the gzip data are damaged" + detail, "copy or download the file again");
    }
  }
  return done;
}

ByteSource::ByteSource(std::filesystem::path path) : state_(std::make_unique<State>()) {
  state_->path = std::move(path);
  state_->open();
  unsigned char magic[2] = {0, 0};
  const std::size_t got = state_->read_file(magic, 2);
  ::lseek(state_->descriptor, 0, SEEK_SET);
  if (got < 2 || magic[0] != 0x1f || magic[1] != 0x8b) return;
  constexpr int kGzipOnly = 15 + 16;
  if (inflateInit2(&state_->stream, kGzipOnly) != Z_OK) {
    fail_input(state_->path, "no memory to inflate it", "close other programs");
  }
  state_->compressed = true;
  state_->buffer.resize(kBufferSize);
  state_->stream.next_in = state_->buffer.data();
}

ByteSource::~ByteSource() = default;
ByteSource::ByteSource(ByteSource&&) noexcept = default;

const std::filesystem::path& ByteSource::path() const { return state_->path; }
bool ByteSource::compressed() const { return state_->compressed; }
std::uint64_t ByteSource::position() const { return state_->position; }

std::string ByteSource::peek(std::size_t size) {
  std::string& peeked = state_->peeked;
  if (peeked.size() < size) {
    const std::size_t before = peeked.size();
    peeked.resize(size);
    peeked.resize(before + state_->read(peeked.data() + before, size - before));
  }
  return peeked.substr(0, size);
}

std::size_t ByteSource::read(void* out, std::size_t size) {
  const std::size_t from_peeked = std::min(size, state_->peeked.size());
  std::memcpy(out, state_->peeked.data(), from_peeked);
  state_->peeked.erase(0, from_peeked);
  std::size_t done = from_peeked;
  if (done < size) done += state_->read(static_cast<char*>(out) + done, size - done);
  state_->position += done;
  return done;
}

void ByteSource::read_exactly(void* out, std::size_t size, const char* what) {
  const std::size_t got = read(out, size);
  if (got == size) return;
  fail_input(state_->path,
             "truncated: " + std::string(what) + " ends after byte " + std::to_string(state_->position) + ", " +
                 std::to_string(size - got) + " bytes early",
             "copy or download the file again");
}

void ByteSource::skip(std::uint64_t size, const char* what) {
  std::vector<char> scratch(static_cast<std::size_t>(std::min<std::uint64_t>(size, kBufferSize)));
  while (size > 0) {
    if (!state_->compressed && state_->peeked.empty()) {
      // Seeking past the end is noticed by the read that follows.
      ::lseek(state_->descriptor, static_cast<off_t>(size), SEEK_CUR);
      state_->position += size;
      return;
    }
    const std::size_t piece = static_cast<std::size_t>(std::min<std::uint64_t>(size, scratch.size()));
    read_exactly(scratch.data(), piece, what);
    size -= piece;
  }
}

std::uint64_t ByteSource::capacity() const {
  const std::uint64_t size = state_->file_size;
  if (!state_->compressed) return size;
  return size > UINT64_MAX / kMostDeflateExpands ? UINT64_MAX : size * kMostDeflateExpands;
}

void ByteSource::verify_end() {
  if (!state_->compressed) return;
  char rest[4096];
  for (int i = 0; i < 16 && read(rest, sizeof rest) == sizeof rest; ++i) {
  }
}

}  // namespace delvox
