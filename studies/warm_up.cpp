#include "studies/warm_up.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/warm_up_corrected.hpp"
#include "studies/warm_up_error.hpp"
#include "studies/warm_up_heat.hpp"
#include "studies/warm_up_search.hpp"

namespace driftwright::studies {
namespace {

using Sections = std::vector<Cyclogram::Section>;

constexpr int kMostParts = 200;

double total_s(const Sections& sections) {
  double sum_s = 0.0;
  for (const auto& section : sections) sum_s += section.duration_s;
  return sum_s;
}

/// The shortest rest after which the job stays within the tolerance.
WarmUp rested(const WarmUpSearch& search, double most_s) {
  WarmUp best = search.least_time(0.0, most_s);
  best.way = "at rest";
  return best;
}

/// The job itself, part after part.
WarmUp by_jobs(const WarmUpTrials& trials, double tolerance_um, double most_s) {
  Sections before;
  WarmUp best = trials.tried(before, tolerance_um);
  const double job_s = trials.job().duration_s();
  for (int part = 1; !best.is_enough && part < kMostParts && total_s(before) + job_s <= most_s; ++part) {
    before.insert(before.end(), trials.job().sections.begin(), trials.job().sections.end());
    const WarmUp next = trials.tried(before, tolerance_um);
    if (next.peak_um < best.peak_um || next.is_enough) best = next;
  }
  best.way = "the job itself, part after part";
  return best;
}

double fastest_rpm(const scenarios::Scenario& scenario, const Cyclogram& job) {
  double most_rpm = 0.0;
  for (const auto& section : job.sections) most_rpm = std::max(most_rpm, section.drive.speed_rpm);
  for (const Cyclogram& c : scenario.cyclograms) {
    for (const auto& section : c.sections) most_rpm = std::max(most_rpm, section.drive.speed_rpm);
  }
  return most_rpm;
}

}  // namespace

double WarmUp::duration_s() const {
  return total_s(sections);
}

WarmUpPlan plan_warm_up(const scenarios::Scenario& scenario, const Cyclogram& job, const WarmUpOptions& options,
                        const Listener& listener) {
  const double asked_rpm = options.most_speed_rpm > 0.0 ? options.most_speed_rpm : fastest_rpm(scenario, job);
  double most_rpm = kWarmUpStep_rpm * std::floor(asked_rpm / kWarmUpStep_rpm);
  if (!(most_rpm >= kWarmUpStep_rpm))
    throw InputError("no cyclogram of the scenario turns the spindle; say with --speed-limit how fast a warm-up may");
  const WarmUpTrials trials(scenario, job, options, most_rpm, listener);
  if (options.most_power_W > 0.0) most_rpm = fastest_within_rpm(trials, most_rpm, options.most_power_W);
  double kept_free = options.kept_free;
  std::optional<DrawnMachines> drawn;
  if (options.model_error > 0.0) {
    listener.begin(fmt::format("{} machines off by {:.0f} %", kDraws, 100.0 * options.model_error));
    drawn.emplace(trials, options.model_error, 1, kDraws);
    const WarmUp fast = WarmUpSearch(trials, options.tolerance_um, most_rpm, options.most_s, listener).constant();
    const double speed_rpm = fast.sections.empty() ? most_rpm : fast.sections.front().drive.speed_rpm;
    const std::optional<double> share =
        free_share(trials, *drawn, speed_rpm, options.most_s, options.tolerance_um, listener);
    if (!share)
      throw InputError(fmt::format(
          "--model-error: no warm-up of up to {:.0f} min at {:.0f} rpm keeps the job within {:g} um on 95 of 100 machines; "
          "allow more drift or time, or correct it (`schedule`, `compensate`)",
          options.most_s / 60.0, speed_rpm, options.tolerance_um));
    kept_free = *share;
  }
  const double tolerance_um = options.tolerance_um * (1.0 - kept_free);
  const WarmUpSearch search(trials, tolerance_um, most_rpm, options.most_s, listener);
  WarmUpPlan plan{.channels = trials.channels(),
                  .tolerance_um = options.tolerance_um,
                  .most_speed_rpm = most_rpm,
                  .most_s = options.most_s,
                  .kept_free = kept_free,
                  .most_power_W = options.most_power_W,
                  .power_at_most_W = heat_of_speed_W(trials, most_rpm),
                  .model_error = options.model_error,
                  .predicted_by = trials.ahead().model->words(),
                  .started_from = trials.ahead().started_from};
  listener.begin("at once, at rest and by jobs");
  plan.at_once = trials.tried({}, tolerance_um);
  plan.at_once.way = "at once";
  plan.at_rest = rested(search, options.most_s);
  plan.by_jobs = by_jobs(trials, tolerance_um, options.most_s);
  plan.constant = search.constant();
  const bool rests =
      plan.at_rest.is_enough && (!plan.constant.is_enough || plan.at_rest.duration_s() < plan.constant.duration_s());
  plan.staged = search.staged_best(rests ? plan.at_rest : plan.constant);
  listener.begin("minutes against micrometres");
  constexpr int kLevels = 8;
  const double longest_s = plan.staged.is_enough ? std::max(1.5 * plan.staged.duration_s(), 600.0) : options.most_s;
  const WarmUpSearch least(trials, 0.0, most_rpm, options.most_s,
                           listener);  // with tolerance zero: searches the least drift
  WarmUpSearch::Shape shape = {1.0, 0.5, 0.5};
  for (int i = 0; i <= kLevels && !listener.wants_end(); ++i) {
    const double time_s = std::min(longest_s, options.most_s) * i / kLevels;
    WarmUp one = plan.at_once, two = plan.at_once;
    if (i > 0) {
      one = least.constant_in(time_s);
      two = least.staged_in(time_s, shape);
      if (one.peak_um < two.peak_um) two = one;
      two.is_enough = two.peak_um <= tolerance_um;
      const bool is_better = plan.staged.is_enough ? two.is_enough && two.duration_s() < plan.staged.duration_s()
                                                   : two.is_enough || two.peak_um < kWorthTelling * plan.staged.peak_um;
      if (is_better) plan.staged = two;
    }
    plan.levels.push_back({.duration_s = time_s, .constant_um = one.peak_um, .staged_um = two.peak_um});
    listener.share(static_cast<double>(i) / kLevels);
  }
  const auto is_one_speed = [](const Sections& sections) {
    return sections.size() == 1 && sections.front().drive.speed_rpm > 0.0;
  };
  if (is_one_speed(plan.staged.sections)) plan.constant = plan.staged;
  plan.at_once.way = "at once";
  plan.constant.way = "one speed";
  plan.staged.way = "two speeds";
  if (WarmUp finest = search.refined(plan.staged); finest.sections.size() > 2) {
    finest.way = finest.sections.size() == 3 ? "three speeds" : "four speeds";
    plan.finest = std::move(finest);
  }
  if (drawn && plan.best().is_enough) {
    const auto n_kept = [&](const DrawnMachines& machines) {
      return machines.n_kept(plan.best().sections, options.tolerance_um, listener);
    };
    const DrawnMachines fresh(trials, options.model_error, 1 + kDraws, kDraws);
    plan.held = {.n = kDraws, .n_kept = n_kept(*drawn), .n_fresh = kDraws, .n_fresh_kept = n_kept(fresh)};
  }
  const auto& counted = plan.channels;
  if (scenario.study && std::find(counted.begin(), counted.end(), scenario.study->target) != counted.end()) {
    const bool turns = !plan.constant.sections.empty();
    plan.corrected = corrected_warm_ups(
        scenario, trials, turns ? plan.constant.sections.front().drive.speed_rpm : most_rpm,
        plan.best().is_enough ? std::min(std::max(1.5 * plan.best().duration_s(), 600.0), options.most_s) : options.most_s,
        tolerance_um, listener);
  }
  plan.job_at_once = trials.job_rows({});
  plan.job_warm = trials.job_rows(plan.best().sections);
  plan.n_tried = trials.n_tried();
  return plan;
}

}  // namespace driftwright::studies
