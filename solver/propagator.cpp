#include "solver/propagator.hpp"

#include <cmath>
#include <span>
#include <stdexcept>

#include "base/series_in_order.hpp"
#include "solver/stage_ode.hpp"
#include "solver/stretches.hpp"

namespace driftwright::solver {
namespace {

/// Limit of λt for slow modes: below it a and b are differences of large numbers, so series replace them.
constexpr double kSlowMode = 1e-3;

/// φ1 = (1 - e^{-x}) / x, φ2 = (1 - φ1) / x, φ3 = (1/2 - φ2) / x for 0 <= x < kSlowMode, to x^4.
double phi1(double x) {
  return 1.0 - x / 2 * (1.0 - x / 3 * (1.0 - x / 4 * (1.0 - x / 5)));
}
double phi2(double x) {
  return 0.5 - x / 6 * (1.0 - x / 4 * (1.0 - x / 5 * (1.0 - x / 6)));
}
double phi3(double x) {
  return 1.0 / 6 - x / 24 * (1.0 - x / 5 * (1.0 - x / 6 * (1.0 - x / 7)));
}

}  // namespace

struct Propagator::Solution {
  const Eigen::VectorXd& lambda;
  Eigen::VectorXd z0, f0, f1;  // at the stretch's start; load and its slope
  Eigen::VectorXd a, b, w;     // z = a + b t + w e^{-λt}
  std::vector<Eigen::Index> slow;

  Solution(const Eigen::VectorXd& lambda_1_s, Eigen::VectorXd start, Eigen::VectorXd load, Eigen::VectorXd slope,
           double length_s)
      : lambda(lambda_1_s), z0(std::move(start)), f0(std::move(load)), f1(std::move(slope)) {
    for (Eigen::Index i = 0; i < lambda.size(); ++i) {
      if (!(lambda[i] * length_s > kSlowMode)) slow.push_back(i);
    }
    b = f1.cwiseQuotient(lambda);
    a = (f0 - b).cwiseQuotient(lambda);
    w = z0 - a;
  }

