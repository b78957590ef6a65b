#include "compensation/modal_predictor.hpp"

#include <algorithm>

#include "solver/propagator.hpp"
#include "solver/reduced_model.hpp"
#include "solver/steady_state.hpp"
#include "solver/thermal_modes.hpp"

namespace driftwright::compensation {

solver::Trajectory ModalPredictor::predict(const Cyclogram& cyclogram, const TimeSeries& hall,
                                           const std::vector<double>& output_s) const {
  return solver::Propagator(system).run(cyclogram, hall, output_s, start);
}

ModalPredictors make_modal_predictors(const solver::FullSystem& full, int most_modes, const Eigen::VectorXd& from,
                                      double hall_K, const Drive& typical) {
  const effects::Inputs standstill{.drive = {}, .hall_K = hall_K};
  Eigen::VectorXd start = from;  // what is held jumps at once, as in simulate()
  for (const solver::FixedUnknowns& f : full.fixed) {
    for (int i : f.unknowns) start[i] = f.follows_hall ? hall_K : f.theta.at(0.0);
  }
  const int n_modes = std::min(most_modes, full.size());
  const auto frozen = [&] {
    solver::require_linearisable(full);
    const effects::Inputs at{.drive = typical, .hall_K = hall_K};
    return solver::linearised(full, at, solver::steady_state(full, at, start));
  };
  const solver::FullSystem system = full.is_linear() ? full : frozen();
  const solver::ThermalModes modes = solver::thermal_modes(system, standstill, n_modes);
  const auto in_basis = [&](const Eigen::MatrixXd& columns) -> ModalPredictor {
    Eigen::MatrixXd with_start(columns.rows(), columns.cols() + 1);  // dropped again where it adds nothing
    with_start << columns, start;
    const Eigen::MatrixXd basis = solver::orthonormalise(system.mass, with_start);
    return {modes.time_constant_s, solver::project(system, basis), basis.transpose() * (system.mass * start)};
  };
  const Eigen::MatrixXd steady = solver::steady_responses(system, standstill);
  Eigen::MatrixXd completed(system.size(), modes.shapes.cols() + steady.cols());
  completed << modes.shapes, steady;
  return {in_basis(modes.shapes), in_basis(completed)};
}

}  // namespace driftwright::compensation
