#pragma once
// Limits of the middle 95 % of functions of independent normal numbers, from few draws.

#include <Eigen/Core>

namespace driftwright::studies {

struct BandLimits {
  Eigen::VectorXd low, high;  ///< per function
};

/// Fewest draws for functions of so many numbers: twice as many as a bent function has coefficients, below.
[[nodiscard]] Eigen::Index fewest_draws(Eigen::Index n_numbers);

/// Limits of each function from draws. The 2.5 % quantile of 80 draws is the second of them, which errs by 20 % of the
/// band half width. So a bent function of one direction b, |b| = 1, is fitted to all draws, whose limits are known,
///
///     y = g(b'x) + r,   g: a polynomial of degree 5,   b'x: a standard normal number,
///
/// and the residuals r, scaled by their degrees of freedom, are added as independent of it: the limits solve
/// mean over the draws of P(g(u) <= y - r) = 2.5 % and 97.5 %. b is that of the linear fit, improved together with
/// g by at most three Gauss-Newton steps. The limits of a linear function are exact.
/// Source: the form is projection pursuit with one term, Friedman & Stuetzle, J. Am. Stat. Assoc. 76 (1981) 817-823.
///
/// Error of a limit, in half widths, against Monte Carlo machines of two bodies with 7 or 20 numbers, whose friction or film
/// depends on temperature: root mean square 2 to 4 % with 84 draws (15 % at most), 2 to 3 % with 200 (7 % at most).
///
/// @param scores  standard normal, n_draws x n_numbers
/// @param values  n_draws x n_functions
/// @throws std::logic_error  for other shapes, and fewer than fewest_draws()
[[nodiscard]] BandLimits band_limits(const Eigen::MatrixXd& scores, const Eigen::MatrixXd& values);

/// The same of one function at successive times: middle and slope are those of each time. How far the limits are away from
/// the middle, in slopes, changes slowly, so it is computed at few times and is linear between two, as far as the time in
/// the middle of two confirms this to 1 % of the half width.
/// @param values  n_draws x n_times
[[nodiscard]] BandLimits band_limits_over_time(const Eigen::MatrixXd& scores, const Eigen::MatrixXd& values);

}  // namespace driftwright::studies
