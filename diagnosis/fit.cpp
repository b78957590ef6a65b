#include "diagnosis/fit.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "diagnosis/no_solution.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr int kMostIterations = 16;  // plus one for each time that slopes are recomputed
constexpr double kConverged = 0.02;  // decrease of Φ below which a fit has converged
constexpr double kFar = 2.0;         // distance in sigmas after which scatter's slopes are recomputed
constexpr double kAtBound = 1e-6;    // share of a step
constexpr double kPromised = 1.0;    // decrease of Φ that the slopes predicted but that did not happen
constexpr int kMostRetakes = 3;
constexpr int kPatience = 5;           // after this number of steps a fit is given up if its misfit is
constexpr double kOutOfReach = 3.0;    // this many times the misfit of interest,
constexpr double kOutOfReachBy = 100;  // larger by this difference,
constexpr double kFallen = 0.7;        // and has not fallen to this share in three steps
constexpr double kTail = 4.0;          // degrees of freedom of a claim's prior

Eigen::Index n_knobs(const Hypothesis& hypothesis) {
  Eigen::Index n = 0;
  for (const Claim& c : hypothesis) n += static_cast<Eigen::Index>(c.knobs.size());
  return n;
}

std::vector<const Knob*> knobs_of(const Hypothesis& hypothesis) {
  std::vector<const Knob*> knobs;
  for (const Claim& c : hypothesis) {
    for (const Knob& k : c.knobs) knobs.push_back(&k);
  }
  return knobs;
}

/// Whether a knob is turned by slopes.
std::vector<char> smooth_knobs(const Hypothesis& hypothesis) {
  std::vector<char> smooth;
  for (const Claim& c : hypothesis) {
    for (const Knob& k : c.knobs) smooth.push_back(!k.is_jump() && !c.all_or_nothing);
  }
  return smooth;
}

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

bool same_numbers(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double u, double v) { return u == v || (std::isnan(u) && std::isnan(v)); });
}

bool acts_alike(const effects::Effect& a, const effects::Effect& b) {
  return a.kind == b.kind && a.place == b.place && a.in == b.in && a.from_s == b.from_s && a.until_s == b.until_s &&
         a.words == b.words && same_numbers(a.values, b.values) &&
         std::equal(a.tables.begin(), a.tables.end(), b.tables.begin(), b.tables.end(), [](const auto& s, const auto& t) {
           return s.first == t.first && s.second.time_s == t.second.time_s && s.second.value == t.second.value;
         });
}

/// Whether an effect changes how far parts expand, and nothing else.
bool is_of_expansion(const effects::Effect& e) {
  if (!e.kind->change_material || e.kind->acts_on_heat() || e.kind->change_drive || e.kind->change_readings) return false;
  const std::vector<effects::MaterialFactor> factors = effects::material_factors({e});
  return std::all_of(factors.begin(), factors.end(),
                     [](const effects::MaterialFactor& f) { return f.conductivity == 1.0 && f.heat_capacity == 1.0; });
}

/// What two states have in common in a run.
enum class Common { kReadings, kTemperatures, kNothing };

/// @param after  made from `before` by changing numbers and appending effects
Common in_common(const TwinState& before, const TwinState& after, const std::string& run) {
  if (after.size() < before.size()) return Common::kNothing;
  Common common = Common::kReadings;
  for (std::size_t i = 0; i < after.size(); ++i) {
    const bool is_there = i < before.size();
    const bool acts = after[i].acts_in(run) || (is_there && before[i].acts_in(run));
    if (!acts || (is_there && acts_alike(before[i], after[i]))) continue;
    if (!is_of_expansion(after[i]) || (is_there && !is_of_expansion(before[i]))) return Common::kNothing;
    common = Common::kTemperatures;
  }
  return common;
}

}  // namespace

double price_of_times(const Claim& claim) {
  double price = 0.0;
  for (const Knob& k : claim.knobs) {
    if (k.is_jump()) price += std::log(std::max(2.0, k.prior_sd * std::sqrt(12.0) / 120.0));
  }
  return price;
}

