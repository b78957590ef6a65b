#include "solver/krylov_reduction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "base/dense.hpp"
#include "base/errors.hpp"
#include "solver/conduction_factor.hpp"
#include "solver/pose_reduction.hpp"
#include "solver/reduced_model.hpp"

namespace driftwright::solver {
namespace {

constexpr int kWhole = 100;  // unknowns; a system up to this size is not reduced
// Time scale of the fastest response that the basis represents; outputs are minutes apart.
constexpr double kShortest_s = 15.0;

std::vector<double> log_spaced(double from, double to, int n) {
  std::vector<double> values;
  for (int i = 0; i < n; ++i) values.push_back(from * std::pow(to / from, i / (n - 1.0)));
  return values;
}

/// A growing basis, M-orthonormal, and systems of one mass matrix projected on it, each at sets of coefficients.
class Basis {
 public:
  explicit Basis(const FullSystem& system) : system_(system), vectors_(system.size(), 0), m_vectors_(system.size(), 0) {
    const int every = std::max(1, system.size() / kRowsLookedAt);
    for (int i = 0; i < system.size(); ++i) {
      if (i % every == 0 || i >= system.size() - 50) rows_.push_back(i);  // the last ones are lumped nodes: each counts
    }
    m_rows_.resize(n_rows(), 0);
  }

  /// @param system  borrowed
  void add_point(const FullSystem& system, const Eigen::VectorXd& c) {
    SparseRow k = system.conduction;
    for (std::size_t e = 0; e < system.exchanges.size(); ++e) {
      if (c[static_cast<Eigen::Index>(e)] != 0.0) k += c[static_cast<Eigen::Index>(e)] * system.exchanges[e].matrix;
    }
    at_.push_back({&system, std::move(k), Eigen::MatrixXd(0, 0), Eigen::MatrixXd(n_rows(), 0),
                   Eigen::MatrixXd(system.outputs.state.cols(), 0)});
    if (size() > 0) project(at_.back(), size());
  }
  /// Back to its first columns and points.
  void shrink(Eigen::Index columns, std::size_t points) {
    for (Eigen::MatrixXd* of_columns : {&vectors_, &m_vectors_, &m_rows_})
      of_columns->conservativeResize(Eigen::NoChange, columns);
    at_.resize(points);
    for (AtPoint& at : at_) {
      at.reduced.conservativeResize(columns, columns);
      at.rows.conservativeResize(Eigen::NoChange, columns);
      at.outputs.conservativeResize(Eigen::NoChange, columns);
    }
  }

  [[nodiscard]] const SparseRow& stiffness(std::size_t point) const { return at_[point].stiffness; }
  [[nodiscard]] Eigen::Index size() const { return vectors_.cols(); }
  [[nodiscard]] const Eigen::MatrixXd& vectors() const { return vectors_; }
  [[nodiscard]] const Eigen::MatrixXd& m_vectors() const { return m_vectors_; }
  [[nodiscard]] const Eigen::MatrixXd& reduced_stiffness(std::size_t point) const { return at_[point].reduced; }
  /// n_outputs x size.
  [[nodiscard]] const Eigen::MatrixXd& outputs(std::size_t point) const { return at_[point].outputs; }

  /// Rows in which residuals are evaluated; K V and M V there.
  [[nodiscard]] const std::vector<int>& rows() const { return rows_; }
  [[nodiscard]] const Eigen::MatrixXd& k_rows(std::size_t point) const { return at_[point].rows; }
  [[nodiscard]] const Eigen::MatrixXd& m_rows() const { return m_rows_; }

  void add(const Eigen::MatrixXd& columns) {
    const Eigen::Index before = size();
    for (Eigen::Index c = 0; c < columns.cols(); ++c) {
      Eigen::VectorXd v = columns.col(c), mv = system_.mass * v;
      const double length = std::sqrt(v.dot(mv));
      for (int pass = 0; pass < 3; ++pass) v -= vectors_ * (m_vectors_.transpose() * v);
      mv = system_.mass * v;
      const double rest = std::sqrt(v.dot(mv));
      if (!(rest > 1e-8 * length)) continue;
      append(vectors_, v / rest);
      append(m_vectors_, mv / rest);
    }
    const Eigen::Index fresh = size() - before;
    if (fresh == 0) return;
    append(m_rows_, m_vectors_.rightCols(fresh)(rows_, Eigen::all));
    for (AtPoint& at : at_) project(at, fresh);
  }

