#include "solver/reduced_transient.hpp"

#include "base/errors.hpp"
#include "solver/propagator.hpp"

namespace driftwright::solver {

Trajectory simulate(const ReducedSystem& system, const Cyclogram& cyclogram, const TimeSeries& hall,
                    const std::vector<double>& output_s, const TransientOptions&, const Eigen::VectorXd& start,
                    const OutputCallback& callback) {
  if (!system.is_linear()) throw InputError("a reduced model with laws of temperature cannot run yet");
  Eigen::MatrixXd states;
  Trajectory run = Propagator(system).run(cyclogram, hall, output_s, start, true, &states);
  for (std::size_t k = 0; callback && k < output_s.size(); ++k) {
    callback(output_s[k], states.col(static_cast<Eigen::Index>(k)));
  }
  return run;
}

}  // namespace driftwright::solver
