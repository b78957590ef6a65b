#pragma once
// Time of a piece of work, for the programs of this folder.

#include <algorithm>
#include <chrono>
#include <ctime>

namespace driftwright {

inline double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Processor time of this thread [s]: other programs beside it do not count.
inline double thread_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The least time of some repetitions [s], by one of these clocks.
template <class Work>
double least_s(int times, const Work& work, double (*clock_s)() = now_s) {
  double least = 1e9;
  for (int i = 0; i < times; ++i) {
    const double begin_s = clock_s();
    work();
    least = std::min(least, clock_s() - begin_s);
  }
  return least;
}

}  // namespace driftwright
