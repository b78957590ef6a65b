#pragma once
// Limits of the middle 95 % of functions of independent normal numbers, from few draws.

#include <Eigen/Core>

namespace driftwright::studies {

struct BandLimits {
  Eigen::VectorXd low, high;  ///< per function
};

/// Limits of each function from draws. A quantile of 200 draws alone errs by 10 % of the band's half width, because the
/// draws reach into the tail by chance. The linear part of the function says how far they do: its limits are known exactly,
///
///     y ≈ a + b'x (least squares over the draws),   limits of the linear part  a ∓ 1.96 |b|,
///
/// so the function is read at the rank that these limits have among the linear parts of the draws. The limits of a linear
/// function are exact, and so are, up to interpolation between draws, those of a monotone function of one.
/// Source: control variates for quantiles, Hsu & Nelson, Management Science 36 (1990) 835-851.
///
/// @param scores  standard normal, n_draws x n_numbers; n_draws > n_numbers + 1
/// @param values  n_draws x n_functions
/// @throws std::logic_error  for other shapes
[[nodiscard]] BandLimits band_limits(const Eigen::MatrixXd& scores, const Eigen::MatrixXd& values);

}  // namespace driftwright::studies
