#pragma once
// Runs any verb of the command line from another program.

#include <string>
#include <vector>

#include "driftwright/api.hpp"

namespace driftwright {

/// Does what `driftwright ARGUMENTS` does, with its words on standard output and standard error and its results in a folder.
/// @param arguments  as in a shell, without the program: {"diagnose", "machine.yaml", "--measured", "monday.csv", "-o",
///                   "out"}
/// @return the exit code: 0 done, 2 the input is wrong, 3 the numerics gave up, 130 ended by Ctrl-C, 1 a bug of this program
[[nodiscard]] DRIFTWRIGHT_API int command(const std::vector<std::string>& arguments);

/// Version of the library, such as "0.2.0".
[[nodiscard]] DRIFTWRIGHT_API const char* version();

}  // namespace driftwright