 private:
  static constexpr int kRowsLookedAt = 6000;
  struct AtPoint {
    const FullSystem* system;
    SparseRow stiffness;
    Eigen::MatrixXd reduced, rows, outputs;
  };
  /// Projects on the last columns.
  void project(AtPoint& at, Eigen::Index fresh) const {
    append(at.outputs, at.system->outputs.state.transpose() * vectors_.rightCols(fresh));
    const Eigen::MatrixXd kv = at.stiffness * vectors_.rightCols(fresh);
    append(at.rows, kv(rows_, Eigen::all));
    const Eigen::MatrixXd border = vectors_.transpose() * kv;  // size x fresh
    at.reduced.conservativeResize(size(), size());
    at.reduced.rightCols(fresh) = border;
    at.reduced.bottomRows(fresh) = border.transpose();
    at.reduced.bottomRightCorner(fresh, fresh) = 0.5 * (border.bottomRows(fresh) + border.bottomRows(fresh).transpose());
  }
  [[nodiscard]] Eigen::Index n_rows() const { return static_cast<Eigen::Index>(rows_.size()); }
  static void append(Eigen::MatrixXd& to, const Eigen::MatrixXd& columns) {
    to.conservativeResize(columns.rows(), to.cols() + columns.cols());
    to.rightCols(columns.cols()) = columns;
  }
  const FullSystem& system_;
  std::vector<int> rows_;
  Eigen::MatrixXd vectors_, m_vectors_, m_rows_;
  std::vector<AtPoint> at_;  ///< per system and set of coefficients
};

/// The inputs of the system, each with its largest magnitude, at one set of coefficients. The start acts as an impulse.
struct InputLoads {
  Eigen::MatrixXd loads;    ///< n x n_inputs: steps, the start, switches between sets of coefficients
  Eigen::Index start = -1;  ///< column that is M θ0, -1 for none
  Eigen::Index n_switches = 0;

