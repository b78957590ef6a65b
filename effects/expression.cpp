#include "effects/expression.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <muParser.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/characters.hpp"
#include "base/config_map.hpp"
#include "base/quantity.hpp"

namespace driftwright::effects {
namespace {

constexpr std::size_t kDeepest = 64;  // values that are kept while a formula is evaluated
constexpr std::size_t kRoom = 72;     // of laws put together (law_steps.hpp), which keep a few more

using Step = Expression::Step;

/// muParser computes with numbers alone. Here each of them is the index of a node of the tree that is being built: numbers
/// and names become leaves as they are read, and operators and functions become nodes as muParser evaluates them.
struct Node {
  Step step;
  std::array<int, 3> arguments = {-1, -1, -1};
};
struct TreeBuilder {
  const std::string& text;
  const std::vector<std::string>& names;
  std::vector<Node> nodes = {};

  double leaf(Step step) {
    nodes.push_back({step});
    return static_cast<double>(nodes.size() - 1);
  }
  double node(Op op, std::initializer_list<double> of) {
    Node made{.step = {.op = op}};
    std::size_t i = 0;
    for (const double handle : of) made.arguments[i++] = static_cast<int>(handle);
    nodes.push_back(made);
    return static_cast<double>(nodes.size() - 1);
  }
};
/// muParser's callbacks for operators take no pointer of ours.
thread_local TreeBuilder* building = nullptr;

template <Op op>
double make1(double a) {
  return building->node(op, {a});
}
template <Op op>
double make2(double a, double b) {
  return building->node(op, {a, b});
}
template <Op op>
double make3(double a, double b, double c) {
  return building->node(op, {a, b, c});
}
/// A plus sign before a value does nothing.
double plus(double a) {
  return a;
}

bool is_of_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

std::size_t end_of_name(const std::string& text, std::size_t begin) {
  std::size_t end = begin;
  while (end < text.size() && is_of_name(text[end])) ++end;
  return end;
}

/// Reads a number or a known name at `at`, as muParser's identfun_type: 1 and the position after it, else 0.
int read_leaf(const char* at, int* position, double* handle) {
  const auto begin = static_cast<std::size_t>(*position);
  Step leaf{.begin = begin, .sign = begin};
  if (std::isdigit(static_cast<unsigned char>(*at)) || *at == '.') {
    const auto read = std::from_chars(at, at + std::strlen(at), leaf.number);
    if (read.ec != std::errc()) return 0;
    leaf.end = begin + static_cast<std::size_t>(read.ptr - at);
  } else {
    leaf.end = end_of_name(building->text, begin);
    const auto& names = building->names;
    const auto found = std::find(names.begin(), names.end(), building->text.substr(begin, leaf.end - begin));
    if (found == names.end()) return 0;
    leaf.op = Op::kName;
    leaf.name = static_cast<std::size_t>(found - names.begin());
  }
  *handle = building->leaf(leaf);
  *position = static_cast<int>(leaf.end);
  return 1;
}

struct Function {
  const char* name;
  Op op;
};
constexpr Function kFunctions[] = {
    {"abs", Op::kAbs},         {"sqrt", Op::kSqrt}, {"exp", Op::kExp}, {"ln", Op::kLn},     {"log10", Op::kLog10},
    {"sin", Op::kSin},         {"cos", Op::kCos},   {"tan", Op::kTan}, {"tanh", Op::kTanh}, {"kelvin", Op::kKelvin},
    {"celsius", Op::kCelsius}, {"min", Op::kMin},   {"max", Op::kMax}, {"if", Op::kIf}};

std::vector<std::string> function_names() {
  std::vector<std::string> names;
  for (const Function& f : kFunctions) names.emplace_back(f.name);
  return names;
}

template <Op... ops>
void define_functions_of_one(mu::Parser& parser) {
  const auto define = [&](Op op, double (*make)(double)) {
    const auto* f =
        std::find_if(std::begin(kFunctions), std::end(kFunctions), [&](const auto& known) { return known.op == op; });
    parser.DefineFun(f->name, make, false);
  };
  (define(ops, make1<ops>), ...);
}

void define_all(mu::Parser& parser) {
  parser.ClearConst();
  parser.ClearFun();
  parser.ClearInfixOprt();
  parser.ClearOprt();
  parser.EnableBuiltInOprt(false);
  parser.AddValIdent(read_leaf);
  parser.DefineOprt("<", make2<Op::kLess>, mu::prCMP);
  parser.DefineOprt(">", make2<Op::kGreater>, mu::prCMP);
  parser.DefineOprt("+", make2<Op::kAdd>, mu::prADD_SUB);
  parser.DefineOprt("-", make2<Op::kSubtract>, mu::prADD_SUB);
  parser.DefineOprt("*", make2<Op::kMultiply>, mu::prMUL_DIV);
  parser.DefineOprt("/", make2<Op::kDivide>, mu::prMUL_DIV);
  parser.DefineOprt("^", make2<Op::kPower>, mu::prPOW, mu::oaRIGHT);
  parser.DefineInfixOprt("-", make1<Op::kNegate>, mu::prINFIX, false);
  parser.DefineInfixOprt("+", plus, mu::prINFIX, false);
  define_functions_of_one<Op::kAbs, Op::kSqrt, Op::kExp, Op::kLn, Op::kLog10, Op::kSin, Op::kCos, Op::kTan, Op::kTanh,
                          Op::kKelvin, Op::kCelsius>(parser);
  parser.DefineFun("min", make2<Op::kMin>, false);
  parser.DefineFun("max", make2<Op::kMax>, false);
  parser.DefineFun("if", make3<Op::kIf>, false);
}

constexpr const char* kAllowed = "allowed are + - * / ^ < > and brackets";

/// " Did you mean 'sin'?" for SIN, as did_you_mean() has it for mistyped words.
std::string did_you_mean_in_any_case(const std::string& word, const std::vector<std::string>& candidates) {
  const auto same = std::find_if(candidates.begin(), candidates.end(),
                                 [&](const std::string& c) { return lower_case(c) == lower_case(word); });
  return same == candidates.end() ? did_you_mean(word, candidates) : fmt::format(" Did you mean '{}'?", *same);
}

/// Refuses what is no character of a formula, and comparisons that it lacks.
void require_known_characters(const std::string& text) {
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '?') throw FormulaError("'?' is not known here; write if(condition, then, else)", at);
    if (static_cast<unsigned char>(text[at]) >= 0x80U)
      throw FormulaError(fmt::format("'{}' is not known here; names have ASCII letters, digits and '_', and {}",
                                     character_at(text, at), kAllowed),
                         at);
    const bool is_comparison = std::strchr("<>=!", text[at]) && at + 1 < text.size() && text[at + 1] == '=';
    if (is_comparison || text[at] == '=')
      throw FormulaError(
          fmt::format("'{}' is not known here; only the comparisons < and > exist", text.substr(at, is_comparison ? 2 : 1)),
          at);
  }
}

