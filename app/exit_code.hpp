#pragma once
// Exit codes of the program, and the exceptions that lead to them.

#include <exception>

namespace driftwright::app {

enum ExitCode { kDone = 0, kOurBug = 1, kWrongInput = 2, kNumericsGaveUp = 3, kEndedEarly = 130 };

/// Prints the failure on standard error. A lack of resources (memory, disk, a folder, threads) is no bug of ours: its
/// code is kWrongInput.
[[nodiscard]] ExitCode exit_code_of(const std::exception_ptr& failure);

/// Installs the same for exceptions that no handler catches, as in a parallel loop: the program prints the failure and
/// ends with its exit code, or aborts after a bug of ours.
void end_with_words();

}  // namespace driftwright::app
