#include "solver/heat_rate.hpp"

#include <algorithm>
#include <stdexcept>

#include "base/errors.hpp"
#include "solver/share.hpp"

namespace driftwright::solver {
namespace {

/// The value of a law; its name is added to a RangeError.
template <class Value>
double named(const std::string& name, Value value) {
  try {
    return value();
  } catch (const RangeError& e) {
    throw RangeError(name + ": " + e.what());
  }
}

}  // namespace

double BoundLaw::operator()(const effects::Inputs& u) const {
  if (looks_at_state()) throw std::logic_error("a law that looks at temperatures was asked without them");
  if (frozen_K.empty()) return law(u);
  effects::Inputs inputs = u;
  inputs.probe_K = frozen_K;
  if (spread_K.empty()) return law(inputs);
  for (std::size_t p = 0; p < frozen_K.size(); ++p) inputs.probe_K[p] = frozen_K[p] + spread_K[p];
  const double above = law(inputs);
  for (std::size_t p = 0; p < frozen_K.size(); ++p) inputs.probe_K[p] = frozen_K[p] - spread_K[p];
  const double below = law(inputs);
  return slope_over_K > 0.0 ? (below - above) / slope_over_K : 0.5 * (above + below);
}

HeatRate::Sparse::Sparse(const Eigen::VectorXd& dense) {
  for (Eigen::Index i = 0; i < dense.size(); ++i) {
    if (dense[i] == 0.0) continue;
    index.push_back(static_cast<int>(i));
    value.push_back(dense[i]);
  }
}
double HeatRate::Sparse::dot(const double* x) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < index.size(); ++k) sum += value[k] * x[index[k]];
  return sum;
}
void HeatRate::Sparse::add_to(double factor, double* y) const {
  for (std::size_t k = 0; k < index.size(); ++k) y[index[k]] += factor * value[k];
}

HeatRate::HeatRate(const FullSystem& system)
    : system_(system),
      thermostat_on_(system.thermostats.size(), 0),
      probe_K_(system.probes.size(), system.reference_K),
      steady_matrix_(system.conduction),
      tangent_(system.conduction),
      product_(system.size()) {
  for (const Probe& p : system.probes) probes_.emplace_back(p.weights);
  for (const HeatSource& s : system.sources) {
    sources_.push_back({Sparse(s.load)});
    flows_.push_back({s.name, FlowKind::kSource});
    looks_at_state_ |= s.power_W.looks_at_state();
  }
  for (const auto& e : system.exchanges) {
    crossings_.push_back({Sparse(e.flow), Sparse(e.to_ambient), Sparse(e.offset), slots_of(e.matrix, system.conduction)});
    const bool continues = !e.place.part.empty() && !flows_.empty() && flows_.back().name == e.name;
    flows_.push_back({e.name, e.leaves_machine() ? FlowKind::kSurrounding : FlowKind::kInternal, continues});
    looks_at_state_ |= e.coefficient.looks_at_state();
  }
  for (const auto& term : system.nonlinear) {
    if (term->is_flow())
      flows_.push_back({term->name, term->reaches_ambient() ? FlowKind::kSurrounding : FlowKind::kInternal});
  }
}

double HeatRate::value_of(const BoundLaw& law) const {
  if (law.thermostat >= 0 && !thermostat_on_[law.thermostat]) return 0.0;
  if (!law.looks_at_state()) return law(inputs_);
  effects::Inputs inputs = inputs_;
  for (int probe : law.probes) inputs.probe_K.push_back(probe_K_[probe]);
  return law.law(inputs);
}

bool HeatRate::set(const Drive& drive, double time_s, std::string_view run) {
  inputs_.run = run;
  inputs_.drive = drive;
  inputs_.time_s = time_s;
  bool changed = !is_set_;
  const auto update = [&](double& value, const BoundLaw& law) {
    if (law.looks_at_state()) return;
    const double now = value_of(law);
    changed |= now != value;
    value = now;
  };
  for (std::size_t s = 0; s < sources_.size(); ++s) update(sources_[s].power_W, system_.sources[s].power_W);
  for (std::size_t e = 0; e < crossings_.size(); ++e) update(crossings_[e].coefficient, system_.exchanges[e].coefficient);
  if (!changed) return false;
  is_set_ = true;
  steady_matrix_ = system_.conduction;
  steady_load_ = Eigen::VectorXd::Zero(system_.size());
  steady_to_ambient_ = steady_load_;
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    if (!system_.sources[s].power_W.looks_at_state()) sources_[s].load.add_to(sources_[s].power_W, steady_load_.data());
  }
  for (std::size_t e = 0; e < crossings_.size(); ++e) {
    const Exchange<SparseRow>& exchange = system_.exchanges[e];
    if (exchange.coefficient.looks_at_state()) continue;
    const Crossing& crossing = crossings_[e];
    for (std::size_t k = 0; k < crossing.slots.size(); ++k) {
      steady_matrix_.valuePtr()[crossing.slots[k]] += crossing.coefficient * exchange.matrix.valuePtr()[k];
    }
    crossing.to_ambient.add_to(crossing.coefficient, steady_to_ambient_.data());
    crossing.offset.add_to(crossing.coefficient, steady_load_.data());
  }
  return true;
}

double HeatRate::of_probe(std::size_t probe, double mean_K, double ambient_K) const {
  return system_.reference_K + mean_K + system_.probes[probe].ambient_share * ambient_K + system_.probes[probe].offset_K;
}