/// What muParser found wrong, as a sentence with a position.
FormulaError sentence(const mu::ParserError& e, const TreeBuilder& b) {
  const std::string& text = b.text;
  auto at = static_cast<std::size_t>(std::clamp(e.GetPos(), 0, static_cast<int>(text.size())));
  switch (e.GetCode()) {
    case mu::ecUNASSIGNABLE_TOKEN: {
      while (at < text.size() && text[at] == ' ') ++at;
      const std::size_t end = end_of_name(text, at);
      if (end == at) return {fmt::format("'{}' cannot follow here; {}", character_at(text, at), kAllowed), at};
      const std::string name = text.substr(at, end - at);
      const std::size_t next = text.find_first_not_of(' ', end);
      if (next != std::string::npos && text[next] == '(')
        return {fmt::format("there is no function '{}'; there are {}.{}", name, fmt::join(function_names(), ", "),
                            did_you_mean_in_any_case(name, function_names())),
                at};
      return {fmt::format("'{}' is not known here; known names: {}.{}", name, fmt::join(b.names, ", "),
                          did_you_mean_in_any_case(name, b.names)),
              at};
    }
    case mu::ecUNEXPECTED_EOF:
      return {"the formula ends where a number, a name or a bracket must follow", text.size()};
    case mu::ecMISSING_PARENS:
      return {"a bracket is not closed", text.size()};
    case mu::ecTOO_MANY_PARAMS:
    case mu::ecTOO_FEW_PARAMS:
      return {fmt::format("the function '{}' takes another number of arguments: min and max two, if three (condition, then, "
                          "else), the others one",
                          e.GetToken()),
              at};
    default:  // an operator, value or bracket that cannot follow what is before it; muParser's position is after the token
      break;
  }
  const std::string& token = e.GetToken();
  if (!token.empty() && at >= token.size() && text.compare(at, token.size(), token) != 0 &&
      text.compare(at - token.size(), token.size(), token) == 0)
    at -= token.size();
  return {token.empty() ? std::string("the formula cannot be read here") : fmt::format("'{}' cannot follow here", token),
          at};
}

