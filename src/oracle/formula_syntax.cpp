#include "oracle/formula_syntax.h"

#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

#include "delvox/core/errors.h"

namespace delvox {
namespace {

constexpr std::size_t kLongest = 100'000;  // characters
constexpr int kDeepest = 200;              // brackets, signs and exponents within one another

struct NamedCall {
  std::string_view name;
  FormulaCall call;
};
constexpr NamedCall kCalls[] = {
    {"sin", FormulaCall::kSin},   {"cos", FormulaCall::kCos},   {"tan", FormulaCall::kTan},
    {"asin", FormulaCall::kAsin}, {"acos", FormulaCall::kAcos}, {"atan", FormulaCall::kAtan},
    {"sinh", FormulaCall::kSinh}, {"cosh", FormulaCall::kCosh}, {"tanh", FormulaCall::kTanh},
    {"exp", FormulaCall::kExp},   {"log", FormulaCall::kLog},   {"sqrt", FormulaCall::kSqrt},
    {"abs", FormulaCall::kAbs},   {"min", FormulaCall::kMin},   {"max", FormulaCall::kMax}};

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

/// Recursive descent: sum = product {(+|-) product}, product = factor {(*|/) factor}, factor = -factor | power,
/// power = primary [^ factor].
class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  FormulaNode parse() {
    if (text_.size() > kLongest) throw OptionError("the formula is longer than 100,000 characters");
    FormulaNode formula = sum();
    if (peek() != '\0') fail("expected an operator or the end");
    return formula;
  }

 private:
  using Kind = FormulaNode::Kind;

  // The next character that is no blank; 0 at the end.
  char peek() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n')) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool take(char c) {
    if (peek() != c) return false;
    ++at_;
    return true;
  }
  [[noreturn]] void fail(const std::string& what) const { fail_at(at_, what); }
  [[noreturn]] void fail_at(std::size_t position, const std::string& what) const {
    throw OptionError("the formula does not parse " + formula_place(text_, position) + ": " + what);
  }
  static FormulaNode node(Kind kind, std::size_t position, std::vector<FormulaNode> operands) {
    return {kind, 0, FormulaCall::kSin, std::move(operands), position};
  }

  FormulaNode sum() {
    if (++depth_ > kDeepest) fail("too many brackets, signs or exponents within one another");
    peek();
    FormulaNode result = node(Kind::kSum, at_, {});
    result.operands.push_back(product());
    for (;;) {
      const char c = peek();
      const std::size_t position = at_;
      if (c != '+' && c != '-') break;
      ++at_;
      FormulaNode term = product();
      result.operands.push_back(c == '+' ? std::move(term) : node(Kind::kNegate, position, {std::move(term)}));
    }
    --depth_;
    return alone_or(std::move(result));
  }

  FormulaNode product() {
    peek();
    FormulaNode result = node(Kind::kProduct, at_, {});
    result.operands.push_back(factor());
    for (;;) {
      const char c = peek();
      const std::size_t position = at_;
      if (c != '*' && c != '/') return alone_or(std::move(result));
      ++at_;
      if (peek() == '*') fail("powers are written with ^");
      FormulaNode next = factor();
      result.operands.push_back(c == '*' ? std::move(next) : node(Kind::kInverse, position, {std::move(next)}));
    }
  }

  static FormulaNode alone_or(FormulaNode list) {
    if (list.operands.size() > 1) return list;
    FormulaNode alone = std::move(list.operands[0]);
    return alone;
  }

  FormulaNode factor() {
    if (++depth_ > kDeepest) fail("too many brackets, signs or exponents within one another");
    const char c = peek();
    const std::size_t position = at_;
    FormulaNode result;
    if (take('-')) {
      result = node(Kind::kNegate, position, {factor()});
    } else if (c == '+') {
      ++at_;
      result = factor();
    } else {
      result = primary();
      peek();
      const std::size_t hat = at_;
      if (take('^')) result = node(Kind::kPower, hat, {std::move(result), factor()});
    }
    --depth_;
    return result;
  }

  FormulaNode primary() {
    const char c = peek();
    if (take('(')) {
      FormulaNode inner = sum();
      if (!take(')')) fail("expected ')'");
      return inner;
    }
    if (is_digit(c) || c == '.') return number();
    if (is_letter(c)) return name();
    fail("expected a number, x, y, z, a function or '('");
  }

  FormulaNode number() {
    FormulaNode result = node(Kind::kNumber, at_, {});
    const char* begin = text_.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), result.number);
    if (error != std::errc() || !std::isfinite(result.number)) fail("not a number that fits");
    at_ += static_cast<std::size_t>(end - begin);
    return result;
  }

  FormulaNode name() {
    const std::size_t start = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    const std::string_view word = text_.substr(start, at_ - start);
    if (word == "x") return node(Kind::kX, start, {});
    if (word == "y") return node(Kind::kY, start, {});
    if (word == "z") return node(Kind::kZ, start, {});
    FormulaNode constant = node(Kind::kNumber, start, {});
    if (word == "pi" || word == "e") {
      constant.number = word == "pi" ? std::numbers::pi : std::numbers::e;
      return constant;
    }
    for (const NamedCall& named : kCalls) {
      if (word == named.name) return call(named, start);
    }
    fail_at(start, "unknown name '" + std::string(word) + "'; there are x, y, z, pi, e, " + call_names());
  }

  FormulaNode call(const NamedCall& named, std::size_t start) {
    if (!take('(')) fail("expected '(' after " + std::string(named.name));
    FormulaNode result = node(Kind::kCall, start, {});
    result.call = named.call;
    do {
      result.operands.push_back(sum());
    } while (take(','));
    if (!take(')')) fail("expected ',' or ')'");
    const bool several = named.call == FormulaCall::kMin || named.call == FormulaCall::kMax;
    if (several != (result.operands.size() > 1)) {
      fail_at(start, std::string(named.name) + (several ? " takes two arguments or more" : " takes one argument"));
    }
    return result;
  }

  static std::string call_names() {
    std::string names;
    for (const NamedCall& named : kCalls) names += (names.empty() ? "" : ", ") + std::string(named.name);
    return names;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

FormulaNode parse_formula(std::string_view text) {
  return Parser(text).parse();
}

std::string formula_place(std::string_view text, std::size_t position) {
  constexpr std::size_t kShown = 12;
  std::string place = "at position " + std::to_string(position + 1);
  if (position >= text.size()) return place + ", its end";
  return place + ", '" + std::string(text.substr(position, kShown)) + "'";
}

}  // namespace delvox
