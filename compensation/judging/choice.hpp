#pragma once
// Chooses the strategy to deploy by its errors on parts of the training runs that it was not fitted to. It uses no row of
// the judged runs.

#include <span>
#include <string>

#include "compensation/predictors/deployed_predictor.hpp"

namespace driftwright::compensation {

/// Two strategies whose errors on left-out rows differ by less than this factor [-] count as equally good for new records.
inline constexpr double kAlike = 1.5;

/// Name of the strategy that averages the equally good ones.
inline constexpr const char* kBlend = "blend";

/// The error of a strategy on left-out rows (`fold_errors`) [um]: the root mean square over the folds of each kind, then the
/// geometric mean over the kinds, so that a factor counts the same in each kind. Infinite without folds.
[[nodiscard]] double left_out_um(const DeployedPredictor& strategy);

struct Choice {
  std::string name = {};  ///< "": nothing could be left out of the training runs, or nothing gains there
  std::string why = {};   ///< one sentence; empty: nothing could be left out
};

/// Chooses in this order:
/// - of the models of the machine that leave at most kAlike times the smallest error of all the one that leaves least on
///   left-out parts of the training runs with a failed sensor (`failed_um`), or the simplest: the laws of a model apply
///   beyond the training data, and alike models differ in the sensors that they depend on;
/// - else the blend, unless another strategy leaves less than 1 / kAlike of the blend's error and the difference is
///   significant: two standard errors of the mean square, fold by fold;
/// - else the simplest strategy whose mean square is within one standard error of the best one's.
/// What is to be chosen must leave less than no correction on left-out parts; else nothing is.
/// @param strategies  from the simplest to the most elaborate
/// Source: the rule of one standard error: Breiman et al., Classification and Regression Trees (1984), 3.4.3; the mean of
/// different predictions compared with the best of them: Stock & Watson, J. Forecasting 23 (2004) 405.
[[nodiscard]] Choice choose(std::span<const DeployedPredictor> strategies);

}  // namespace driftwright::compensation
