#pragma once
// The command line: parse, call the verb, turn exceptions into exit codes.

namespace driftwright::app {

/// @param argv  as in main(); argv[0] is the program
/// @return the exit code
[[nodiscard]] int command_line(int argc, const char* const* argv);

}  // namespace driftwright::app
