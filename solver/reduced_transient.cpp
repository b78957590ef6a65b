#include "solver/reduced_transient.hpp"

#include "solver/integrate.hpp"
#include "solver/propagator.hpp"
#include "solver/reduced_ode.hpp"

namespace driftwright::solver {

Trajectory simulate(const ReducedSystem& system, const Cyclogram& cyclogram, const TimeSeries& hall,
                    const std::vector<double>& output_s, const TransientOptions& options, const Eigen::VectorXd& start,
                    const OutputCallback& callback) {
  if (!system.is_linear()) {
    std::vector<double> knots_s = hall.time_s;
    knots_s.insert(knots_s.end(), system.change_times_s.begin(), system.change_times_s.end());
    ReducedOde ode(system, hall);
    return integrate(ode, behind(options.from_s, linear_stretches(cyclogram, knots_s)), hall, output_s, options, start,
                     callback);
  }
  Eigen::MatrixXd states;
  Trajectory run = Propagator(system).run(cyclogram, hall, output_s, start, true, &states, options.from_s);
  for (std::size_t k = 0; callback && k < output_s.size(); ++k) {
    callback(output_s[k], states.col(static_cast<Eigen::Index>(k)));
  }
  return run;
}

}  // namespace driftwright::solver
