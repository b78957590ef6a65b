#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "diagnosis/fit.hpp"
#include "diagnosis/no_solution.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr int kMostIterations = 16;  // plus one for each time that slopes are recomputed
constexpr double kConverged = 0.02;  // decrease of Φ below which a fit has converged
constexpr double kFar = 2.0;         // distance in sigmas after which scatter's slopes are recomputed
constexpr double kPromised = 1.0;    // decrease of Φ that the slopes predicted but that did not happen
constexpr int kMostRetakes = 3;

/// Solves H s = g within bounds of the first numbers of x: a number whose step would pass its bound ends there, and the
/// others are solved again.
/// @param x, most  values of the first numbers, and their largest distances from zero
Eigen::VectorXd bounded_step(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient, const Eigen::VectorXd& x,
                             const Eigen::VectorXd& most) {
  Eigen::VectorXd step = hessian.llt().solve(gradient);
  Eigen::VectorXd ends = Eigen::VectorXd::Zero(gradient.size());  // steps of numbers that end at their bound
  std::vector<Eigen::Index> bound;
  for (Eigen::Index turn = 0; turn < x.size(); ++turn) {
    const std::size_t n_before = bound.size();
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (!(std::abs(x[i] + step[i]) > most[i]) || std::find(bound.begin(), bound.end(), i) != bound.end()) continue;
      bound.push_back(i);
      ends[i] = std::copysign(most[i], x[i] + step[i]) - x[i];
    }
    if (bound.size() == n_before) break;
    Eigen::MatrixXd h = hessian;
    Eigen::VectorXd g = gradient - hessian * ends;
    for (Eigen::Index i : bound) {
      h.row(i).setZero();
      h.col(i).setZero();
      h(i, i) = 1.0;
      g[i] = ends[i];
    }
    step = h.llt().solve(g);
  }
  return step;
}

}  // namespace

/// One fit: Gauss-Newton from its start to the least Φ, and between steps a search for better times.
class Fitter::Climb {
 public:
  /// @throws SolveError  when the machine has no solution at the start
  Climb(const Fitter& fitter, const Hypothesis& hypothesis, Eigen::VectorXd start, Eigen::Index held,
        Twin::Workspace& workspace, Slopes slopes);
  /// The fit at the least Φ.
  Fit best();

 private:
  struct Direction {
    Eigen::VectorXd gradient, step;  ///< of -Φ by x; to the least Φ of the linear model
  };

  void into_range(Eigen::VectorXd& x) const;
  [[nodiscard]] double prior(const Eigen::VectorXd& x) const;
  /// Φ of a prediction. @param predicted  makes it; 1e300 where it has no solution
  template <class Predicted>
  void judge(Fit& at, const Predicted& predicted) const;
  void look(Fit& at, Prediction& kept, bool reuse) const;
  /// Takes scatter's slopes anew if the fit has moved far or stopped before what its slopes promised. @returns whether it
  /// did
  bool retake(double promised);
  void differentiate(bool from_both_sides);
  /// W f's slope by a claim's number. @param base  W f here
  [[nodiscard]] Eigen::VectorXd slope_of(Eigen::Index k, const TwinState& here, const Eigen::VectorXd& base,
                                         bool from_both_sides) const;
  [[nodiscard]] Direction direction(bool times_wait) const;
  /// Takes the first share of a step that decreases Φ.
  void go_along(const Eigen::VectorXd& step);
  /// Moves each time by jumps, as long as Φ decreases.
  void move_times();
  void take(Fit& tried, Prediction& kept);
  /// Covariance and evidence, by Laplace.
  void weigh();

  const Fitter& fitter_;
  const Hypothesis& hypothesis_;
  Twin::Workspace& workspace_;
  const Eigen::Index held_;
  const bool keeps_slopes_;
  const std::vector<const Knob*> knobs_;
  const std::vector<char> smooth_;
  const Eigen::Index n_n_, n_k_, n_, n_scatter_;
  const Eigen::VectorXd sd_;
  Fit f_;
  Prediction responses_;
  // Scatter's slopes are those of the fitter; they are recomputed where a fit has moved far.
  Eigen::MatrixXd own_slopes_, own_squares_;
  const Eigen::MatrixXd *nuisance_slopes_, *nuisance_squares_;
  Eigen::VectorXd taken_at_;
  int n_retakes_ = 0;
  Eigen::MatrixXd square_;
};

