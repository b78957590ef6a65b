#pragma once
// The exceptions that a command may end with. Each type has its own exit code.

#include <stdexcept>
#include <string>

#include "driftwright/api.hpp"

namespace driftwright {

/// A position in an input file. line and column count from one; 0 = unknown.
struct Where {
  std::string file;
  int line = 0;
  int column = 0;
  std::string key;      ///< key path, such as "sensors[3].at"
  std::string excerpt;  ///< the source line, without its line break
};

/// The input is wrong and the user can correct it. Exit code 2.
/// what() reads "file:line:column: message [key]" followed by the source line with a caret.
class DRIFTWRIGHT_API InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
  /// @param message  what is wrong and what is allowed, one sentence each
  InputError(const Where& where, const std::string& message);
};

/// The numerics gave up. Exit code 3. The message names time, step, residual or flag, and what to try.
class DRIFTWRIGHT_API SolveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The user ended the work before it was complete (Ctrl-C); what was known by then has been written. Exit code 130.
class DRIFTWRIGHT_API EndedEarly : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An argument lies outside the range a formula is valid for; NaN counts as outside.
class DRIFTWRIGHT_API RangeError : public std::domain_error {
 public:
  using std::domain_error::domain_error;
};

}  // namespace driftwright
