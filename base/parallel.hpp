#pragma once
// Independent pieces of work on all cores.

#include <cstddef>
#include <exception>
#include <optional>
#include <vector>

namespace driftwright {

/// Calls work(i, space) for each i < n, on as many threads as OpenMP has; each thread makes itself a space and keeps it. What throws is carried out of
/// the threads: that of the smallest i, the same from run to run, once all others are done.
template <class MakeSpace, class Work>
void for_each_index(std::size_t n, const MakeSpace& make_space, const Work& work) {
  std::vector<std::exception_ptr> failures(n);
#pragma omp parallel
  {
    std::optional<decltype(make_space())> space;
#pragma omp for schedule(dynamic)
    for (std::size_t i = 0; i < n; ++i) {
      try {
        if (!space) space.emplace(make_space());
        work(i, *space);
      } catch (...) {
        failures[i] = std::current_exception();
      }
    }
  }
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace driftwright
