#include "solver/reduced_transient.hpp"

#include "solver/integrate.hpp"
#include "solver/propagator.hpp"
#include "solver/reduced_ode.hpp"
#include "solver/stretches.hpp"

namespace driftwright::solver {

Trajectory simulate(const ReducedSystem& system, const Cyclogram& cyclogram, const TimeSeries& ambient,
                    const std::vector<double>& output_s, const TransientOptions& options, const Eigen::VectorXd& start,
                    const OutputCallback& callback) {
  return simulate(system, behind(options.from_s, stretches_of(system, cyclogram, ambient)), ambient, output_s, options, start,
                  callback);
}

Trajectory simulate(const ReducedSystem& system, const std::vector<LinearStretch>& stretches, const TimeSeries& ambient,
                    const std::vector<double>& output_s, const TransientOptions& options, const Eigen::VectorXd& start,
                    const OutputCallback& callback) {
  if (!system.is_linear()) {
    ReducedOde ode(system, ambient);
    return integrate(ode, stretches, ambient, output_s, options, start, callback);
  }
  Eigen::MatrixXd states;
  Trajectory run = Propagator(system).run(stretches, ambient, output_s, start, true, &states);
  for (std::size_t k = 0; callback && k < output_s.size(); ++k) {
    callback(output_s[k], states.col(static_cast<Eigen::Index>(k)));
  }
  return run;
}

}  // namespace driftwright::solver