void HeatRate::look_at_state(const double* theta, double ambient_K) {
  for (std::size_t p = 0; p < probes_.size(); ++p) probe_K_[p] = probes_[p].dot(theta);
  if (system_.share) system_.share->sum(probe_K_.data(), static_cast<int>(probe_K_.size()));
  for (std::size_t p = 0; p < probes_.size(); ++p) probe_K_[p] = of_probe(p, probe_K_[p], ambient_K);
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    const HeatSource& source = system_.sources[s];
    if (source.power_W.looks_at_state()) sources_[s].power_W = named(source.name, [&] { return value_of(source.power_W); });
  }
  for (std::size_t e = 0; e < crossings_.size(); ++e) {
    const Exchange<SparseRow>& exchange = system_.exchanges[e];
    if (exchange.coefficient.looks_at_state()) {
      crossings_[e].coefficient = named(exchange.name, [&] { return value_of(exchange.coefficient); });
    }
  }
}

void HeatRate::evaluate(const double* theta, double ambient_K, double* heat_W) {
  const int n = system_.size();
  if (looks_at_state_) look_at_state(theta, ambient_K);
  multiply(steady_matrix_, theta, product_.data());
  for (int i = 0; i < n; ++i) heat_W[i] = steady_load_[i] + ambient_K * steady_to_ambient_[i] - product_[i];
  if (looks_at_state_) {
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      if (system_.sources[s].power_W.looks_at_state()) sources_[s].load.add_to(sources_[s].power_W, heat_W);
    }
    for (std::size_t e = 0; e < crossings_.size(); ++e) {
      const Exchange<SparseRow>& exchange = system_.exchanges[e];
      if (!exchange.coefficient.looks_at_state()) continue;
      const Crossing& crossing = crossings_[e];
      multiply(exchange.matrix, theta, product_.data());
      for (int i = 0; i < n; ++i) heat_W[i] -= crossing.coefficient * product_[i];
      crossing.to_ambient.add_to(crossing.coefficient * ambient_K, heat_W);
      crossing.offset.add_to(crossing.coefficient, heat_W);
    }
  }
  if (!system_.nonlinear.empty()) {
    product_.setZero();
    for (const auto& term : system_.nonlinear) term->add_heat_out(theta, ambient_K, product_.data());
    for (int i = 0; i < n; ++i) heat_W[i] -= product_[i];
  }
}

void HeatRate::flows_W(const double* theta, double ambient_K, double* flows_W) const {
  const bool has_powers = !system_.share || system_.share->is_first;  // every process knows all of them
  for (const Source& s : sources_) *flows_W++ = has_powers ? s.power_W : 0.0;
  for (std::size_t e = 0; e < crossings_.size(); ++e) {
    const Exchange<SparseRow>& exchange = system_.exchanges[e];
    const double crossing_W =
        crossings_[e].coefficient * (crossings_[e].flow.dot(theta) - exchange.ambient_sum * ambient_K - exchange.offset_sum);
    *flows_W++ = exchange.leaves_machine() ? -crossing_W : crossing_W;
  }
  for (const auto& term : system_.nonlinear) {
    if (!term->is_flow()) continue;
    const double out_W = term->heat_out_W(theta, ambient_K);
    *flows_W++ = term->reaches_ambient() ? -out_W : out_W;
  }
}

void HeatRate::flows_along(const double* dtheta, double* dflows_W) const {
  for (std::size_t s = 0; s < sources_.size(); ++s) *dflows_W++ = 0.0;
  for (std::size_t e = 0; e < crossings_.size(); ++e) {
    const double crossing_W = crossings_[e].coefficient * crossings_[e].flow.dot(dtheta);
    *dflows_W++ = system_.exchanges[e].leaves_machine() ? -crossing_W : crossing_W;
  }
  for (const auto& term : system_.nonlinear) {
    if (term->is_flow()) *dflows_W++ = 0.0;
  }
}

std::pair<double, double> HeatRate::power_range_W() const {
  std::pair<double, double> range{0.0, 0.0};
  for (const Source& s : sources_) range = {std::min(range.first, s.power_W), std::max(range.second, s.power_W)};
  return range;
}

const SparseRow& HeatRate::tangent(const double* theta, double ambient_K) {
  if (!looks_at_state_ && system_.nonlinear.empty()) return steady_matrix_;
  tangent_ = steady_matrix_;
  for (std::size_t e = 0; e < crossings_.size(); ++e) {
    const Exchange<SparseRow>& exchange = system_.exchanges[e];
    if (!exchange.coefficient.looks_at_state()) continue;
    for (std::size_t k = 0; k < crossings_[e].slots.size(); ++k) {
      tangent_.valuePtr()[crossings_[e].slots[k]] += crossings_[e].coefficient * exchange.matrix.valuePtr()[k];
    }
  }
  for (const auto& term : system_.nonlinear) term->add_tangent(theta, ambient_K, tangent_);
  return tangent_;
}

double HeatRate::thermostat_probe_K(int i, const double* theta, double ambient_K) const {
  const auto probe = static_cast<std::size_t>(system_.thermostats[i].probe);
  const double mean_K = probes_[probe].dot(theta);
  return of_probe(probe, system_.share ? system_.share->sum(mean_K) : mean_K, ambient_K);
}

}  // namespace driftwright::solver
