#include "studies/probe_plan.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "base/normal.hpp"
#include "compensation/control/probe_feedback.h"

namespace driftwright::studies {
namespace {

constexpr double kBisected = 1e-6;           // of the half width
constexpr std::size_t kFurtherProbings = 4;  // of the curve, at least, beyond those that keep the tolerance
constexpr std::size_t kMostOfCurve = 40;     // rows of the curve, and one or two more
constexpr double kNearLeast = 0.01;          // of the least half width: the last hundredth takes most of the probings
constexpr int kPointsOfWidth = 24;           // of a plotted stretch

/// The end of the work before a time, at most that time; none without work before it.
std::optional<double> work_before_s(const ProbeJob& job, double time_s) {
  const auto later = std::lower_bound(job.work.begin(), job.work.end(), time_s,
                                      [](const WorkStretch& w, double t_s) { return w.from_s < t_s; });
  if (later == job.work.begin()) return std::nullopt;
  return std::min(std::prev(later)->until_s, time_s);
}

double start_um2(const ProbedAxis& axis) {
  return axis.is_known_at_start ? 0.0 : axis.process.deviation_um * axis.process.deviation_um;
}

double half_width_um(const ProbedAxis& axis, double um2) {
  return axis.factor * std::sqrt(um2);
}

/// What is known from one probing on.
struct Known {
  double since_s = 0.0;  // time of the job
  double um2 = 0.0;      // variance there
};

double um2_at(const ProbedAxis& axis, const Known& known, double time_s) {
  return grown_um2(axis.process, known.um2, time_s - known.since_s);
}

/// A probing: the work goes on when its value has come.
Known probed_at(const ProbedAxis& axis, const Known& known, const ProbePlace& place) {
  const double before_um2 = um2_at(axis, known, place.time_s), noise_um2 = axis.probe.noise_um * axis.probe.noise_um;
  return {place.time_s, grown_um2(axis.process, before_um2 * noise_um2 / (before_um2 + noise_um2), axis.probe.lag_s)};
}

double job_end_s(const ProbeJob& job) {
  return job.work.back().until_s;
}

/// Integral of the variance over a stretch [um² s].
double integral(const ProbedAxis& axis, const Known& known, double from_s, double until_s) {
  const double most = axis.process.deviation_um * axis.process.deviation_um, half_T = 0.5 * axis.process.time_constant_s;
  return most * (until_s - from_s) + half_T * (um2_at(axis, known, from_s) - um2_at(axis, known, until_s));
}

/// Adds what is left from `known` on until a time.
void judge_until(const ProbeJob& job, const ProbedAxis& axis, const Known& known, double until_s, ProbeSequence& sequence,
                 double& um2_s) {
  for (const WorkStretch& w : job.work) {
    const double from_s = std::max(w.from_s, known.since_s), to_s = std::min(w.until_s, until_s);
    if (!(to_s > from_s)) continue;
    um2_s += integral(axis, known, from_s, to_s);
    const double um = half_width_um(axis, um2_at(axis, known, to_s));
    if (um > sequence.worst_um) {
      sequence.worst_um = um;
      sequence.worst_s = to_s;
    }
  }
}

}  // namespace

ProbedAxis probed_axis(const compensation::DeployedPredictor& predictor, const compensation::Probe& probe,
                       double probing_time_s) {
  if (!predictor.residual) throw std::logic_error("probed_axis() of a predictor without a process");
  ProbedAxis axis{.process = *predictor.residual,
                  .probe = probe,
                  .is_known_at_start = predictor.from_start,
                  .factor = kNormal95,
                  .probing_s = probing_time_s};
  if (predictor.interval_um) axis.factor = std::max(axis.factor, *predictor.interval_um / axis.process.deviation_um);
  return axis;
}

double grown_um2(const compensation::ResidualProcess& process, double um2, double time_s) {
  const double most = process.deviation_um * process.deviation_um;
  return most + (um2 - most) * std::exp(-2.0 * time_s / process.time_constant_s);
}

ProbeSequence judged_probings(const ProbeJob& job, const ProbedAxis& axis, std::span<const std::size_t> places) {
  ProbeSequence sequence;
  Known known{.since_s = 0.0, .um2 = start_um2(axis)};
  double um2_s = 0.0, work_s = 0.0;
  for (const WorkStretch& w : job.work) work_s += w.until_s - w.from_s;
  for (std::size_t k : places) {
    const ProbePlace& place = job.places[k];
    judge_until(job, axis, known, place.time_s, sequence, um2_s);
    const std::optional<double> work_s_before = work_before_s(job, place.time_s);
    const double rest_from_s = std::max(known.since_s, work_s_before.value_or(0.0));
    const double rest_s = place.time_s - rest_from_s;  // none is left for a second probing of the place
    PlannedProbing probing{.place = k,
                           .before_um = half_width_um(axis, um2_at(axis, known, work_s_before ? rest_from_s : place.time_s)),
                           .lost_s = std::max(0.0, std::max(axis.probing_s, axis.probe.lag_s) - rest_s)};
    known = probed_at(axis, known, place);
    probing.after_um = half_width_um(axis, known.um2);
    sequence.lost_s += probing.lost_s;
    sequence.probings.push_back(probing);
  }
  judge_until(job, axis, known, job_end_s(job), sequence, um2_s);
  sequence.rms_um = std::sqrt(um2_s / work_s);
  return sequence;
}

std::optional<ProbeSequence> fewest_probings(const ProbeJob& job, const ProbedAxis& axis, double tolerance_um) {
  std::vector<std::size_t> chosen;
  Known known{.since_s = 0.0, .um2 = start_um2(axis)};
  std::size_t next = 0;  // the first place that has not been passed
  int n_here = 0;        // probings of the place before it
  const auto keeps_until = [&](double time_s) {
    const std::optional<double> end_s = work_before_s(job, time_s);  // at rest nothing has to be kept
    return !end_s || *end_s <= known.since_s || half_width_um(axis, um2_at(axis, known, *end_s)) <= tolerance_um;
  };
  while (!keeps_until(job_end_s(job))) {
    const std::size_t first = next;
    while (next < job.places.size() && keeps_until(job.places[next].time_s)) ++next;
    n_here = next > first ? 1 : n_here + 1;
    if (next == 0 || n_here > kMostAtAPlace) return std::nullopt;
    known = probed_at(axis, known, job.places[next - 1]);
    chosen.push_back(next - 1);
  }
  return judged_probings(job, axis, chosen);
}

ProbeSequence best_probings(const ProbeJob& job, const ProbedAxis& axis, std::size_t n) {
  ProbeSequence best = judged_probings(job, axis, {});
  if (n == 0) return best;
  double low_um = 0.0, high_um = best.worst_um;  // `best` has `high_um`
  while (high_um - low_um > kBisected * high_um) {
    const double tried_um = 0.5 * (low_um + high_um);
    std::optional<ProbeSequence> sequence = fewest_probings(job, axis, tried_um);
    if (sequence && sequence->probings.size() <= n) {
      high_um = std::min(tried_um, sequence->worst_um);
      best = std::move(*sequence);
    } else {
      low_um = tried_um;
    }
  }
  return best;
}

ProbeSequence equal_probings(const ProbeJob& job, const ProbedAxis& axis, std::size_t n) {
  if (n > 0 && job.places.empty()) throw std::logic_error("equal_probings() of a job without places");
  std::vector<std::size_t> chosen;
  std::set<std::size_t> fewest;  // places with the fewest probings
  const double interval_s =
      job_end_s(job) / static_cast<double>(axis.is_known_at_start ? n + 1 : std::max<std::size_t>(n, 1));
  for (std::size_t i = 0; i < n; ++i) {
    const double due_s = interval_s * static_cast<double>(axis.is_known_at_start ? i + 1 : i);
    if (fewest.empty()) {
      for (std::size_t k = 0; k < job.places.size(); ++k) fewest.insert(fewest.end(), k);
    }
    const auto due = std::lower_bound(job.places.begin(), job.places.end(), due_s,
                                      [](const ProbePlace& p, double t_s) { return p.time_s < t_s; });
    auto nearest = fewest.lower_bound(static_cast<std::size_t>(due - job.places.begin()));
    const auto away_s = [&](auto place) { return std::abs(job.places[*place].time_s - due_s); };
    if (nearest == fewest.end() || (nearest != fewest.begin() && away_s(std::prev(nearest)) <= away_s(nearest))) --nearest;
    chosen.push_back(*nearest);
    fewest.erase(nearest);
  }
  std::sort(chosen.begin(), chosen.end());
  return judged_probings(job, axis, chosen);
}

std::vector<WidthAt> widths_of(const ProbeJob& job, const ProbedAxis& axis, const ProbeSequence& sequence) {
  std::vector<WidthAt> widths;
  Known known{.since_s = 0.0, .um2 = start_um2(axis)};
  const auto add_until = [&](double until_s) {
    for (int i = 0; i <= kPointsOfWidth; ++i) {
      const double time_s = known.since_s + (until_s - known.since_s) * i / kPointsOfWidth;
      widths.push_back({time_s, half_width_um(axis, um2_at(axis, known, time_s))});
    }
  };
  for (const PlannedProbing& p : sequence.probings) {
    add_until(job.places[p.place].time_s);
    known = probed_at(axis, known, job.places[p.place]);
  }
  add_until(job_end_s(job));
  return widths;
}

const ProbeSequence* ProbePlan::equal() const {
  if (!best) return nullptr;
  const auto row = std::find_if(curve.begin(), curve.end(), [&](const auto& r) { return r.n == best->probings.size(); });
  return row == curve.end() ? nullptr : &row->equal;
}

TouchBounds touch_bounds(const ProbePlan& plan) {
  const double s_um = plan.axis.process.deviation_um * plan.axis.factor / kNormal95;
  const double s2 = s_um * s_um, r2 = plan.axis.probe.noise_um * plan.axis.probe.noise_um;
  const std::vector<PlannedProbing>& probings = plan.shown().probings;
  double longest_s = 0.0, next_s = plan.job.work.back().until_s;
  for (auto p = probings.rbegin(); p != probings.rend(); ++p) {
    const double at_s = plan.job.places[p->place].time_s;
    longest_s = std::max(longest_s, next_s - at_s);
    next_s = at_s;
  }
  if (probings.empty()) longest_s = next_s;
  longest_s += plan.axis.probing_s;
  const double changed = -std::expm1(-longest_s / plan.axis.process.time_constant_s);
  return {PROBE_REFUSED * std::sqrt(s2 + r2), PROBE_REFUSED * std::sqrt(2.0 * r2 + 2.0 * s2 * changed)};
}

ProbePlan plan_probings(ProbeJob job, const ProbedAxis& axis, double tolerance_um, double kept_free) {
  ProbePlan plan{.job = std::move(job), .axis = axis, .tolerance_um = tolerance_um, .kept_free = kept_free};
  const std::optional<ProbeSequence> fewest = fewest_probings(plan.job, axis, plan.allowed_um());
  if (fewest) {
    plan.best = best_probings(plan.job, axis, fewest->probings.size());
  } else {
    const double least_um = best_probings(plan.job, axis, kMostAtAPlace * plan.job.places.size()).worst_um;
    plan.nearest = fewest_probings(plan.job, axis, (1.0 + kNearLeast) * least_um);
  }
  const std::size_t needed = plan.shown().probings.size();
  const std::size_t last = fewest && !plan.job.places.empty() ? std::max(needed + kFurtherProbings, 2 * needed) : needed;
  const std::size_t step = 1 + last / kMostOfCurve;
  for (std::size_t n = 0; n <= last; ++n) {
    if (n % step != 0 && n != needed) continue;
    ProbeSequence best = best_probings(plan.job, axis, n);
    if (n > needed && best.probings.size() < n) break;  // more do not help
    plan.curve.push_back({n, std::move(best), equal_probings(plan.job, axis, n)});
  }
  return plan;
}

}  // namespace driftwright::studies