Remainder without_claims(const Hypothesis& hypothesis, const std::vector<std::size_t>& claims, Eigen::Index n_nuisance) {
  Remainder left;
  for (Eigen::Index i = 0; i < n_nuisance; ++i) left.x.push_back(i);
  Eigen::Index at = n_nuisance;
  for (std::size_t c = 0; c < hypothesis.size(); ++c) {
    const auto next = at + static_cast<Eigen::Index>(hypothesis[c].knobs.size());
    if (std::find(claims.begin(), claims.end(), c) == claims.end()) {
      left.hypothesis.push_back(hypothesis[c]);
      for (Eigen::Index i = at; i < next; ++i) left.x.push_back(i);
    }
    at = next;
  }
  return left;
}

Fitter::Fitter(const Twin& twin, const std::vector<MeasuredRun>& runs, std::vector<Knob> scatter,
               std::vector<Prediction> linear, const Listener& listener)
    : twin_(twin), runs_(runs), scatter_(std::move(scatter)), linear_(std::move(linear)) {
  nuisance_ = Eigen::VectorXd::Zero(n_nuisance());
  const Eigen::VectorXd x = nuisance_;
  take_slopes({}, x, {.on_begin = {}, .on_share = listener.on_share, .wants_end_now = {}});
  written_differences_ = differences_;
}

Fitter::Fitter(const Fitter& other, const std::vector<MeasuredRun>& runs)
    : twin_(other.twin_),
      runs_(runs),
      scatter_(other.scatter_),
      linear_(other.linear_),
      most_sigmas_(other.most_sigmas_),
      nuisance_(other.nuisance_),
      differences_(other.differences_),
      written_differences_(other.written_differences_) {
  if (other.comparison_) set_noise(other.noise_, other.shared_);
}

double heavy_tailed_width(double prior_sd, double x) {
  const double u = x / prior_sd;
  return prior_sd * std::sqrt(1.0 + u * u / (kTail + 1.0));
}

double heavy_tailed_cost(double prior_sd, double x) {
  const double u = x / prior_sd;
  return 0.5 * (kTail + 1.0) * std::log1p(u * u / (kTail + 1.0));
}

Eigen::VectorXd Fitter::nuisance_sd() const {
  Eigen::VectorXd sd = Eigen::VectorXd::Ones(n_nuisance());
  for (std::size_t i = 0; i < scatter_.size(); ++i) sd[static_cast<Eigen::Index>(i)] = scatter_[i].prior_sd;
  return sd;
}

Eigen::VectorXd Fitter::prior_sd(const Hypothesis& hypothesis) const {
  Eigen::VectorXd sd(n_nuisance() + n_knobs(hypothesis));
  sd.head(n_nuisance()) = nuisance_sd();
  Eigen::Index k = n_nuisance();
  for (const Knob* knob : knobs_of(hypothesis)) sd[k++] = knob->prior_sd;
  return sd;
}

Eigen::VectorXd Fitter::prior_width(const Hypothesis& hypothesis, const Eigen::VectorXd& x) const {
  Eigen::VectorXd width = prior_sd(hypothesis);
  const std::vector<const Knob*> knobs = knobs_of(hypothesis);
  const std::vector<char> smooth = smooth_knobs(hypothesis);
  for (std::size_t k = 0; k < knobs.size(); ++k) {
    const Eigen::Index at = n_nuisance() + static_cast<Eigen::Index>(k);
    if (smooth[k] && !knobs[k]->is_time) width[at] = heavy_tailed_width(width[at], x[at]);  // all others have a flat prior
  }
  return width;
}

