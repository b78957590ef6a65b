#include "solver/linearise.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace driftwright::solver {
namespace {

// Below this standard deviation rows are of one temperature: of a body [K], of a difference as a share of it.
constexpr double kLeastSpread_K = 0.01, kLeastShareOfSpread = 1e-3;

/// Temperatures of a law's probes per row, and their dependence on the temperature x that the linear law follows.
struct LawOnX {
  double x_K = 0.0;       ///< weighted mean
  double spread_K = 0.0;  ///< standard deviation of x
  std::vector<double> probe_K, probe_spread_K;
};

double probe_at_row_K(const ReducedSystem& system, int probe, const OperatingRow& row) {
  return system.reference_K + system.probes[static_cast<std::size_t>(probe)].theta_K(row.state, row.at.ambient_K);
}

effects::Inputs inputs_at_row(const ReducedSystem& system, const BoundLaw& law, const OperatingRow& row) {
  effects::Inputs inputs = row.at;
  inputs.probe_K.clear();
  for (int p : law.probes) inputs.probe_K.push_back(probe_at_row_K(system, p, row));
  return inputs;
}

/// @param x_K  per row, and the weight of each
/// @param is_x  per probe of the law, whether it is x itself, up to a constant
/// @param least_K  standard deviation of x below which the two states are this far from the mean, and only x differs
LawOnX law_on(const ReducedSystem& system, const BoundLaw& law, std::span<const OperatingRow> rows,
              const std::vector<double>& x_K, std::vector<double> weight, const std::vector<bool>& is_x, double least_K) {
  double total = 0.0;
  for (double w : weight) total += w;
  if (!(total > 0.0)) {
    weight.assign(rows.size(), 1.0);
    total = static_cast<double>(rows.size());
  }
  for (double& w : weight) w /= total;
  LawOnX r;
  for (std::size_t i = 0; i < rows.size(); ++i) r.x_K += weight[i] * x_K[i];
  double variance = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) variance += weight[i] * (x_K[i] - r.x_K) * (x_K[i] - r.x_K);
  const bool is_spread = std::sqrt(variance) > least_K;
  r.spread_K = is_spread ? std::sqrt(variance) : least_K;
  for (std::size_t p = 0; p < law.probes.size(); ++p) {
    double mean_K = 0.0, covariance = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) mean_K += weight[i] * probe_at_row_K(system, law.probes[p], rows[i]);
    for (std::size_t i = 0; i < rows.size(); ++i)
      covariance += weight[i] * (x_K[i] - r.x_K) * (probe_at_row_K(system, law.probes[p], rows[i]) - mean_K);
    r.probe_K.push_back(mean_K);
    const double per_x = is_spread ? covariance / variance : is_x[p] ? 1.0 : 0.0;
    r.probe_spread_K.push_back(per_x * r.spread_K);
  }
  return r;
}

LinearisedLaw law_words(const ReducedSystem& system, const std::string& name, const BoundLaw& law, const LawOnX& r) {
  std::size_t shown = 0;
  for (std::size_t p = law.probes.size(); p-- > 0;) {
    if (system.probes[static_cast<std::size_t>(law.probes[p])].ambient_share == 0.0) shown = p;
  }
  return {name, r.probe_K[shown], std::abs(r.probe_spread_K[shown])};
}

void freeze_at(BoundLaw& law, const LawOnX& r) {
  law.frozen_K = r.probe_K;
  law.spread_K = r.probe_spread_K;
  law.probes.clear();
}

}  // namespace

Linearisation linearise(const ReducedSystem& system, std::span<const OperatingRow> rows) {
  if (!system.thermostats.empty()) throw std::logic_error("linearise: a thermostat switches");
  if (rows.empty()) throw std::logic_error("linearise: at least one row is required");
  Linearisation result{system, {}};
  std::vector<double> x_K(rows.size()), weight(rows.size());
  for (std::size_t k = 0; k < system.exchanges.size(); ++k) {
    const auto& e = system.exchanges[k];
    if (!e.coefficient.looks_at_state()) continue;
    double squares = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {  // times the area, for a film
      x_K[i] = e.flow.dot(rows[i].state) - e.ambient_sum * rows[i].at.ambient_K - e.offset_sum;
      weight[i] = x_K[i] * x_K[i];
      squares += weight[i];
    }
    const double least_K = kLeastShareOfSpread * std::sqrt(squares / static_cast<double>(rows.size()));
    const LawOnX r =
        law_on(system, e.coefficient, rows, x_K, weight, std::vector<bool>(e.coefficient.probes.size()), least_K);
    result.laws.push_back(law_words(system, e.name, e.coefficient, r));
    freeze_at(result.system.exchanges[k].coefficient, r);
  }
  for (std::size_t k = 0; k < system.sources.size(); ++k) {
    const HeatSource& s = system.sources[k];
    if (!s.power_W.looks_at_state()) continue;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      x_K[i] = s.load.dot(rows[i].state);
      const double power_W = s.power_W.law(inputs_at_row(system, s.power_W, rows[i]));
      weight[i] = power_W * power_W;
    }
    std::vector<bool> is_x;
    for (int p : s.power_W.probes) is_x.push_back(system.probes[static_cast<std::size_t>(p)].weights.isApprox(s.load, 1e-9));
    const LawOnX r = law_on(system, s.power_W, rows, x_K, weight, is_x, kLeastSpread_K);
    result.laws.push_back(law_words(system, s.name, s.power_W, r));
    freeze_at(result.system.sources[k].power_W, r);
    Exchange<Eigen::MatrixXd> slope;
    slope.name = fmt::format("{} over temperature", s.name);
    slope.matrix = s.load * s.load.transpose();
    slope.to_ambient = Eigen::VectorXd::Zero(system.size());
    slope.coefficient = result.system.sources[k].power_W;
    slope.coefficient.slope_over_K = 2.0 * r.spread_K;
    slope.flow = s.load;
    slope.medium = s.load;
    slope.medium_sum = 1.0;
    slope.hold_medium(r.x_K);
    slope.slope_of = static_cast<int>(k);
    result.system.exchanges.push_back(std::move(slope));
  }
  for (const OperatingRow& row : rows) {  // within the range of every law
    for (const auto& e : result.system.exchanges) (void)e.coefficient(row.at);
    for (const auto& s : result.system.sources) (void)s.power_W(row.at);
  }
  return result;
}

}  // namespace driftwright::solver
