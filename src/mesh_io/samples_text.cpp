#include "mesh_io/raw_samples.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <span>
#include <string_view>

namespace delvox::mesh_io {
namespace {

using Cells = std::vector<std::string_view>;

/// The number that a cell spells, wholly; "nan" and "inf" are numbers here, and refused later.
std::optional<double> number_in(std::string_view cell) {
  if (!cell.empty() && cell.front() == '+') cell.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (end != cell.data() + cell.size() || cell.empty()) return std::nullopt;
  if (error == std::errc::result_out_of_range) {  // 1e-400 is 0, 1e400 infinite
    return cell.find("e-") != cell.npos || cell.find("E-") != cell.npos ? 0 : std::numeric_limits<double>::infinity();
  }
  if (error != std::errc()) return std::nullopt;
  return value;
}

class TextReader {
 public:
  TextReader(const Source& source, const std::string& field) : source_(source), field_(field) {}

  RawSamples run() {
    std::string_view text = source_.bytes;
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // a byte order mark
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      ++line_;
      read_line(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (!begun_) source_.fail("holds no samples", "give lines of x, y, z and a value");
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(const std::string& cause, const std::string& mend) const {
    source_.fail("line " + std::to_string(line_) + ": " + cause, mend);
  }

  void read_line(std::string_view line) {
    line = trimmed(line.substr(0, line.find('#')));
    if (line.empty()) return;
    if (!begun_) choose_separator(line);
    split(line);
    if (begun_) {
      read_sample();
      return;
    }
    begun_ = true;
    column_count_ = cells_.size();
    const bool names =
        std::any_of(cells_.begin(), cells_.end(), [](std::string_view cell) { return !number_in(cell).has_value(); });
    if (names) {
      choose_columns();
    } else {
      take_first_columns();
      read_sample();
    }
  }

  void choose_separator(std::string_view line) {
    for (char separator : {';', '\t', ','}) {
      if (line.find(separator) == line.npos) continue;
      separator_ = separator;
      return;
    }
    separator_ = ' ';
  }

  void split(std::string_view line) {
    cells_.clear();
    while (true) {
      std::size_t end = 0;
      bool quoted = false;
      while (end < line.size() && (quoted || !parts(line[end]))) quoted ^= line[end++] == '"';
      std::string_view cell = trimmed(line.substr(0, end));
      if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"')
        cell = trimmed(cell.substr(1, cell.size() - 2));
      cells_.push_back(cell);
      if (end == line.size()) return;
      line.remove_prefix(end + 1);
      if (separator_ == ' ') line = trimmed(line);
    }
  }

  bool parts(char c) const { return separator_ == ' ' ? is_blank(c) : c == separator_; }

  void take_first_columns() {
    if (!field_.empty()) {
      fail("the columns have no names, so none is " + in_quotes(field_), "leave out --field, or write a line of names");
    }
    if (cells_.size() < 4) {
      fail("has " + std::to_string(cells_.size()) + " cells", "give x, y, z and a value, parted by commas or blanks");
    }
    columns_ = {0, 1, 2, 3};
  }

  void choose_columns() {
    std::vector<std::string> names;
    for (std::string_view cell : cells_) names.push_back(lower_case(cell));
    const auto find = [&](const std::string& name) {
      return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    };
    for (const std::array<const char*, 3>& axes :
         {std::array{"x", "y", "z"}, {"points:0", "points:1", "points:2"}, {"points_0", "points_1", "points_2"}}) {
      if (find(axes[0]) == names.size() || find(axes[1]) == names.size() || find(axes[2]) == names.size()) continue;
      columns_ = {find(axes[0]), find(axes[1]), find(axes[2]), 0};
      choose_value(find("value"));
      return;
    }
    if (names.size() < 4) fail("names fewer than four columns", "name x, y, z and a value");
    columns_ = {0, 1, 2, 0};
    choose_value(find("value"));
  }

  void choose_value(std::size_t named_value) {
    std::vector<std::size_t> others;
    std::string list;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (std::find(columns_.begin(), columns_.begin() + 3, i) != columns_.begin() + 3) continue;
      if (std::count(cells_.begin(), cells_.end(), cells_[i]) > 1) {
        fail("names two columns " + in_quotes(cells_[i]), "give each a name of its own");
      }
      if (!field_.empty() && cells_[i] == field_) {
        take(i);
        return;
      }
      others.push_back(i);
      list += (list.empty() ? "" : ", ") + in_quotes(cells_[i]);
    }
    if (others.empty()) fail("has no column of values beside x, y, z", "add one");
    if (!field_.empty()) fail("no column of values is named " + in_quotes(field_), "there are " + list);
    if (std::find(others.begin(), others.end(), named_value) != others.end()) {
      take(named_value);
    } else if (others.size() == 1) {
      take(others[0]);
    } else {
      fail("which column holds the values?", "choose with --field among " + list);
    }
  }

  void take(std::size_t column) {
    columns_[3] = column;
    result_.field = cells_[column];
  }

  void read_sample() {
    if (cells_.size() != column_count_) {
      fail("has " + std::to_string(cells_.size()) + " cells, the first line " + std::to_string(column_count_),
           "is the file cut off? write it again");
    }
    std::array<double, 4> numbers;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::string_view cell = cells_[columns_[i]];
      const auto number = number_in(cell);
      if (!number) {
        const bool comma = cell.find(',') != cell.npos;
        fail("a number was expected, " + in_quotes(cell) + " found",
             comma ? "write decimal points, not commas" : "mend or leave out that line");
      }
      numbers[i] = *number;
    }
    result_.samples.points.push_back({numbers[0], numbers[1], numbers[2]});
    result_.samples.values.push_back(numbers[3]);
    result_.line_of.push_back(line_);
  }

  const Source& source_;
  const std::string& field_;
  std::uint32_t line_ = 0;
  bool begun_ = false;
  char separator_ = ' ';
  std::size_t column_count_ = 0;
  std::array<std::size_t, 4> columns_{};  // x, y, z, value
  Cells cells_;                           // of the current line
  RawSamples result_;
};

}  // namespace

RawSamples read_samples_text(const Source& source, const std::string& field) {
  return TextReader(source, field).run();
}

}  // namespace delvox::mesh_io
