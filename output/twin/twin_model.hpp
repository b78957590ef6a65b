#pragma once
// The small system of a machine as numbers for a page: dz/dt = -K z + f, with tabulated laws, also laws of temperatures.

#include <string>
#include <vector>

#include "machine/reduced_machine.hpp"
#include "output/twin/twin_law.hpp"

namespace driftwright::output {

/// A law of a source or exchange that changes at given times.
struct TwinTimedLaw {
  std::vector<TwinLaw> laws = {};    ///< the different ones
  std::vector<int> of_stretch = {};  ///< index of the law before the first time of change, after it, ...
  std::vector<int> probes = {};      ///< of the laws, as indices in the system's list
  int thermostat = -1;               ///< index; the law is zero while it is off
};

struct TwinModel {
  std::vector<DriveRange> drive = {};
  solver::ReducedSystem system = {};  ///< M = 1; its laws are in `powers_W` and `coefficients`
  Eigen::VectorXd start = {};
  std::vector<TwinTimedLaw> powers_W = {}, coefficients = {};
  TimeSeries ambient = {};              ///< over the reference temperature [K]
  std::vector<std::string> notes = {};  ///< parts of the scenario that the page leaves out, one sentence each
  [[nodiscard]] bool follows_temperatures() const { return system.looks_at_state() || !system.thermostats.empty(); }
};

/// @throws InputError  naming the law: one that twin_law() cannot tabulate; a recorded column that drives the machine;
/// prescribed temperatures over time
[[nodiscard]] TwinModel twin_model(const scenarios::Scenario& scenario, const solver::ReducedSystem& system,
                                   const Eigen::VectorXd& start);

/// The scenario without effects that the page leaves out and that are no part of the machine: on readings, and on what was
/// recorded of drive and ambient. A prediction of it is what the page computes.
[[nodiscard]] scenarios::Scenario as_the_page_has_it(scenarios::Scenario scenario);

/// A machine of lumped nodes, unreduced, in unknowns of unit mass, and its node temperatures over the reference [K].
struct LumpedSystem {
  solver::ReducedSystem system;
  Eigen::VectorXd start;
  Eigen::MatrixXd node_temperature;  ///< n_nodes x n_states, in the order of HeatBalance::nodes
};
/// @param model  without a mesh
[[nodiscard]] LumpedSystem lumped_system(const scenarios::MachineModel& model);

}  // namespace driftwright::output
