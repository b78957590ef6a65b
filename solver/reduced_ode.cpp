#include "solver/reduced_ode.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/errors.hpp"

namespace driftwright::solver {
namespace {

constexpr int kMostNewtonIterations = 12;
// Relative difference of an exchange from its value in the diagonal, up to which the diagonal is kept.
constexpr double kServes = 0.3;
constexpr double kNewtonShareOfTolerance = 0.02;  // errors of Newton's iterations must not affect the step size

}  // namespace

ReducedOde::ReducedOde(const ReducedSystem& system, const TimeSeries& ambient)
    : system_(system),
      ambient_(ambient),
      n_(system.size()),
      flows_(flows_of(system)),
      decompositions_(system),
      is_on_(system.thermostats.size(), 0),
      power_W_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(system.sources.size()))),
      probes_(n_, static_cast<Eigen::Index>(system.probes.size())),
      at_start_(size()),
      latest_(size()),
      heat_(n_),
      flow_W_(static_cast<Eigen::Index>(flows_.size())) {
  if (!system.mass.isIdentity(1e-8))
    throw std::logic_error("ReducedOde: the mass matrix must be the unit matrix, see with_unit_mass()");
  for (std::size_t s = 0; s < system.sources.size(); ++s) {
    if (system.sources[s].power_W.looks_at_state()) live_sources_.push_back({s, 0.0, {}});
  }
  for (std::size_t e = 0; e < system.exchanges.size(); ++e) {
    if (!system.exchanges[e].coefficient.looks_at_state()) continue;
    const Eigen::MatrixXd& g = system.exchanges[e].matrix;
    const auto same = std::find_if(matrices_.begin(), matrices_.end(), [&](const auto& m) { return *m.of_system == g; });
    live_exchanges_.push_back({.index = e, .matrix = static_cast<std::size_t>(same - matrices_.begin())});
    if (same == matrices_.end()) matrices_.push_back({&g});
  }
  const auto look_at = [&](const BoundLaw& law) {
    for (int p : law.probes) looked_at_.push_back(static_cast<std::size_t>(p));
  };
  for (const HeatSource& s : system.sources) look_at(s.power_W);
  for (const auto& e : system.exchanges) look_at(e.coefficient);
  std::sort(looked_at_.begin(), looked_at_.end());
  looked_at_.erase(std::unique(looked_at_.begin(), looked_at_.end()), looked_at_.end());
  probe_K_.resize(system.probes.size());
}

void ReducedOde::begin(const Eigen::VectorXd& start, double* y) {
  std::copy(start.data(), start.data() + n_, y);
  std::fill(y + n_, y + size(), 0.0);
  began_J_ = system_.ones.dot(start);
  for (std::size_t p = 0; p < system_.probes.size(); ++p)
    probes_.col(static_cast<Eigen::Index>(p)) = system_.probes[p].weights;
  for (std::size_t i = 0; i < is_on_.size(); ++i) {
    is_on_[i] = 0;
    is_on_[i] = distance_to_switch_K(static_cast<int>(i), 0.0, y) > 0.0 ? 1 : 0;
  }
}

void ReducedOde::tolerances(double absolute_K, double* tolerance) const {
  double per_unit_K = 1.0 / system_.ones.norm();
  for (std::size_t o = 0; o < system_.outputs.unit.size(); ++o) {
    const double scale_per_K = system_.outputs.unit[o] == "K" ? 1.0 : system_.outputs.unit[o] == "m" ? 2e-6 : 2e-5;
    per_unit_K = std::max(per_unit_K, system_.outputs.state.col(static_cast<Eigen::Index>(o)).norm() / scale_per_K);
  }
  std::fill(tolerance, tolerance + n_, absolute_K / per_unit_K);
  std::fill(tolerance + n_, tolerance + size(), 1e30);
}