Fitter::Climb::Climb(const Fitter& fitter, const Hypothesis& hypothesis, Eigen::VectorXd start, Eigen::Index held,
                     Twin::Workspace& workspace, Slopes slopes)
    : fitter_(fitter),
      hypothesis_(hypothesis),
      workspace_(workspace),
      held_(held),
      keeps_slopes_(slopes == Slopes::kKept),
      knobs_(knobs_of(hypothesis)),
      smooth_(smooth_knobs(hypothesis)),
      n_n_(fitter.n_nuisance()),
      n_k_(static_cast<Eigen::Index>(knobs_.size())),
      n_(n_n_ + n_k_),
      n_scatter_(static_cast<Eigen::Index>(fitter.scatter_.size())),
      sd_(fitter.prior_sd(hypothesis)),
      nuisance_slopes_(&fitter.slopes_),
      nuisance_squares_(&fitter.squares_),
      taken_at_(fitter.nuisance_),
      square_(n_, n_) {
  f_.x = std::move(start);
  into_range(f_.x);
  look(f_, responses_, false);
  if (f_.prediction.empty() || f_.misfit >= 1e300) throw SolveError("the machine has no solution where the fit begins");
  if (n_n_ > 0 && f_.x.head(n_n_).isZero(0.0)) {
    nuisance_slopes_ = &fitter.written_slopes_;
    nuisance_squares_ = &fitter.written_squares_;
    taken_at_ = f_.x.head(n_n_);
  }
  f_.slopes.resize(f_.residual.size(), n_k_);
}

void Fitter::Climb::into_range(Eigen::VectorXd& x) const {
  const auto to_bound = [](const Knob& knob, double& number) {  // beyond its bound a number has no slope
    if (const double value = knob.value(number); value == knob.low || value == knob.high) number = knob.x(value);
  };
  for (std::size_t i = 0; i < fitter_.scatter_.size(); ++i) {
    double& number = x[static_cast<Eigen::Index>(i)];
    const double most = fitter_.most_sigmas_ * fitter_.scatter_[i].prior_sd;
    number = std::clamp(number, -most, most);
    to_bound(fitter_.scatter_[i], number);
  }
  for (Eigen::Index k = 0; k < n_k_; ++k) {
    const Knob& knob = *knobs_[static_cast<std::size_t>(k)];
    to_bound(knob, x[n_n_ + k]);
    x[n_n_ + k] = std::clamp(x[n_n_ + k], -8.0 * knob.prior_sd, 8.0 * knob.prior_sd);
  }
}

double Fitter::Climb::prior(const Eigen::VectorXd& x) const {
  double sum = 0.5 * x.head(n_n_).cwiseQuotient(sd_.head(n_n_)).squaredNorm();
  for (Eigen::Index k = n_n_; k < n_; ++k) sum += heavy_tailed_cost(sd_[k], x[k]);
  return sum;
}

template <class Predicted>
void Fitter::Climb::judge(Fit& at, const Predicted& predicted) const {
  const Comparison& comparison = *fitter_.comparison_;
  at.misfit = 1e300;
  if (!has_solution([&] { at.prediction = predicted(); })) return;  // a step too far
  at.residual = comparison.measured() - comparison.whitened(at.prediction);
  const double misfit = 0.5 * at.residual.squaredNorm() + prior(at.x);
  if (std::isfinite(misfit)) at.misfit = misfit;
}

void Fitter::Climb::look(Fit& at, Prediction& kept, bool reuse) const {
  judge(at, [&] { return fitter_.predict(hypothesis_, at.x, workspace_, &kept, reuse); });
}

bool Fitter::Climb::retake(double promised) {
  if (n_n_ == 0 || keeps_slopes_) return false;
  const Eigen::VectorXd gone = (f_.x.head(n_n_) - taken_at_).cwiseQuotient(sd_.head(n_n_));
  const double far = gone.cwiseAbs().maxCoeff();
  const bool are_here = n_retakes_ > 0 && far == 0.0;
  if (n_retakes_ == kMostRetakes || are_here || (far <= kFar && promised < kPromised)) return false;
  own_slopes_ = fitter_.slopes_at(hypothesis_, f_, responses_);
  own_squares_.noalias() = own_slopes_.transpose() * own_slopes_;
  nuisance_slopes_ = &own_slopes_;
  nuisance_squares_ = &own_squares_;
  taken_at_ = f_.x.head(n_n_);
  ++n_retakes_;
  return true;
}

