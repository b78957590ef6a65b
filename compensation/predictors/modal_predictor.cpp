#include "compensation/predictors/modal_predictor.hpp"

#include <algorithm>

#include "base/dense.hpp"
#include "base/errors.hpp"
#include "solver/propagator.hpp"
#include "solver/reduced_model.hpp"
#include "solver/steady_state.hpp"
#include "solver/thermal_modes.hpp"

namespace driftwright::compensation {

solver::Trajectory ModalPredictor::predict(const Cyclogram& cyclogram, const TimeSeries& ambient,
                                           const std::vector<double>& output_s) const {
  return solver::Propagator(system).run(cyclogram, ambient, output_s, start);
}

ModalPredictors make_modal_predictors(const solver::FullSystem& full, int most_modes, const Eigen::VectorXd& from,
                                      double ambient_K, const Drive& typical) {
  const effects::Inputs standstill{.drive = {}, .ambient_K = ambient_K};
  Eigen::VectorXd start = from;  // prescribed temperatures jump at once, as in simulate()
  for (const solver::FixedUnknowns& f : full.fixed) {
    for (int i : f.unknowns) start[i] = f.follows_ambient ? ambient_K : f.theta.at(0.0);
  }
  const int n_modes = std::min(most_modes, full.size());
  const auto frozen = [&] {
    solver::require_linearisable(full);
    const effects::Inputs at{.drive = typical, .ambient_K = ambient_K};
    return solver::linearised(full, at, solver::steady_state(full, at, start));
  };
  const solver::FullSystem system = full.is_linear() ? full : frozen();
  const solver::ThermalModes modes = solver::thermal_modes(system, standstill, n_modes);
  const auto in_basis = [&](const Eigen::MatrixXd& columns) -> ModalPredictor {
    Eigen::MatrixXd with_start(columns.rows(), columns.cols() + 1);  // dropped again below if it adds nothing
    with_start << columns, start;
    const Eigen::MatrixXd basis = solver::orthonormalise(system.mass, with_start);
    return {modes.time_constant_s, solver::project(system, basis), basis.transpose() * (system.mass * start)};
  };
  const Eigen::MatrixXd steady = solver::steady_responses(system, standstill);
  Eigen::MatrixXd completed(system.size(), modes.shapes.cols() + steady.cols());
  completed << modes.shapes, steady;
  return {in_basis(modes.shapes), in_basis(completed)};
}

ModalPredictor make_ritz_predictor(const solver::ReducedSystem& system, const Eigen::VectorXd& start, int n_modes,
                                   const effects::Inputs& at) {
  Eigen::MatrixXd k = system.conduction;
  Eigen::VectorXd ambient = Eigen::VectorXd::Zero(system.size()), stratified = ambient;
  for (const auto& e : system.exchanges) {
    k += e.coefficient(at) * e.matrix;
    if (e.reaches_ambient()) ambient += e.coefficient(at) * e.to_ambient;
    if (e.offset.size() > 0) stratified += e.coefficient(at) * e.offset;
  }
  const dense::SymmetricEigen eigen(k);
  constexpr double kRounding = 1e-12;  // of the fastest rate
  if (!(eigen.eigenvalues()[0] > kRounding * eigen.eigenvalues()[k.rows() - 1]))
    throw SolveError("the reduced model has no steady state there: heat has no way out of a part of the machine");
  const Eigen::Index n = std::min<Eigen::Index>(n_modes, k.rows());
  Eigen::MatrixXd columns(k.rows(), n + static_cast<Eigen::Index>(system.sources.size()) + 3);
  columns.leftCols(n) = eigen.eigenvectors().leftCols(n);
  for (std::size_t s = 0; s < system.sources.size(); ++s)
    columns.col(n + static_cast<Eigen::Index>(s)) = system.sources[s].load;
  columns.col(columns.cols() - 3) = ambient;
  columns.col(columns.cols() - 2) = stratified;
  auto loads = columns.middleCols(n, columns.cols() - n - 1);
  loads = dense::solve_symmetric(k, loads);  // their steady responses
  columns.col(columns.cols() - 1) = start;
  Eigen::MatrixXd basis(k.rows(), 0);
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {  // Gram-Schmidt with two passes; dependent columns are dropped
    Eigen::VectorXd v = columns.col(c);
    const double length = v.norm();
    for (int pass = 0; pass < 2; ++pass) v -= basis * (basis.transpose() * v);
    if (!(v.norm() > 1e-10 * length) || basis.cols() == basis.rows()) continue;
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.col(basis.cols() - 1) = v.normalized();
  }
  ModalPredictor p{{}, solver::project(system, basis), basis.transpose() * start};
  for (Eigen::Index i = 0; i < n; ++i) p.time_constant_s.push_back(1.0 / eigen.eigenvalues()[i]);
  return p;
}

solver::ReducedSystem with_fixed_exchanges(solver::ReducedSystem system, const effects::Inputs& at) {
  for (auto& e : system.exchanges) {
    const double coefficient = e.coefficient(at);
    e.coefficient = solver::BoundLaw([coefficient](const effects::Inputs&) { return coefficient; });
  }
  return system;
}

}  // namespace driftwright::compensation
