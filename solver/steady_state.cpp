#include "solver/steady_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.hpp"
#include "solver/conduction_factor.hpp"
#include "solver/heat_rate.hpp"

namespace driftwright::solver {
namespace {

/// Advances θ along a step as far as laws are defined: the whole step, or a half, a quarter, ... Leaves the rate evaluated
/// at the new state.
/// @throws RangeError  of the law that refuses the last of forty halvings
void advance(HeatRate& rate, double ambient_K, const Eigen::VectorXd& step, double share, Eigen::VectorXd& theta,
             Eigen::VectorXd& heat) {
  const Eigen::VectorXd from = theta;
  constexpr int kMostHalvings = 40;
  for (int halving = 0;; ++halving, share *= 0.5) {
    theta = from + share * step;
    try {
      rate.evaluate(theta.data(), ambient_K, heat.data());
      return;
    } catch (const RangeError&) {  // a trial state at which some law is undefined
      if (halving == kMostHalvings) throw;
    }
  }
}

/// @throws InputError  if a thermostat would switch at the temperatures that its setting leads to
void require_thermostats_at_rest(const FullSystem& system, const HeatRate& rate, const Eigen::VectorXd& theta,
                                 double ambient_K) {
  for (std::size_t i = 0; i < system.thermostats.size(); ++i) {
    const Thermostat& thermostat = system.thermostats[i];
    const bool on = rate.thermostat_is_on(static_cast<int>(i));
    const double probe_K = rate.thermostat_probe_K(static_cast<int>(i), theta.data(), ambient_K);
    if (on ? probe_K >= thermostat.off_below_K : probe_K <= thermostat.on_above_K) continue;
    throw InputError(
        fmt::format("there is no steady state: thermostat '{}' switches {} on the way there, to {:.1f} K with it "
                    "{}. Start at the ambient's or at a given temperature",
                    thermostat.name, on ? "off" : "on", probe_K, on ? "on" : "off"));
  }
}

}  // namespace

Eigen::VectorXd steady_state(const FullSystem& system, const effects::Inputs& at, const Eigen::VectorXd& start) {
  constexpr int kMostIterations = 200;
  HeatRate rate(system);
  Eigen::VectorXd theta = start, heat(system.size()), last_step;
  for (std::size_t i = 0; i < system.thermostats.size(); ++i) {
    const int t = static_cast<int>(i);
    rate.set_thermostat(t, rate.thermostat_probe_K(t, start.data(), at.ambient_K) > system.thermostats[i].on_above_K);
  }
  rate.set(at.drive, at.time_s, at.run);
  std::vector<char> is_fixed(system.size(), 0);
  for (const FixedUnknowns& f : system.fixed) {
    for (int i : f.unknowns) {
      is_fixed[i] = 1;
      theta[i] = f.follows_ambient ? at.ambient_K : f.theta.at(at.time_s);
    }
  }
  rate.evaluate(theta.data(), at.ambient_K, heat.data());
  double largest_K = 0.0, last_moved_K = std::numeric_limits<double>::infinity(), share = 1.0;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    SparseRow k = rate.tangent(theta.data(), at.ambient_K);
    if (iteration == 0) require_way_out(k, is_fixed);
    for (int row = 0; row < system.size(); ++row) {
      if (is_fixed[row]) heat[row] = 0.0;
      for (SparseRow::InnerIterator entry(k, row); entry; ++entry) {
        if (is_fixed[row] || is_fixed[entry.col()]) entry.valueRef() = entry.col() == row ? 1.0 : 0.0;
      }
    }
    const ConductionFactor factor(k);
    const Eigen::VectorXd step = factor.solve(heat);
    const double moved_K = step.cwiseAbs().maxCoeff();
    if (!std::isfinite(moved_K)) break;
    // K does not contain the slope of laws: where it is steeper than K, whole steps would oscillate with growing amplitude.
    // Steps that shrink slowly in one direction are those of a liquid that carries heat from body to body.
    const bool turns = iteration > 0 && step.dot(last_step) < 0.0;
    if (moved_K > last_moved_K || (turns && moved_K > 0.9 * last_moved_K)) share = std::max(0.5 * share, 1.0 / 64.0);
    last_moved_K = moved_K;
    last_step = step;
    try {
      advance(rate, at.ambient_K, step, share, theta, heat);
    } catch (const RangeError& e) {
      throw SolveError(fmt::format("no steady state where every law is defined: {}", e.what()));
    }
    largest_K = std::max({largest_K, theta.cwiseAbs().maxCoeff(), std::abs(at.ambient_K)});
    if (moved_K <= 1e-10 * largest_K) {
      require_thermostats_at_rest(system, rate, theta, at.ambient_K);
      return theta;
    }
  }
  throw SolveError(fmt::format(
      "no steady state after {} iterations; is a law of temperature too steep, or the start far off?", kMostIterations));
}

