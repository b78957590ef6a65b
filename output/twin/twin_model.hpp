#pragma once
// What a page holds of a machine's small system, as numbers: dz/dt = -K z + f with laws as tables, whether they follow temperatures or not.

#include <string>
#include <vector>

#include "machine/reduced_machine.hpp"
#include "output/twin/twin_law.hpp"

namespace driftwright::output {

/// A law of a source or exchange between the times at which it changes on its own.
struct TwinTimedLaw {
  std::vector<TwinLaw> laws = {};    ///< different ones
  std::vector<int> of_stretch = {};  ///< index of the law before the first time of change, behind it, ...
  std::vector<int> probes = {};      ///< of the laws, in the system's list
  int thermostat = -1;               ///< off: zero
};

struct TwinModel {
  std::vector<DriveRange> drive = {};
  solver::ReducedSystem system = {};  ///< M = 1; its laws stand in `powers_W` and `coefficients`
  Eigen::VectorXd start = {};
  std::vector<TwinTimedLaw> powers_W = {}, coefficients = {};
  TimeSeries ambient = {};              ///< over the reference temperature [K]
  std::vector<std::string> notes = {};  ///< what of the scenario the page leaves out, a sentence each
  [[nodiscard]] bool follows_temperatures() const { return system.looks_at_state() || !system.thermostats.empty(); }
};

/// @throws InputError  naming the law: one that no table of twin_law() says; a recorded column that drives the machine; prescribed temperatures over time
[[nodiscard]] TwinModel twin_model(const scenarios::Scenario& scenario, const solver::ReducedSystem& system,
                                   const Eigen::VectorXd& start);

/// A machine of lumped nodes as it is, in unknowns of unit mass, and the temperatures of its nodes over the reference in these [K].
struct LumpedSystem {
  solver::ReducedSystem system;
  Eigen::VectorXd start;
  Eigen::MatrixXd node_temperature;  ///< n_nodes x n_states, in the order of HeatBalance::nodes
};
/// @param model  without a mesh
[[nodiscard]] LumpedSystem lumped_system(const scenarios::MachineModel& model);

}  // namespace driftwright::output
