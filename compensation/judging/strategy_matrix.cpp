#include "compensation/judging/strategy_matrix.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "base/record_channel.hpp"
#include "compensation/judging/failed_left_out.hpp"
#include "compensation/judging/failed_sensor_runs.hpp"
#include "compensation/judging/iso230_3.hpp"
#include "compensation/judging/strategy_verdict.hpp"
#include "compensation/predictors/drift_model.hpp"
#include "compensation/predictors/scored_rows.hpp"

namespace driftwright::compensation {
namespace {

/// Range from row `first` on until a time.
double range_until(const std::vector<double>& time_s, const std::vector<double>& x, std::size_t first, double until_s) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = first; i < x.size() && time_s[i] - time_s[first] <= until_s; ++i) {
    if (std::isnan(x[i])) continue;
    low = std::min(low, x[i]);
    high = std::max(high, x[i]);
  }
  return high >= low ? high - low : std::numeric_limits<double>::quiet_NaN();
}

template <class F>
std::vector<std::string> each_once(const std::vector<JudgedRunOfMachine>& runs, F name) {
  std::vector<std::string> names;
  for (const JudgedRunOfMachine& r : runs) {
    if (std::find(names.begin(), names.end(), name(r)) == names.end()) names.push_back(name(r));
  }
  return names;
}

}  // namespace

const char* word(Safety safety) {
  return safety == Safety::kSafe ? "safe to deploy" : safety == Safety::kWithinLimits ? "safe within limits" : "unsafe";
}

std::vector<std::string> other_axes(const StrategyMatrix& m) {
  std::vector<std::string> names;
  const MachineRun& run = m.runs.front().run;
  const Record& readings = run.readings;
  for (const Channel& c : readings.channels) {
    const bool is_axis =
        is_displacement_unit(c.unit) && !run.cyclogram.column(c.name);  // a column may be an axis' place in mm
    if (is_axis && &c != readings.find(m.settings.strategies.target)) names.push_back(c.name);
  }
  return names;
}

std::vector<std::string> families_of(const StrategyMatrix& matrix) {
  return each_once(matrix.runs, [](const JudgedRunOfMachine& r) { return r.family; });
}

std::vector<std::string> seasons_of(const StrategyMatrix& matrix) {
  return each_once(matrix.runs, [](const JudgedRunOfMachine& r) { return r.season; });
}

Worst worst_of(const JudgedStrategy& strategy, const std::function<bool(const Case&)>& counts) {
  Worst w;
  int n = 0;
  for (const Case& c : strategy.cases) {
    if (!counts(c)) continue;
    if (!w.peak || c.after.peak_abs > w.peak->after.peak_abs) w.peak = &c;
    w.left = std::max(w.left, c.left());
    w.rms_um = std::max(w.rms_um, c.after.rmse);
    w.covered = std::min(w.covered, c.covered);
    w.mean_covered += c.covered;
    ++n;
  }
  if (n > 0) w.mean_covered /= n;
  return w;
}

double overall_rms(const JudgedStrategy& strategy) {
  double squares = 0.0, n = 0.0;
  for (const Case& c : strategy.cases) {
    if (!c.failed.empty() || c.after.n == 0) continue;
    squares += c.after.n * c.after.rmse * c.after.rmse;
    n += c.after.n;
  }
  return std::sqrt(squares / n);
}

const JudgedStrategy* simplest_enough(const StrategyMatrix& matrix, const std::string& family) {
  for (const JudgedStrategy& s : matrix.strategies) {
    const bool does_nothing = s.fitted.name == kNoCorrection;
    if (!does_nothing && (s.fitted.is_baseline || s.safety == Safety::kUnsafe)) continue;
    const Worst w = worst_of(s, [&](const Case& c) { return c.failed.empty() && matrix.runs[c.run].family == family; });
    if (w.peak && w.peak->after.peak_abs <= matrix.settings.tolerance_um) return &s;
  }
  return nullptr;
}

const JudgedStrategy* chosen_strategy(const StrategyMatrix& matrix) {
  for (const JudgedStrategy& s : matrix.strategies) {
    if (s.fitted.name == matrix.choice.name) return &s;
  }
  return nullptr;
}

const JudgedStrategy& best_in_hindsight(const StrategyMatrix& matrix) {
  return *std::min_element(matrix.strategies.begin(), matrix.strategies.end(),
                           [](const JudgedStrategy& a, const JudgedStrategy& b) { return overall_rms(a) < overall_rms(b); });
}

std::vector<ProbedMember> probed_members(const DeployedPredictor& strategy, const Judgement& judged) {
  const std::vector<probe_process> processes = probe_processes_of(strategy, {.noise_um = strategy.probe.noise_um});
  std::vector<ProbedMember> members = {{processes.front(), judged.left_um}};
  for (std::size_t m = 0; m < judged.members_left_um.size(); ++m)
    members.push_back({processes[m + 1], judged.members_left_um[m]});
  return members;
}

