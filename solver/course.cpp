#include "solver/course.hpp"

#include <algorithm>
#include <cmath>

#include "base/series_in_order.hpp"
#include "solver/stretches.hpp"

namespace driftwright::solver {
namespace {

constexpr double kSlowStretch =
    1e-3;                        // of λt: below it the integrals are differences of large numbers, so series replace them
constexpr double kEqual = 1e-7;  // of |λ_i - λ_j| over the whole course: below it the two count as equal

/// Σ (-x)^k / c_k for c_k as given, 0 <= x < kSlowStretch.
double series(double x, double c0, double c1, double c2, double c3) {
  return 1.0 / c0 - x * (1.0 / c1 - x * (1.0 / c2 - x / c3));
}

/// The loads of a system in the stretches of a run; ask for them in order.
class Loads {
 public:
  /// Both are borrowed.
  Loads(const ReducedSystem& system, const TimeSeries& ambient)
      : system_(system), ambient_(ambient), changes_(system.change_times_s) {}
  void enter(const LinearStretch& stretch) {
    if (changes_.at(stretch)) ask_laws(stretch);
    const double ambient_K = ambient_.at(stretch.start_s);
    constant = load_ + ambient_K * to_ambient_;
    slope = (ambient_.at(stretch.end_s) - ambient_K) / (stretch.end_s - stretch.start_s) * to_ambient_;
  }

  Eigen::VectorXd coefficient;  ///< of each exchange
  Eigen::VectorXd constant, slope;

 private:
  void ask_laws(const LinearStretch& stretch) {
    effects::Inputs at{.drive = stretch.drive, .time_s = stretch.law_time_s()};
    at.run = stretch.run;
    coefficient.resize(static_cast<Eigen::Index>(system_.exchanges.size()));
    load_.setZero(system_.size());
    to_ambient_.setZero(system_.size());
    for (const HeatSource& s : system_.sources) {
      if (const double power_W = s.power_W(at); power_W != 0.0) load_ += power_W * s.load;
    }
    for (std::size_t e = 0; e < system_.exchanges.size(); ++e) {
      const Exchange<Eigen::MatrixXd>& exchange = system_.exchanges[e];
      const double c = exchange.coefficient(at);
      coefficient[static_cast<Eigen::Index>(e)] = c;
      if (c == 0.0) continue;
      to_ambient_ += c * exchange.to_ambient;
      if (exchange.offset.size() > 0) load_ += c * exchange.offset;
    }
  }

  const ReducedSystem& system_;
  SeriesInOrder ambient_;
  LawChanges changes_;
  Eigen::VectorXd load_, to_ambient_;
};

}  // namespace

Course::Exponentials Course::exponentials(const Eigen::VectorXd& lambda_1_s, const std::vector<double>& times_s) {
  const Eigen::Index n = lambda_1_s.size(), n_times = static_cast<Eigen::Index>(times_s.size());
  const Eigen::ArrayXd lambda = lambda_1_s.array();
  Exponentials x;
  for (Eigen::ArrayXXd* a : {&x.e, &x.p, &x.q, &x.te, &x.r, &x.s}) a->resize(n, n_times);
  double before_s = 0.0, step_s = -1.0;
  Eigen::ArrayXd e = Eigen::ArrayXd::Ones(n), decay(n);
  for (Eigen::Index k = 0; k < n_times; ++k) {  // evenly spaced times take one exponential per mode
    const double t_s = times_s[static_cast<std::size_t>(k)];
    if (std::abs(t_s - before_s - step_s) > 1e-9 * step_s) {
      step_s = t_s - before_s;
      decay = (-step_s * lambda).exp();
    }
    e *= decay;
    before_s = t_s;
    x.e.col(k) = e;
    x.te.col(k) = t_s * e;
    x.p.col(k) = (1.0 - e) / lambda;
    x.q.col(k) = (t_s - x.p.col(k)) / lambda;
    x.r.col(k) = (x.p.col(k) - x.te.col(k)) / lambda;
    x.s.col(k) = (x.q.col(k) - x.r.col(k)) / lambda;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double lt = lambda[i] * t_s;
      if (lt > kSlowStretch) continue;
      x.p(i, k) = t_s * series(lt, 1.0, 2.0, 6.0, 24.0);
      x.q(i, k) = t_s * t_s * series(lt, 2.0, 6.0, 24.0, 120.0);
      x.r(i, k) = t_s * t_s * series(lt, 2.0, 3.0, 8.0, 30.0);
      x.s(i, k) = t_s * t_s * t_s * series(lt, 6.0, 12.0, 40.0, 180.0);
    }
  }
  return x;
}

