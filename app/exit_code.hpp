#pragma once
// How a command ended, as the number that the shell sees.

#include <exception>

namespace driftwright::app {

enum ExitCode { kDone = 0, kOurBug = 1, kWrongInput = 2, kNumericsGaveUp = 3, kEndedEarly = 130 };

/// Says on standard error what happened. What the machine lacks that the program runs on (memory, disk, a folder, threads) is no bug of ours: 2, with words.
[[nodiscard]] ExitCode exit_code_of(const std::exception_ptr& failure);

/// The same for what is thrown where no handler is, as in a loop on all cores: the program ends with that number and words.
void end_with_words();

}  // namespace driftwright::app