TwinState Fitter::state(const Hypothesis& hypothesis, const Eigen::VectorXd& x) const {
  TwinState state = twin_.as_written();
  for (std::size_t i = 0; i < scatter_.size(); ++i) {
    const double xi = x[static_cast<Eigen::Index>(i)];
    if (xi != 0.0) scatter_[i].set(state, scatter_[i].value(xi));
  }
  Eigen::Index next = n_nuisance();
  for (const Claim& c : hypothesis) {
    for (const Knob& k : c.knobs) k.set(state, k.value(x[next++]));
  }
  return state;
}

Prediction Fitter::predict(const Hypothesis& hypothesis, const Eigen::VectorXd& x, Twin::Workspace& workspace,
                           Prediction* responses, bool reuse) const {
  const TwinState s = state(hypothesis, x);
  Prediction prediction;
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    Eigen::MatrixXd response = reuse ? (*responses)[r] : twin_.respond(s, runs_[r], workspace);
    if (responses && !reuse) {
      if (responses->size() <= r) responses->resize(r + 1);
      (*responses)[r] = response;
    }
    prediction.push_back(readings(s, r, x, std::move(response)));
  }
  return prediction;
}

Eigen::VectorXd Fitter::of_machine(Eigen::VectorXd x) const {
  x.segment(static_cast<Eigen::Index>(scatter_.size()), static_cast<Eigen::Index>(linear_.size())).setZero();
  return x;
}

Prediction Fitter::predict_machine(const Hypothesis& hypothesis, const Eigen::VectorXd& x,
                                   Twin::Workspace& workspace) const {
  return predict(hypothesis, of_machine(x), workspace);
}

Prediction Fitter::predict_beside(const TwinState& known_state, const Prediction& known, const Hypothesis& hypothesis,
                                  const Eigen::VectorXd& x, Twin::Workspace& workspace, const KeptRuns& about,
                                  Prediction* responses) const {
  const TwinState s = state(hypothesis, x);
  Prediction prediction;
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const Common common = in_common(known_state, s, runs_[r].name);
    if (common == Common::kReadings) {
      prediction.push_back(known[r]);
      continue;
    }
    const solver::KeptRun* near = about.empty() ? nullptr : about[r].get();
    Eigen::MatrixXd response = near && common == Common::kTemperatures ? twin_.outputs_of(s, runs_[r], near->states())
                                                                       : twin_.respond(s, runs_[r], workspace, near);
    if (responses) (*responses)[r] = response;
    prediction.push_back(readings(s, r, x, std::move(response)));
  }
  return prediction;
}

Eigen::MatrixXd Fitter::readings(const TwinState& state, std::size_t run, const Eigen::VectorXd& x,
                                 Eigen::MatrixXd response) const {
  Eigen::MatrixXd readings = twin_.read(state, runs_[run], std::move(response));
  for (std::size_t l = 0; l < linear_.size(); ++l) {
    const double amplitude = x[static_cast<Eigen::Index>(scatter_.size() + l)];
    if (amplitude != 0.0) readings += amplitude * linear_[l][run];
  }
  return readings;
}

Fitter::KeptRuns Fitter::kept_runs(const TwinState& state, Twin::Workspace& workspace, bool for_slopes) const {
  KeptRuns all;
  for (const MeasuredRun& run : runs_) all.push_back(twin_.kept_run(state, run, workspace, for_slopes));
  return all;
}

