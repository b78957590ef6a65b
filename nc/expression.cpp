#include "nc/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "base/characters.hpp"
#include "base/errors.hpp"

namespace driftwright {
namespace {

constexpr double kSame = 1e-4;        // a parameter's number may be off a whole one by this much
constexpr int kDeepestBracket = 100;  // nested brackets

double arc_of(double x, double (*f)(double)) {
  if (!(std::abs(x) <= 1.0)) throw RangeError(fmt::format("there is no angle whose sine or cosine is {:g}", x));
  return f(x) / kDegree;
}

std::optional<double> function_of(const std::string& name, double x, const NcSyntax& syntax) {
  if (name == "SIN") return std::sin(x * kDegree);
  if (name == "COS") return std::cos(x * kDegree);
  if (name == "TAN") return std::tan(x * kDegree);
  if (name == "ASIN") return arc_of(x, [](double v) { return std::asin(v); });
  if (name == "ACOS") return arc_of(x, [](double v) { return std::acos(v); });
  if (name == "ABS") return std::abs(x);
  if (name == "EXP") return std::exp(x);
  if (name == "SQRT") {
    if (x < 0.0) throw RangeError("the number under the root is negative");
    return std::sqrt(x);
  }
  if (name == "LN" || name == "LOG") {
    if (!(x > 0.0)) throw RangeError("the logarithm requires a number above 0");
    return name == "LN" ? std::log(x) : std::log10(x);
  }
  if (name == "ROUND") return std::round(x);
  const auto further = syntax.functions.find(name);
  if (further != syntax.functions.end()) return further->second(x);
  return std::nullopt;
}

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '$';
}

class Reader {
 public:
  Reader(const std::string& text, std::size_t& at, const NcSyntax& syntax, const NcLookup& lookup)
      : text_(text), at_(at), syntax_(syntax), lookup_(lookup) {}

  NcValue expression(int lowest) {
    NcValue left = primary();
    while (const NcSyntax::Operator* op = next_operator(lowest)) {
      const NcValue right = expression(op->level + 1);
      left = {op->apply(left.value, right.value), left.certain && right.certain};
      if (!std::isfinite(left.value)) throw RangeError("the result is too large for a number");
    }
    return left;
  }

  NcValue primary() {
    if (++depth_ > kDeepestBracket) throw RangeError("the expression is nested too deeply");
    const NcValue value = unguarded_primary();
    --depth_;
    return value;
  }

  std::string parameter() {
    if (peek() == '<') {
      const std::size_t end = text_.find('>', at_);
      if (end == std::string::npos) throw RangeError("the named parameter has no '>'");
      const std::string name = text_.substr(at_, end + 1 - at_);
      at_ = end + 1;
      return name;
    }
    const double number = primary().value;
    if (!(number >= 0.0 && number < 1e6) || std::abs(number - std::round(number)) > kSame)
      throw RangeError(fmt::format("a parameter cannot have the number {:g}", number));
    return fmt::format("{}", std::lround(number));
  }

 private:
  [[nodiscard]] char peek() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  void take(char expected) {
    if (peek() != expected) throw RangeError(fmt::format("'{}' is expected here", expected));
    ++at_;
  }

  NcValue bracket() {
    take(syntax_.open);
    const NcValue value = expression(0);
    take(syntax_.close);
    return value;
  }

  const NcSyntax::Operator* next_operator(int lowest) {
    const char c = peek();
    if (c == '\0') return nullptr;
    for (const NcSyntax::Operator& op : syntax_.operators) {
      const std::string word = op.text;
      if (text_.compare(at_, word.size(), word) != 0) continue;
      if (is_letter(word[0]) && !syntax_.is_joined && at_ + word.size() < text_.size() &&
          is_letter(text_[at_ + word.size()]))
        continue;
      if (op.level < lowest) return nullptr;
      at_ += word.size();
      return &op;
    }
    return nullptr;
  }