  [[nodiscard]] Eigen::Index n_steps() const { return loads.cols() - n_switches - (start >= 0 ? 1 : 0); }
};

InputLoads inputs_at(const FullSystem& system, const ReductionDemand& demand, const Eigen::VectorXd& start,
                     const Eigen::VectorXd& c) {
  std::vector<Eigen::VectorXd> loads;
  for (std::size_t s = 0; s < system.sources.size(); ++s) {
    const double power_W = demand.power_W[static_cast<Eigen::Index>(s)];
    if (power_W > 0.0) loads.push_back(power_W * system.sources[s].load);
  }
  Eigen::VectorXd ambient = Eigen::VectorXd::Zero(system.size()), offset = ambient;
  for (std::size_t e = 0; e < system.exchanges.size(); ++e) {
    const auto& exchange = system.exchanges[e];
    ambient += c[static_cast<Eigen::Index>(e)] * exchange.to_ambient;
    if (exchange.offset.size() > 0) offset += c[static_cast<Eigen::Index>(e)] * exchange.offset;
  }
  // The same number at each set of coefficients, even if all are zero there: a pump at rest.
  const auto any = [&](const auto& drives) { return std::any_of(system.exchanges.begin(), system.exchanges.end(), drives); };
  if (demand.ambient_K > 0.0 && any([](const auto& e) { return (e.to_ambient.array() != 0.0).any(); }))
    loads.push_back(demand.ambient_K * ambient);
  if (any([](const auto& e) { return (e.offset.array() != 0.0).any(); })) loads.push_back(offset);
  InputLoads inputs;
  if (start.cwiseAbs().maxCoeff() > 0.0) {
    inputs.start = static_cast<Eigen::Index>(loads.size());
    loads.push_back(system.mass * start);
  }
  inputs.loads.resize(system.size(), static_cast<Eigen::Index>(loads.size()));
  for (std::size_t i = 0; i < loads.size(); ++i) inputs.loads.col(static_cast<Eigen::Index>(i)) = loads[i];
  return inputs;
}

/// Reduced states after a step of each input, one block of columns per time.
Eigen::MatrixXd step_states(const Eigen::MatrixXd& k, const Eigen::MatrixXd& loads, Eigen::Index start,
                            const std::vector<double>& times_s) {
  const dense::SymmetricEigen eigen(k);
  const Eigen::MatrixXd f = eigen.eigenvectors().transpose() * loads;
  Eigen::MatrixXd states(k.rows(), loads.cols() * static_cast<Eigen::Index>(times_s.size()));
  for (std::size_t t = 0; t < times_s.size(); ++t) {
    const Eigen::ArrayXd x = eigen.eigenvalues().array() * times_s[t];
    const Eigen::ArrayXd stepped = -(-x).unaryExpr([](double v) { return std::expm1(v); }) / eigen.eigenvalues().array();
    Eigen::MatrixXd z = stepped.matrix().asDiagonal() * f;
    if (start >= 0) z.col(start) = (-x).exp().matrix().asDiagonal() * f.col(start);
    states.middleCols(static_cast<Eigen::Index>(t) * loads.cols(), loads.cols()).noalias() = eigen.eigenvectors() * z;
  }
  return states;
}

/// Largest difference of an output, by unit: the sum over steps and start, doubled because they may step back as far, and
/// the largest of the switches.
/// @param all_inputs  of each
ReductionError difference(const Outputs& outputs, const std::vector<Eigen::MatrixXd>& a,
                          const std::vector<Eigen::MatrixXd>& b, std::span<const InputLoads> all_inputs) {
  ReductionError error;
  for (std::size_t p = 0; p < a.size(); ++p) {
    const InputLoads& inputs = all_inputs[p];
    const Eigen::Index n_inputs = inputs.loads.cols();
    const Eigen::MatrixXd apart = (a[p] - b[p]).cwiseAbs();
    for (Eigen::Index first = 0; first < apart.cols(); first += n_inputs) {
      Eigen::VectorXd sum = 2.0 * apart.middleCols(first, n_inputs - inputs.n_switches).rowwise().sum();
      if (inputs.n_switches > 0) {
        sum += apart.middleCols(first + n_inputs - inputs.n_switches, inputs.n_switches).rowwise().maxCoeff();
      }
      for (std::size_t o = 0; o < outputs.unit.size(); ++o) {
        double& worst = outputs.unit[o] == "K"   ? error.temperature_K
                        : outputs.unit[o] == "m" ? error.displacement_m
                                                 : error.angle_rad;
        worst = std::max(worst, sum[static_cast<Eigen::Index>(o)]);
      }
    }
  }
  return error;
}

bool is_within(const ReductionError& error, const ReductionOptions& options, double share) {
  return error.temperature_K <= share * options.temperature_K && error.displacement_m <= share * options.displacement_m &&
         error.angle_rad <= share * options.angle_rad;
}

class Reducer {
 public:
  /// @param first  the first system; borrowed, as all
  Reducer(const FullSystem& first, const ReductionDemand& demand, Eigen::VectorXd start, const ReductionOptions& options)
      : system_(first),
        demand_(demand),
        start_(std::move(start)),
        options_(options),
        coefficients_(demand.points()),
        basis_(first) {
    shifts_1_s_ = log_spaced(0.3 / demand.duration_s, 1.0 / kShortest_s, 14);
    shifts_1_s_.insert(shifts_1_s_.begin(), 0.0);
    times_s_ = log_spaced(kShortest_s, demand.duration_s, 40);
    add_points(first);
    basis_.add(system_.ones);
    if (start_.cwiseAbs().maxCoeff() > 0.0) basis_.add(start_);
    latest_ = rounds();
  }