Prediction Fitter::slope(const Hypothesis& hypothesis, const Eigen::VectorXd& x, const Prediction& base,
                         const KeptRuns& about, std::size_t which, Twin::Workspace& workspace) const {
  const TwinState here = state(hypothesis, x);
  const Knob& knob = scatter_[which];
  const double at = x[static_cast<Eigen::Index>(which)];
  const auto moved = [&](double by) {
    return knob.x(knob.value(at + by)) - knob.x(knob.value(at));
  };  // no further than its bound
  const auto beside = [&](double by) {
    Eigen::VectorXd turned = x;
    turned[static_cast<Eigen::Index>(which)] += by;
    Prediction p;
    if (std::abs(moved(by)) < kAtBound * std::abs(by)) return p;
    return has_solution([&] { p = predict_beside(here, base, hypothesis, turned, workspace, about); }) ? p : Prediction{};
  };
  // Differences from both sides: if capacities, conductances and heats change by the same factor, no reading changes. The
  // curvature errors of one-sided slopes do not cancel there, so this direction would seem far better known than it is.
  for (double share : {1.0, 0.1}) {  // a machine that is about to run away has a solution on one side only
    const double step = share * knob.step;
    Prediction above = beside(step), below = beside(-step);
    if (above.empty() && below.empty()) continue;
    const double width = (above.empty() ? 0.0 : moved(step)) - (below.empty() ? 0.0 : moved(-step));
    if (above.empty()) above = base;
    if (below.empty()) below = base;
    for (std::size_t r = 0; r < runs_.size(); ++r) above[r] = (above[r] - below[r]) / width;
    return above;
  }
  throw SolveError(fmt::format("the machine has no solution beside {} of {}", knob.name, knob.where));
}

void Fitter::take_slopes(const Hypothesis& hypothesis, const Eigen::VectorXd& x, const Listener& listener) {
  std::vector<Prediction> differences(scatter_.size());
  Prediction base;
  KeptRuns about;
  {
    Twin::Workspace workspace(twin_);
    base = predict_machine(hypothesis, x, workspace);
    about = kept_runs(state(hypothesis, x), workspace);
  }
  const Eigen::VectorXd at = of_machine(x);
  for_each_index(
      scatter_.size(), [&] { return Twin::Workspace(twin_); },
      [&](std::size_t i, Twin::Workspace& workspace) { differences[i] = slope(hypothesis, at, base, about, i, workspace); },
      listener);
  differences_ = std::move(differences);
}

Eigen::MatrixXd Fitter::whitened_slopes(const std::vector<Prediction>& differences) const {
  Eigen::MatrixXd slopes(comparison_->n(), n_nuisance());
  for (std::size_t i = 0; i < scatter_.size(); ++i)
    slopes.col(static_cast<Eigen::Index>(i)) = comparison_->whitened(differences[i]);
  for (std::size_t l = 0; l < linear_.size(); ++l)
    slopes.col(static_cast<Eigen::Index>(scatter_.size() + l)) = comparison_->whitened(linear_[l]);
  return slopes;
}

void Fitter::whiten_slopes() {
  slopes_ = whitened_slopes(differences_);
  squares_.noalias() = slopes_.transpose() * slopes_;
}

void Fitter::add_linear(const std::vector<Prediction>& columns) {
  linear_.insert(linear_.end(), columns.begin(), columns.end());
  const Eigen::Index before = nuisance_.size();
  nuisance_.conservativeResize(n_nuisance());
  nuisance_.tail(n_nuisance() - before).setZero();
}

void Fitter::set_noise(const std::map<std::string, NoiseModel>& noise, std::shared_ptr<const SharedNoise> shared) {
  noise_ = noise;
  shared_ = std::move(shared);
  comparison_.emplace(runs_, noise, shared_ ? *shared_ : SharedNoise{});
  whiten_slopes();
  written_slopes_ = whitened_slopes(written_differences_);
  written_squares_.noalias() = written_slopes_.transpose() * written_slopes_;
}

void Fitter::settle(const Hypothesis& hypothesis, const Fit& at) {
  take_slopes(hypothesis, at.x);
  nuisance_ = at.x.head(n_nuisance());
  whiten_slopes();
}

Eigen::MatrixXd Fitter::slopes_at(const Hypothesis& hypothesis, const Fit& at, Prediction responses) const {
  Eigen::MatrixXd slopes = slopes_;
  KeptRuns about;
  Prediction base;
  const Eigen::VectorXd x = of_machine(at.x);
  {
    Twin::Workspace workspace(twin_);
    base = predict(hypothesis, x, workspace, &responses, true);
    about = kept_runs(state(hypothesis, x), workspace);
  }
  for_each_index(
      scatter_.size(), [&] { return Twin::Workspace(twin_); },
      [&](std::size_t i, Twin::Workspace& own) {
        slopes.col(static_cast<Eigen::Index>(i)) = comparison_->whitened(slope(hypothesis, x, base, about, i, own));
      });
  return slopes;
}