  /// z at t, e = e^{-λt}.
  template <class Column>
  void state(double t_s, const Eigen::ArrayXd& e, Column z) const {
    z = a.array() + t_s * b.array() + w.array() * e;
    for (Eigen::Index i : slow) {
      const double x = lambda[i] * t_s;
      z[i] = z0[i] * e[i] + t_s * (phi1(x) * f0[i] + t_s * phi2(x) * f1[i]);
    }
  }
  /// ∫ z from 0 to t.
  template <class Column>
  void integral(double t_s, const Eigen::ArrayXd& e, Column sum) const {
    sum = t_s * (a.array() + 0.5 * t_s * b.array()) + w.array() * (1.0 - e) / lambda.array();
    for (Eigen::Index i : slow) {
      const double x = lambda[i] * t_s;
      sum[i] = t_s * (phi1(x) * z0[i] + t_s * (phi2(x) * f0[i] + t_s * phi3(x) * f1[i]));
    }
  }
  /// z at the columns' times and, unless null, ∫ z up to them. @param start_s  of the stretch
  void at(std::span<const double> times_s, double start_s, Eigen::MatrixXd& states, Eigen::MatrixXd* integrals) const {
    Eigen::ArrayXd e = Eigen::ArrayXd::Ones(lambda.size()), decay(lambda.size());
    double t_s = 0.0, step_s = -1.0;
    for (std::size_t i = 0; i < times_s.size(); ++i) {  // evenly spaced outputs take one exponential per mode
      const auto k = static_cast<Eigen::Index>(i);
      const double now_s = times_s[i] - start_s;
      if (std::abs(now_s - t_s - step_s) > 1e-9 * step_s) {
        step_s = now_s - t_s;
        decay = (-step_s * lambda.array()).exp();
      }
      e *= decay;
      t_s = now_s;
      state(t_s, e, states.col(k));
      if (integrals) integral(t_s, e, integrals->col(k));
    }
  }
};

namespace {

/// @throws SolveError  for a temperature among the outputs that no machine has
void require_sane_outputs(const Trajectory& run, const ReducedSystem& system) {
  for (std::size_t o = 0; o < system.outputs.unit.size() && !run.time_s.empty(); ++o) {
    if (system.outputs.unit[o] != "K") continue;
    const auto row = run.outputs.row(static_cast<Eigen::Index>(o));
    Eigen::Index at = 0;
    const double farthest_K = row.cwiseAbs().maxCoeff(&at), value_K = row[at];
    if (farthest_K > 0.0) require_sane(&value_K, 1, system.reference_K, run.time_s[static_cast<std::size_t>(at)]);
  }
}

}  // namespace

Propagator::Propagator(const ReducedSystem& system) : system_(system), decompositions_(system) {
  if (!system.is_linear()) throw std::logic_error("only linear systems evolve as exponentials");
}

Trajectory Propagator::run(const Cyclogram& cyclogram, const TimeSeries& ambient, const std::vector<double>& output_s,
                           const Eigen::VectorXd& start, bool with_heat, Eigen::MatrixXd* states, double from_s) {
  const auto n = static_cast<Eigen::Index>(system_.size()), n_times = static_cast<Eigen::Index>(output_s.size());
  const auto n_sources = static_cast<Eigen::Index>(system_.sources.size()),
             n_exchanges = static_cast<Eigen::Index>(system_.exchanges.size());
  Trajectory run;
  run.time_s = output_s;
  run.outputs.resize(system_.outputs.state.cols(), n_times);
  if (states) states->resize(n, n_times);
  const bool reads_ambient = (system_.outputs.ambient.array() != 0.0).any();
  Eigen::VectorXd heat_J;  // of every flow up to the start of the stretch
  double initial_J = 0.0;
  if (with_heat) {
    run.flows = flows_of(system_);
    heat_J = Eigen::VectorXd::Zero(n_sources + n_exchanges);
    run.heat_J.resize(n_sources + n_exchanges, n_times);
    run.stored_J.resize(n_times);
    initial_J = system_.ones.dot(start);
  }

  Eigen::VectorXd state = start, coefficient(n_exchanges), power_W(n_sources);
  Eigen::MatrixXd block, integrals;  // z and ∫ z at the outputs of a stretch, in its eigenvectors
  SeriesInOrder ambient_in_order(ambient);
  LawChanges changes(system_.change_times_s);
  const Decomposition* decomposition = nullptr;
  Eigen::VectorXd load;  // of everything except the ambient, in the eigenvectors
  std::size_t next = 0;
  for (const LinearStretch& stretch : behind(from_s, stretches_of(system_, cyclogram, ambient))) {
    const double length_s = stretch.end_s - stretch.start_s, ambient_K = ambient_in_order.at(stretch.start_s),
                 ambient_slope = (ambient_in_order.at(stretch.end_s) - ambient_K) / length_s;
    if (changes.at(stretch)) {
      effects::Inputs at{.drive = stretch.drive, .time_s = stretch.law_time_s()};
      at.run = stretch.run;
      for (Eigen::Index i = 0; i < n_exchanges; ++i)
        coefficient[i] = system_.exchanges[static_cast<std::size_t>(i)].coefficient(at);
      for (Eigen::Index s = 0; s < n_sources; ++s) power_W[s] = system_.sources[static_cast<std::size_t>(s)].power_W(at);
      decomposition = &decompositions_.at(coefficient, with_heat);
      load = decomposition->loads * power_W + decomposition->offset;
    }
    const Decomposition& d = *decomposition;
    const Solution solution(d.lambda_1_s, d.to_modes * state, load + ambient_K * d.to_ambient, ambient_slope * d.to_ambient,
                            length_s);

    std::size_t last = next;
    while (last < output_s.size() && output_s[last] <= stretch.end_s) ++last;
    const auto first_column = static_cast<Eigen::Index>(next), n_columns = static_cast<Eigen::Index>(last - next);
    block.resize(n, n_columns);
    if (with_heat) integrals.resize(n, n_columns);
    solution.at(std::span(output_s).subspan(next, last - next), stretch.start_s, block, with_heat ? &integrals : nullptr);
    run.outputs.middleCols(first_column, n_columns).noalias() = d.outputs * block;
    if (states) states->middleCols(first_column, n_columns).noalias() = d.vectors * block;
    const auto heats_after = [&](double dt_s, const auto& integral) {
      const double ambient_Ks = dt_s * (ambient_K + 0.5 * ambient_slope * dt_s);
      Eigen::VectorXd heat = heat_J;
      heat.head(n_sources) += dt_s * power_W;
      const Eigen::VectorXd crossed = d.flows * integral - ambient_Ks * d.ambient_W_K - dt_s * d.offset_W;
      for (Eigen::Index i = 0; i < n_exchanges; ++i) {
        const bool is_internal = run.flows[static_cast<std::size_t>(n_sources + i)].kind == FlowKind::kInternal;
        heat[n_sources + i] += is_internal ? crossed[i] : -crossed[i];
      }
      return heat;
    };
    for (Eigen::Index k = 0; k < n_columns; ++k) {
      const double now_s = output_s[next + static_cast<std::size_t>(k)];
      if (reads_ambient) run.outputs.col(first_column + k) += ambient.at(now_s) * system_.outputs.ambient;
      if (!with_heat) continue;
      run.heat_J.col(first_column + k) = heats_after(now_s - stretch.start_s, integrals.col(k));
      run.stored_J[first_column + k] = d.stored_J_K.dot(block.col(k)) - initial_J;
    }
    next = last;

    const Eigen::ArrayXd e = (-length_s * d.lambda_1_s.array()).exp();
    Eigen::VectorXd z(n);
    if (with_heat) {
      solution.integral(length_s, e, z.head(n));
      heat_J = heats_after(length_s, z);
    }
    solution.state(length_s, e, z.head(n));
    state.noalias() = d.vectors * z;
  }
  require_sane_outputs(run, system_);
  return run;
}

}  // namespace driftwright::solver
