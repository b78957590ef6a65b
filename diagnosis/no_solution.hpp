#pragma once
// A search continues if the machine has no solution; any other failure is a bug of ours and is not caught.

#include "base/errors.hpp"

namespace driftwright::diagnosis {

/// Whether the work finished: false if the machine has no solution, or if a law is evaluated outside its range.
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
