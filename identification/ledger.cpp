#include "identification/ledger.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace driftwright::identification {
namespace {

// Number of times of a step response, from a hundredth of the shortest time constant to ten times the longest.
constexpr int kTimes = 400;
constexpr double kThere = 0.63;

std::string name_of(const Law& law) {
  switch (law.kind) {
    case Law::Kind::kTurning:
      return fmt::format("while {} is not 0", law.channel);
    case Law::Kind::kPower:
      return fmt::format("{}^{:.3g}", law.channel, law.exponent);
    case Law::Kind::kColumn:
      break;
  }
  return law.channel;
}

/// Gains and time constants of a driver's parts.
struct Parts {
  std::string name;
  Eigen::VectorXd course;
  std::vector<std::pair<double, double>> gain_tau;
};

double delay_s(const std::vector<std::pair<double, double>>& gain_tau) {
  double least = 1e300, most = 0.0;
  for (const auto& [gain, tau_s] : gain_tau) {
    least = std::min(least, tau_s);
    most = std::max(most, tau_s);
  }
  if (most <= 0.0) return 0.0;
  const double from = std::log(0.01 * std::max(least, 1e-3)), to = std::log(10.0 * most);
  std::vector<double> time_s, response;
  for (int i = 0; i < kTimes; ++i) {
    time_s.push_back(std::exp(from + (to - from) * i / (kTimes - 1)));
    double sum = 0.0;
    for (const auto& [gain, tau_s] : gain_tau) sum += gain * (tau_s > 0.0 ? -std::expm1(-time_s.back() / tau_s) : 1.0);
    response.push_back(sum);
  }
  double largest = 0.0;
  for (double r : response) largest = std::max(largest, std::abs(r));
  for (std::size_t i = 0; i < response.size(); ++i) {
    if (std::abs(response[i]) >= kThere * largest) return time_s[i];
  }
  return 0.0;
}

/// What laws and the ambient do to a channel.
std::vector<Parts> learned_parts(const FosterProblem& problem, std::size_t channel, const ChannelFit& fit) {
  const std::vector<NetworkBody>& bodies = problem.bodies();
  const bool is_thermometer = channel < problem.n_thermometers();
  std::vector<Parts> parts;
  for (const Law& law : problem.structure().laws)
    parts.push_back({name_of(law), Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem.n_rows())), {}});
  Parts ambient{"ambient", Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem.n_rows())), {}};
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const double weight = fit.weight[static_cast<Eigen::Index>(b)];
    if (bodies[b].law) {
      Parts& of = parts[*bodies[b].law];
      of.course += weight * problem.heated_K(b);
      of.gain_tau.emplace_back(weight * bodies[b].rise_K * problem.structure().laws[*bodies[b].law].sign, bodies[b].tau_s);
    }
    ambient.course += weight * (problem.body_K(b) - problem.heated_K(b));
    ambient.gain_tau.emplace_back(weight, bodies[b].tau_s);
  }
  if (is_thermometer) {
    ambient.course += fit.of_ambient * problem.ambient_K();
    ambient.gain_tau.emplace_back(fit.of_ambient, 0.0);
  }
  if (problem.ambient_K().cwiseAbs().maxCoeff() > 0.0) parts.push_back(std::move(ambient));
  return parts;
}

/// Shares in the variance of the sum of all parts, over rows without a gap.
std::vector<Driver> drivers_of(std::vector<Parts> parts) {
  if (parts.empty()) return {};
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(parts.front().course.size());
  for (const Parts& p : parts) sum += p.course;
  std::vector<Eigen::Index> whole;
  for (Eigen::Index i = 0; i < sum.size(); ++i) {
    if (std::isfinite(sum[i])) whole.push_back(i);
  }
  if (whole.empty()) return {};
  for (Parts& p : parts) p.course = Eigen::VectorXd(p.course(whole));
  sum = Eigen::VectorXd(sum(whole));
  const Eigen::VectorXd about = (sum.array() - sum.mean()).matrix();
  const double variance = about.squaredNorm();
  std::vector<Driver> drivers;
  for (const Parts& p : parts) {
    Driver d{.name = p.name};
    d.share = variance > 0.0 ? about.dot((p.course.array() - p.course.mean()).matrix()) / variance : 0.0;
    d.swing = p.course.maxCoeff() - p.course.minCoeff();
    for (const auto& [gain, tau_s] : p.gain_tau) d.in_the_end += gain;
    d.delay_s = delay_s(p.gain_tau);
    drivers.push_back(std::move(d));
  }
  std::sort(drivers.begin(), drivers.end(), [](const Driver& a, const Driver& b) { return a.share > b.share; });
  return drivers;
}

}  // namespace

std::vector<Driver> ledger(const FosterProblem& problem, std::size_t channel, const ChannelFit& fit) {
  std::vector<Parts> parts = learned_parts(problem, channel, fit);
  if (problem.extends_scenario()) parts.push_back({"the scenario", fit.kept * problem.simulated(channel), {}});
  return drivers_of(std::move(parts));
}

std::vector<Driver> ledger_of_missing(const FosterProblem& problem, std::size_t channel, const ChannelFit& fit) {
  std::vector<Parts> parts = learned_parts(problem, channel, fit);
  if (fit.kept < 1.0) parts.push_back({"less of the scenario", (fit.kept - 1.0) * problem.simulated(channel), {}});
  parts.push_back({kLeft, problem.misses(channel, fit), {}});
  return drivers_of(std::move(parts));
}

}  // namespace driftwright::identification