  NcValue number() {
    const std::size_t begin = at_;
    std::string digits;
    while (at_ < text_.size() &&
           (is_digit(text_[at_]) || text_[at_] == '.' || (text_[at_] == ',' && syntax_.has_decimal_comma)))
      digits += text_[at_] == ',' ? '.' : text_[at_], ++at_;
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed);
    if (error != std::errc() || end != digits.data() + digits.size()) {
      at_ = begin;
      throw RangeError(digits.empty() ? "a number, a variable or an expression is expected here"
                                      : fmt::format("'{}' is no number", digits));
    }
    return {value};
  }

  std::string name() {
    std::string name;
    while (at_ < text_.size() && (is_letter(text_[at_]) || (is_digit(text_[at_]) && !syntax_.is_joined)))
      name += static_cast<char>(std::toupper(static_cast<unsigned char>(text_[at_++])));
    return name;
  }

  NcValue call(const std::string& function) {
    if (syntax_.has_numbered && function == "EXISTS") {
      if (peek() != '[' || at_ + 1 >= text_.size() || text_[at_ + 1] != '#')
        throw RangeError("EXISTS must be written as EXISTS[#<name>]");
      at_ += 2;
      const std::string name = parameter();
      take(']');
      try {
        return {1.0, lookup_(name).certain};
      } catch (const RangeError&) {
        return {0.0};
      }
    }
    if (function == syntax_.angle_of_two) {
      take(syntax_.open);
      const NcValue y = expression(0);
      take(',');
      const NcValue x = expression(0);
      take(syntax_.close);
      return {std::atan2(y.value, x.value) / kDegree, y.certain && x.certain};
    }
    const bool bare = syntax_.has_bare_arguments && peek() != syntax_.open;
    const NcValue x = bare ? primary() : bracket();
    if (function == syntax_.angle_of_ratio) {
      if (peek() != '/') throw RangeError("ATAN must be written as ATAN[y]/[x]");
      ++at_;
      const NcValue along = bracket();
      return {std::atan2(x.value, along.value) / kDegree, x.certain && along.certain};
    }
    const std::optional<double> value = function_of(function, x.value, syntax_);
    if (!value) throw RangeError(fmt::format("'{}' is no function known here", function));
    return {*value, x.certain};
  }

  NcValue unguarded_primary() {
    const char c = peek();
    if (c == '+' || c == '-') {
      ++at_;
      const NcValue value = primary();
      return {c == '-' ? -value.value : value.value, value.certain};
    }
    if (c == syntax_.open) return bracket();
    if (c == '#' && syntax_.has_numbered) {
      ++at_;
      return lookup_(parameter());
    }
    if (is_letter(c)) {
      const std::size_t begin = at_;
      const std::string word = name();
      if (word == syntax_.negation) return {primary().value == 0.0 ? 1.0 : 0.0};
      if (const auto constant = syntax_.constants.find(word); constant != syntax_.constants.end()) return {constant->second};
      const bool variable =
          (syntax_.is_variable && syntax_.is_variable(word)) || (syntax_.has_named_variables && peek() != syntax_.open);
      if (variable) {
        try {
          return lookup_(word);
        } catch (const RangeError&) {
          at_ = begin;
          throw;
        }
      }
      return call(word);
    }
    return number();
  }

  const std::string& text_;
  std::size_t& at_;
  const NcSyntax& syntax_;
  const NcLookup& lookup_;
  int depth_ = 0;
};

}  // namespace

NcValue evaluate(const std::string& text, std::size_t& at, const NcSyntax& syntax, const NcLookup& lookup, bool whole) {
  Reader reader(text, at, syntax, lookup);
  return whole ? reader.expression(0) : reader.primary();
}

std::string parameter_name(const std::string& text, std::size_t& at, const NcSyntax& syntax, const NcLookup& lookup) {
  return Reader(text, at, syntax, lookup).parameter();
}

}  // namespace driftwright
