#pragma once
// The strategies that are judged side by side: what each is fitted on, what it predicts from, and what keeps it safe.

#include <functional>
#include <optional>
#include <span>

#include "compensation/drift_model.hpp"
#include "compensation/fail_safe.hpp"
#include "compensation/grey_relational.hpp"
#include "compensation/observer.hpp"

namespace driftwright::app {

using compensation::ObservedRun;

/// A linear model of the machine that strategies may use. It need not be right.
struct Physics {
  solver::ReducedSystem system;
  Eigen::VectorXd start;      ///< state at the start of runs in a hall at `start_hall_K`
  double start_hall_K = 0.0;  ///< minus the reference temperature
};

struct StrategySettings {
  std::string target;                   ///< channel in um
  std::vector<std::string> candidates;  ///< thermometers to choose from
  int n_sensors = 4;
  bool count_from_start = false;
  compensation::Image image = compensation::Image::kAutomatic;  ///< of grey grades
  std::string speed, hall;                                      ///< channels; empty: there is none
  double reading_K = 0.1;                                       ///< 1 sigma of a thermometer, for the observer
  double drift_um = 1.0;                                        ///< 1 sigma of the indicator in the training runs
  std::optional<Physics> physics;
  std::string without_physics = {};  ///< why there is none; empty: nobody asked for it
};

/// A strategy fitted on training runs.
struct FittedStrategy {
  std::string name;
  bool is_baseline = false;          ///< what a strategy has to beat; it has no fail-safe
  std::vector<std::string> sensors;  ///< thermometers it reads
  std::string reason;                ///< what the fit decided, one sentence; may be empty
  /// Drift [um] per row of the run's readings; NaN where it cannot say.
  std::function<std::vector<double>(const ObservedRun&)> predict;
  std::optional<compensation::DriftModel> model;  ///< where it is a formula
  std::optional<compensation::FailSafe> fail_safe;
  /// Half width of the 95 % prediction interval [um]: of each training run left out in turn the error that 95 % of its rows keep, the
  /// largest of those. None where only one run was given.
  std::optional<double> interval_um;

  /// The correction as it goes to an axis: of repaired readings, guarded. Without a fail-safe the prediction, 0 where it says nothing.
  [[nodiscard]] compensation::GuardedCorrection correct(const ObservedRun& run) const;
};

/// One that could not be fitted, and why.
struct LeftOut {
  std::string name, why;
};

struct FittedStrategies {
  std::vector<FittedStrategy> strategies;  ///< from the simplest to the most elaborate; baselines first
  std::vector<LeftOut> left_out;
};

/// Fits all of them. @param training  with the target among the readings
[[nodiscard]] FittedStrategies fit_strategies(const StrategySettings& settings, std::span<const ObservedRun> training);

/// Name of the strategy that does nothing.
inline constexpr const char* kNoCorrection = "no correction";

}  // namespace driftwright::app
