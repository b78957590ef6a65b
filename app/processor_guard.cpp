// Ends the program with a message on a processor older than the one it was built for (cmake/processor.cmake), before
// anything else runs: constructors of other files already use its vectors. This file itself is built for every x86-64.

#include <unistd.h>

namespace {

__attribute__((constructor(101))) void refuse_older_processors() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2")) return;
  constexpr char kWords[] =
      "error: this program was built on a processor with AVX2, and this one has none; build it here, in a folder of its "
      "own, or with "
      "-DDRIFTWRIGHT_PROCESSOR=baseline\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kWords, sizeof kWords - 1);
  _exit(2);
}

}  // namespace
