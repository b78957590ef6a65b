#include "app/library_settings.hpp"

#include <omp.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <string_view>

namespace driftwright::app {
namespace {

constexpr std::string_view kComputing[] = {"run",      "mesh",     "simulate",  "predict", "validate", "compensate",
                                           "schedule", "diagnose", "calibrate", "sweep",   "follow"};
constexpr const char* kSpins = "10000";  // turns, some microseconds

/// @return whether it was missing and is now set
bool set_missing(const char* name, const char* value) {
  const char* present = std::getenv(name);
  return !(present && *present) && setenv(name, value, 1) == 0;
}

}  // namespace

void restart_with_library_settings(char** argv) {
  const std::string_view verb = argv[0] && argv[1] ? argv[1] : "";
  if (std::find(std::begin(kComputing), std::end(kComputing), verb) == std::end(kComputing)) return;
  bool is_new = false;
  const char* policy = std::getenv("OMP_WAIT_POLICY");
  if (!(policy && *policy)) is_new = set_missing("GOMP_SPINCOUNT", kSpins);
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq"))
    is_new = set_missing("OPENBLAS_CORETYPE", "SKYLAKEX") || is_new;
#endif
  if (is_new) execv("/proc/self/exe", argv);  // returns only if it fails
}

void take_threads_that_fit() {
  constexpr rlim_t kOfAThread = rlim_t(256) << 20;  // a thread's stack, its memory arena, and some memory to compute with
  rlimit space = {};
  if (getrlimit(RLIMIT_AS, &space) != 0 || space.rlim_cur == RLIM_INFINITY) return;
  const auto n_fitting = std::max<rlim_t>(1, space.rlim_cur / kOfAThread);
  if (n_fitting < static_cast<rlim_t>(omp_get_max_threads())) omp_set_num_threads(static_cast<int>(n_fitting));
}

}  // namespace driftwright::app
