#pragma once
// Tolerances for the ends of steps in exponential integration, for runs and stored runs.

namespace driftwright::solver {

inline constexpr double kShareIterated = 1e-3;  ///< the end of a step is iterated to this share of the step's error
inline constexpr int kMostStepIterations = 8;
inline constexpr double kSameStep = 1e-9;  ///< times that differ by less than this share of a step are equal

}  // namespace driftwright::solver
