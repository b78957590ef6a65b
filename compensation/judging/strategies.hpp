#pragma once
// The strategies that are judged side by side: the data of their fit, their inputs, and their fail-safe.

#include <optional>
#include <span>

#include "compensation/judging/left_out.hpp"
#include "compensation/predictors/deployed_predictor.hpp"
#include "compensation/predictors/observer.hpp"
#include "compensation/sensors/grey_relational.hpp"
#include "compensation/sensors/redundancy.hpp"
#include "solver/linearise.hpp"

namespace driftwright::compensation {

/// What a model with laws of temperature lost when it was made linear about the training runs.
struct LinearisedModel {
  std::vector<solver::LinearisedLaw> laws;  ///< at least one
  double error_um = 0.0;                    ///< largest difference between the drift of both models over the training runs
  double drift_um = 0.0;                    ///< largest drift of the nonlinear model in them
};
/// "linearised at 24 to 38 °C".
[[nodiscard]] std::string words_of(const LinearisedModel& model);

/// A linear model of the machine that strategies may use. It need not be exact.
struct Physics {
  solver::ReducedSystem system;
  Eigen::VectorXd start;                           ///< state at the start of runs with the ambient at `start_ambient_K`
  double start_ambient_K = 0.0;                    ///< minus the reference temperature
  std::optional<LinearisedModel> linearised = {};  ///< none: the machine's own laws are linear
  std::vector<effects::Effect> laws = {};          ///< effects of the machine that the system was made of
};

/// The corrected axis is probed again and again, and the correction takes up what is found (residual_process.hpp).
struct Probing {
  std::vector<double> every_s = {3600.0};  ///< intervals to judge, each > 0, at least one
  double noise_um = 1.0;                   ///< of a probing, 1 sigma
  double takes_s = 120.0;                  ///< time that a probing takes
};

/// The place of a feed axis whose error is corrected.
struct ScrewPlace {
  std::string screw;
  double at_m = 0.0;  ///< position of the axis
};

/// Settings of all strategies.
struct StrategySettings {
  std::string target;                    ///< channel in um
  std::optional<ScrewPlace> place = {};  ///< of the target, if it is one of several places that are judged
  std::vector<std::string> candidates;   ///< thermometers to choose from
  int n_sensors = 4;
  bool count_from_start = false;
  Image image = Image::kAutomatic;  ///< of grey grades
  std::string speed, ambient;       ///< channels; empty: none
  double reading_K = 0.1;           ///< 1 sigma of a thermometer, for the observer
  double drift_um = 1.0;            ///< 1 sigma of the indicator that measured the drift in the training runs
  CorrectionLimits limits = {};     ///< of the machine; they narrow each fail-safe
  std::optional<Probing> probing = {};
  std::optional<Physics> physics;
  std::string without_physics = {};  ///< why there is none; empty: it was not requested
};

/// A strategy that could not be fitted, and why.
struct LeftOut {
  std::string name, why;
};

/// A strategy as fitted to what a fold leaves, with a fail-safe learned from the same rows.
struct FittedInFold {
  std::size_t fold = 0;
  DeployedPredictor fitted;
};

struct FittedStrategies {
  std::vector<DeployedPredictor> strategies;  ///< from the simplest to the most elaborate; baselines first, the blend last
  std::vector<LeftOut> left_out;
  std::vector<DoubtedThermometer> doubted;  ///< in the training runs; no strategy reads those that are alone
  FoldedRuns folds = {};                    ///< what was left out of the training runs in turn
  /// Of each strategy that is a model of the machine, in the order of `strategies`: in each of folds_for_failures(). Empty
  /// for other strategies, and if a fold leaves too little for a fit.
  std::vector<std::vector<FittedInFold>> in_folds = {};
};

/// Fits all of them. @param training  with the target among the readings
[[nodiscard]] FittedStrategies fit_strategies(const StrategySettings& settings, std::span<const MachineRun> training);

/// Name of the strategy without any correction.
inline constexpr const char* kNoCorrection = "no correction";

}  // namespace driftwright::compensation