  /// PoseReduction::add()
  ReductionError add(const FullSystem& system, const Eigen::MatrixXd& outputs) {
    const Eigen::Index size = basis_.size();
    size_before_ = size;
    add_points(system);
    latest_ = rounds();
    is_of_all_ = false;
    std::vector<Eigen::MatrixXd> tested;
    for (std::size_t p = first_; p < inputs_.size(); ++p)
      tested.push_back(outputs.transpose() * step_states(basis_.reduced_stiffness(p).topLeftCorner(size, size),
                                                         basis_.vectors().leftCols(size).transpose() * inputs_[p].loads,
                                                         inputs_[p].start, times_s_));
    return difference(system_.outputs, tested, latest_, std::span(inputs_).subspan(first_));
  }
  void forget() {
    basis_.shrink(size_before_, first_);
    inputs_.resize(first_);
    first_ -= coefficients_.size();
  }
  [[nodiscard]] const Eigen::MatrixXd& vectors() const { return basis_.vectors(); }
  [[nodiscard]] Eigen::MatrixXd steady_states() const {
    const Eigen::MatrixXd loads = inputs_[first_].loads.leftCols(inputs_[first_].n_steps());
    return basis_.vectors() * dense::solve_definite(basis_.reduced_stiffness(first_), basis_.vectors().transpose() * loads);
  }
  /// @param elsewhere  error at systems that were added and forgotten
  [[nodiscard]] Reduction result(const ReductionError& elsewhere = {}) {
    ReductionError& error = result_.error;
    error = {std::max(error.temperature_K, elsewhere.temperature_K),
             std::max(error.displacement_m, elsewhere.displacement_m), std::max(error.angle_rad, elsewhere.angle_rad)};
    if (!is_of_all_) {
      first_ = 0;
      latest_ = step_test();
    }
    compress(result_, latest_);
    return result_;
  }

 private:
  struct Choice {
    std::size_t point = 0, shift = 0;
    std::vector<Eigen::Index> inputs;
  };

  [[nodiscard]] bool is_alone() const { return inputs_.size() == coefficients_.size(); }

  void add_points(const FullSystem& system) {
    first_ = inputs_.size();
    for (const Eigen::VectorXd& c : coefficients_) {
      basis_.add_point(system, c);
      inputs_.push_back(inputs_at(system, demand_, start_, c));
    }
  }

  /// Adds responses at the latest points until these change their outputs by less than half of the tolerance.
  /// @returns  outputs of the step test
  std::vector<Eigen::MatrixXd> rounds() {
    std::vector<Choice> round;  // first the steady states
    for (std::size_t p = first_; p < inputs_.size(); ++p) {
      round.push_back({.point = p, .shift = 0, .inputs = {}});
      for (Eigen::Index i = 0; i < inputs_[p].loads.cols(); ++i) round.back().inputs.push_back(i);
    }
    std::vector<Eigen::MatrixXd> last;  // outputs of the step test of the previous round
    for (int n_rounds = 1;; ++n_rounds) {
      for (const Choice& choice : round) {
        const Eigen::MatrixXd found = respond(choice);
        result_.shifts_1_s.push_back(shifts_1_s_[choice.shift]);
        result_.n_solves += static_cast<int>(found.cols());
        basis_.add(found);
      }
      ++result_.n_rounds;
      if (n_rounds == 1) add_switches();
      std::vector<Eigen::MatrixXd> now = step_test();
      if (!last.empty()) {
        const ReductionError changed = difference(system_.outputs, last, now, std::span(inputs_).subspan(first_));
        if (is_alone()) result_.error = changed;
        if (is_within(changed, options_, 0.5)) return now;
        if (n_rounds >= options_.most_rounds) {
          throw SolveError(fmt::format(
              "the reduced model misses by about {:.2g} K and {:.2g} um after {} rounds; take `model: full` in `solver`",
              changed.temperature_K, 1e6 * changed.displacement_m, n_rounds));
        }
      }
      last = std::move(now);
      for (Choice& choice : round) choice = worst_residual(choice.point);
    }
  }

  /// (s M + K)⁻¹ of the chosen inputs.
  Eigen::MatrixXd respond(const Choice& at) {
    const SparseRow a = basis_.stiffness(at.point) + shifts_1_s_[at.shift] * system_.mass;
    if (at.shift == 0) require_way_out(a);
    if (factor_ && is_alone()) {
      factor_->refactor(a);  // in the same pattern
    } else {
      factor_.emplace(a);
    }
    return factor_->solve(Eigen::MatrixXd(inputs_[at.point].loads(Eigen::all, at.inputs)));
  }

  /// A change of a coefficient is one more input: the steady state with c' drives the system with c by (K(c') - K(c)) θ'.
  /// So is a move: the same at the first system's.
  void add_switches() {
    std::vector<std::size_t> points;
    if (!is_alone()) points.push_back(0);
    for (std::size_t p = first_; p < inputs_.size(); ++p) points.push_back(p);
    std::vector<Eigen::VectorXd> steady;
    for (const std::size_t p : points) {
      const Eigen::VectorXd load = inputs_[p].loads.leftCols(inputs_[p].n_steps()).rowwise().sum();
      steady.push_back(basis_.vectors() *
                       dense::solve_definite(basis_.reduced_stiffness(p), basis_.vectors().transpose() * load));
    }
    for (std::size_t p = first_; p < inputs_.size(); ++p) {
      Eigen::MatrixXd& loads = inputs_[p].loads;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const std::size_t other = points[i];
        if (other == p) continue;
        const Eigen::VectorXd jump = basis_.stiffness(other) * steady[i] - basis_.stiffness(p) * steady[i];
        loads.conservativeResize(Eigen::NoChange, loads.cols() + 1);
        loads.rightCols(1) = jump;
        ++inputs_[p].n_switches;
      }
    }
  }

