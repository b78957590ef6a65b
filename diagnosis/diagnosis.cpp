#include "diagnosis/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "base/normal.hpp"
#include "diagnosis/calibration.hpp"
#include "diagnosis/extended_scenario.hpp"
#include "diagnosis/inquiry.hpp"
#include "diagnosis/interval.hpp"
#include "diagnosis/missing_data.hpp"
#include "diagnosis/no_solution.hpp"
#include "diagnosis/own_effects.hpp"
#include "diagnosis/unexplained.hpp"
#include "diagnosis/verdict.hpp"

namespace driftwright::diagnosis {
namespace {

const double kSureOdds = std::log(kSure / (1.0 - kSure));  // for a number that moved too far [nats]

/// Index of a claim's first knob in x.
Eigen::Index first_of(const Hypothesis& hypothesis, std::size_t claim, Eigen::Index n_nuisance) {
  for (std::size_t c = 0; c < claim; ++c) n_nuisance += static_cast<Eigen::Index>(hypothesis[c].knobs.size());
  return n_nuisance;
}

/// A claim of a hypothesis, with its numbers.
Cause cause_of(const std::vector<Candidate>& list, const Fitter& fitter, const Hypothesis& hypothesis, std::size_t claim,
               const Fit& fit, double gain, const Listener& listener) {
  const Claim& of = hypothesis[claim];
  const Variant& variant = list[of.candidate].variants[of.variant];
  Cause c{list[of.candidate].effect, list[of.candidate].where, variant.law, {}, gain, {}};
  const Eigen::Index first = first_of(hypothesis, claim, fitter.n_nuisance());
  c.own = own_effects(fitter.twin().as_written(),
                      change_of(of, fit.x.segment(first, static_cast<Eigen::Index>(of.knobs.size()))));
  for (std::size_t k = 0; k < of.knobs.size() && !of.all_or_nothing; ++k) {
    const Knob& knob = of.knobs[k];
    const auto at = first + static_cast<Eigen::Index>(k);
    const double sd = std::sqrt(std::max(0.0, fit.covariance(at, at)));
    const Interval x = listener.wants_end() ? Interval{fit.x[at] - kNormal95 * sd, fit.x[at] + kNormal95 * sd}
                                            : profile_interval(fitter, hypothesis, fit, claim, k);
    const double scale = knob.is_time ? 60.0 : 1.0;
    c.parameters.push_back({knob.name, knob.is_time ? "min" : knob.unit, knob.value(fit.x[at]) / scale,
                            knob.value(x.low) / scale, knob.value(x.high) / scale});
  }
  if (variant.at_speed_rpm > 0.0) {
    c.parameters.push_back({"at_speed", "rpm", variant.at_speed_rpm, variant.at_speed_rpm, variant.at_speed_rpm});
  }
  return c;
}

/// The claims with which kept-out rows are predicted better, with all numbers fitted for them alone.
Written written_of(const Fitter& fitter, const SearchResult& result, const HeldOut& held, Twin::Workspace& workspace) {
  Written w{.hypothesis = result.hypothesis,
            .causes = {},
            .fit = result.fit,
            .why_not = held.why_not_written,
            .keeps_numbers = held.why_nothing.empty(),
            .why_nothing = held.why_nothing};
  for (std::size_t c = 0; c < result.hypothesis.size(); ++c) (w.why_not[c].empty() ? w.causes : w.taken_up).push_back(c);
  if (!w.taken_up.empty()) {
    const Remainder rest = without_claims(result.hypothesis, w.taken_up, fitter.n_nuisance());
    w.hypothesis = rest.hypothesis;
    w.fit = result.without;
    const Eigen::VectorXd x = result.fit.x(rest.x);
    if (!w.hypothesis.empty() &&
        !has_solution([&] { w.fit = fitter.fit(w.hypothesis, x.tail(x.size() - fitter.n_nuisance()), workspace); })) {
      for (std::size_t c : w.causes) w.why_not[c] = "the machine has no solution without the causes that are left out";
      w.taken_up.insert(w.taken_up.end(), w.causes.begin(), w.causes.end());
      w.hypothesis.clear();
      w.causes.clear();
    }
  }
  if (w.keeps_numbers) return w;
  w.taken_up.clear();
  for (std::string& why : w.why_not) {
    if (why.empty()) why = w.why_nothing;
  }
  return w;
}

void leave_out(Cause& cause, const std::string& why) {
  cause.is_written = false;
  cause.why_not_written = why;
}

/// Numbers of the scenario that moved too far for a calibration: causes with their own key, as fitted. The surest is first,
/// also in Diagnosis::moved.
void add_moved_numbers(Diagnosis& d, const Twin& twin) {
  std::vector<Cause> causes;
  const double price = std::log(std::max(1.0, static_cast<double>(d.n_candidates)));
  for (std::size_t i : d.moved) {
    const Estimate& e = d.calibrated[i];
    const Knob& k = d.scatter[i];
    const double fitted = k.scale == Knob::Scale::kLog ? std::log(e.value / k.nominal) : e.value - k.nominal;
    const double known_to = std::abs(e.deviation) > 0.0 ? std::abs(fitted / e.deviation) : k.prior_sd;
    // The density of its value under the wide prior of a fault divided by that under its own prior.
    const double gain =
        0.5 * e.deviation * e.deviation - 0.5 * std::pow(fitted / k.prior_sd, 2) - std::log(k.prior_sd / known_to) - price;
    Estimate number = e;
    number.name = k.name;
    Cause c{k.effect, k.where, fmt::format("another {}, {:+.1f} sigmas from what is known of it", k.name, e.deviation),
            {number}, gain,    {}};
    c.own = own_effects(twin.as_written(), [&](TwinState& state) { k.set(state, e.value); });
    if (!d.written.keeps_numbers) leave_out(c, d.written.why_nothing);
    c.standing = gain >= kSureOdds ? Standing::kNamed : Standing::kSuspected;
    if (c.standing == Standing::kNamed &&
        !d.written.keeps_numbers) {  // the fitted numbers harm rows that they were not fitted to
      c.standing = Standing::kSuspected;
      c.doubt = d.written.why_nothing;
    }
    causes.push_back(std::move(c));
  }
  std::vector<std::size_t> order(causes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return causes[a].log_evidence_gain > causes[b].log_evidence_gain; });
  const std::vector<std::size_t> moved = d.moved;
  for (std::size_t i = 0; i < order.size(); ++i) {
    d.moved[i] = moved[order[i]];
    d.causes.push_back(std::move(causes[order[i]]));
  }
}

/// Simulates what was found without each cause in turn, at the same numbers.
void add_readings_without(Diagnosis& d, const Fitter& fitter, Twin::Workspace& workspace, const Listener& listener) {
  d.without_cause.assign(d.causes.size(), {});
  for (std::size_t c = 0; c < d.causes.size() && !listener.wants_end(); ++c) {
    const std::size_t n_found = d.search.findings.size();
    Hypothesis hypothesis = d.search.hypothesis;
    Eigen::VectorXd x = d.search.fit.x;
    if (c < n_found) {
      const Remainder rest = without_claims(d.search.hypothesis, {c}, fitter.n_nuisance());
      hypothesis = rest.hypothesis;
      x = d.search.fit.x(rest.x);
    } else {
      x[static_cast<Eigen::Index>(d.moved[c - n_found])] = 0.0;
    }
    Prediction without;
    if (has_solution([&] { without = fitter.predict(hypothesis, x, workspace); })) d.without_cause[c] = std::move(without);
  }
}

/// For one record of a machine with an unexplained error: in all trials, fits held for their own rows only
/// (docs/theory/measured.md).
void write_nothing(Diagnosis& d, const std::string& why) {
  d.written.keeps_numbers = false;
  d.written.why_nothing = why;
  d.written.taken_up.clear();
  d.extended = d.as_written;
  for (Cause& c : d.causes) leave_out(c, d.written.why_nothing);
  for (Estimate& e : d.calibrated) e.is_written = false;
  for (ChannelGain& g : d.gain) {
    g.rmse_after = g.rmse_before;
    g.peak_after = g.peak_before;
  }
  d.misses.extended = d.misses.as_written;
}

/// Removes the certainty of every cause.
void doubt_all(Diagnosis& d, const std::string& why) {
  for (Cause& c : d.causes) {
    if (c.standing != Standing::kSuspected && c.doubt.empty()) c.doubt = why;
    c.standing = Standing::kSuspected;
  }
}

/// Sets the written causes' numbers as they are written. @param fitter  fitter of these numbers
void say_what_is_written(Diagnosis& d, const Fitter& fitter, const Listener& listener) {
  for (std::size_t i = 0; i < d.written.causes.size(); ++i) {
    Cause& c = d.causes.at(d.written.causes[i]);
    c.parameters =
        cause_of(d.search.candidates, fitter, d.written.hypothesis, i, d.written.fit, c.log_evidence_gain, listener)
            .parameters;
  }
}

/// Writes causes with the scenario's own numbers unchanged.
void write_alone(Diagnosis& d, const CausesAlone& alone, const Fitter& fitter, Twin::Workspace& workspace,
                 const Listener& listener) {
  d.written = {.hypothesis = alone.hypothesis,
               .causes = alone.claims,
               .fit = alone.fit,
               .why_not = {},
               .keeps_numbers = true,
               .causes_alone = true,
               .why_nothing =
                   "for a single record with an unexplained rest, a cause is written only if it has 20 nats, has no time of "
                   "its own, and does not worsen the prediction of the last third of the record"};
  Fitter numbers_as_written(fitter.twin(), fitter.runs(), {}, {});
  numbers_as_written.set_noise(fitter.noise(), fitter.shared_noise());
  d.extended = numbers_as_written.predict_machine(alone.hypothesis, alone.fit.x, workspace);
  d.holdout = alone.how;
  d.gain = alone.channels;
  d.misses = alone.misses;
  for (Estimate& e : d.calibrated) e.is_written = false;
  for (std::size_t c = 0; c < d.causes.size(); ++c) {
    const bool is_written = std::find(alone.claims.begin(), alone.claims.end(), c) != alone.claims.end();
    d.causes[c].is_written = is_written;
    d.causes[c].why_not_written = is_written ? "" : d.written.why_nothing;
  }
  say_what_is_written(d, numbers_as_written, listener);
}

/// For a diagnosis that was ended: reports what is known so far, and that it was not judged.
void leave_incomplete(Diagnosis& d, const std::string& stage) {
  d.ended_at = stage;
  for (Cause& c : d.causes) {
    c.standing = Standing::kSuspected;
    c.doubt = "the diagnosis was ended before it was complete";
  }
  if (d.verdict == Verdict::kConsistent) d.verdict = Verdict::kInsufficientData;
  if (d.verdict == Verdict::kNamed || d.verdict == Verdict::kAmbiguous) d.verdict = Verdict::kSuspected;
  d.reason = fmt::format("Ended at \"{}\", before it was complete. {}", stage,
                         d.causes.empty() ? "No cause was found so far." : "So far: " + reason_of(d));
}

/// The causes that the search found, with intervals, and what cannot be distinguished from them.
void add_causes_found(Diagnosis& d, const Fitter& fitter, const Listener& listener) {
  const std::vector<Candidate>& list = d.search.candidates;
  listener.begin("intervals");
  for (std::size_t c = 0; c < d.search.findings.size(); ++c) {
    listener.share(static_cast<double>(c) / static_cast<double>(d.search.findings.size()));
    const Finding& f = d.search.findings[c];
    Cause cause = cause_of(list, fitter, d.search.hypothesis, c, d.search.fit, f.log_evidence_gain, listener);
    for (const Finding::Alternative& a : f.alternatives) {
      Hypothesis other = d.search.hypothesis;
      other.erase(other.begin() + static_cast<std::ptrdiff_t>(c));
      other.push_back(a.claim);
      cause.alternatives.push_back(cause_of(list, fitter, other, other.size() - 1, a.fit, a.log_evidence_gain, listener));
      leave_out(cause.alternatives.back(), "the cause from which it cannot be distinguished is written instead");
      cause.alternatives.back().probability = a.probability;
      cause.alternatives.back().share = a.share;
    }
    cause.probability = f.probability;
    cause.share = f.share;
    cause.odds = f.odds;
    d.causes.push_back(std::move(cause));
  }
}

/// What kept-out records say against the causes that are named.
void doubt_by_kept_out(Diagnosis& d, const HeldOut& held) {
  const bool is_any_named =
      std::any_of(d.search.findings.begin(), d.search.findings.end(), [](const Finding& f) { return f.is_named; });
  if (is_any_named && held.fails) {
    if (!d.unexplained) d.unexplained.emplace().channels.push_back(held.fails_at);
    d.unexplained->fails_held_out = true;
  }
}

/// Where something is left that nothing explains: writes only what holds nevertheless.
void write_less(Diagnosis& d, const Fitter& fitter, const std::vector<MeasuredRun>& runs, Twin::Workspace& workspace,
                const Listener& listener) {
  if (runs.size() == 1) {
    const std::optional<CausesAlone> alone = listener.wants_end() ? std::nullopt : causes_alone(fitter, d.search, d.noise);
    if (alone) {
      write_alone(d, *alone, fitter, workspace, listener);
    } else if (d.written.keeps_numbers) {
      write_nothing(d, "a single record of which something is left that nothing explains says too little of others");
    }
  } else if (d.written.keeps_numbers && !listener.wants_end()) {
    const std::string why = worse_in_another_cycle(fitter, d.search, d.noise, d.written.causes);
    if (!why.empty()) write_nothing(d, why);
  }
}

/// An experiment where causes cannot be distinguished, or one is in doubt.
void add_experiment(Diagnosis& d, const Fitter& fitter, const Listener& listener) {
  const bool is_open = std::any_of(d.causes.begin(), d.causes.end(), [](const Cause& c) { return !c.alternatives.empty(); });
  std::vector<char> in_doubt(d.search.findings.size(), 0);  // marks a cause that is suspected against nothing at all
  for (std::size_t c = 0; c < in_doubt.size() && d.verdict == Verdict::kSuspected; ++c)
    in_doubt[c] = d.causes[c].standing == Standing::kSuspected;
  const bool is_in_doubt = std::any_of(in_doubt.begin(), in_doubt.end(), [](char doubt) { return doubt != 0; });
  if ((is_open || is_in_doubt) && !is_wrong_all_over(d) && !listener.wants_end()) {
    listener.begin("choosing an experiment");
    d.experiment = propose_experiment(fitter, d.search, in_doubt);
  }
}

}  // namespace