double ReducedOde::value(const BoundLaw& law) {
  if (law.thermostat >= 0 && !is_on_[static_cast<std::size_t>(law.thermostat)]) return 0.0;
  inputs_.probe_K.clear();
  if (!law.looks_at_state()) return law(inputs_);
  for (int p : law.probes) inputs_.probe_K.push_back(probe_K_[static_cast<std::size_t>(p)]);
  return law.law(inputs_);
}

void ReducedOde::probe(const Eigen::VectorXd& w, double ambient_K) {
  for (std::size_t p : looked_at_) {
    const Probe& probe = system_.probes[p];
    probe_K_[p] = system_.reference_K + probes_.col(static_cast<Eigen::Index>(p)).dot(w) + probe.ambient_share * ambient_K +
                  probe.offset_K;
  }
}

bool ReducedOde::begin_stretch(const LinearStretch& stretch, double* y) {
  inputs_.drive = stretch.drive;
  inputs_.run = stretch.run;
  inputs_.time_s = stretch.law_time_s();
  inputs_.ambient_K = ambient_.at(stretch.start_s);
  Eigen::VectorXd coefficient = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(system_.exchanges.size())),
                  power_W = Eigen::VectorXd::Zero(power_W_.size());
  for (std::size_t s = 0; s < system_.sources.size(); ++s) {
    const BoundLaw& law = system_.sources[s].power_W;
    if (!law.looks_at_state()) power_W[static_cast<Eigen::Index>(s)] = value(law);
  }
  for (std::size_t e = 0; e < system_.exchanges.size(); ++e) {
    const BoundLaw& law = system_.exchanges[e].coefficient;
    if (!law.looks_at_state()) coefficient[static_cast<Eigen::Index>(e)] = value(law);
  }
  bool jumps = is_first_ || power_W != power_W_;
  for (std::size_t e = 0; e < system_.exchanges.size() && !jumps; ++e) {
    const auto i = static_cast<Eigen::Index>(e);
    jumps = !system_.exchanges[e].coefficient.looks_at_state() && coefficient[i] != now_.coefficient[i];
  }
  // Laws that depend on temperature may also jump with the drive or a switch.
  jumps = jumps || ((stretch.drive_changed || !is_on_.empty()) && !(live_sources_.empty() && live_exchanges_.empty()));
  if (!jumps) return false;
  power_W_ = power_W;
  const Eigen::VectorXd z = state(y);
  const auto weights_of_probes = [&](const Eigen::MatrixXd& v) {
    for (std::size_t p = 0; p < system_.probes.size(); ++p) {
      probes_.col(static_cast<Eigen::Index>(p)).noalias() = v.transpose() * system_.probes[p].weights;
    }
  };
  weights_of_probes(Eigen::MatrixXd::Identity(n_, n_));
  probe(z, inputs_.ambient_K);
  bool serves = !is_first_;  // true if the present diagonal can be kept
  for (const LiveExchange& live : live_exchanges_) {
    double& c = coefficient[static_cast<Eigen::Index>(live.index)];
    c = std::max(0.0, value(system_.exchanges[live.index].coefficient));
    serves = serves && std::abs(c - live.in_diagonal) <= kServes * live.in_diagonal;
  }
  for (const LiveExchange& live : live_exchanges_) {
    if (serves) coefficient[static_cast<Eigen::Index>(live.index)] = live.in_diagonal;
  }
  if (serves && coefficient == now_.coefficient) {
    weights_of_probes(now_.vectors);
    return true;
  }
  for (LiveExchange& live : live_exchanges_) live.in_diagonal = coefficient[static_cast<Eigen::Index>(live.index)];
  now_ = decompositions_.at(coefficient);
  const Eigen::MatrixXd& v = now_.vectors;
  weights_of_probes(v);
  for (LiveExchange& live : live_exchanges_) {
    const auto& e = system_.exchanges[live.index];
    live.to_ambient.noalias() = v.transpose() * e.to_ambient;
    live.offset = e.offset.size() > 0 ? Eigen::VectorXd(v.transpose() * e.offset) : Eigen::VectorXd::Zero(n_);
    live.flow.noalias() = v.transpose() * e.flow;
  }
  Eigen::Map<Eigen::VectorXd>(y, n_) = v.transpose() * z;
  is_first_ = false;
  return true;
}

