#pragma once
// Runs small machines whose laws depend on temperatures, by exponentials of their tangent.
//
//     z' = F(t, z) = J z + N(t, z)
//     z(t + h) = e^{hJ} z + h (φ1 - φ2) N(t) + h φ2 N(t + h), φ1 = ∫ e^{(1-s)hJ} ds, φ2 = ∫ e^{(1-s)hJ} s ds, s from 0 to 1
//
// This is exact if laws do not depend on temperatures, and else if N is linear in time over the step. The deviation from a
// line in the middle of the step estimates the error; a step with too large an error is halved. N at the step's end is
// iterated, which takes two or three evaluations of the laws; implicit stages take a dozen. Source: Hochbruck & Ostermann,
// Acta Numerica 19 (2010) 209-286.

#include <optional>

#include "solver/kept_steps.hpp"
#include "solver/transient.hpp"

namespace driftwright::solver {

/// Largest number of unknowns for this method, because it multiplies full matrices.
inline constexpr int kMostOfExponentialRun = 40;

/// States at times of a cyclogram, size x n_times; M may be any mass matrix.
/// @returns none for a system with more unknowns, with laws that are undefined at a tried state, with temperatures that no
///          machine has, or with thermostats that switch endlessly; integrate() then reports the problem or continues
/// @param steps  unless null, receives the steps taken
[[nodiscard]] std::optional<Eigen::MatrixXd> exponential_states(const ReducedSystem& system, const Cyclogram& cyclogram,
                                                                const TimeSeries& ambient,
                                                                const std::vector<double>& output_s,
                                                                const TransientOptions& options,
                                                                const Eigen::VectorXd& start, StepsTaken* steps = nullptr);

/// The same for any reduced system: by exponentials where possible, else by integrate(). @throws SolveError
[[nodiscard]] Eigen::MatrixXd states_of_run(const ReducedSystem& system, const Cyclogram& cyclogram,
                                            const TimeSeries& ambient, const std::vector<double>& output_s,
                                            const TransientOptions& options, const Eigen::VectorXd& start);

}  // namespace driftwright::solver
