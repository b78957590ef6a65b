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

/// z over one stretch, in the eigenvectors. Slow modes, of which a and b would be differences of large numbers, have a, b
/// and w of 0 and are added apart.
struct Propagator::Solution {
  const Eigen::VectorXd& lambda;
  Eigen::VectorXd z0, f0, f1;  // at the stretch's start; load and its slope
  Eigen::VectorXd a, b, w;     // z = a + b t + w e^{-λt}
  std::vector<Eigen::Index> slow;

  Solution(const Eigen::VectorXd& lambda_1_s, Eigen::VectorXd start, Eigen::VectorXd load, Eigen::VectorXd slope,
           double length_s)
      : lambda(lambda_1_s), z0(std::move(start)), f0(std::move(load)), f1(std::move(slope)) {
    b = f1.cwiseQuotient(lambda);
    a = (f0 - b).cwiseQuotient(lambda);
    w = z0 - a;
    for (Eigen::Index i = 0; i < lambda.size(); ++i) {
      if (lambda[i] * length_s > kSlowMode) continue;
      slow.push_back(i);
      a[i] = b[i] = w[i] = 0.0;
    }
  }

  [[nodiscard]] double slow_state(Eigen::Index i, double t_s) const {
    const double x = lambda[i] * t_s;
    return z0[i] * std::exp(-x) + t_s * (phi1(x) * f0[i] + t_s * phi2(x) * f1[i]);
  }
  [[nodiscard]] double slow_integral(Eigen::Index i, double t_s) const {
    const double x = lambda[i] * t_s;
    return t_s * (phi1(x) * z0[i] + t_s * (phi2(x) * f0[i] + t_s * phi3(x) * f1[i]));
  }
  [[nodiscard]] Eigen::VectorXd decay(double t_s) const { return (-t_s * lambda.array()).exp(); }
  /// z at t. @param e  decay(t)
  [[nodiscard]] Eigen::VectorXd state(double t_s, const Eigen::VectorXd& e) const {
    Eigen::VectorXd z = a.array() + t_s * b.array() + w.array() * e.array();
    for (Eigen::Index i : slow) z[i] = slow_state(i, t_s);
    return z;
  }
  /// The rows' products with z, without the slow modes.
  [[nodiscard]] SumsOfDecays states_of(const Eigen::MatrixXd& rows) const {
    SumsOfDecays sums;
    sums.factors.resize(rows.rows(), SumsOfDecays::kPowers + lambda.size());
    sums.curve().setZero();
    sums.constant().noalias() = rows * a;
    sums.slope().noalias() = rows * b;
    sums.factors.rightCols(lambda.size()) = rows * w.asDiagonal();
    return sums;
  }
  /// The rows' products with ∫ z, likewise.
  [[nodiscard]] SumsOfDecays integrals_of(const Eigen::MatrixXd& rows) const {
    Eigen::VectorXd u = w.cwiseQuotient(lambda);
    for (Eigen::Index i : slow) u[i] = 0.0;
    SumsOfDecays sums;
    sums.factors.resize(rows.rows(), SumsOfDecays::kPowers + lambda.size());
    sums.curve().noalias() = 0.5 * (rows * b);
    sums.constant().noalias() = rows * u;
    sums.slope().noalias() = rows * a;
    sums.factors.rightCols(lambda.size()) = rows * (-u).asDiagonal();
    return sums;
  }
};

namespace {

/// @throws SolveError  for a temperature among the outputs that no machine has
void require_sane_outputs(const Trajectory& run, const ReducedSystem& system) {
  Eigen::ArrayXd farthest_K = Eigen::ArrayXd::Zero(run.outputs.rows());
  for (Eigen::Index k = 0; k < run.outputs.cols(); ++k) farthest_K = farthest_K.max(run.outputs.col(k).array().abs());
  for (std::size_t o = 0; o < system.outputs.unit.size(); ++o) {
    const auto row = static_cast<Eigen::Index>(o);
    if (system.outputs.unit[o] != "K" || farthest_K[row] < system.reference_K) continue;
    Eigen::Index at = 0;
    run.outputs.row(row).cwiseAbs().maxCoeff(&at);
    const double value_K = run.outputs(row, at);
    require_sane(&value_K, 1, system.reference_K, run.time_s[static_cast<std::size_t>(at)]);
  }
}

}  // namespace

