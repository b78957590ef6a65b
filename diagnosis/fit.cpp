#include "diagnosis/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/lists.hpp"
#include "base/parallel.hpp"
#include "diagnosis/no_solution.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kAtBound = 1e-6;  // share of a step
constexpr double kTail = 4.0;      // degrees of freedom of a claim's prior

bool same_numbers(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_number);
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

std::vector<const Knob*> knobs_of(const Hypothesis& hypothesis) {
  std::vector<const Knob*> knobs;
  for (const Claim& c : hypothesis) {
    for (const Knob& k : c.knobs) knobs.push_back(&k);
  }
  return knobs;
}

std::vector<char> smooth_knobs(const Hypothesis& hypothesis) {
  std::vector<char> smooth;
  for (const Claim& c : hypothesis) {
    for (const Knob& k : c.knobs) smooth.push_back(!k.is_jump() && !c.all_or_nothing);
  }
  return smooth;
}

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
    : twin_(twin), runs_(runs), scatter_(std::move(scatter)), linear_rows_(runs.size()) {
  take_linear(std::move(linear));
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
      linear_rows_(other.linear_rows_),
      most_sigmas_(other.most_sigmas_),
      nuisance_(other.nuisance_),
      differences_(other.differences_),
      written_differences_(other.written_differences_) {
  if (other.comparison_) set_noise(other.noise_, other.shared_);
}

void Fitter::take_linear(std::vector<Prediction> columns) {
  for (Prediction& column : columns) {
    for (std::size_t run = 0; run < column.size(); ++run) {
      for (Eigen::Index channel = 0; channel < column[run].rows(); ++channel) {
        if (!column[run].row(channel).isZero(0.0)) linear_rows_[run].push_back({linear_.size(), channel});
      }
    }
    linear_.push_back(std::move(column));
  }
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
  const std::vector<const Knob*> knobs = knobs_of(hypothesis);
  Eigen::VectorXd sd(n_nuisance() + static_cast<Eigen::Index>(knobs.size()));
  sd.head(n_nuisance()) = nuisance_sd();
  Eigen::Index k = n_nuisance();
  for (const Knob* knob : knobs) sd[k++] = knob->prior_sd;
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
    const solver::KeptStates* near = about.empty() ? nullptr : about[r].get();
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
  for (const LinearRow& row : linear_rows_[run]) {
    const double amplitude = x[static_cast<Eigen::Index>(scatter_.size() + row.of)];
    if (amplitude != 0.0) readings.row(row.channel) += amplitude * linear_[row.of][run].row(row.channel);
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
  take_linear(columns);
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

}  // namespace driftwright::diagnosis