std::optional<Course> Course::of(const ReducedSystem& system, Decompositions& decompositions, const Cyclogram& cyclogram,
                                 const TimeSeries& ambient, const std::vector<double>& output_s,
                                 const Eigen::VectorXd& start) {
  Course c;
  c.conduction_ = system.conduction;
  c.mass_ = system.mass;
  c.start_ = start;
  c.states_.resize(system.size(), static_cast<Eigen::Index>(output_s.size()));
  Eigen::VectorXd state = start;
  std::size_t next = 0;
  Loads loads(system, ambient);
  const std::vector<LinearStretch> stretches = stretches_of(system, cyclogram, ambient);
  require_within(stretches, output_s);
  for (const LinearStretch& stretch : stretches) {
    loads.enter(stretch);
    Stretch s;
    s.start_s = stretch.start_s;
    s.end_s = stretch.end_s;
    s.first = static_cast<Eigen::Index>(next);
    const auto known = std::find_if(c.decompositions_.begin(), c.decompositions_.end(),
                                    [&](const Decomposition& d) { return d.coefficient == loads.coefficient; });
    s.decomposition = static_cast<std::size_t>(known - c.decompositions_.begin());
    if (known == c.decompositions_.end()) {
      if (c.decompositions_.size() == kMostSets) return std::nullopt;
      c.decompositions_.push_back(decompositions.at(loads.coefficient, false));
    }
    const Decomposition& d = c.decompositions_[s.decomposition];
    s.y0 = d.to_modes * state;
    s.f0 = d.vectors.transpose() * loads.constant;
    s.f1 = d.vectors.transpose() * loads.slope;
    std::vector<double> times_s;
    for (; next < output_s.size() && output_s[next] <= stretch.end_s; ++next)
      times_s.push_back(output_s[next] - stretch.start_s);
    times_s.push_back(stretch.end_s - stretch.start_s);
    s.at = exponentials(d.lambda_1_s, times_s);
    s.y = s.at.e.colwise() * s.y0.array() + s.at.p.colwise() * s.f0.array() + s.at.q.colwise() * s.f1.array();
    const Eigen::MatrixXd z = d.vectors * s.y;
    c.states_.middleCols(s.first, z.cols() - 1) = z.leftCols(z.cols() - 1);
    state = z.rightCols<1>();
    c.stretches_.push_back(std::move(s));
  }
  return c;
}

