#pragma once
// Selects sensors by a model: those from which the drift can be estimated even if the model's factors are wrong.

#include "compensation/predictors/observer.hpp"
#include "compensation/sensors/sensor_selection.hpp"

namespace driftwright::compensation {

/// Adds, one by one, the sensor that leaves the smallest variance of the drift. Every heat source and every film, joint and
/// link of the model is uncertain (settings.factor), and every reading is noisy (settings.reading_K, settings.model_K):
///
///     var(d | y) = J_d C J_d' - J_d C J_y' (J_y C J_y' + R)^-1 J_y C J_d', J = d(outputs)/d(factors), at every tenth row,
///     mean over rows
///
/// from readings at the same time only. It uses the model and the drive, never measured values.
/// @param system  linear; @param start  its state at the start of the runs; @param candidates, drift  its outputs
[[nodiscard]] Selection select_by_observability(const solver::ReducedSystem& system, const Eigen::VectorXd& start,
                                                std::span<const MachineRun> runs, const std::vector<std::string>& candidates,
                                                const std::string& drift, int n, const ObserverSettings& settings = {});

}  // namespace driftwright::compensation