Eigen::VectorXd Fitter::Climb::slope_of(Eigen::Index k, const TwinState& here, const Eigen::VectorXd& base,
                                        bool from_both_sides) const {
  const Knob& knob = *knobs_[static_cast<std::size_t>(k)];
  const auto beside = [&](double by) {
    Eigen::VectorXd x = f_.x;
    x[n_n_ + k] += by;
    Prediction kept = knob.reading_only ? responses_ : Prediction{};
    const Prediction turned = knob.reading_only ? fitter_.predict(hypothesis_, x, workspace_, &kept, true)
                                                : fitter_.predict_beside(here, f_.prediction, hypothesis_, x, workspace_);
    return fitter_.comparison_->whitened(turned);
  };
  const auto is_bound = [&](double by) { return knob.value(f_.x[n_n_ + k] + by) == knob.value(f_.x[n_n_ + k]); };
  const double step = is_bound(knob.step) ? -knob.step : knob.step;
  Eigen::VectorXd slope;
  if (from_both_sides && !is_bound(-step) &&
      has_solution([&] { slope = (beside(0.5 * step) - beside(-0.5 * step)) / step; }))
    return slope;
  return (beside(step) - base) / step;
}

void Fitter::Climb::differentiate(bool from_both_sides) {
  const Eigen::VectorXd base = fitter_.comparison_->measured() - f_.residual;
  const TwinState here = fitter_.state(hypothesis_, f_.x);
  for (Eigen::Index k = 0; k < n_k_; ++k) {
    f_.slopes.col(k).setZero();
    if (smooth_[static_cast<std::size_t>(k)]) f_.slopes.col(k) = slope_of(k, here, base, from_both_sides);
  }
  square_.topLeftCorner(n_n_, n_n_) = *nuisance_squares_;
  square_.topRightCorner(n_n_, n_k_).noalias() = nuisance_slopes_->transpose() * f_.slopes;
  square_.bottomLeftCorner(n_k_, n_n_) = square_.topRightCorner(n_n_, n_k_).transpose();
  square_.bottomRightCorner(n_k_, n_k_).noalias() = f_.slopes.transpose() * f_.slopes;
}

Fitter::Climb::Direction Fitter::Climb::direction(bool times_wait) const {
  const Eigen::VectorXd known = fitter_.prior_width(hypothesis_, f_.x).cwiseAbs2().cwiseInverse();
  Eigen::MatrixXd hessian = square_;
  hessian.diagonal() += known;
  Eigen::VectorXd gradient(n_);
  gradient.head(n_n_) = nuisance_slopes_->transpose() * f_.residual;
  gradient.tail(n_k_) = f_.slopes.transpose() * f_.residual;
  gradient -= f_.x.cwiseProduct(known);
  for (Eigen::Index k = 0; k < n_k_; ++k) {
    if (!smooth_[static_cast<std::size_t>(k)])
      gradient[n_n_ + k] = 0.0;  // no slope: the number keeps its value from the search
  }
  const auto hold = [&](Eigen::Index i) {
    hessian.row(i).setZero();
    hessian.col(i).setZero();
    hessian(i, i) = 1.0;
    gradient[i] = 0.0;
  };
  if (held_ >= 0) hold(held_);
  for (Eigen::Index k = 0; k < n_k_ && times_wait; ++k) {
    if (knobs_[static_cast<std::size_t>(k)]->is_time) hold(n_n_ + k);
  }
  Eigen::VectorXd step = bounded_step(hessian, gradient, f_.x.head(n_scatter_), fitter_.most_sigmas_ * sd_.head(n_scatter_));
  return {std::move(gradient), std::move(step)};
}

void Fitter::Climb::take(Fit& tried, Prediction& kept) {
  tried.slopes = std::move(f_.slopes);
  f_ = std::move(tried);
  responses_ = std::move(kept);
}

