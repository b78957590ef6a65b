#pragma once
// Runs independent pieces of work on all cores.

#include <atomic>
#include <cstddef>
#include <exception>
#include <optional>
#include <vector>

#include "base/listener.hpp"

namespace driftwright {

/// Calls work(i, space) for each i < n, on as many threads as OpenMP has. Each thread creates its own space and reuses it.
/// An exception of the work or the listener is rethrown after all others are done: the one of the smallest i, so it is the
/// same from run to run.
/// @param listener  receives the share that is done; once it requests an end, work that has not begun is skipped
template <class MakeSpace, class Work>
void for_each_index(std::size_t n, const MakeSpace& make_space, const Work& work, const Listener& listener = {}) {
  std::vector<std::exception_ptr> failures(n);
  std::atomic<std::size_t> n_done = 0;
#pragma omp parallel if (n > 1)  // a single piece leaves all cores to the loops inside it
  {
    std::optional<decltype(make_space())> space;
#pragma omp for schedule(dynamic)
    for (std::size_t i = 0; i < n; ++i) {
      try {
        if (listener.wants_end()) continue;
        if (!space) space.emplace(make_space());
        work(i, *space);
      } catch (...) {
        failures[i] = std::current_exception();
      }
      const double done = static_cast<double>(++n_done) / static_cast<double>(n);
      if (!listener.on_share) continue;
#pragma omp critical(told_of_work)
      try {
        listener.share(done);
      } catch (...) {
        if (!failures[i]) failures[i] = std::current_exception();
      }
    }
  }
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

/// The same for work(i), which needs no space.
template <class Work>
void parallel_for(std::size_t n, const Work& work, const Listener& listener = {}) {
  struct NoSpace {};
  for_each_index(
      n, [] { return NoSpace{}; }, [&](std::size_t i, NoSpace&) { work(i); }, listener);
}

}  // namespace driftwright
