#pragma once
// Keeps a library to one thread.

#include <omp.h>

namespace driftwright::solver {

/// While it lives, OpenMP's parallel regions begun from here have one thread. For CHOLMOD's factorisations, which ask for four
/// whatever OMP_NUM_THREADS says and let them wait for each other at each of thousands of small supernodes.
class OneThread {
 public:
  OneThread() : levels_(omp_get_max_active_levels()) { omp_set_max_active_levels(0); }
  ~OneThread() { omp_set_max_active_levels(levels_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int levels_;
};

}  // namespace driftwright::solver
