#pragma once
// How exactly the steps of exponential integration end, in a run and in a kept one.

namespace driftwright::solver {

inline constexpr double kShareIterated = 1e-3;  ///< of a step's error: to which its end is iterated
inline constexpr int kMostStepIterations = 8;
inline constexpr double kSameStep = 1e-9;  ///< of a step: times that are one

}  // namespace driftwright::solver