  /// Outputs after steps at the latest points: n_outputs x (inputs of a time, time after time).
  std::vector<Eigen::MatrixXd> step_test() const {
    std::vector<Eigen::MatrixXd> found;
    for (std::size_t p = first_; p < inputs_.size(); ++p) {
      found.push_back(basis_.outputs(p) * step_states(basis_.reduced_stiffness(p),
                                                      basis_.vectors().transpose() * inputs_[p].loads, inputs_[p].start,
                                                      times_s_));
    }
    return found;
  }

  /// The largest residual of the response at one set of coefficients, in the energy that a Jacobi step would remove.
  Choice worst_residual(std::size_t p) const {
    Choice worst;
    double largest = -1.0;
    Eigen::VectorXd of_inputs;
    const Eigen::MatrixXd& k = basis_.reduced_stiffness(p);
    const Eigen::MatrixXd f = basis_.vectors().transpose() * inputs_[p].loads,
                          loads = inputs_[p].loads(basis_.rows(), Eigen::all);
    const Eigen::VectorXd k_diagonal = Eigen::VectorXd(basis_.stiffness(p).diagonal())(basis_.rows()),
                          m_diagonal = Eigen::VectorXd(system_.mass.diagonal())(basis_.rows());
    for (std::size_t j = 0; j < shifts_1_s_.size(); ++j) {
      const double s = shifts_1_s_[j];
      const Eigen::MatrixXd z = dense::solve_definite(k + s * Eigen::MatrixXd::Identity(k.rows(), k.cols()), f);
      const Eigen::MatrixXd residual = loads - basis_.k_rows(p) * z - s * (basis_.m_rows() * z);
      const Eigen::VectorXd weight = (k_diagonal + s * m_diagonal).cwiseInverse();
      const Eigen::VectorXd energy = (residual.cwiseAbs2().transpose() * weight);
      if (energy.maxCoeff() <= largest) continue;
      largest = energy.maxCoeff();
      of_inputs = energy;
      worst.point = p;
      worst.shift = j;
    }
    for (Eigen::Index i = 0; i < of_inputs.size(); ++i) {
      if (of_inputs[i] > 0.01 * largest) worst.inputs.push_back(i);
    }
    return worst;
  }

