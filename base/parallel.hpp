#pragma once
// Independent pieces of work on all cores.

#include <atomic>
#include <cstddef>
#include <exception>
#include <optional>
#include <vector>

#include "base/listener.hpp"

namespace driftwright {

/// Calls work(i, space) for each i < n, on as many threads as OpenMP has; each thread makes itself a space and keeps it. What throws is carried out of
/// the threads: that of the smallest i, the same from run to run, once all others are done.
/// @param listener  told of the share that is done; once it wants an end, what has not begun is left out
template <class MakeSpace, class Work>
void for_each_index(std::size_t n, const MakeSpace& make_space, const Work& work, const Listener& listener = {}) {
  std::vector<std::exception_ptr> failures(n);
  std::atomic<std::size_t> n_done = 0;
#pragma omp parallel if (n > 1)  // a single piece has all cores for the loops inside it
  {
    std::optional<decltype(make_space())> space;
#pragma omp for schedule(dynamic)
    for (std::size_t i = 0; i < n; ++i) {
      if (listener.wants_end()) continue;
      try {
        if (!space) space.emplace(make_space());
        work(i, *space);
      } catch (...) {
        failures[i] = std::current_exception();
      }
      const double done = static_cast<double>(++n_done) / static_cast<double>(n);
      if (!listener.on_share) continue;
#pragma omp critical(told_of_work)
      listener.share(done);
    }
  }
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

/// The same for work(i), which needs no space of its own.
template <class Work>
void parallel_for(std::size_t n, const Work& work, const Listener& listener = {}) {
  struct NoSpace {};
  for_each_index(
      n, [] { return NoSpace{}; }, [&](std::size_t i, NoSpace&) { work(i); }, listener);
}

}  // namespace driftwright
