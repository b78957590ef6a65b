#pragma once
// Keeps what CHOLMOD does with numbers to one thread.

#include <omp.h>

#include <mutex>

#include "solver/blas_work_space.hpp"

namespace driftwright::solver {

/// While it lives, OpenMP's parallel regions begun from here have one thread, and other threads that want one wait. For CHOLMOD's
/// factorisations, which ask for four threads whatever OMP_NUM_THREADS says and let them wait for each other at each of thousands of
/// small supernodes; and for these and its solves because Debian's serial OpenBLAS has no locks: two threads in it share work space
/// and find matrices "not positive definite", or wrong numbers. Never two in one thread.
class OneThread {
 public:
  /// @throws std::bad_alloc  where there is no memory for OpenBLAS's work space
  OneThread() : alone_(one_at_a_time()), levels_(omp_get_max_active_levels()) {
    claim_blas_work_space();
    omp_set_max_active_levels(0);
  }
  ~OneThread() { omp_set_max_active_levels(levels_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  static std::mutex& one_at_a_time() {
    static std::mutex mutex;  // global as OpenBLAS's work space is
    return mutex;
  }
  std::unique_lock<std::mutex> alone_;
  int levels_;
};

}  // namespace driftwright::solver
