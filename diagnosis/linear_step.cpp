#include "diagnosis/linear_step.hpp"

#include <Eigen/LU>
#include <unsupported/Eigen/MatrixFunctions>

namespace driftwright::diagnosis {
namespace {

constexpr double kDifference_K = 0.5;
constexpr double kNoWayOut_1_s = 1e-14;  // lets an isolated node have a steady state
constexpr int kLooks = 8;                // iterations of laws of temperature, for the balance

/// A law at a state: its value, and its slope for each of its probes.
struct Said {
  double value = 0.0;
  std::vector<double> by_probe;
};

Said said_by(const solver::BoundLaw& law, const solver::ReducedSystem& system, effects::Inputs at,
             const Eigen::VectorXd& state) {
  if (!law.looks_at_state()) return {law(at), {}};
  at.probe_K.clear();
  for (int p : law.probes)
    at.probe_K.push_back(system.probes[static_cast<std::size_t>(p)].theta_K(state, at.ambient_K) + system.reference_K);
  Said said{law.law(at), {}};
  for (double& probe_K : at.probe_K) {
    probe_K += kDifference_K;
    const double above = law.law(at);
    probe_K -= 2.0 * kDifference_K;
    said.by_probe.push_back((above - law.law(at)) / (2.0 * kDifference_K));
    probe_K += kDifference_K;
  }
  return said;
}

/// @param on  marks the thermostats that switch at this drive
LinearSystem about(const solver::ReducedSystem& system, const effects::Inputs& at, const Eigen::VectorXd& state,
                   const std::vector<char>& on) {
  LinearSystem linear{system.conduction, Eigen::VectorXd::Zero(system.size()), Eigen::VectorXd::Zero(system.size())};
  /// Adds a load that depends on the law's probes.
  const auto add_slopes = [&](const solver::BoundLaw& law, const Said& said, const Eigen::VectorXd& load) {
    for (std::size_t j = 0; j < said.by_probe.size(); ++j) {
      const solver::Probe& probe = system.probes[static_cast<std::size_t>(law.probes[j])];
      linear.stiffness.noalias() -= said.by_probe[j] * load * probe.weights.transpose();
      linear.constant -= said.by_probe[j] * probe.theta_K(state, at.ambient_K) * load;
      linear.constant += said.by_probe[j] * probe.offset_K * load;
      linear.of_ambient += said.by_probe[j] * probe.ambient_share * load;
    }
  };
  for (const solver::HeatSource& s : system.sources) {
    const int t = s.power_W.thermostat;
    if (t >= 0 && !on[static_cast<std::size_t>(t)]) continue;
    const Said said = said_by(s.power_W, system, at, state);
    if (t < 0) {
      linear.constant += said.value * s.load;
      add_slopes(s.power_W, said, s.load);
      continue;
    }
    const solver::Thermostat& thermostat =
        system.thermostats[static_cast<std::size_t>(t)];  // in proportion between its limits
    const solver::Probe& probe = system.probes[static_cast<std::size_t>(thermostat.probe)];
    const double per_K = said.value / (thermostat.on_above_K - thermostat.off_below_K);
    linear.stiffness.noalias() -= per_K * s.load * probe.weights.transpose();
    linear.of_ambient += per_K * probe.ambient_share * s.load;
    linear.constant += per_K * (probe.offset_K + system.reference_K - thermostat.off_below_K) * s.load;
  }
  for (const auto& e : system.exchanges) {
    const int t = e.coefficient.thermostat;
    if (t >= 0 && !on[static_cast<std::size_t>(t)]) continue;
    Said said = said_by(e.coefficient, system, at, state);
    if (t >= 0) said.value *= 0.5;
    linear.stiffness += said.value * e.matrix;
    if (e.reaches_ambient()) linear.of_ambient += said.value * e.to_ambient;
    if (e.offset.size() > 0) linear.constant += said.value * e.offset;
    if (said.by_probe.empty()) continue;
    Eigen::VectorXd out = e.matrix * state;
    if (e.reaches_ambient()) out -= at.ambient_K * e.to_ambient;
    if (e.offset.size() > 0) out -= e.offset;
    add_slopes(e.coefficient, said, -out);
  }
  return linear;
}

Eigen::VectorXd balance_of(const LinearSystem& linear, const Eigen::MatrixXd& mass, double ambient_K) {
  return (linear.stiffness + kNoWayOut_1_s * mass).partialPivLu().solve(linear.constant + ambient_K * linear.of_ambient);
}

}  // namespace

LinearSystem linear_system(const solver::ReducedSystem& system, const effects::Inputs& at, const Eigen::VectorXd& start) {
  std::vector<char> on(system.thermostats.size(), 0);
  if (system.thermostats.empty() && !system.looks_at_state()) return about(system, at, start, on);
  Eigen::VectorXd halfway = start;
  for (int look = 0; look < kLooks; ++look)
    halfway = 0.5 * (halfway + 0.5 * (start + balance_of(about(system, at, halfway, on), system.mass, at.ambient_K)));
  for (std::size_t t = 0; t < on.size(); ++t) {
    const solver::Thermostat& thermostat = system.thermostats[t];
    const double probe_K =
        system.probes[static_cast<std::size_t>(thermostat.probe)].theta_K(halfway, at.ambient_K) + system.reference_K;
    on[t] = probe_K > 0.5 * (thermostat.on_above_K + thermostat.off_below_K) ? 1 : 0;
  }
  for (int look = 0; look < kLooks && !on.empty(); ++look)
    halfway = 0.5 * (halfway + 0.5 * (start + balance_of(about(system, at, halfway, on), system.mass, at.ambient_K)));
  return about(system, at, halfway, on);
}

LinearStep linear_step(const LinearSystem& system, const Eigen::MatrixXd& mass, double step_s) {
  const Eigen::Index n = mass.rows();
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(n + 3, n + 3);  // of state, one, ambient, and its rise over the step
  Eigen::MatrixXd right(n, n + 2);
  right << -system.stiffness, system.constant, system.of_ambient;
  block.topLeftCorner(n, n + 2) = step_s * mass.llt().solve(right);
  block(n + 1, n + 2) = 1.0;
  const Eigen::MatrixXd after = block.exp();
  return {after.topLeftCorner(n, n), after.col(n).head(n), after.col(n + 1).head(n), after.col(n + 2).head(n)};
}

}  // namespace driftwright::diagnosis
