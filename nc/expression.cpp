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

constexpr double kSame = 1e-4;        // tolerance of LinuxCNC's EQ and NE
constexpr int kDeepestBracket = 100;  // nested brackets

struct Operator {
  const char* text;
  int level;  ///< higher binds more closely
  double (*apply)(double a, double b);
};

double checked_quotient(double a, double b) {
  if (b == 0.0) throw RangeError("the expression divides by zero");
  return a / b;
}
double modulus(double a, double b) {
  if (b == 0.0) throw RangeError("the expression divides by zero");
  const double rest = std::fmod(a, b);
  return rest < 0.0 ? rest + std::abs(b) : rest;
}
constexpr auto power = [](double a, double b) { return std::pow(a, b); };
constexpr auto product = [](double a, double b) { return a * b; };
constexpr auto plus = [](double a, double b) { return a + b; };
constexpr auto minus = [](double a, double b) { return a - b; };
constexpr auto whole_quotient = [](double a, double b) { return std::trunc(checked_quotient(a, b)); };
constexpr auto equal = [](double a, double b) { return std::abs(a - b) < kSame ? 1.0 : 0.0; };
constexpr auto unequal = [](double a, double b) { return 1.0 - equal(a, b); };
constexpr auto same = [](double a, double b) { return a == b ? 1.0 : 0.0; };
constexpr auto different = [](double a, double b) { return a != b ? 1.0 : 0.0; };
constexpr auto greater = [](double a, double b) { return a > b ? 1.0 : 0.0; };
constexpr auto at_least = [](double a, double b) { return a >= b ? 1.0 : 0.0; };
constexpr auto less = [](double a, double b) { return a < b ? 1.0 : 0.0; };
constexpr auto at_most = [](double a, double b) { return a <= b ? 1.0 : 0.0; };
constexpr auto both = [](double a, double b) { return a != 0.0 && b != 0.0 ? 1.0 : 0.0; };
constexpr auto either = [](double a, double b) { return a != 0.0 || b != 0.0 ? 1.0 : 0.0; };
constexpr auto one_of = [](double a, double b) { return (a != 0.0) != (b != 0.0) ? 1.0 : 0.0; };

/// Longer operators first, if one begins with another.
const std::vector<Operator>& operators(NcSyntax syntax) {
  static const std::vector<Operator> kLinuxCnc = {
      {"**", 5, power}, {"*", 4, product},  {"/", 4, checked_quotient}, {"MOD", 4, modulus}, {"+", 3, plus},
      {"-", 3, minus},  {"EQ", 2, equal},   {"NE", 2, unequal},         {"GT", 2, greater},  {"GE", 2, at_least},
      {"LT", 2, less},  {"LE", 2, at_most}, {"AND", 1, both},           {"OR", 1, either},   {"XOR", 1, one_of}};
  static const std::vector<Operator> kSiemens = {{"*", 5, product},
                                                 {"/", 5, checked_quotient},
                                                 {"DIV", 5, whole_quotient},
                                                 {"MOD", 5, modulus},
                                                 {"+", 4, plus},
                                                 {"-", 4, minus},
                                                 {"==", 3, same},
                                                 {"<>", 3, different},
                                                 {"<=", 3, at_most},
                                                 {">=", 3, at_least},
                                                 {"<", 3, less},
                                                 {">", 3, greater},
                                                 {"AND", 2, both},
                                                 {"XOR", 1, one_of},
                                                 {"OR", 1, either}};
  static const std::vector<Operator> kHeidenhain = {
      {"^", 3, power}, {"*", 2, product}, {"/", 2, checked_quotient}, {"+", 1, plus}, {"-", 1, minus}};
  return syntax == NcSyntax::kLinuxCnc ? kLinuxCnc : syntax == NcSyntax::kSiemens ? kSiemens : kHeidenhain;
}

double arc_of(double x, double (*f)(double)) {
  if (!(std::abs(x) <= 1.0)) throw RangeError(fmt::format("there is no angle whose sine or cosine is {:g}", x));
  return f(x) / kDegree;
}

std::optional<double> function_of(const std::string& name, double x, NcSyntax syntax) {
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
  if (syntax == NcSyntax::kLinuxCnc && name == "FIX") return std::floor(x);
  if (syntax == NcSyntax::kLinuxCnc && name == "FUP") return std::ceil(x);
  if (syntax == NcSyntax::kSiemens && name == "TRUNC") return std::trunc(x);
  if (syntax == NcSyntax::kSiemens && name == "POT") return x * x;
  if (syntax == NcSyntax::kHeidenhain) {
    if (name == "SQ") return x * x;
    if (name == "NEG") return -x;
    if (name == "INT") return std::trunc(x);
    if (name == "FRAC") return x - std::trunc(x);
    if (name == "SGN") return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0;
    if (name == "ATAN") return std::atan(x) / kDegree;
  }
  return std::nullopt;
}

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '$';
}
class Reader {
 public:
  Reader(const std::string& text, std::size_t& at, NcSyntax syntax, const NcLookup& lookup)
      : text_(text), at_(at), syntax_(syntax), lookup_(lookup) {}

