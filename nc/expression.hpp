#pragma once
// Expressions of NC programs, such as [#1 + 2], R1+2*SIN(30), Q2 * 2.

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "nc/units.hpp"

namespace driftwright {

/// A number of a program. `certain` is false if it is known only while the program runs (a probed position, an offset of the
/// machine).
struct NcValue {
  double value = 0.0;
  bool certain = true;
};

/// How a language writes expressions. All have signs, brackets, SIN COS TAN ASIN ACOS in degrees, ABS EXP SQRT LN LOG ROUND.
struct NcSyntax {
  struct Operator {
    const char* text;
    int level;  ///< higher binds more closely
    double (*apply)(double a, double b);
  };
  std::vector<Operator> operators;  ///< longer ones first, if one begins with another
  std::map<std::string, double (*)(double x)> functions = {};
  std::map<std::string, double> constants = {};
  std::string negation = {};        ///< such as "NOT"
  std::string angle_of_ratio = {};  ///< the function of [y]/[x] in degrees, such as "ATAN"
  std::string angle_of_two = {};    ///< the function of (y, x) in degrees, such as "ATAN2"
  char open = '(', close = ')';
  bool (*is_variable)(const std::string& name) = nullptr;
  bool has_named_variables = false;  ///< a name is a variable if no bracket follows
  bool has_numbered = false;         ///< #1, #<NAME>, EXISTS[#<NAME>]
  bool has_decimal_comma = false;
  bool has_bare_arguments = false;  ///< a function's argument needs no brackets
  bool is_joined = false;           ///< without blanks: a name has no digits, and a letter may follow an operator
};

/// The value of a variable, named as it is written, without '#': "1", "<NAME>", "R1", "Q1". @throws RangeError  if it is
/// unknown
using NcLookup = std::function<NcValue(const std::string& name)>;

/// The value of the expression that begins at text[at]; `at` is then the index after it. With `whole`, the longest
/// expression; else one number, parameter, function or bracket, as after a word's letter.
/// @throws RangeError  with `at` at the error: for text that is not an expression, a division by zero, a function outside
///                     its range
[[nodiscard]] NcValue evaluate(const std::string& text, std::size_t& at, const NcSyntax& syntax, const NcLookup& lookup,
                               bool whole);

/// The name of the parameter after the '#' at text[at]: "5420" or "<NAME>"; `at` is then the index after it.
[[nodiscard]] std::string parameter_name(const std::string& text, std::size_t& at, const NcSyntax& syntax,
                                         const NcLookup& lookup);

}  // namespace driftwright
