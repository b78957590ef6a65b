#pragma once
// Expressions of NC programs: LinuxCNC's [#1 + 2], Siemens' R1+2*SIN(30), Heidenhain's Q1 = Q2 * 2.

#include <functional>
#include <string>

#include "nc/units.hpp"

namespace driftwright {

/// A number of a program. `certain` is false if it is known only while the program runs (a probed position, an offset of the
/// machine).
struct NcValue {
  double value = 0.0;
  bool certain = true;
};

enum class NcSyntax {
  /// Upper case without blanks; [ ], #1, #<NAME>, ** MOD EQ NE GT GE LT LE AND OR XOR, SIN[ ] in degrees, ATAN[ ]/[ ].
  kLinuxCnc,
  /// ( ), names and R1 as variables, DIV MOD == <> < > <= >= AND OR NOT, SIN( ) in degrees, ATAN2( , ).
  kSiemens,
  /// ( ) optional after functions, Q1 QL1 QR1, + - * / ^, SQ SQRT SIN COS TAN ASIN ACOS ATAN LN LOG EXP NEG INT ABS FRAC PI.
  kHeidenhain,
};

/// The value of a variable, named "1" or "<NAME>" (LinuxCNC), "R1", "NAME" or "Q1". @throws RangeError  if it is unknown
using NcLookup = std::function<NcValue(const std::string& name)>;

/// The value of the expression that begins at text[at]; `at` is then the index after it. With `whole`, the longest
/// expression; else (LinuxCNC) one number, parameter, function or bracket, as after a word's letter.
/// @throws RangeError  with `at` at the error: for text that is not an expression, a division by zero, a function outside
///                     its range
/// Source: LinuxCNC documentation "G-code Overview" (Parameters, Expressions, Binary Operators, Functions; EQ and NE within
/// 0.0001); Siemens, SINUMERIK Programming Manual Job Planning, arithmetic functions and comparisons; Heidenhain, User's
/// Manual, Q parameters, formulas.
[[nodiscard]] NcValue evaluate(const std::string& text, std::size_t& at, NcSyntax syntax, const NcLookup& lookup,
                               bool whole);

/// The name of the parameter after the '#' at text[at] (LinuxCNC): "5420" or "<NAME>"; `at` is then the index after it.
[[nodiscard]] std::string parameter_name(const std::string& text, std::size_t& at, const NcLookup& lookup);

}  // namespace driftwright
