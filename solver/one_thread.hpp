#pragma once
// Restricts CHOLMOD's numerical work to one thread.

#include <omp.h>

#include <mutex>

#include "solver/blas_work_space.hpp"

namespace driftwright::solver {

/// While it exists, OpenMP's parallel regions that this thread begins have one thread, and other threads that construct one
/// wait. There are two reasons. CHOLMOD's factorisations request four threads whatever OMP_NUM_THREADS says, and these wait
/// for each other at each of thousands of small supernodes. And Debian's serial OpenBLAS, which factorisations and solves
/// use, has no locks: two threads in it share work space and find matrices "not positive definite", or compute wrong
/// numbers. A thread must not construct two.
class OneThread {
 public:
  /// @throws std::bad_alloc  if there is no memory for OpenBLAS's work space
  OneThread() : alone_(one_at_a_time()), levels_(omp_get_max_active_levels()) {
    claim_blas_work_space();
    omp_set_max_active_levels(0);
  }
  ~OneThread() { omp_set_max_active_levels(levels_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  static std::mutex& one_at_a_time() {
    static std::mutex mutex;  // global because OpenBLAS's work space is global
    return mutex;
  }
  std::unique_lock<std::mutex> alone_;
  int levels_;
};

}  // namespace driftwright::solver
