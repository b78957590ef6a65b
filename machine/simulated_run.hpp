#pragma once
// Simulates cyclograms with a machine's model, and computes the whole fields of one of them.

#include <optional>
#include <span>

#include "base/listener.hpp"
#include "machine/body_range.hpp"
#include "solver/stress.hpp"

namespace driftwright::scenarios {

/// A simulated cyclogram.
struct SimulatedRun {
  Record record;
  solver::Trajectory trajectory;
  std::vector<BodyRange> bodies = {};  ///< set by simulate_cyclograms()
};

/// Warnings about impossible results of runs: temperatures of bodies and thermometers, displacements and tilts
/// (base/usual_ranges.hpp).
[[nodiscard]] std::vector<std::string> unusual_results(std::span<const SimulatedRun> runs, const MachineModel& machine);

/// Runs one cyclogram.
/// @param machine   the scenario's, or one that differs from it in the ambient
/// @param from      state of the model at t = 0
/// @param times_s   times of the outputs, within the cyclogram
/// @param at_output called at each of them
[[nodiscard]] SimulatedRun simulate_run(const MachineModel& machine, const solver::TransientOptions& options,
                                        const Model& model, const Eigen::VectorXd& from, const Cyclogram& cyclogram,
                                        const std::vector<double>& times_s, const solver::OutputCallback& at_output = {});

/// The state of the model at t = 0 above the reference temperature [K], as the scenario's `start` defines it; reduced for a
/// reduced model.
[[nodiscard]] Eigen::VectorXd start_of(const MachineModel& machine, const Model& model);
/// The same for a model and a cyclogram (driven_before.hpp).
[[nodiscard]] Eigen::VectorXd after_what_was_before(const MachineModel& machine, const solver::TransientOptions& options,
                                                    const Model& model, const Eigen::VectorXd& from,
                                                    const Cyclogram& cyclogram);
/// The state "1 K warmer everywhere".
[[nodiscard]] const Eigen::VectorXd& ones_of(const Model& model);

/// The fields of all nodes at one time of a run.
struct WholeFields {
  double time_s = 0.0;
  Eigen::VectorXd temperature_degC;             ///< n_nodes
  Eigen::Matrix3Xd displacement_um;             ///< 3 x n_nodes
  std::optional<solver::StressField> stress{};  ///< if the scenario asks for it
};
/// Receives the fields of one cyclogram, every `fields_every` and at its end.
struct FieldSink {
  std::size_t cyclogram = 0;                              ///< index of the cyclogram
  std::function<void(const WholeFields& fields)> take{};  ///< null: no fields are computed
};

/// Runs cyclograms from the scenario's start, in parallel on all cores, with one common progress.
[[nodiscard]] std::vector<SimulatedRun> simulate_cyclograms(const Scenario& scenario, const Model& model,
                                                            const std::vector<const Cyclogram*>& cyclograms,
                                                            const Listener& listener, const FieldSink& fields = {});

}  // namespace driftwright::scenarios