Fit Fitter::fit(const Hypothesis& hypothesis, const Eigen::VectorXd& start, Twin::Workspace& workspace,
                double of_interest) const {
  Eigen::VectorXd x(n_nuisance() + start.size());
  x << nuisance_, start;
  return climb(hypothesis, std::move(x), -1, workspace, of_interest, Slopes::kTakenAnew);
}

Fit Fitter::fit_others(const Hypothesis& hypothesis, const Eigen::VectorXd& start, Eigen::Index held,
                       Twin::Workspace& workspace, double of_interest, Slopes slopes) const {
  return climb(hypothesis, start, held, workspace, of_interest, slopes);
}

Fit Fitter::climb(const Hypothesis& hypothesis, Eigen::VectorXd start, Eigen::Index held, Twin::Workspace& workspace,
                  double of_interest, Slopes slopes) const {
  const Eigen::Index n_n = n_nuisance(), n_k = n_knobs(hypothesis), n = n_n + n_k,
                     n_scatter = static_cast<Eigen::Index>(scatter_.size());
  const std::vector<const Knob*> knobs = knobs_of(hypothesis);
  const std::vector<char> smooth = smooth_knobs(hypothesis);
  const Eigen::VectorXd sd = prior_sd(hypothesis);
  const auto into_range = [&](Eigen::VectorXd& x) {
    const auto to_bound = [](const Knob& knob, double& number) {  // beyond its bound a number has no slope
      if (const double value = knob.value(number); value == knob.low || value == knob.high) number = knob.x(value);
    };
    for (std::size_t i = 0; i < scatter_.size(); ++i) {
      double& number = x[static_cast<Eigen::Index>(i)];
      const double most = most_sigmas_ * scatter_[i].prior_sd;
      number = std::clamp(number, -most, most);
      to_bound(scatter_[i], number);
    }
    for (Eigen::Index k = 0; k < n_k; ++k) {
      const Knob& knob = *knobs[static_cast<std::size_t>(k)];
      to_bound(knob, x[n_n + k]);
      x[n_n + k] = std::clamp(x[n_n + k], -8.0 * knob.prior_sd, 8.0 * knob.prior_sd);
    }
  };
  const auto prior = [&](const Eigen::VectorXd& x) {
    double sum = 0.5 * x.head(n_n).cwiseQuotient(sd.head(n_n)).squaredNorm();
    for (Eigen::Index k = n_n; k < n; ++k) sum += heavy_tailed_cost(sd[k], x[k]);
    return sum;
  };

  Fit f;
  f.x = std::move(start);
  into_range(f.x);
  Prediction responses;
  const auto judge = [&](Fit& at, const auto& predicted) {
    at.misfit = 1e300;
    if (!has_solution([&] { at.prediction = predicted(); })) return;  // a step too far
    at.residual = comparison_->measured() - comparison_->whitened(at.prediction);
    const double misfit = 0.5 * at.residual.squaredNorm() + prior(at.x);
    if (std::isfinite(misfit)) at.misfit = misfit;
  };
  const auto look = [&](Fit& at, Prediction& kept, bool reuse) {
    judge(at, [&] { return predict(hypothesis, at.x, workspace, &kept, reuse); });
  };
  look(f, responses, false);
  if (f.prediction.empty() || f.misfit >= 1e300) throw SolveError("the machine has no solution where the fit begins");

  // Scatter's slopes are those of the fitter; they are recomputed where a fit has moved far.
  Eigen::MatrixXd own_slopes, own_squares;
  const Eigen::MatrixXd *nuisance_slopes = &slopes_, *nuisance_squares = &squares_;
  Eigen::VectorXd taken_at = nuisance_;
  int n_retakes = 0;
  const auto retake = [&](double promised) {
    if (n_n == 0 || slopes == Slopes::kKept) return false;
    const Eigen::VectorXd gone = (f.x.head(n_n) - taken_at).cwiseQuotient(sd.head(n_n));
    const double far = gone.cwiseAbs().maxCoeff();
    const bool are_here = n_retakes > 0 && far == 0.0;
    if (n_retakes == kMostRetakes || are_here || (far <= kFar && promised < kPromised)) return false;
    own_slopes = slopes_at(hypothesis, f, responses);
    own_squares.noalias() = own_slopes.transpose() * own_slopes;
    nuisance_slopes = &own_slopes;
    nuisance_squares = &own_squares;
    taken_at = f.x.head(n_n);
    ++n_retakes;
    return true;
  };

  if (n_n > 0 && f.x.head(n_n).isZero(0.0)) {
    nuisance_slopes = &written_slopes_;
    nuisance_squares = &written_squares_;
    taken_at = f.x.head(n_n);
  }

  Eigen::MatrixXd square(n, n);
  f.slopes.resize(f.residual.size(), n_k);
  const auto differentiate = [&](bool from_both_sides) {
    const Eigen::VectorXd base = comparison_->measured() - f.residual;
    const TwinState here = state(hypothesis, f.x);
    for (Eigen::Index k = 0; k < n_k; ++k) {
      f.slopes.col(k).setZero();
      if (!smooth[static_cast<std::size_t>(k)]) continue;
      const Knob& knob = *knobs[static_cast<std::size_t>(k)];
      const auto beside = [&](double by) {
        Eigen::VectorXd x = f.x;
        x[n_n + k] += by;
        Prediction kept = knob.reading_only ? responses : Prediction{};
        const Prediction turned = knob.reading_only ? predict(hypothesis, x, workspace, &kept, true)
                                                    : predict_beside(here, f.prediction, hypothesis, x, workspace);
        return comparison_->whitened(turned);
      };
      const auto is_bound = [&](double by) { return knob.value(f.x[n_n + k] + by) == knob.value(f.x[n_n + k]); };
      const double step = is_bound(knob.step) ? -knob.step : knob.step;
      if (from_both_sides && !is_bound(-step) &&
          has_solution([&] { f.slopes.col(k) = (beside(0.5 * step) - beside(-0.5 * step)) / step; }))
        continue;
      f.slopes.col(k) = (beside(step) - base) / step;
    }
    square.topLeftCorner(n_n, n_n) = *nuisance_squares;
    square.topRightCorner(n_n, n_k).noalias() = nuisance_slopes->transpose() * f.slopes;
    square.bottomLeftCorner(n_k, n_n) = square.topRightCorner(n_n, n_k).transpose();
    square.bottomRightCorner(n_k, n_k).noalias() = f.slopes.transpose() * f.slopes;
  };

  double row_s = 60.0;
  for (const MeasuredRun& run : runs_) {
    row_s = std::min(row_s, run.time_s.back() / static_cast<double>(run.time_s.size() - 1));
  }
  std::vector<double> passed;  // misfits
  double searched_at = 1e300;  // misfit at which no other time was better
  const bool search_times = std::any_of(knobs.begin(), knobs.end(), [](const Knob* k) { return k->is_time; });
  // Times are fixed during the first step: linear theory chose them together with moves of all other numbers, and before
  // these moves the search for better times would be misled.
  for (int iteration = search_times ? -1 : 0; iteration < kMostIterations + n_retakes; ++iteration) {
    const bool times_wait = iteration < 0;
    differentiate(false);
    const Eigen::VectorXd known = prior_width(hypothesis, f.x).cwiseAbs2().cwiseInverse();
    Eigen::MatrixXd hessian = square;
    hessian.diagonal() += known;
    Eigen::VectorXd gradient(n);
    gradient.head(n_n) = nuisance_slopes->transpose() * f.residual;
    gradient.tail(n_k) = f.slopes.transpose() * f.residual;
    gradient -= f.x.cwiseProduct(known);
    for (Eigen::Index k = 0; k < n_k; ++k) {
      if (!smooth[static_cast<std::size_t>(k)])
        gradient[n_n + k] = 0.0;  // no slope: the number keeps its value from the search
    }
    const auto hold = [&](Eigen::Index i) {
      hessian.row(i).setZero();
      hessian.col(i).setZero();
      hessian(i, i) = 1.0;
      gradient[i] = 0.0;
    };
    if (held >= 0) hold(held);
    for (Eigen::Index k = 0; k < n_k && times_wait; ++k) {
      if (knobs[static_cast<std::size_t>(k)]->is_time) hold(n_n + k);
    }
    const Eigen::VectorXd step = bounded_step(hessian, gradient, f.x.head(n_scatter), most_sigmas_ * sd.head(n_scatter));
    const double before = f.misfit;
    for (double share : {1.0, 0.4, 0.1}) {
      Fit tried;
      tried.x = f.x + share * step;
      into_range(tried.x);
      Prediction kept;
      look(tried, kept, false);
      if (!(tried.misfit < f.misfit)) continue;
      tried.slopes = std::move(f.slopes);
      f = std::move(tried);
      responses = std::move(kept);
      break;
    }
    if (search_times && !times_wait && searched_at - f.misfit >= kConverged) {
      const double unsearched = f.misfit;
      TwinState here = state(hypothesis, f.x);
      for (Eigen::Index k = 0; k < n_k; ++k) {
        const Knob& knob = *knobs[static_cast<std::size_t>(k)];
        if (!knob.is_time || n_n + k == held) continue;
        for (double jump_s : {-960.0, 960.0, -480.0, 480.0, -240.0, 240.0, -120.0, 120.0, -60.0, 60.0, -row_s, row_s}) {
          Fit tried;
          tried.x = f.x;
          tried.x[n_n + k] += jump_s;
          into_range(tried.x);
          Prediction kept = responses;
          if (knob.reading_only)
            look(tried, kept, true);
          else
            judge(tried, [&] { return predict_beside(here, f.prediction, hypothesis, tried.x, workspace, {}, &kept); });
          if (!(tried.misfit < f.misfit)) continue;
          tried.slopes = std::move(f.slopes);
          f = std::move(tried);
          responses = std::move(kept);
          here = state(hypothesis, f.x);
        }
      }
      searched_at = f.misfit < unsearched ? 1e300 : f.misfit;
    }
    passed.push_back(f.misfit);
    if (iteration >= kPatience && f.misfit > kOutOfReach * of_interest + kOutOfReachBy &&
        f.misfit > kFallen * passed[passed.size() - 4])
      return {};
    if (!times_wait && before - f.misfit < kConverged && !retake(0.5 * gradient.dot(step))) break;
  }
  differentiate(true);
  Eigen::MatrixXd hessian = square;
  hessian.diagonal() += prior_width(hypothesis, f.x).cwiseAbs2().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> factor(hessian);
  f.covariance = factor.solve(Eigen::MatrixXd::Identity(n, n));
  // log det(1 + S J'J S) = log det(H) + 2 Σ log sd
  double log_det = 2.0 * factor.matrixLLT().diagonal().array().log().sum() + 2.0 * sd.array().log().sum();
  f.log_evidence = -f.misfit - 0.5 * log_det;
  for (const Claim& c : hypothesis) f.log_evidence -= price_of_times(c) + c.price_nats;
  for (Eigen::Index k = 0; k < n_k; ++k) {
    const Knob& knob = *knobs[static_cast<std::size_t>(k)];
    const bool has_slope = smooth[static_cast<std::size_t>(k)] != 0;
    // the prior of a time or of swapped cables is flat
    if (knob.is_time || !has_slope) f.log_evidence += heavy_tailed_cost(sd[n_n + k], f.x[n_n + k]);
  }
  return f;
}

}  // namespace driftwright::diagnosis