Propagator::Propagator(const ReducedSystem& system) : system_(system), decompositions_(system) {
  if (!system.is_linear()) throw std::logic_error("only linear systems evolve as exponentials");
}

Trajectory Propagator::run(const Cyclogram& cyclogram, const TimeSeries& ambient, const std::vector<double>& output_s,
                           const Eigen::VectorXd& start, bool with_heat, Eigen::MatrixXd* states, double from_s) {
  return run(behind(from_s, stretches_of(system_, cyclogram, ambient)), ambient, output_s, start, with_heat, states);
}

Trajectory Propagator::run(const std::vector<LinearStretch>& stretches, const TimeSeries& ambient,
                           const std::vector<double>& output_s, const Eigen::VectorXd& start, bool with_heat,
                           Eigen::MatrixXd* states) {
  const auto n = static_cast<Eigen::Index>(system_.size()), n_times = static_cast<Eigen::Index>(output_s.size());
  const auto n_sources = static_cast<Eigen::Index>(system_.sources.size()),
             n_exchanges = static_cast<Eigen::Index>(system_.exchanges.size());
  Trajectory run;
  run.time_s = output_s;
  run.outputs.resize(system_.outputs.state.cols(), n_times);
  if (states) states->resize(n, n_times);
  Eigen::VectorXd heat_J, inwards;  // of every flow up to the start of the stretch; sign of each exchange's flow
  double initial_J = 0.0;
  if (with_heat) {
    run.flows = flows_of(system_);
    heat_J = Eigen::VectorXd::Zero(n_sources + n_exchanges);
    run.heat_J.resize(n_sources + n_exchanges, n_times);
    run.stored_J.resize(n_times);
    initial_J = system_.ones.dot(start);
    inwards.resize(n_exchanges);
    for (Eigen::Index i = 0; i < n_exchanges; ++i)
      inwards[i] = run.flows[static_cast<std::size_t>(n_sources + i)].kind == FlowKind::kInternal ? 1.0 : -1.0;
  }

  Eigen::VectorXd coefficient(n_exchanges), power_W(n_sources);
  SeriesInOrder ambient_in_order(ambient);
  LawChanges changes(system_.change_times_s);
  Decomposition* decomposition = nullptr;
  Eigen::VectorXd z, load;  // state and load of everything except the ambient, in the eigenvectors
  std::size_t next = 0;
  require_within(stretches, output_s);
  for (const LinearStretch& stretch : stretches) {
    const double length_s = stretch.end_s - stretch.start_s, ambient_K = ambient_in_order.at(stretch.start_s),
                 ambient_slope = (ambient_in_order.at(stretch.end_s) - ambient_K) / length_s;
    if (changes.at(stretch)) {
      effects::Inputs at{.drive = stretch.drive, .time_s = stretch.law_time_s()};
      at.run = stretch.run;
      for (Eigen::Index i = 0; i < n_exchanges; ++i)
        coefficient[i] = system_.exchanges[static_cast<std::size_t>(i)].coefficient(at);
      for (Eigen::Index s = 0; s < n_sources; ++s) power_W[s] = system_.sources[static_cast<std::size_t>(s)].power_W(at);
      if (!decomposition || coefficient != decomposition->coefficient) {
        const Eigen::VectorXd state = decomposition ? Eigen::VectorXd(decomposition->vectors * z) : start;
        decomposition = &decompositions_.at(coefficient, with_heat);
        z.noalias() = decomposition->to_modes * state;
      }
      load = decomposition->loads * power_W + decomposition->offset;
    }
    Decomposition& d = *decomposition;
    const Solution solution(d.lambda_1_s, std::move(z), load + ambient_K * d.to_ambient, ambient_slope * d.to_ambient,
                            length_s);

    std::size_t last = next;
    while (last < output_s.size() && output_s[last] <= stretch.end_s) ++last;
    const auto first_column = static_cast<Eigen::Index>(next), n_columns = static_cast<Eigen::Index>(last - next);
    const std::span now_s = std::span(output_s).subspan(next, last - next);
    next = last;
    // Sums at the outputs of this stretch, with the slow modes' share of the rows they were made of. An output at its start
    // is taken as it is: a machine at rest there has 0, and not what is left of sums that cancel.
    const bool begins_here = n_columns > 0 && now_s.front() == stretch.start_s;
    const auto write = [&](const SumsOfDecays& sums, const Eigen::MatrixXd& rows, auto slow_value, auto out, auto at_start) {
      d.decays.values(sums, d.lambda_1_s, now_s, stretch.start_s, out);
      for (Eigen::Index i : solution.slow) {
        for (Eigen::Index k = 0; k < n_columns; ++k)
          out.col(k) += slow_value(i, now_s[static_cast<std::size_t>(k)] - stretch.start_s) * rows.col(i);
      }
      if (begins_here) out.col(0) = at_start();
    };
    const auto slow_state = [&](Eigen::Index i, double t_s) { return solution.slow_state(i, t_s); };
    const auto slow_integral = [&](Eigen::Index i, double t_s) { return solution.slow_integral(i, t_s); };
    SumsOfDecays outputs = solution.states_of(d.outputs);
    outputs.constant() += ambient_K * system_.outputs.ambient;
    outputs.slope() += ambient_slope * system_.outputs.ambient;
    write(outputs, d.outputs, slow_state, run.outputs.middleCols(first_column, n_columns),
          [&] { return Eigen::VectorXd(d.outputs * solution.z0 + ambient_K * system_.outputs.ambient); });
    if (states)
      write(solution.states_of(d.vectors), d.vectors, slow_state, states->middleCols(first_column, n_columns),
            [&] { return Eigen::VectorXd(d.vectors * solution.z0); });
    const Eigen::VectorXd e = solution.decay(length_s);
    if (with_heat) {
      const Eigen::MatrixXd flows = inwards.asDiagonal() * d.flows;
      SumsOfDecays heats = solution.integrals_of(flows);
      const Eigen::VectorXd from_ambient = inwards.cwiseProduct(d.ambient_W_K);
      heats.constant() += heat_J.tail(n_exchanges);
      heats.slope() -= ambient_K * from_ambient + inwards.cwiseProduct(d.offset_W);
      heats.curve() -= 0.5 * ambient_slope * from_ambient;
      write(heats, flows, slow_integral, run.heat_J.bottomRows(n_exchanges).middleCols(first_column, n_columns),
            [&] { return heat_J.tail(n_exchanges); });
      for (Eigen::Index k = 0; k < n_columns; ++k) {
        const double t_s = now_s[static_cast<std::size_t>(k)] - stretch.start_s;
        run.heat_J.col(first_column + k).head(n_sources) = heat_J.head(n_sources) + t_s * power_W;
      }
      heat_J.head(n_sources) += length_s * power_W;
      heat_J.tail(n_exchanges) = heats.at(length_s, e);
      for (Eigen::Index i : solution.slow) heat_J.tail(n_exchanges) += solution.slow_integral(i, length_s) * flows.col(i);
      SumsOfDecays stored = solution.states_of(d.stored_J_K);
      stored.constant().array() -= initial_J;
      Eigen::MatrixXd stored_J(1, n_columns);
      write(stored, d.stored_J_K, slow_state, stored_J.middleCols(0, n_columns),
            [&] { return Eigen::VectorXd::Constant(1, (d.stored_J_K * solution.z0).value() - initial_J); });
      run.stored_J.segment(first_column, n_columns) = stored_J.transpose();
    }
    z = solution.state(length_s, e);
  }
  require_sane_outputs(run, system_);
  return run;
}

}  // namespace driftwright::solver
