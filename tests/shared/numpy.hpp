#pragma once
// Python with NumPy as an independent reader of the program's files, if it is installed.

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/shared/temporary_file.hpp"

namespace driftwright {

inline bool has_numpy() {
  return std::system("/usr/bin/python3 -c 'import numpy' > /dev/null 2>&1") == 0;
}

/// Runs Python text in the folder for temporary files, with numpy as np; returns its output and errors. Empty: no error.
inline std::string run_numpy(const std::string& text) {
  write_file("by_numpy.py", "import numpy as np\n" + text);
  FILE* pipe =
      popen(("cd " + temporary_folder().string() + " && /usr/bin/python3 by_numpy.py 2>&1 || echo failed").c_str(), "r");
  std::string output;
  char buffer[4096];
  while (std::fgets(buffer, sizeof buffer, pipe)) output += buffer;
  pclose(pipe);
  return output;
}

}  // namespace driftwright