void ReducedOde::restart(double, const double*) {
  has_jumped_ = true;
}

double ReducedOde::distance_to_switch_K(int i, double t_s, const double* y) const {
  const Thermostat& thermostat = system_.thermostats[static_cast<std::size_t>(i)];
  const Probe& probe = system_.probes[static_cast<std::size_t>(thermostat.probe)];
  const double t_K = system_.reference_K + probes_.col(thermostat.probe).dot(unknowns(y)) +
                     probe.ambient_share * ambient_.at(t_s) + probe.offset_K;
  return t_K - (is_on_[static_cast<std::size_t>(i)] ? thermostat.off_below_K : thermostat.on_above_K);
}

void ReducedOde::find_laws(double t_s, const Eigen::VectorXd& w) {
  inputs_.ambient_K = ambient_.at(t_s);
  probe(w, inputs_.ambient_K);
  for (LiveSource& live : live_sources_) {
    power_W_[static_cast<Eigen::Index>(live.index)] = live.power_W = value(system_.sources[live.index].power_W);
  }
  for (LiveExchange& live : live_exchanges_) live.coefficient = value(system_.exchanges[live.index].coefficient);
}

void ReducedOde::find_heat(const Eigen::VectorXd& w) {
  const double ambient_K = inputs_.ambient_K;
  heat_ = now_.offset + ambient_K * now_.to_ambient - now_.lambda_1_s.cwiseProduct(w);
  heat_.noalias() += now_.loads * power_W_;
  if (matrices_.empty()) return;
  for (ExchangeMatrix& m : matrices_) m.beyond = 0.0;
  for (const LiveExchange& live : live_exchanges_) {
    const double beyond = live.coefficient - live.in_diagonal;
    matrices_[live.matrix].beyond += beyond;
    heat_ += beyond * (ambient_K * live.to_ambient + live.offset);
  }
  z_.noalias() = now_.vectors * w;
  exchanged_.setZero(n_);
  for (const ExchangeMatrix& m : matrices_) {
    if (m.beyond != 0.0) exchanged_.noalias() += m.beyond * *m.of_system * z_;
  }
  heat_.noalias() -= now_.vectors.transpose() * exchanged_;
}

void ReducedOde::find_flows(const Eigen::VectorXd& w) {
  const double ambient_K = inputs_.ambient_K;
  const Eigen::Index n_sources = power_W_.size(), n_exchanges = now_.ambient_W_K.size();
  flow_W_.head(n_sources) = power_W_;
  flow_W_.tail(n_exchanges).noalias() = now_.flows * w;
  flow_W_.tail(n_exchanges) -= ambient_K * now_.ambient_W_K + now_.offset_W;
  for (const LiveExchange& live : live_exchanges_) {
    const auto& e = system_.exchanges[live.index];
    flow_W_[n_sources + static_cast<Eigen::Index>(live.index)] =
        live.coefficient * (live.flow.dot(w) - e.ambient_sum * ambient_K - e.offset_sum);
  }
  for (Eigen::Index j = n_sources; j < flow_W_.size(); ++j) {
    if (flows_[static_cast<std::size_t>(j)].kind != FlowKind::kInternal) flow_W_[j] = -flow_W_[j];
  }
}

void ReducedOde::find_slopes(double t_s, const Eigen::VectorXd& w) {
  constexpr double kHalfStep_K = 0.01;
  probe(w, ambient_.at(t_s));
  for (LiveSource& live : live_sources_) {
    const BoundLaw& law = system_.sources[live.index].power_W;
    live.slope = Eigen::VectorXd::Zero(n_);
    for (int p : law.probes) {
      double& probe_K = probe_K_[static_cast<std::size_t>(p)];
      const double here_K = probe_K;
      probe_K = here_K + kHalfStep_K;
      const double above = value(law);
      probe_K = here_K - kHalfStep_K;
      const double below = value(law);
      probe_K = here_K;
      live.slope += (above - below) / (2.0 * kHalfStep_K) * probes_.col(p);
    }
  }
}