void require_linearisable(const FullSystem& system) {
  if (!system.thermostats.empty()) {
    throw InputError(fmt::format("thermostat '{}' switches; a linear model (thermal modes) cannot follow it. `simulate` can",
                                 system.thermostats.front().name));
  }
  for (const FixedUnknowns& f : system.fixed) {
    if (!f.follows_ambient && f.theta.value.size() > 1) {
      throw InputError(fmt::format(
          "{} is prescribed over time; a linear model (thermal modes) cannot follow it. `simulate` can", f.name));
    }
  }
}

void freeze_laws(FullSystem& system, const effects::Inputs& at, const Eigen::VectorXd& theta) {
  const auto freeze = [&](BoundLaw& law) {
    for (int p : law.probes) law.frozen_K.push_back(system.reference_K + system.probes[p].theta_K(theta, at.ambient_K));
    law.probes.clear();
  };
  for (HeatSource& s : system.sources) freeze(s.power_W);
  for (auto& e : system.exchanges) freeze(e.coefficient);
}

void hold_by_exchanges(FullSystem& system) {
  const effects::Law one([](const effects::Inputs&) { return 1.0; });
  const int n = system.size();
  const double stiff_W_K = 1e6 * system.conduction.diagonal().maxCoeff() + 1e6;
  for (const FixedUnknowns& f : system.fixed) {
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd members = Eigen::VectorXd::Zero(n);
    for (int i : f.unknowns) {
      entries.emplace_back(i, i, stiff_W_K);
      members[i] = stiff_W_K;
    }
    Exchange<SparseRow> e;
    e.name = f.name;
    e.matrix = SparseRow(n, n);
    e.to_ambient = Eigen::VectorXd::Zero(n);
    e.coefficient = one;
    e.flow = members;
    e.matrix.setFromTriplets(entries.begin(), entries.end());
    if (f.follows_ambient) {
      e.to_ambient = members;
      e.ambient_sum = members.sum();
    } else {
      e.offset = f.theta.value.front() * members;
      e.offset_sum = e.offset.sum();
    }
    e.prescribes = true;
    system.exchanges.push_back(std::move(e));
  }
  system.fixed.clear();
}

FullSystem linearised(const FullSystem& system, const effects::Inputs& at, const Eigen::VectorXd& theta) {
  require_linearisable(system);
  FullSystem linear = system;
  freeze_laws(linear, at, theta);
  const effects::Law one([](const effects::Inputs&) { return 1.0; });
  const int n = system.size();
  for (const auto& term : system.nonlinear) {  // r(θ) ≈ r0 + J (θ - θ0) + dr/dθ_ambient (θ_ambient - θ_ambient0)
    Exchange<SparseRow> e;
    e.name = term->name;
    e.matrix = system.conduction;
    e.to_ambient = Eigen::VectorXd::Zero(n);
    e.coefficient = one;
    e.flow = Eigen::VectorXd::Zero(n);
    std::fill(e.matrix.valuePtr(), e.matrix.valuePtr() + e.matrix.nonZeros(), 0.0);
    term->add_tangent(theta.data(), at.ambient_K, e.matrix);
    Eigen::VectorXd heat_out = Eigen::VectorXd::Zero(n);
    term->add_heat_out(theta.data(), at.ambient_K, heat_out.data());
    e.offset = e.matrix * theta - heat_out;
    if (term->reaches_ambient()) {  // slope over the ambient: a surrounding of another temperature radiates differently
      constexpr double kHalfStep_K = 0.05;
      Eigen::VectorXd below = Eigen::VectorXd::Zero(n), above = below;
      term->add_heat_out(theta.data(), at.ambient_K - kHalfStep_K, below.data());
      term->add_heat_out(theta.data(), at.ambient_K + kHalfStep_K, above.data());
      e.to_ambient = (below - above) / (2.0 * kHalfStep_K);
      e.ambient_sum = e.to_ambient.sum();
      e.offset -= at.ambient_K * e.to_ambient;
      e.flow = e.matrix * Eigen::VectorXd::Ones(n);
    }
    e.offset_sum = e.offset.sum();
    linear.exchanges.push_back(std::move(e));
  }
  linear.nonlinear.clear();
  if (system.capacity) system.capacity->add_to(theta.data(), linear.mass);
  linear.capacity.reset();
  hold_by_exchanges(linear);
  return linear;
}

}  // namespace driftwright::solver
