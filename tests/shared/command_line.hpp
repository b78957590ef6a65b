#pragma once
// Runs the built program as a user would, for the tests of the command line and of the shipped scenarios.

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/shared/temporary_file.hpp"

namespace driftwright {

/// Where programs started by tests keep reduced machines: in a store that all tests of a run share (`./test` begins with an
/// empty one), else in the test's own folder. The user's cache is not touched.
inline std::string test_store() {
  const std::string own = (temporary_folder() / "cache").string();  // the folder is made here, before a test changes TMPDIR
  const char* shared = std::getenv("DRIFTWRIGHT_TEST_STORE");
  return shared ? shared : own;
}
inline const bool kHasOwnCache = setenv("XDG_CACHE_HOME", test_store().c_str(), 1) == 0;

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
