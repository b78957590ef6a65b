#include "solver/transient.hpp"

#include <cmath>

#include "solver/heat_ode.hpp"
#include "solver/integrate.hpp"
#include "solver/stretches.hpp"

namespace driftwright::solver {
namespace {

/// Times at which the drive is constant but another input bends or jumps.
std::vector<double> knots_s(const FullSystem& system, const TimeSeries& ambient) {
  std::vector<double> knots = knots_of(system, ambient);
  for (const FixedUnknowns& f : system.fixed) knots.insert(knots.end(), f.theta.time_s.begin(), f.theta.time_s.end());
  return knots;
}

}  // namespace

double Trajectory::energy_gap() const {
  const Eigen::VectorXd last = heat_J.col(heat_J.cols() - 1);
  double in_J = 0.0, magnitude_J = std::abs(stored_J[stored_J.size() - 1]);
  for (std::size_t j = 0; j < flows.size(); ++j) {
    if (flows[j].kind == FlowKind::kInternal) continue;
    const double heat = last[static_cast<Eigen::Index>(j)];
    in_J += heat;
    magnitude_J += std::abs(heat);
  }
  return magnitude_J == 0.0 ? 0.0 : std::abs(in_J - stored_J[stored_J.size() - 1]) / (0.5 * magnitude_J);
}

Trajectory simulate(const FullSystem& system, const Cyclogram& cyclogram, const TimeSeries& ambient,
                    const std::vector<double>& output_s, const TransientOptions& options, const Eigen::VectorXd& start,
                    const OutputCallback& callback) {
  HeatOde ode(system, ambient, options.absolute_tolerance_K);
  return integrate(ode, behind(options.from_s, linear_stretches(cyclogram, knots_s(system, ambient))), ambient, output_s,
                   options, start, callback);
}

}  // namespace driftwright::solver
