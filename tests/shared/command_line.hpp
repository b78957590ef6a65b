#pragma once
// Runs the built program as a user would, for the tests of the command line and of the shipped scenarios.

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/shared/temporary_file.hpp"

namespace driftwright {

/// Programs started by tests keep reduced models in the test's own folder: an older model cannot help a test to pass, and
/// the user's cache is not touched.
inline const bool kHasOwnCache = setenv("XDG_CACHE_HOME", (temporary_folder() / "cache").c_str(), 1) == 0;

struct CommandOutcome {
  int exit_code = -1;
  std::string output;  ///< standard output and standard error
};

/// DRIFTWRIGHT_PROGRAM is the path of the built program, set by CMake.
inline CommandOutcome run_program(const std::string& arguments) {
  CommandOutcome outcome;
  FILE* pipe = popen((std::string(DRIFTWRIGHT_PROGRAM) + " " + arguments + " 2>&1").c_str(), "r");
  char buffer[4096];
  while (std::fgets(buffer, sizeof buffer, pipe)) outcome.output += buffer;
  const int status = pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

}  // namespace driftwright