void leave_numbers(Diagnosis& d) {
  for (std::size_t i = 0; i < d.calibrated.size(); ++i) {
    if (std::find(d.moved.begin(), d.moved.end(), i) == d.moved.end()) d.calibrated[i].is_written = false;
  }
}

Diagnosis diagnose(const Twin& twin, const Twin* coarse, const std::vector<MeasuredRun>& runs,
                   const DiagnosisOptions& options, const Listener& waiting) {
  Diagnosis d;
  std::string stage;
  Listener listener = waiting;
  listener.on_begin = [&](const std::string& work) {
    if (!waiting.wants_end()) stage = work;
    waiting.begin(work);
  };
  const Eigen::Index n_readings = readings_of(runs);
  const std::vector<Candidate> standing = candidates(twin, runs, options.without);
  const Fitter fresh = begun(d, twin, coarse, runs, options, listener);
  Twin::Workspace workspace(twin);
  const InquiryGround ground{.twin = twin,
                             .coarse = coarse,
                             .options = options,
                             .candidates = standing,
                             .fresh = fresh,
                             .as_written = d.as_written};
  Inquiry own = inquire(ground, runs, listener);
  const Fitter& fitter = *own.fitter;
  d.noise = std::move(own.noise);
  d.search = std::move(own.search);
  d.statements = d.search.statements;
  d.unexplained = std::move(own.unexplained);
  d.wander = std::move(own.wander);
  d.weighed_by_model_error = own.weighed_by_model_error;
  d.moved = std::move(own.moved);
  std::vector<double> known_to;
  for (const Knob& k : d.scatter) known_to.push_back(k.prior_sd);
  d.scatter = fitter.scatter();  // with priors of faults for numbers that moved too far
  d.n_candidates = static_cast<int>(standing.size());
  if (const auto nameless = without_name(fitter, d.search, d.statements, d.noise)) {
    if (!d.unexplained) d.unexplained = nameless;
    d.unexplained->statement = nameless->statement;
  }
  add_causes_found(d, fitter, listener);
  listener.begin("measuring the gain");
  const HeldOut held = held_out_gain(fitter, d.search, d.noise, listener);
  d.written = written_of(fitter, d.search, held, workspace);
  d.extended =
      d.written.keeps_numbers ? fitter.predict_machine(d.written.hypothesis, d.written.fit.x, workspace) : d.as_written;
  if (d.written.keeps_numbers && !d.written.taken_up.empty()) say_what_is_written(d, fitter, listener);
  d.calibrated = fitted_numbers(fitter, d.written.fit.x, d.written.fit.covariance, known_to);
  for (Estimate& e : d.calibrated) e.is_written = d.written.keeps_numbers;
  // A number that moved back once others were free again is no cause.
  std::erase_if(d.moved, [&](std::size_t i) { return !(std::abs(d.calibrated[i].deviation) > kTooFar); });
  add_moved_numbers(d, twin);
  add_readings_without(d, fitter, workspace, listener);
  d.holdout = held.how;
  d.gain = held.channels;
  d.misses = held.misses;
  give_standing(d, held);
  doubt_by_kept_out(d, held);
  if (is_wrong_all_over(d)) doubt_all(d, "too many of the scenario's own numbers had to go beyond what is known of them");
  d.verdict = n_readings < kFewestReadings ? Verdict::kInsufficientData : verdict_of(d);
  if (d.verdict == Verdict::kInsufficientData) {
    doubt_all(d, "the readings are too few to distinguish causes");
    if (d.written.keeps_numbers) write_nothing(d, "the readings are too few");
  }
  if (d.verdict == Verdict::kUnexplained) doubt_all(d, "more is left than it explains");
  if (d.verdict != Verdict::kInsufficientData && is_more_left(d)) write_less(d, fitter, runs, workspace, listener);
  add_experiment(d, fitter, listener);
  d.reason = d.verdict == Verdict::kInsufficientData
                 ? what_is_missing(twin, runs, static_cast<int>(n_readings), kFewestReadings)
                 : reason_of(d);
  if (listener.wants_end()) leave_incomplete(d, stage);
  return d;
}

}  // namespace driftwright::diagnosis