  /// Keeps the directions that the step tests use most, as few as the other half of the tolerance allows.
  void compress(Reduction& result, const std::vector<Eigen::MatrixXd>& reference) const {
    const Eigen::Index n = basis_.size();
    if (system_.size() <=
        kWhole) {  // a law may distinguish two bodies that have the same connections in all sets of coefficients
      Basis whole = basis_;
      whole.add(Eigen::MatrixXd::Identity(system_.size(), system_.size()));
      result.basis = whole.vectors();
      result.error = {};
      return;
    }
    const Eigen::Index n_kept = 1 + (inputs_[0].start >= 0 ? 1 : 0);  // the uniform temperature and the start are kept
    Eigen::MatrixXd kept(n, n_kept);
    kept.col(0) = basis_.m_vectors().transpose() * system_.ones;
    if (inputs_[0].start >= 0) kept.col(1) = basis_.m_vectors().transpose() * start_;
    const Eigen::MatrixXd held = dense::orthonormal_from(kept).leftCols(kept.cols());
    std::vector<Eigen::MatrixXd> k, f, states;
    Eigen::Index n_states = 0;
    for (std::size_t p = 0; p < inputs_.size(); ++p) {
      k.push_back(basis_.reduced_stiffness(p));
      f.push_back(basis_.vectors().transpose() * inputs_[p].loads);
      states.push_back(step_states(k[p], f[p], inputs_[p].start, times_s_));
      n_states += states[p].cols();
    }
    Eigen::MatrixXd all(n, n_states);
    for (Eigen::Index p = 0, at = 0; p < static_cast<Eigen::Index>(states.size());
         at += states[static_cast<std::size_t>(p)].cols(), ++p) {
      all.middleCols(at, states[static_cast<std::size_t>(p)].cols()) = states[static_cast<std::size_t>(p)];
    }
    all -= held * (held.transpose() * all);
    const dense::SingularValues svd = dense::SingularValues::with_full_u(all);
    Eigen::MatrixXd directions(n, n);
    directions << held, svd.u.leftCols(n - held.cols());
    directions = dense::orthonormal_from(directions);  // orthonormal also where singular values are rounding errors
    const auto truncation = [&](Eigen::Index size) {
      const Eigen::MatrixXd u = directions.leftCols(size);
      std::vector<Eigen::MatrixXd> found;
      for (std::size_t p = 0; p < inputs_.size(); ++p) {
        found.push_back(basis_.outputs(p) * u *
                        step_states(u.transpose() * k[p] * u, u.transpose() * f[p], inputs_[p].start, times_s_));
      }
      return difference(system_.outputs, found, reference, inputs_);
    };
    Eigen::Index size = n;
    ReductionError lost;
    Eigen::Index step = 8;
    while (!is_alone() && 4 * step < n) step *= 2;  // one trial takes as many decompositions as there are points
    for (; step >= 1; step /= 2) {                  // errors decrease almost monotonically with the size
      while (size - step > held.cols()) {
        const ReductionError trial = truncation(size - step);
        if (!is_within(trial, options_, 0.5)) break;
        lost = trial;
        size -= step;
      }
    }
    result.error.temperature_K += lost.temperature_K;
    result.error.displacement_m += lost.displacement_m;
    result.error.angle_rad += lost.angle_rad;
    result.basis = basis_.vectors() * directions.leftCols(size);
  }

  const FullSystem& system_;  ///< the first one
  const ReductionDemand& demand_;
  const Eigen::VectorXd start_;
  const ReductionOptions options_;
  const std::vector<Eigen::VectorXd> coefficients_;  ///< sets of them
  Basis basis_;
  std::optional<ConductionFactor> factor_;
  std::vector<InputLoads> inputs_;  ///< per system and set of coefficients
  std::size_t first_ = 0;           ///< of the latest system
  Eigen::Index size_before_ = 0;    ///< it was added
  std::vector<double> shifts_1_s_, times_s_;
  std::vector<Eigen::MatrixXd> latest_;  ///< outputs of its step test
  bool is_of_all_ = true;                ///< these are of all systems: there is one
  Reduction result_;
};

}  // namespace

Reduction reduce(const FullSystem& system, const ReductionDemand& demand, const Eigen::VectorXd& start,
                 const ReductionOptions& options) {
  return Reducer(system, demand, start, options).result();
}

struct PoseReduction::Parts {
  Parts(std::shared_ptr<const FullSystem> first, const ReductionDemand& of_all, const Eigen::VectorXd& start,
        const ReductionOptions& options)
      : demand(of_all), systems{std::move(first)}, reducer(*systems.front(), demand, start, options) {}
  ReductionDemand demand;
  std::vector<std::shared_ptr<const FullSystem>> systems;
  Reducer reducer;
};

PoseReduction::PoseReduction(std::shared_ptr<const FullSystem> first, const ReductionDemand& demand,
                             const Eigen::VectorXd& start, const ReductionOptions& options)
    : parts_(std::make_unique<Parts>(std::move(first), demand, start, options)) {}
PoseReduction::~PoseReduction() = default;

const Eigen::MatrixXd& PoseReduction::basis() const {
  return parts_->reducer.vectors();
}
ReductionError PoseReduction::add(std::shared_ptr<const FullSystem> system, const Eigen::MatrixXd& outputs) {
  parts_->systems.push_back(std::move(system));
  return parts_->reducer.add(*parts_->systems.back(), outputs);
}
void PoseReduction::forget() {
  parts_->reducer.forget();
  parts_->systems.pop_back();
}
Eigen::MatrixXd PoseReduction::steady_states() const {
  return parts_->reducer.steady_states();
}
Reduction PoseReduction::result(const ReductionError& elsewhere) {
  return parts_->reducer.result(elsewhere);
}

}  // namespace driftwright::solver