void ReducedOde::slopes(double t_s, const double* y, double* ydot) {
  is_rough_ = has_jumped_;
  has_jumped_ = false;
  const Eigen::VectorXd w = unknowns(y);
  find_laws(t_s, w);
  find_heat(w);
  find_flows(w);
  find_slopes(t_s, w);
  at_start_ << heat_, flow_W_;
  std::copy(at_start_.data(), at_start_.data() + size(), ydot);
}

bool ReducedOde::solve_stage(double t_s, double gamma, const double* predicted, const double* s, const double* weight,
                             double* c) {
  const Map base(predicted, n_), gathered(s, n_), scale(weight, n_);
  const Eigen::VectorXd damping = (1.0 + gamma * now_.lambda_1_s.array()).inverse();
  const auto n_live = static_cast<Eigen::Index>(live_sources_.size());
  Eigen::MatrixXd along(n_, n_live), slopes(n_, n_live);  // D b_s, dP_s/dw
  for (Eigen::Index k = 0; k < n_live; ++k) {
    const LiveSource& live = live_sources_[static_cast<std::size_t>(k)];
    along.col(k) = damping.cwiseProduct(now_.loads.col(static_cast<Eigen::Index>(live.index)));
    slopes.col(k) = live.slope;
  }
  const Eigen::PartialPivLU<Eigen::MatrixXd> coupling(Eigen::MatrixXd::Identity(n_live, n_live) -
                                                      gamma * slopes.transpose() * along);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n_), w(n_);
  bool converged = false;
  for (int i = 0; i < kMostNewtonIterations && !converged; ++i) {
    w = base + x;
    find_laws(t_s, w);
    find_heat(w);
    Eigen::VectorXd step = damping.cwiseProduct(gathered + gamma * heat_ - x);
    if (n_live > 0) step += gamma * along * coupling.solve(slopes.transpose() * step);
    x += step;
    ++n_iterations_;
    const double size_of_step = std::sqrt(step.cwiseProduct(scale).squaredNorm() / n_);
    if (!std::isfinite(size_of_step)) return false;
    converged = size_of_step <= kNewtonShareOfTolerance || (live_sources_.empty() && live_exchanges_.empty());
  }
  ++n_solves_;
  if (!converged) return false;
  // Heats use the flows of the state found: stage values and balance agree up to the size of the last step, which is linear
  // in it.
  w = base + x;
  find_laws(t_s, w);
  find_flows(w);
  std::copy(x.data(), x.data() + n_, c);
  for (Eigen::Index j = 0; j < flow_W_.size(); ++j) c[n_ + j] = s[n_ + j] + gamma * flow_W_[j];
  for (int i = 0; i < size(); ++i) latest_[i] = (c[i] - s[i]) / gamma;
  return true;
}

void ReducedOde::look(double t_s, const double* y) {
  const Eigen::VectorXd outputs = now_.outputs * unknowns(y);
  for (std::size_t o = 0; o < system_.outputs.unit.size(); ++o) {
    if (system_.outputs.unit[o] == "K") require_sane(&outputs[static_cast<Eigen::Index>(o)], 1, system_.reference_K, t_s);
  }
}

Eigen::VectorXd ReducedOde::observe(const double* y, double ambient_K) const {
  return now_.outputs * unknowns(y) + ambient_K * system_.outputs.ambient;
}

Eigen::VectorXd ReducedOde::state(const double* y) const {
  if (is_first_) return unknowns(y);
  return now_.vectors * unknowns(y);
}

Eigen::VectorXd ReducedOde::heats_J(const double* y) const {
  return Map(y + n_, static_cast<Eigen::Index>(flows_.size()));
}

double ReducedOde::stored_J(const double* y) const {
  return now_.stored_J_K.dot(unknowns(y)) - began_J_;
}

}  // namespace driftwright::solver
