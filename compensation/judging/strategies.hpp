#pragma once
// The strategies that are judged side by side: what each is fitted on, what it predicts from, and what keeps it safe.

#include <optional>
#include <span>

#include "compensation/predictors/deployed_predictor.hpp"
#include "compensation/predictors/observer.hpp"
#include "compensation/sensors/grey_relational.hpp"

namespace driftwright::compensation {

/// A linear model of the machine that strategies may use. It need not be right.
struct Physics {
  solver::ReducedSystem system;
  Eigen::VectorXd start;         ///< state at the start of runs in an ambient at `start_ambient_K`
  double start_ambient_K = 0.0;  ///< minus the reference temperature
};

struct StrategySettings {
  std::string target;                   ///< channel in um
  std::vector<std::string> candidates;  ///< thermometers to choose from
  int n_sensors = 4;
  bool count_from_start = false;
  Image image = Image::kAutomatic;  ///< of grey grades
  std::string speed, ambient;       ///< channels; empty: there is none
  double reading_K = 0.1;           ///< 1 sigma of a thermometer, for the observer
  double drift_um = 1.0;            ///< 1 sigma of the indicator in the training runs
  std::optional<Physics> physics;
  std::string without_physics = {};  ///< why there is none; empty: nobody asked for it
};

/// One that could not be fitted, and why.
struct LeftOut {
  std::string name, why;
};

struct FittedStrategies {
  std::vector<DeployedPredictor> strategies;  ///< from the simplest to the most elaborate; baselines first, the blend last
  std::vector<LeftOut> left_out;
  std::string chosen;      ///< the one to deploy, by choose(); "": nothing could be left out of the training runs
  std::string why_chosen;  ///< one sentence
};

/// The error of a strategy on what was left out: of the folds of each kind the root mean square, and the geometric mean of the kinds, which weighs a factor on
/// each of them alike. Infinite without folds.
[[nodiscard]] double left_out_um(const DeployedPredictor& strategy);

/// The strategy to deploy, by what was left out of the training runs alone:
/// - a model of the machine, where the best of these leaves no more than kAlike times the least of all: its laws hold beyond what was trained on;
/// - else the blend, unless another leaves less than 1 / kAlike of what it leaves, and that beyond chance (two standard errors of the mean square, fold by fold);
/// - else the simplest whose mean square is within one standard error of the best one's. So it is among models.
/// Source: the rule of one standard error: Breiman et al., Classification and Regression Trees (1984), 3.4.3; the mean of unlike predictions against the best of them:
/// Stock & Watson, J. Forecasting 23 (2004) 405.
void choose(FittedStrategies& fitted);

/// Errors on what was left out that differ by less than this factor do not tell which strategy is better on what comes.
inline constexpr double kAlike = 1.5;

/// Name of the mean of those that are alike.
inline constexpr const char* kBlend = "blend";

/// Fits all of them. @param training  with the target among the readings
[[nodiscard]] FittedStrategies fit_strategies(const StrategySettings& settings, std::span<const ObservedRun> training);

/// Name of the strategy that does nothing.
inline constexpr const char* kNoCorrection = "no correction";

}  // namespace driftwright::compensation
