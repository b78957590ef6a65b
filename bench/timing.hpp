#pragma once
// Time of a piece of work, for the programs of this folder.

#include <algorithm>
#include <chrono>

namespace driftwright {

inline double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The least time of some repetitions [s].
template <class Work>
double least_s(int times, const Work& work) {
  double least = 1e9;
  for (int i = 0; i < times; ++i) {
    const double begin_s = now_s();
    work();
    least = std::min(least, now_s() - begin_s);
  }
  return least;
}

}  // namespace driftwright