Judgement judge(const DeployedPredictor& strategy, const MachineRun& run, const std::vector<double>& drift_um) {
  Case c;
  const std::vector<double> predicted = live(*strategy.predictor, run);
  GuardedCorrection correction = correct(strategy, run);
  std::vector<double> left, unguarded;
  int n_inside = 0, n = 0;
  for (std::size_t i = 0; i < drift_um.size(); ++i) {
    left.push_back(drift_um[i] - correction.correction_um[i]);
    if (std::isfinite(left.back())) c.harm_um = std::max(c.harm_um, std::abs(left.back()) - std::abs(drift_um[i]));
    const double off = drift_um[i] - predicted[i];
    if (std::isnan(drift_um[i])) continue;
    unguarded.push_back(std::isnan(off) ? std::numeric_limits<double>::infinity() : off);
    if (std::isnan(correction.interval_um[i])) continue;  // without trust there is no interval, so the row does not count
    ++n;
    if (std::abs(left.back()) <= correction.interval_um[i]) ++n_inside;
  }
  c.before = score(drift_um);
  c.after = score(left);
  for (double off : unguarded) c.peak_unguarded_um = std::max(c.peak_unguarded_um, std::abs(off));
  std::erase_if(unguarded, [](double off) { return std::isinf(off); });
  c.rms_unguarded_um = score(unguarded).rmse;
  c.first_hour_um = range_until(run.readings.time_s, left, run.n_before, kHour_s);
  c.whole_um = range_until(run.readings.time_s, left, run.n_before, std::numeric_limits<double>::infinity());
  c.covered = strategy.interval_um && n > 0 ? static_cast<double>(n_inside) / n : std::numeric_limits<double>::quiet_NaN();
  c.events = std::move(correction.events);
  for (std::vector<double>& member_um : correction.members_um) {  // of corrections, now of what they leave
    for (std::size_t i = 0; i < drift_um.size(); ++i) member_um[i] = drift_um[i] - member_um[i];
  }
  return {std::move(c), std::move(correction.correction_um), std::move(left), std::move(correction.members_um)};
}

namespace {

/// Sets what remains of a case if the axis is probed again and again while its correction is in force.
void probe(const MatrixSettings& settings, const DeployedPredictor& strategy, const MachineRun& run, std::uint64_t seed,
           const Judgement& judged, Case& c) {
  const std::optional<Probing>& probing = settings.strategies.probing;
  if (!probing || !strategy.residual) return;
  const std::vector<double>& t_s = run.readings.time_s;
  const std::vector<ProbedMember> members = probed_members(strategy, judged);
  RunProbing how{.noise_um = probing->noise_um, .seed = seed};
  for (double every_s : probing->every_s) {
    how.every_s = every_s;
    c.probed.push_back(probed_run(members, t_s, how));
  }
  if (!c.failed.empty()) return;
  const double start_s = t_s[run.n_before];
  how.every_s = probing->every_s.front();
  how.fails_at_s = start_s + settings.fails_at.value_or(0.5) * (t_s.back() - start_s);
  how.error_um = settings.tolerance_um;
  how.fault = ProbeFault::kStuck;
  c.stuck_probe = probed_run(members, t_s, how);
  how.fault = ProbeFault::kBiased;
  c.biased_probe = probed_run(members, t_s, how);
}

/// What a correction leaves in each case of a strategy on a run, in the order of the cases.
using LeftOfCases = std::vector<std::vector<double>>;

/// Judges the strategies with weights by probings. A failed sensor changes the strategies that read it.
void judge_weighted(StrategyMatrix& matrix, const std::vector<DeployedPredictor>& strategies,
                    const std::vector<std::vector<Case>>& cases, const std::vector<LeftOfCases>& left_um) {
  const std::optional<Probing>& probing = matrix.settings.strategies.probing;
  if (!probing) return;
  std::vector<std::size_t> members;
  for (std::size_t s = 0; s < strategies.size(); ++s) {
    if (!strategies[s].is_baseline && strategies[s].residual && strategies[s].name != kBlend) members.push_back(s);
  }
  if (members.size() < 2) return;
  const std::size_t n_runs = matrix.runs.size();
  for (std::size_t r = 0; r < n_runs; ++r) {
    std::vector<std::string> failures = {""};
    for (std::size_t s : members) {
      for (const Case& c : cases[s * n_runs + r]) {
        if (std::find(failures.begin(), failures.end(), c.failed) == failures.end()) failures.push_back(c.failed);
      }
    }
    for (std::string& failed : failures) matrix.weighted.push_back({.run = r, .failed = std::move(failed)});
  }
  parallel_for(matrix.weighted.size(), [&](std::size_t k) {
    WeightedCase& weighted = matrix.weighted[k];
    std::vector<ProbedMember> with;
    for (std::size_t s : members) {
      const std::vector<Case>& own = cases[s * n_runs + weighted.run];
      const auto at = std::find_if(own.begin(), own.end(), [&](const Case& c) { return c.failed == weighted.failed; });
      const std::size_t index = at == own.end() ? 0 : static_cast<std::size_t>(at - own.begin());  // the first is intact
      with.push_back(
          {probe_process_of(*strategies[s].residual, {.noise_um = strategies[s].probe.noise_um}, strategies[s].from_start),
           left_um[s * n_runs + weighted.run][index]});
    }
    for (double every_s : probing->every_s) {
      weighted.probed.push_back(probed_run(with, matrix.runs[weighted.run].run.readings.time_s,
                                           {.every_s = every_s, .noise_um = probing->noise_um, .seed = weighted.run}));
    }
  });
}

/// Sets what models of the machine leave on left-out parts with failed sensors; the choice among them depends on it.
void try_failures(const MatrixSettings& settings, FittedStrategies& fitted) {
  for (std::size_t s = 0; s < fitted.strategies.size(); ++s) {
    if (!fitted.in_folds[s].empty())
      fitted.strategies[s].failed_um = failed_left_out_um(settings, fitted.folds, fitted.in_folds[s]);
  }
}

}  // namespace

