#pragma once
// A formula of a scenario as a tree: read by muParser, checked and evaluated here. The tree is data: it is evaluated in any
// thread, looked through for units, and knows where in the text each part is.

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace driftwright::effects {

/// A formula that cannot be read or whose units do not fit. `at` is the index of the character in the text.
class FormulaError : public std::runtime_error {
 public:
  FormulaError(const std::string& message, std::size_t where) : std::runtime_error(message), at(where) {}
  std::size_t at;
};

/// Functions of one argument, in the order of kFunctions1; kelvin() and celsius() take an absolute temperature [K].
enum class Op {
  kNumber,
  kName,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kPower,
  kLess,
  kGreater,
  kMin,
  kMax,
  kIf,
  kNegate,
  kAbs,
  kSqrt,
  kExp,
  kLn,
  kLog10,
  kSin,
  kCos,
  kTan,
  kTanh,
  kKelvin,
  kCelsius
};

struct Expression {
  /// One number, name, operation or function; its arguments come directly before it, each after its own (postfix order).
  struct Step {
    Op op = Op::kNumber;
    double number = 0.0;             ///< of kNumber
    std::size_t name = 0;            ///< of kName: index in the list of names
    std::size_t begin = 0, end = 0;  ///< of the whole part in the text
    std::size_t sign = 0;            ///< of the operator, or `begin`
  };
  std::string text;
  std::vector<Step> steps;

  /// The text of a step's part, with what it is applied to.
  [[nodiscard]] std::string part(const Step& step) const { return text.substr(step.begin, step.end - step.begin); }
};

/// The number of arguments of an operation: 0 to 3.
[[nodiscard]] int n_arguments(Op op);

/// Reads a formula: + - * / ^ < >, brackets, numbers, names and functions; ^ binds more closely than a sign.
/// @param names  that may occur in it
/// @throws FormulaError  for anything else, an unknown name (the message lists the known ones), a formula that is nested too
/// deeply
[[nodiscard]] Expression parse_expression(const std::string& text, const std::vector<std::string>& names);

/// The value of an expression. @param values  by name, in the order of the list of names; not finite where the formula
/// divides by zero or leaves the range of a function. Thread-safe.
[[nodiscard]] double value_of(std::span<const Expression::Step> steps, const double* values);

/// The same steps with each part that has no name as its number, unless that is not finite.
[[nodiscard]] std::vector<Expression::Step> with_constants_folded(const std::vector<Expression::Step>& steps);

/// The first step whose value is not finite although those of its arguments are; nullptr if all are finite.
[[nodiscard]] const Expression::Step* failing_step(std::span<const Expression::Step> steps, const double* values);

}  // namespace driftwright::effects
