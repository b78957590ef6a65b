#pragma once
// Expressions of NC programs: LinuxCNC's [#1 + 2], Siemens' R1+2*SIN(30), Heidenhain's Q1 = Q2 * 2.

#include <functional>
#include <string>

#include "nc/units.hpp"

namespace driftwright {

/// A number of a program, and whether it is known before the program runs (not what a probe finds, or an offset of the machine).
struct NcValue {
  double value = 0.0;
  bool certain = true;
};

enum class NcSyntax {
  kLinuxCnc,  ///< upper case without blanks; [ ], #1, #<NAME>, ** MOD EQ NE GT GE LT LE AND OR XOR, SIN[ ] in degrees, ATAN[ ]/[ ]
  kSiemens,  ///< ( ), names and R1 as variables, DIV MOD == <> < > <= >= AND OR NOT, SIN( ) in degrees, ATAN2( , )
  kHeidenhain,  ///< ( ) optional behind functions, Q1 QL1 QR1, + - * / ^, SQ SQRT SIN COS TAN ASIN ACOS ATAN LN LOG EXP NEG INT ABS FRAC PI
};

/// What a variable holds: its name as "1" or "<NAME>" (LinuxCNC), "R1", "NAME" or "Q1". @throws RangeError  where nobody knows
using NcLookup = std::function<NcValue(const std::string& name)>;

/// The value of the expression that begins at text[at]; `at` then stands behind it. With `whole`, of the longest one; else (LinuxCNC) of one
/// number, parameter, function or bracket, as behind a word's letter.
/// @throws RangeError  with `at` at the place: for what is no expression, a division by zero, a function outside its range
/// Source: LinuxCNC documentation "G-code Overview" (Parameters, Expressions, Binary Operators, Functions; EQ and NE within 0.0001);
/// Siemens, SINUMERIK Programming Manual Job Planning, arithmetic functions and comparisons; Heidenhain, User's Manual, Q parameters, formulas.
[[nodiscard]] NcValue evaluate(const std::string& text, std::size_t& at, NcSyntax syntax, const NcLookup& lookup,
                               bool whole);

/// The parameter that text[at] names behind its '#' (LinuxCNC): "5420" or "<NAME>"; `at` then stands behind it.
[[nodiscard]] std::string parameter_name(const std::string& text, std::size_t& at, const NcLookup& lookup);

}  // namespace driftwright
