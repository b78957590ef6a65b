#include "compensation/modal_predictor.hpp"

namespace driftwright::compensation {

solver::Trajectory ModalPredictor::predict(const Cyclogram& cyclogram, const TimeSeries& hall,
                                           const std::vector<double>& output_s) const {
  return solver::evolve(system, cyclogram, hall, output_s, Eigen::VectorXd::Zero(system.size()));
}

ModalPredictor make_modal_predictor(const solver::FullSystem& system, int n_modes, bool with_steady_responses) {
  const effects::Inputs standstill{.speed_rpm = 0.0, .hall_K = 0.0};
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
