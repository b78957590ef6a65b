#include "compensation/modal_predictor.hpp"

#include "solver/steady_state.hpp"

namespace driftwright::compensation {

solver::Trajectory ModalPredictor::predict(const Cyclogram& cyclogram, const TimeSeries& hall,
                                           const std::vector<double>& output_s) const {
  return solver::evolve(system, cyclogram, hall, output_s, Eigen::VectorXd::Zero(system.size()));
}

ModalPredictor make_modal_predictor(const solver::FullSystem& full, int n_modes, bool with_steady_responses) {
  const effects::Inputs standstill;
  // Laws of temperature stay as they are at the reference temperature, where every run starts.
  const solver::FullSystem system =
      full.is_linear() ? full : solver::linearised(full, standstill, Eigen::VectorXd::Zero(full.size()));
  const solver::ThermalModes modes = solver::thermal_modes(system, standstill, n_modes);
  Eigen::MatrixXd columns = modes.shapes;
  if (with_steady_responses) {
    const Eigen::MatrixXd steady = solver::steady_responses(system, standstill);
    columns.conservativeResize(Eigen::NoChange, n_modes + steady.cols());
    columns.rightCols(steady.cols()) = steady;
  }
  return {modes.time_constant_s, solver::project(system, solver::orthonormalise(system.mass, columns))};
}

}  // namespace driftwright::compensation