/// Appends the part that a node heads, in postfix order. @returns its number of values kept at once
std::size_t flatten(const TreeBuilder& b, int index, std::vector<Step>& steps) {
  const Node& node = b.nodes[static_cast<std::size_t>(index)];
  Step step = node.step;
  std::size_t deepest = 1, n = 0;
  std::size_t after_first = 0;
  for (const int argument : node.arguments) {
    if (argument < 0) break;
    deepest = std::max(deepest, n + flatten(b, argument, steps));
    const Step& last = steps.back();
    if (n == 0) step.begin = last.begin, after_first = last.end;
    step.end = last.end;
    ++n;
  }
  // The part reaches over brackets that are opened before it, and the sign is between the first two arguments.
  const std::string& text = b.text;
  step.sign = step.begin;
  if (n > 0) {
    const bool is_prefix = step.op >= Op::kMin;  // of a function, or a sign
    const auto back_over = [&](std::size_t at, const char* what) {
      while (at > 0 && std::strchr(what, text[at - 1])) --at;
      return at;
    };
    if (is_prefix && step.op == Op::kNegate) {
      step.begin = back_over(step.begin, " (");
      if (step.begin > 0) --step.begin;
      step.sign = step.begin;
    } else if (is_prefix) {
      step.begin = back_over(step.begin, " (+-");
      while (step.begin > 0 && is_of_name(text[step.begin - 1])) --step.begin;
      step.sign = step.begin;
    } else {
      step.sign = text.find_first_of("+-*/^<>", after_first);
    }
    // Close the brackets that were opened within the part.
    const auto open = [&] {
      std::ptrdiff_t depth = 0;
      for (std::size_t i = step.begin; i < step.end; ++i) depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
      return depth;
    };
    for (std::ptrdiff_t depth = open(); depth > 0 && step.end < text.size(); ++step.end)
      depth -= text[step.end] == ')' ? 1 : 0;
    for (std::ptrdiff_t depth = open(); depth < 0 && step.begin > 0;) depth += text[--step.begin] == '(' ? 1 : 0;
  }
  steps.push_back(step);
  return deepest;
}

double applied_to_finite(Op op, const double* a) {
  switch (op) {
    case Op::kAdd:
      return a[0] + a[1];
    case Op::kSubtract:
      return a[0] - a[1];
    case Op::kMultiply:
      return a[0] * a[1];
    case Op::kDivide:
      return a[0] / a[1];
    case Op::kPower:
      return std::pow(a[0], a[1]);
    case Op::kLess:
      return a[0] < a[1] ? 1.0 : 0.0;
    case Op::kGreater:
      return a[0] > a[1] ? 1.0 : 0.0;
    case Op::kMin:
      return std::min(a[0], a[1]);
    case Op::kMax:
      return std::max(a[0], a[1]);
    case Op::kNegate:
      return -a[0];
    case Op::kAbs:
      return std::abs(a[0]);
    case Op::kSqrt:
      return std::sqrt(a[0]);
    case Op::kExp:
      return std::exp(a[0]);
    case Op::kLn:
      return std::log(a[0]);
    case Op::kLog10:
      return std::log10(a[0]);
    case Op::kSin:
      return std::sin(a[0]);
    case Op::kCos:
      return std::cos(a[0]);
    case Op::kTan:
      return std::tan(a[0]);
    case Op::kTanh:
      return std::tanh(a[0]);
    case Op::kKelvin:
      return a[0];
    case Op::kCelsius:
      return a[0] - kZeroCelsius_K;
    case Op::kNumber:
    case Op::kName:
    case Op::kIf:
      break;
  }
  return 0.0;
}