std::optional<Eigen::MatrixXd> Course::states_of(const ReducedSystem& other, const Cyclogram& cyclogram,
                                                 const TimeSeries& ambient, const Eigen::VectorXd& start) const {
  if (!other.is_linear()) return std::nullopt;
  // a system may have additional exchanges, of laws that it had before
  if (!decompositions_.empty() &&
      static_cast<Eigen::Index>(other.exchanges.size()) != decompositions_.front().coefficient.size())
    return std::nullopt;
  const std::vector<LinearStretch> theirs = stretches_of(other, cyclogram, ambient);
  if (theirs.size() != stretches_.size()) return std::nullopt;
  for (std::size_t k = 0; k < theirs.size(); ++k) {
    if (theirs[k].start_s != stretches_[k].start_s || theirs[k].end_s != stretches_[k].end_s) return std::nullopt;
  }
  const Eigen::MatrixXd more_conduction = other.conduction - conduction_, more_mass = other.mass - mass_;
  const bool is_other_conduction = (more_conduction.array() != 0.0).any(), is_other_mass = (more_mass.array() != 0.0).any();

  /// The effect of a difference of the matrices, by decomposition and difference of the coefficients.
  struct Coupling {
    std::size_t decomposition;
    Eigen::VectorXd more_coefficient;
    Eigen::MatrixXd apart, mass;        // C and V'δM V
    Eigen::SparseMatrix<double> equal;  // G where the two λ are equal
  };
  std::vector<Coupling> couplings;
  const double least_1_s = kEqual / (stretches_.empty() ? 1.0 : stretches_.back().end_s);
  const auto coupling = [&](std::size_t decomposition, const Eigen::VectorXd& more) -> const Coupling& {
    for (const Coupling& c : couplings) {
      if (c.decomposition == decomposition && c.more_coefficient == more) return c;
    }
    const Decomposition& d = decompositions_[decomposition];
    Eigen::MatrixXd matrix = more_conduction;
    for (Eigen::Index e = 0; e < more.size(); ++e) {
      if (more[e] != 0.0) matrix += more[e] * other.exchanges[static_cast<std::size_t>(e)].matrix;
    }
    Coupling c{.decomposition = decomposition, .more_coefficient = more, .apart = {}, .mass = {}, .equal = {}};
    c.apart.noalias() = -d.vectors.transpose() * (matrix * d.vectors).eval();
    if (is_other_mass) {
      c.mass.noalias() = d.vectors.transpose() * (more_mass * d.vectors).eval();
      c.apart += c.mass * d.lambda_1_s.asDiagonal();
    }
    const Eigen::Index n = d.lambda_1_s.size();
    std::vector<Eigen::Triplet<double>> equal;
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index i = 0; i < n; ++i) {
        const double difference = d.lambda_1_s[j] - d.lambda_1_s[i];
        if (std::abs(difference) < least_1_s) {
          equal.emplace_back(static_cast<int>(i), static_cast<int>(j), c.apart(i, j));
          c.apart(i, j) = 0.0;
        } else {
          c.apart(i, j) /= difference;
        }
      }
    }
    c.equal.resize(n, n);
    c.equal.setFromTriplets(equal.begin(), equal.end());
    couplings.push_back(std::move(c));
    return couplings.back();
  };

  Eigen::MatrixXd states = states_, change;
  Eigen::VectorXd off = start - start_;  // difference of the state, at the start of a stretch
  Eigen::VectorXd y0, h0, h1, more, e0, e1, e2;
  Loads loads(other, ambient);
  for (std::size_t k = 0; k < theirs.size(); ++k) {
    const Stretch& s = stretches_[k];
    const Decomposition& d = decompositions_[s.decomposition];
    loads.enter(theirs[k]);
    y0.noalias() = d.to_modes * off;
    h0.noalias() = d.vectors.transpose() * loads.constant;
    h0 -= s.f0;
    h1.noalias() = d.vectors.transpose() * loads.slope;
    h1 -= s.f1;
    more = loads.coefficient - d.coefficient;
    const bool is_coupled = is_other_conduction || is_other_mass || (more.array() != 0.0).any();
    if (is_coupled) {
      const Coupling& c = coupling(s.decomposition, more);
      if (is_other_mass) {
        h0.noalias() -= c.mass * s.f0;
        h1.noalias() -= c.mass * s.f1;
      }
      y0.noalias() += c.apart * s.y0;
      h0.noalias() += c.apart * s.f0;
      h1.noalias() += c.apart * s.f1;
      e0.noalias() = c.equal * s.y0;
      e1.noalias() = c.equal * s.f0;
      e2.noalias() = c.equal * s.f1;
      change = s.at.te.colwise() * e0.array() + s.at.r.colwise() * e1.array() + s.at.s.colwise() * e2.array();
      change.noalias() -= c.apart * s.y;
    } else {
      change.setZero(s.y.rows(), s.y.cols());
    }
    change.array() += s.at.e.colwise() * y0.array() + s.at.p.colwise() * h0.array() + s.at.q.colwise() * h1.array();
    const Eigen::Index n_outputs = change.cols() - 1;
    if (n_outputs > 0) states.middleCols(s.first, n_outputs).noalias() += d.vectors * change.leftCols(n_outputs);
    off.noalias() = d.vectors * change.rightCols<1>();
  }
  return states;
}

}  // namespace driftwright::solver
