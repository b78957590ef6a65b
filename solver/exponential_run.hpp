#pragma once
// Runs of small machines whose laws look at temperatures, by exponentials of their tangent.
//
//     z' = F(t, z) = J z + N(t, z)
//     z(t + h) = e^{hJ} z + h (φ1 - φ2) N(t) + h φ2 N(t + h),   φ1 = ∫ e^{(1-s)hJ} ds,   φ2 = ∫ e^{(1-s)hJ} s ds,   s from 0 to 1
//
// exact where laws do not look at temperatures, and else for an N that is a line over the step; how far it is off that line in the middle says the
// step's error, and a step with too large a one is halved. N at the step's end is iterated, which takes two or three looks at the laws, where implicit
// stages take a dozen. Source: Hochbruck & Ostermann, Acta Numerica 19 (2010) 209-286.

#include <optional>

#include "solver/kept_steps.hpp"
#include "solver/transient.hpp"

namespace driftwright::solver {

inline constexpr int kMostOfExponentialRun = 40;  ///< unknowns: products of full matrices

/// States at times on a cyclogram, size x n_times; M is any.
/// @returns nothing for a system with more unknowns, one whose laws are not defined at a state that was tried, whose temperatures no machine has, or
///          whose thermostats switch without end: integrate() then says what is wrong, or goes on
/// @param steps  unless null, those that were gone
[[nodiscard]] std::optional<Eigen::MatrixXd> exponential_states(const ReducedSystem& system, const Cyclogram& cyclogram,
                                                                const TimeSeries& ambient,
                                                                const std::vector<double>& output_s,
                                                                const TransientOptions& options,
                                                                const Eigen::VectorXd& start, StepsOfRun* steps = nullptr);

/// The same of any reduced system by exponentials, where they serve, or by integrate(). @throws SolveError
[[nodiscard]] Eigen::MatrixXd states_of_run(const ReducedSystem& system, const Cyclogram& cyclogram,
                                            const TimeSeries& ambient, const std::vector<double>& output_s,
                                            const TransientOptions& options, const Eigen::VectorXd& start);

}  // namespace driftwright::solver
