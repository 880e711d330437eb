#include "mesh_io/source.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <system_error>
#include <tuple>

#include "delvox/core/errors.h"

namespace delvox::mesh_io {

namespace fs = std::filesystem;

void Source::fail(const std::string& cause, const std::string& mend) const {
  throw InputError(path.string() + ": " + cause + "; " + mend);
}

std::size_t Source::checked_count(std::int64_t count, std::size_t bytes_each, std::size_t bytes_left,
                                  const char* what) const {
  if (count < 0 || static_cast<std::uint64_t>(count) > bytes_left / bytes_each) {
    fail("claims " + std::to_string(count) + " " + what + ", which " + std::to_string(bytes_left) +
         " bytes cannot hold");
  }
  return static_cast<std::size_t>(count);
}

Source load_source(const fs::path& path) {
  Source source{path, {}};
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) source.fail("there is no such file", "check the path");
  if (!fs::is_regular_file(status)) source.fail("is not a regular file", "give the path of a mesh file");
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) source.fail(std::string("cannot be opened: ") + std::strerror(errno), "check its permissions");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) source.fail("its size is not known: " + error.message(), "copy it to a local disk");
  if (size == 0) source.fail("is empty", "write it again");
  source.bytes.resize(size);
  stream.read(source.bytes.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size) source.fail("cannot be read to its end", "check the disk");
  return source;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string result = "'";
  for (char c : text.substr(0, kLongest)) result += (c >= ' ' && c <= '~') ? c : '?';
  return result + (text.size() > kLongest ? "...'" : "'");
}

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string upper_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return result;
}

double parse_real(const Source& source, std::string_view text) {
  std::string_view digits = text;
  if (!digits.empty() && digits.front() == '+') digits.remove_prefix(1);
  double value = 0;
  auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  std::string fortran;
  if (error == std::errc() && end != digits.data() + digits.size() && (*end == 'D' || *end == 'd')) {
    fortran = digits;
    fortran[static_cast<std::size_t>(end - digits.data())] = 'e';
    digits = fortran;
    std::tie(end, error) = [&] {
      const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), value);
      return std::pair(result.ptr, result.ec);
    }();
  }
  const bool underflow = error == std::errc::result_out_of_range && digits.find('-', 1) != std::string_view::npos;
  if (underflow) return 0.0;
  if (error != std::errc() || end != digits.data() + digits.size()) {
    source.fail("a number was expected, " + in_quotes(text) + " found");
  }
  return value;
}

std::int64_t parse_integer(const Source& source, std::string_view text) {
  std::string_view digits = text;
  if (!digits.empty() && digits.front() == '+') digits.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) {
    source.fail("a whole number was expected, " + in_quotes(text) + " found");
  }
  return value;
}

bool TextCursor::more() {
  while (position_ < text_.size()) {
    if (is_blank(text_[position_])) {
      ++position_;
    } else if (comment_ != '\0' && text_[position_] == comment_) {
      position_ = std::min(text_.find('\n', position_), text_.size());
    } else {
      return true;
    }
  }
  return false;
}

std::string_view TextCursor::token() {
  if (!more()) source_.fail("ends too early");
  const std::size_t start = position_;
  while (position_ < text_.size() && !is_blank(text_[position_])) ++position_;
  return text_.substr(start, position_ - start);
}

std::size_t TextCursor::count(const char* what, std::size_t bytes_each) {
  const std::int64_t claimed = integer();
  return source_.checked_count(claimed, bytes_each, remaining() + 1, what);
}

std::string_view TextCursor::line() {
  const std::size_t start = position_;
  const std::size_t end = std::min(text_.find('\n', start), text_.size());
  position_ = std::min(end + 1, text_.size());
  std::string_view result = text_.substr(start, end - start);
  if (!result.empty() && result.back() == '\r') result.remove_suffix(1);
  return result;
}

std::string_view TextCursor::raw(std::size_t size, const char* what) {
  if (size > remaining()) source_.fail(std::string("ends within the ") + what);
  const std::string_view result = text_.substr(position_, size);
  position_ += size;
  return result;
}

}  // namespace delvox::mesh_io
