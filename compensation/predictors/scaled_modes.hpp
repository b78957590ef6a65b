#pragma once
// Hybrid of model and tests. The structure comes from the model (which source heats what, how parts are connected, how films
// grow with speed). A few factors come from the tests: one on each heat source, one on all films and links to the ambient,
// one on all joints, one on all rates of change, one on each displacement and tilt.

#include "compensation/predictors/thermal_test.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::compensation {

struct ScaledModes {
  struct Factor {
    std::string name;
    double value = 1.0, low = 1.0, high = 1.0;  ///< with 95 % interval
  };
  std::vector<Factor> factors;
  solver::ReducedSystem system;
  Eigen::VectorXd start;
};

/// @param model     linear, M = 1; borrowed during the call
/// @param start     its state at t = 0
/// @param ambient_K    ambient temperature at the start minus the reference temperature; the tests' ambients count from it
/// @param channels  all of them outputs of the model
/// @throws InputError  for a channel that the model lacks, tests with missing readings
/// @throws SolveError  when no factors are found
[[nodiscard]] ScaledModes fit_scaled_modes(const solver::ReducedSystem& model, const Eigen::VectorXd& start,
                                           double ambient_K, const std::vector<ThermalTest>& tests,
                                           const TestChannels& channels);

}  // namespace driftwright::compensation