  NcValue expression(int lowest) {
    NcValue left = primary();
    while (const Operator* op = next_operator(lowest)) {
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

  [[nodiscard]] char opening() const { return syntax_ == NcSyntax::kLinuxCnc ? '[' : '('; }

  NcValue bracket() {
    const char close = syntax_ == NcSyntax::kLinuxCnc ? ']' : ')';
    if (peek() != opening()) throw RangeError(fmt::format("'{}' is expected here", opening()));
    ++at_;
    const NcValue value = expression(0);
    if (peek() != close) throw RangeError(fmt::format("'{}' is expected here", close));
    ++at_;
    return value;
  }

  const Operator* next_operator(int lowest) {
    const char c = peek();
    if (c == '\0') return nullptr;
    for (const Operator& op : operators(syntax_)) {
      const std::string word = op.text;
      if (text_.compare(at_, word.size(), word) != 0) continue;
      if (is_letter(word[0]) && syntax_ != NcSyntax::kLinuxCnc && at_ + word.size() < text_.size() &&
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
           (is_digit(text_[at_]) || text_[at_] == '.' || (text_[at_] == ',' && syntax_ == NcSyntax::kHeidenhain)))
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
    while (at_ < text_.size() && (is_letter(text_[at_]) || (is_digit(text_[at_]) && syntax_ != NcSyntax::kLinuxCnc)))
      name += static_cast<char>(std::toupper(static_cast<unsigned char>(text_[at_++])));
    return name;
  }

  NcValue call(const std::string& function) {
    if (syntax_ == NcSyntax::kLinuxCnc && function == "EXISTS") {
      if (peek() != '[' || at_ + 1 >= text_.size() || text_[at_ + 1] != '#')
        throw RangeError("EXISTS must be written as EXISTS[#<name>]");
      at_ += 2;
      const std::string name = parameter();
      if (peek() != ']') throw RangeError("']' is expected here");
      ++at_;
      try {
        return {1.0, lookup_(name).certain};
      } catch (const RangeError&) {
        return {0.0};
      }
    }
    if (syntax_ == NcSyntax::kSiemens && function == "ATAN2") {
      if (peek() != '(') throw RangeError("'(' is expected here");
      ++at_;
      const NcValue y = expression(0);
      if (peek() != ',') throw RangeError("',' is expected here");
      ++at_;
      const NcValue x = expression(0);
      if (peek() != ')') throw RangeError("')' is expected here");
      ++at_;
      return {std::atan2(y.value, x.value) / kDegree, y.certain && x.certain};
    }
    const bool bare = syntax_ == NcSyntax::kHeidenhain && peek() != '(';
    const NcValue x = bare ? primary() : bracket();
    if (syntax_ == NcSyntax::kLinuxCnc && function == "ATAN") {
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
    if (c == opening()) return bracket();
    if (c == '#' && syntax_ == NcSyntax::kLinuxCnc) {
      ++at_;
      return lookup_(parameter());
    }
    if (is_letter(c)) {
      const std::size_t begin = at_;
      const std::string word = name();
      if (syntax_ == NcSyntax::kSiemens && word == "NOT") return {primary().value == 0.0 ? 1.0 : 0.0};
      if (syntax_ == NcSyntax::kSiemens && (word == "TRUE" || word == "FALSE")) return {word == "TRUE" ? 1.0 : 0.0};
      if (syntax_ == NcSyntax::kHeidenhain && word == "PI") return {std::numbers::pi};
      const bool variable =
          (syntax_ == NcSyntax::kHeidenhain && word[0] == 'Q' && word.size() > 1 && is_digit(word.back())) ||
          (syntax_ == NcSyntax::kSiemens && peek() != '(');
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
  NcSyntax syntax_;
  const NcLookup& lookup_;
  int depth_ = 0;
};

}  // namespace

NcValue evaluate(const std::string& text, std::size_t& at, NcSyntax syntax, const NcLookup& lookup, bool whole) {
  Reader reader(text, at, syntax, lookup);
  return whole ? reader.expression(0) : reader.primary();
}

std::string parameter_name(const std::string& text, std::size_t& at, const NcLookup& lookup) {
  return Reader(text, at, NcSyntax::kLinuxCnc, lookup).parameter();
}

}  // namespace driftwright
