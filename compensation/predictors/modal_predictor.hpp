#pragma once
// Drift of any cyclogram without sensors: the machine's thermal modes, driven by the cyclogram and the ambient.

#include "base/cyclogram.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::compensation {

/// The slowest thermal modes of the machine at standstill, completed by its steady responses to each heat source and to
/// the ambient. The modes describe the slow memory, the steady responses the steady part of the omitted fast modes: 20
/// modes alone give errors of kelvins at a bearing.
struct ModalPredictor {
  std::vector<double> time_constant_s;  ///< of the modes, in decreasing order
  solver::ReducedSystem system;
  Eigen::VectorXd start;  ///< reduced state at t = 0

  /// Outputs in K, m and rad over a cyclogram from `start`, exact between the changes of speed.
  [[nodiscard]] solver::Trajectory predict(const Cyclogram& cyclogram, const TimeSeries& ambient,
                                           const std::vector<double>& output_s) const;
};

struct ModalPredictors {
  ModalPredictor bare;       ///< thermal modes alone, for comparison
  ModalPredictor completed;  ///< with the steady responses
};

/// @param n_modes  >= 1; a machine with fewer lumped nodes gets all of its modes
/// @param start    temperatures at t = 0 minus the reference temperature
/// @param ambient_K   ambient temperature at t = 0 minus the reference temperature
/// @param typical  drive for freezing laws of temperature, in its steady state in that ambient: the mean of the expected
///                 cyclograms. A film that grows with the temperature difference would be zero if frozen at the start
/// @throws InputError, SolveError  as thermal_modes()
[[nodiscard]] ModalPredictors make_modal_predictors(const solver::FullSystem& system, int n_modes,
                                                    const Eigen::VectorXd& start, double ambient_K, const Drive& typical);

/// The same from a reduced model with M = 1: its slowest Ritz modes at some inputs, completed by its steady responses to
/// each heat source and to the ambient there. They are modes of the reduced model, close to the machine's own where those
/// are slow.
/// @param system  linear
/// @throws SolveError  when it has no steady state there
[[nodiscard]] ModalPredictor make_ritz_predictor(const solver::ReducedSystem& system, const Eigen::VectorXd& start,
                                                 int n_modes, const effects::Inputs& at);

/// A linear reduced system whose films, joints and links are fixed at some inputs: one set of time constants for all speeds.
[[nodiscard]] solver::ReducedSystem with_fixed_exchanges(solver::ReducedSystem system, const effects::Inputs& at);

}  // namespace driftwright::compensation