/// NaN if an argument or the result is not finite, so that no later operation hides it: max(0, NaN), tanh(1/0) and NaN^0
/// would.
/// Only the part of an `if` that is not chosen may have no value.
double applied(Op op, const double* a) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (op == Op::kIf) return !std::isfinite(a[0]) ? kNone : a[0] != 0.0 ? a[1] : a[2];
  if (!std::all_of(a, a + n_arguments(op), [](double argument) { return std::isfinite(argument); })) return kNone;
  const double value = applied_to_finite(op, a);
  return std::isfinite(value) ? value : kNone;
}

/// Evaluates the steps. look(step, value, arguments, n) sees each value as it is made.
template <class Look>
double evaluated(std::span<const Step> steps, const double* values, Look look) {
  std::array<double, kRoom> stack;
  double* top = stack.data();  // one after the last value
  for (const Step& s : steps) {
    const int n = n_arguments(s.op);
    top -= n;
    const double value = s.op == Op::kNumber ? s.number : s.op == Op::kName ? values[s.name] : applied(s.op, top);
    look(s, value, top, n);
    *top++ = value;
  }
  return stack[0];
}

}  // namespace

int n_arguments(Op op) {
  return op <= Op::kName ? 0 : op <= Op::kMax ? 2 : op == Op::kIf ? 3 : 1;
}

Expression parse_expression(const std::string& text, const std::vector<std::string>& names) {
  require_known_characters(text);
  TreeBuilder builder{text, names};
  building = &builder;
  int root = -1;
  try {
    mu::Parser parser;
    define_all(parser);
    parser.SetExpr(text);
    root = static_cast<int>(parser.Eval());
    if (parser.GetNumResults() > 1)
      throw FormulaError("a formula has one value, not several with commas between", text.find(','));
  } catch (const mu::ParserError& e) {
    throw sentence(e, builder);
  }
  Expression read{.text = text, .steps = {}};
  if (flatten(builder, root, read.steps) > kDeepest)
    throw FormulaError(fmt::format("the formula is nested too deeply: more than {} parts wait for each other", kDeepest), 0);
  return read;
}

double value_of(std::span<const Step> steps, const double* values) {
  return evaluated(steps, values, [](const Step&, double, const double*, int) {});
}

std::vector<Step> with_constants_folded(const std::vector<Step>& steps) {
  std::vector<Step> folded;
  for (const Step& s : steps) {
    const auto n = static_cast<std::size_t>(n_arguments(s.op));
    const std::span<const Step> last(folded.end() - static_cast<std::ptrdiff_t>(n), n);
    const bool is_constant =
        n > 0 && std::all_of(last.begin(), last.end(), [](const Step& a) { return a.op == Op::kNumber; });
    std::array<double, 3> arguments = {};
    if (is_constant) std::transform(last.begin(), last.end(), arguments.begin(), [](const Step& a) { return a.number; });
    const double number = is_constant ? applied(s.op, arguments.data()) : 0.0;
    if (!is_constant || !std::isfinite(number)) {
      folded.push_back(s);
      continue;
    }
    folded.resize(folded.size() - n);
    folded.push_back({.op = Op::kNumber, .number = number, .begin = s.begin, .end = s.end, .sign = s.sign});
  }
  return folded;
}

const Step* failing_step(std::span<const Step> steps, const double* values) {
  std::array<const Step*, kRoom> stack;  // beside the values: the step that each owes it to if it is not finite
  const Step** top = stack.data();
  (void)evaluated(steps, values, [&](const Step& s, double value, const double* arguments, int n) {
    top -= n;
    const Step* const* of = std::find_if(top, top + n, [](const Step* a) { return a != nullptr; });
    if (s.op == Op::kIf && !*top) of = arguments[0] != 0.0 ? top + 1 : top + 2;
    *top = std::isfinite(value) ? nullptr : of < top + n ? *of : &s;
    ++top;
  });
  return stack[0];
}

}  // namespace driftwright::effects