StrategyMatrix judge_strategies(const MatrixSettings& settings, std::vector<MachineRun> training,
                                std::vector<JudgedRunOfMachine> runs) {
  StrategyMatrix matrix{
      .training = std::move(training), .runs = std::move(runs), .strategies = {}, .left_out = {}, .settings = settings};
  FittedStrategies fitted = fit_strategies(settings.strategies, matrix.training);
  matrix.left_out = std::move(fitted.left_out);
  try_failures(settings, fitted);
  fitted.in_folds.clear();
  fitted.folds = {};
  matrix.choice = choose(fitted.strategies);
  for (const DoubtedThermometer& d : fitted.doubted) {
    matrix.findings.push_back(fmt::format(
        "Thermometer '{}' {}: in {} from {:.0f} min on it differs by up to {:.2g} K from what the others lead to; usually "
        "the "
        "difference is {:.2g} K. {}",
        d.name, d.is_alone ? "is left out of all strategies" : "is doubtful",
        std::filesystem::path(d.record).filename().string(), d.from_s / 60.0, d.off_K, d.usual_K,
        d.is_alone ? "Check whether it is broken or has come off."
                   : "Others differ in the same record, too: the machine may have been in an unusual state, or they share a "
                     "plug. All are used; leave them out of `sensors` if they are broken."));
  }
  std::vector<std::vector<double>> drift_um;
  for (const JudgedRunOfMachine& r : matrix.runs) {
    const std::string& target = settings.strategies.target;
    drift_um.push_back(scored_readings(r.run, target, settings.strategies.count_from_start).at(target).values);
  }
  for (std::size_t r = 0; r < drift_um.size(); ++r) {
    if (score(drift_um[r]).n == 0)
      throw InputError(fmt::format("{}: '{}' has no value in any row; there is nothing to judge by", matrix.runs[r].name,
                                   settings.strategies.target));
  }
  if (std::all_of(fitted.strategies.begin(), fitted.strategies.end(),
                  [](const DeployedPredictor& f) { return f.is_baseline; })) {
    std::vector<std::string> reasons;
    for (const LeftOut& l : matrix.left_out) {
      if (std::find(reasons.begin(), reasons.end(), l.why) == reasons.end()) reasons.push_back(l.why);
    }
    throw InputError(fmt::format("no strategy could be fitted: {}", fmt::join(reasons, "; ")));
  }
  const std::size_t n_runs = matrix.runs.size(), n_jobs = fitted.strategies.size() * n_runs;
  std::vector<std::vector<Case>> cases(n_jobs);
  std::vector<LeftOfCases> left_um(n_jobs);  // for weights by probings
  parallel_for(n_jobs, [&](std::size_t job) {
    const DeployedPredictor& strategy = fitted.strategies[job / n_runs];
    const std::size_t r = job % n_runs;
    const MachineRun& whole = matrix.runs[r].run;
    for (const auto& [failed, run] : runs_with_failures(
             settings, strategy, matrix.runs[r], whole.readings.time_s[whole.n_before], whole.readings.time_s.back())) {
      Judgement judged = judge(strategy, run, drift_um[r]);
      cases[job].push_back(judged.scores);
      cases[job].back().run = r;
      cases[job].back().failed = failed;
      probe(settings, strategy, run, r, judged, cases[job].back());
      if (settings.strategies.probing && !strategy.is_baseline) left_um[job].push_back(std::move(judged.left_um));
    }
  });
  judge_weighted(matrix, fitted.strategies, cases, left_um);
  for (std::size_t s = 0; s < fitted.strategies.size(); ++s) {
    JudgedStrategy judged;
    judged.fitted = std::move(fitted.strategies[s]);
    for (std::size_t r = 0; r < n_runs; ++r) {
      auto& of_run = cases[s * n_runs + r];
      std::move(of_run.begin(), of_run.end(), std::back_inserter(judged.cases));
    }
    matrix.strategies.push_back(std::move(judged));
  }
  for (JudgedStrategy& s : matrix.strategies) {
    give_verdict(matrix, s);
    if (s.fitted.is_baseline) continue;
    double least = overall_rms(s);
    for (const JudgedStrategy& baseline : matrix.strategies) {
      if (!baseline.fitted.is_baseline || !(overall_rms(baseline) < least)) continue;
      least = overall_rms(baseline);
      s.beaten_by = baseline.fitted.name;
    }
  }
  return matrix;
}

}  // namespace driftwright::compensation
