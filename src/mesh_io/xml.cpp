#include "mesh_io/xml.h"

#include <algorithm>
#include <string>

namespace delvox::mesh_io {
namespace {

// A mesh needs some dozens of elements: more would only serve to fill the memory.
constexpr std::size_t kMostElements = 100'000;
constexpr std::size_t kDeepest = 64;

class Parser {
 public:
  Parser(const Source& source, std::string_view text) : source_(source), text_(text) {}

  XmlNode parse() {
    XmlNode document;
    std::vector<XmlNode*> open{&document};
    while (true) {
      const std::size_t start = text_.find('<', position_);
      if (start == std::string_view::npos) break;
      XmlNode& parent = *open.back();
      if (parent.children.empty() && parent.text.empty()) parent.text = text_.substr(position_, start - position_);
      position_ = start;
      if (skip("<!--", "-->") || skip("<?", "?>") || skip("<!", ">")) continue;
      if (text_.substr(start, 2) == "</") {
        close_element(open);
      } else if (open_element(parent)) {
        open.push_back(&parent.children.back());
        if (open.size() > kDeepest) source_.fail("its XML is nested too deep", "is it a VTU file?");
      }
    }
    return document;
  }

 private:
  bool skip(std::string_view begin, std::string_view end) {
    if (text_.substr(position_, begin.size()) != begin) return false;
    position_ = find(end, position_ + begin.size()) + end.size();
    return true;
  }

  std::size_t find(std::string_view what, std::size_t from) const {
    const std::size_t found = text_.find(what, from);
    if (found == std::string_view::npos) source_.fail("its XML ends within a tag");
    return found;
  }

  void close_element(std::vector<XmlNode*>& open) {
    const std::size_t end = find(">", position_);
    const std::string_view name = trimmed(text_.substr(position_ + 2, end - position_ - 2));
    if (open.size() < 2 || open.back()->name != name) source_.fail("its XML closes " + in_quotes(name) + " unopened");
    open.pop_back();
    position_ = end + 1;
  }

  /// Adds the element that begins here to its parent; true if it stays open.
  bool open_element(XmlNode& parent) {
    if (++elements_ > kMostElements) source_.fail("its XML has too many elements", "is it a VTU file?");
    XmlNode& node = parent.children.emplace_back();
    ++position_;
    node.name = name();
    while (true) {
      skip_blanks();
      if (text_[position_] == '>') {
        ++position_;
        return true;
      }
      if (text_.substr(position_, 2) == "/>") {
        position_ += 2;
        return false;
      }
      if (++elements_ > kMostElements) source_.fail("its XML has too many attributes", "is it a VTU file?");
      const std::string_view key = name();
      skip_blanks();
      if (text_[position_] != '=') source_.fail("its XML has an attribute without a value");
      ++position_;
      skip_blanks();
      const char quote = text_[position_];
      if (quote != '"' && quote != '\'') source_.fail("its XML has an attribute without quotes");
      const std::size_t end = find(std::string_view(&quote, 1), position_ + 1);
      node.attributes.emplace_back(key, text_.substr(position_ + 1, end - position_ - 1));
      position_ = end + 1;
    }
  }

  /// Leaves position_ at a character.
  void skip_blanks() {
    while (position_ < text_.size() && is_blank(text_[position_])) ++position_;
    if (position_ >= text_.size()) source_.fail("its XML ends within a tag");
  }

  std::string_view name() {
    const std::size_t start = position_;
    const auto ends_name = [](char c) { return is_blank(c) || c == '=' || c == '>' || c == '/' || c == '<'; };
    while (position_ < text_.size() && !ends_name(text_[position_])) ++position_;
    if (position_ == start) source_.fail("its XML has a tag without a name");
    return text_.substr(start, position_ - start);
  }

  const Source& source_;
  std::string_view text_;
  std::size_t position_ = 0;
  std::size_t elements_ = 0;
};

}  // namespace

std::string_view XmlNode::attribute(std::string_view key, std::string_view otherwise) const {
  const auto found =
      std::find_if(attributes.begin(), attributes.end(), [&](const auto& pair) { return pair.first == key; });
  return found == attributes.end() ? otherwise : found->second;
}

const XmlNode* XmlNode::child(std::string_view key) const {
  const auto found = std::find_if(children.begin(), children.end(), [&](const XmlNode& n) { return n.name == key; });
  return found == children.end() ? nullptr : &*found;
}

XmlNode parse_xml(const Source& source, std::string_view text) { return Parser(source, text).parse(); }

}  // namespace delvox::mesh_io
