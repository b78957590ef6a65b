#pragma once
// Which strategy to deploy, by what each leaves on parts of the training runs that it was not fitted to. Nothing here has seen a judged row.

#include <span>
#include <string>

#include "compensation/predictors/deployed_predictor.hpp"

namespace driftwright::compensation {

/// Errors on what was left out that differ by less than this factor do not tell which strategy is better on what comes.
inline constexpr double kAlike = 1.5;

/// Name of the mean of those that are alike.
inline constexpr const char* kBlend = "blend";

/// The error of a strategy on what was left out (`fold_errors`): of the folds of each kind the root mean square, and the geometric mean of the kinds,
/// which weighs a factor on each of them alike [um]. Infinite without folds.
[[nodiscard]] double left_out_um(const DeployedPredictor& strategy);

struct Choice {
  std::string name = {};  ///< "": nothing could be left out of the training runs
  std::string why = {};   ///< one sentence
};

/// The strategy to deploy:
/// - a model of the machine, where the best of these leaves no more than kAlike times the least of all: its laws hold beyond what was trained on;
/// - else the blend, unless another leaves less than 1 / kAlike of what it leaves, and that beyond chance: by two standard errors of the mean square, fold by fold;
/// - else the simplest whose mean square is within one standard error of the best one's. Among models, too, it is the simplest of these.
/// @param strategies  from the simplest to the most elaborate
/// Source: the rule of one standard error: Breiman et al., Classification and Regression Trees (1984), 3.4.3; the mean of unlike predictions against the best
/// of them: Stock & Watson, J. Forecasting 23 (2004) 405.
[[nodiscard]] Choice choose(std::span<const DeployedPredictor> strategies);

}  // namespace driftwright::compensation