void Fitter::Climb::go_along(const Eigen::VectorXd& step) {
  for (double share : {1.0, 0.4, 0.1}) {
    Fit tried;
    tried.x = f_.x + share * step;
    into_range(tried.x);
    Prediction kept;
    look(tried, kept, false);
    if (!(tried.misfit < f_.misfit)) continue;
    take(tried, kept);
    break;
  }
}

void Fitter::Climb::move_times() {
  const double row_s = std::min(60.0, shortest_row_s(fitter_.runs_));
  TwinState here = fitter_.state(hypothesis_, f_.x);
  for (Eigen::Index k = 0; k < n_k_; ++k) {
    const Knob& knob = *knobs_[static_cast<std::size_t>(k)];
    if (!knob.is_time || n_n_ + k == held_) continue;
    for (double jump_s : {-960.0, 960.0, -480.0, 480.0, -240.0, 240.0, -120.0, 120.0, -60.0, 60.0, -row_s, row_s}) {
      Fit tried;
      tried.x = f_.x;
      tried.x[n_n_ + k] += jump_s;
      into_range(tried.x);
      Prediction kept = responses_;
      if (knob.reading_only)
        look(tried, kept, true);
      else
        judge(tried,
              [&] { return fitter_.predict_beside(here, f_.prediction, hypothesis_, tried.x, workspace_, {}, &kept); });
      if (!(tried.misfit < f_.misfit)) continue;
      take(tried, kept);
      here = fitter_.state(hypothesis_, f_.x);
    }
  }
}

void Fitter::Climb::weigh() {
  Eigen::MatrixXd hessian = square_;
  hessian.diagonal() += fitter_.prior_width(hypothesis_, f_.x).cwiseAbs2().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> factor(hessian);
  f_.covariance = factor.solve(Eigen::MatrixXd::Identity(n_, n_));
  // log det(1 + S J'J S) = log det(H) + 2 Σ log sd
  double log_det = 2.0 * factor.matrixLLT().diagonal().array().log().sum() + 2.0 * sd_.array().log().sum();
  f_.log_evidence = -f_.misfit - 0.5 * log_det;
  for (const Claim& c : hypothesis_) f_.log_evidence -= price_of_times(c) + c.price_nats;
  for (Eigen::Index k = 0; k < n_k_; ++k) {
    const Knob& knob = *knobs_[static_cast<std::size_t>(k)];
    const bool has_slope = smooth_[static_cast<std::size_t>(k)] != 0;
    // the prior of a time or of swapped cables is flat
    if (knob.is_time || !has_slope) f_.log_evidence += heavy_tailed_cost(sd_[n_n_ + k], f_.x[n_n_ + k]);
  }
}

Fit Fitter::Climb::best() {
  double searched_at = 1e300;  // misfit at which no other time was better
  const bool search_times = std::any_of(knobs_.begin(), knobs_.end(), [](const Knob* k) { return k->is_time; });
  // Times are fixed during the first step: linear theory chose them together with moves of all other numbers, and before
  // these moves the search for better times would be misled.
  for (int iteration = search_times ? -1 : 0; iteration < kMostIterations + n_retakes_; ++iteration) {
    const bool times_wait = iteration < 0;
    differentiate(false);
    const Direction to = direction(times_wait);
    const double before = f_.misfit;
    go_along(to.step);
    if (search_times && !times_wait && searched_at - f_.misfit >= kConverged) {
      const double unsearched = f_.misfit;
      move_times();
      searched_at = f_.misfit < unsearched ? 1e300 : f_.misfit;
    }
    if (!times_wait && before - f_.misfit < kConverged && !retake(0.5 * to.gradient.dot(to.step))) break;
  }
  differentiate(true);
  weigh();
  return std::move(f_);
}

Fit Fitter::fit(const Hypothesis& hypothesis, const Eigen::VectorXd& start, Twin::Workspace& workspace) const {
  Eigen::VectorXd x(n_nuisance() + start.size());
  x << nuisance_, start;
  return Climb(*this, hypothesis, std::move(x), -1, workspace, Slopes::kTakenAnew).best();
}

Fit Fitter::fit_others(const Hypothesis& hypothesis, const Eigen::VectorXd& start, Eigen::Index held,
                       Twin::Workspace& workspace, Slopes slopes) const {
  return Climb(*this, hypothesis, start, held, workspace, slopes).best();
}

}  // namespace driftwright::diagnosis
