#pragma once
// Where the machine has no solution a search goes on; any other failure is one of ours and is not caught.

#include "base/errors.hpp"

namespace driftwright::diagnosis {

/// Whether the work came to an end: false where the machine has no solution, or one of its laws is asked beyond its range.
template <class Work>
[[nodiscard]] bool has_solution(const Work& work) {
  try {
    work();
    return true;
  } catch (const SolveError&) {
  } catch (const RangeError&) {
  }
  return false;
}

}  // namespace driftwright::diagnosis
