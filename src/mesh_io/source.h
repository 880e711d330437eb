#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace delvox::mesh_io {

/// A mesh file in memory, and the way to complain of it.
struct Source {
  std::filesystem::path path;
  std::string bytes;

  /// Throws InputError: path, cause, mend in one line.
  [[noreturn]] void fail(const std::string& cause,
                         const std::string& mend = "is the file damaged or cut off? write it again") const;
  /// Throws unless `count` items of at least `bytes_each` can lie in `bytes_left`: what a file claims is never
  /// believed before memory is taken for it.
  std::size_t checked_count(std::int64_t count, std::size_t bytes_each, std::size_t bytes_left, const char* what) const;
};

/// Throws InputError unless `path` is a regular, readable, non-empty file.
Source load_source(const std::filesystem::path& path);

/// Foreign text fit for a one-line message: short, printable, in quotes.
std::string in_quotes(std::string_view text);

std::string_view trimmed(std::string_view text);
/// With small letters in place of A to Z.
std::string lower_case(std::string_view text);
std::string upper_case(std::string_view text);
bool is_blank(char c);

/// The number that `text` spells, wholly; accepts a leading '+' and Fortran's D exponents. Throws InputError.
double parse_real(const Source& source, std::string_view text);
std::int64_t parse_integer(const Source& source, std::string_view text);

/// Walks through text token by token or line by line.
class TextCursor {
 public:
  /// From `comment` to the end of a line is skipped, unless it is '\0'.
  TextCursor(const Source& source, std::string_view text, char comment = '\0')
      : source_(source), text_(text), comment_(comment) {}

  /// Skips blanks and comments; false at the end of the text.
  bool more();
  /// The next token, and throws InputError at the end of the text.
  std::string_view token();
  double real() { return parse_real(source_, token()); }
  std::int64_t integer() { return parse_integer(source_, token()); }
  /// A count of things that take at least `bytes_each` bytes of the remaining text.
  std::size_t count(const char* what, std::size_t bytes_each);
  /// The rest of the current line without its end; pre: !at_end().
  std::string_view line();
  /// `size` raw bytes; throws InputError if there are not as many.
  std::string_view raw(std::size_t size, const char* what);

  bool at_end() const { return position_ >= text_.size(); }
  char peek() const { return text_[position_]; }
  std::size_t position() const { return position_; }
  void seek(std::size_t position) { position_ = position; }
  std::size_t remaining() const { return text_.size() - position_; }
  std::string_view rest() const { return text_.substr(position_); }
  const Source& source() const { return source_; }

 private:
  const Source& source_;
  std::string_view text_;
  char comment_;
  std::size_t position_ = 0;
};

}  // namespace delvox::mesh_io
