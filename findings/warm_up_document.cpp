#include "findings/warm_up_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "findings/named_value.hpp"
#include "findings/run_section.hpp"

namespace driftwright::findings {
namespace {

using output::Plot, output::Series, output::Table, output::Value, output::Verdict;
using studies::WarmUp, studies::WarmUpPlan;

std::string speeds_words(const std::vector<Cyclogram::Section>& sections) {
  if (sections.size() > 6) return fmt::format("{} sections", sections.size());
  std::vector<std::string> words;
  for (const Cyclogram::Section& section : sections) {
    const std::string time = section.duration_s < 600.0 ? fmt::format("{:.0f} s", section.duration_s)
                                                        : fmt::format("{:.1f} min", section.duration_s / 60.0);
    words.push_back(section.drive.speed_rpm > 0.0 ? fmt::format("{} at {:.0f} rpm", time, section.drive.speed_rpm)
                                                  : time + " at rest");
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

Table ways_table(const WarmUpPlan& plan, const Cyclogram& job) {
  Table table{.key = "ways",
              .title = "Ways to begin",
              .caption =
                  "Peak: of the job's drift from its first row, where the tool is set. Where no time is enough, the least "
                  "peak that was found.",
              .columns = {{.key = "way", .title = "way"},
                          {.key = "is_enough", .title = "enough"},
                          {.key = "duration_min", .title = "takes", .unit = "min", .digits = output::decimals(1)},
                          {.key = "peak_um", .title = "peak of the job", .unit = "um", .digits = output::decimals(2)},
                          {.key = "channel", .title = "of"},
                          {.key = "programme", .title = "programme"}}};
  std::vector<const WarmUp*> ways = {&plan.at_once, &plan.at_rest, &plan.by_jobs, &plan.constant, &plan.staged};
  if (plan.finest) ways.push_back(&*plan.finest);
  for (const WarmUp* way : ways) {
    const bool is_tried = way != &plan.by_jobs || !way->sections.empty() || job.duration_s() <= plan.most_s;
    table.rows.push_back({way->way, way->is_enough, way->duration_s() / 60.0, way->peak_um, way->peak_channel,
                          !is_tried               ? "not tried: one part is longer than the time limit"
                          : way->sections.empty() ? "nothing"
                                                  : speeds_words(way->sections)});
  }
  return table;
}

double kept_um(const WarmUpPlan& plan) {
  return plan.tolerance_um * (1.0 - plan.kept_free);
}

std::string tolerance_words(const WarmUpPlan& plan) {
  if (plan.kept_free == 0.0) return fmt::format("{:g} µm", plan.tolerance_um);
  return fmt::format("{:.3g} µm, of {:g} µm with {:.0f} % kept free", kept_um(plan), plan.tolerance_um,
                     100.0 * plan.kept_free);
}

Verdict verdict_of(const WarmUpPlan& plan, const Cyclogram& job) {
  const std::string tolerance = tolerance_words(plan);
  if (plan.at_once.is_enough)
    return {.kind = Verdict::Kind::kGood,
            .title = "No warm-up is needed",
            .text = fmt::format("{} drifts by {:.2f} µm at most when it begins at once, within {}.", job.name,
                                plan.at_once.peak_um, tolerance)};
  const WarmUp& best = plan.best();
  if (!best.is_enough) {
    std::string text = fmt::format(
        "Of warm-ups up to {:.0f} min and {:.0f} rpm none was found after which {} drifts by less than {:.2f} µm ({}); "
        "allowed are {}.",
        plan.most_s / 60.0, plan.most_speed_rpm, job.name, best.peak_um, best.peak_channel, tolerance);
    if (plan.by_jobs.is_enough)
      text += fmt::format(" After {:.0f} min of the job itself it drifts by {:.2f} µm: the parts before are the warm-up.",
                          plan.by_jobs.duration_s() / 60.0, plan.by_jobs.peak_um);
    return {.kind = Verdict::Kind::kBad,
            .title = "No warm-up was found that is enough",
            .text = text + " Allow more time or speed, or correct the drift (`schedule`, `compensate`)."};
  }
  std::string text = fmt::format("{}; then {} drifts by {:.2f} µm at most, within {}.", speeds_words(best.sections),
                                 job.name, best.peak_um, tolerance);
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  if (best.sections.size() == 1) {
    text += " No programme of more speeds was found that is shorter.";
  } else if (!plan.constant.is_enough) {
    text += " No single speed was found that is enough.";
  } else {
    const double saved = 1.0 - best.duration_s() / plan.constant.duration_s();
    text += fmt::format(" The best single speed takes {:.1f} min; the others save {:.0f} % of that.",
                        plan.constant.duration_s() / 60.0, 100.0 * saved);
  }
  if (plan.held)
    text += fmt::format(" Of {} machines off by {:.0f} % it keeps {:g} µm on {}, of {} others on {}.", plan.held->n,
                        100.0 * plan.model_error, plan.tolerance_um, plan.held->n_kept, plan.held->n_fresh,
                        plan.held->n_fresh_kept);
  return {
      .kind = Verdict::Kind::kGood, .title = fmt::format("Warm up for {:.1f} min", best.duration_s() / 60.0), .text = text};
}

Plot levels_plot(const WarmUpPlan& plan) {
  Plot plot{.title = "Minutes against micrometres",
            .x_label = "warm-up [min]",
            .y_label = "least peak of the job's drift [µm]",
            .series = {{.label = "one speed"}, {.label = "two speeds"}},
            .bands = {{.label = "allowed", .low = 0.0, .high = kept_um(plan)}},
            .half_width = true};
  for (const studies::WarmUpLevel& level : plan.levels) {
    for (Series& series : plot.series) series.x.push_back(level.duration_s / 60.0);
    plot.series[0].y.push_back(level.constant_um);
    plot.series[1].y.push_back(level.staged_um);
  }
  return plot;
}

Plot programme_plot(const WarmUpPlan& plan) {
  Plot plot{
      .title = "Shortest warm-up", .x_label = "time before the job [min]", .y_label = "speed [rpm]", .half_width = true};
  std::vector<const WarmUp*> ways = {&plan.constant, &plan.staged};
  if (plan.finest) ways.push_back(&*plan.finest);
  for (const WarmUp* way : ways) {
    Series series{.label = way->way, .style = Series::Style::kSteps};
    double time_s = -way->duration_s();
    series.x.push_back(time_s / 60.0);  // from rest
    series.y.push_back(0.0);
    for (const Cyclogram::Section& section : way->sections) {
      series.x.push_back(time_s / 60.0);
      series.y.push_back(section.drive.speed_rpm);
      time_s += section.duration_s;
    }
    if (way->sections.empty()) continue;
    series.x.push_back(0.0);
    series.y.push_back(series.y.back());
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Plot job_plot(const WarmUpPlan& plan, const Cyclogram& job) {
  Plot plot{.title = "Drift of the job",
            .x_label = "time in the job [min]",
            .y_label = "drift from its first row [µm]",
            .bands = {{.label = "allowed", .low = -kept_um(plan), .high = kept_um(plan)}},
            .marks = section_marks(job)};
  for (const std::string& name : plan.channels) {
    const int color = static_cast<int>(plot.series.size() / 2);
    plot.series.push_back({.label = name + ", at once",
                           .x = minutes(plan.job_at_once),
                           .y = plan.job_at_once.at(name).values,
                           .style = Series::Style::kDashed,
                           .color = color});
    plot.series.push_back(
        {.label = name + ", warmed up", .x = minutes(plan.job_warm), .y = plan.job_warm.at(name).values, .color = color});
  }
  return plot;
}

/// One strategy of each kind, so that lines can be distinguished.
constexpr std::array<const char*, 6> kDrawn = {
    "no correction", "one thermometer", "ridge, all sensors", "thermal modes of the model", "thermometers and memories",
    "observer"};

std::string corrected_words(const studies::CorrectedWarmUps& corrected, const WarmUpPlan& plan) {
  return fmt::format(
      "Warm-up of {} min at {:.0f} rpm, then the job, {} corrected by strategies that were fitted on the scenario's "
      "training runs, with a "
      "model that is off by {:.0f} %{} where they have one, and readings with noise. Enough: within {}.",
      fmt::format("0 to {:.0f}", corrected.times_s.back() / 60.0), corrected.speed_rpm, corrected.target,
      100.0 * corrected.model_scatter, corrected.model.empty() ? "" : " and " + corrected.model, tolerance_words(plan));
}

Plot corrected_plot(const studies::CorrectedWarmUps& corrected, const WarmUpPlan& plan) {
  Plot plot{.title = "Warm-up beside correction",
            .x_label = fmt::format("warm-up at {:.0f} rpm [min]", corrected.speed_rpm),
            .y_label = fmt::format("peak of what is left of {} [µm]", corrected.target),
            .bands = {{.label = "allowed", .low = 0.0, .high = kept_um(plan)}}};
  for (const studies::CorrectedWarmUp& strategy : corrected.strategies) {
    if (std::find(kDrawn.begin(), kDrawn.end(), strategy.strategy) == kDrawn.end()) continue;
    Series series{.label = strategy.strategy, .y = strategy.left_um};
    for (double time_s : corrected.times_s) series.x.push_back(time_s / 60.0);
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Table corrected_table(const studies::CorrectedWarmUps& corrected, const WarmUpPlan& plan) {
  Table table{.key = "corrected",
              .title = "Warm-up beside correction",
              .caption = corrected_words(corrected, plan),
              .columns = {{.key = "strategy", .title = "strategy"},
                          {.key = "is_enough", .title = "enough"},
                          {.key = "least_min", .title = "warm-up", .unit = "min", .digits = output::decimals(1)},
                          {.key = "at_once_um", .title = "left at once", .unit = "um", .digits = output::decimals(2)},
                          {.key = "least_um", .title = "least left", .unit = "um", .digits = output::decimals(2)}}};
  for (const studies::CorrectedWarmUp& strategy : corrected.strategies)
    table.rows.push_back({strategy.strategy, strategy.is_enough,
                          strategy.is_enough ? output::Datum(strategy.least_s / 60.0) : output::Datum(),
                          strategy.left_um.front(), *std::min_element(strategy.left_um.begin(), strategy.left_um.end())});
  return table;
}

Table corrected_times_table(const studies::CorrectedWarmUps& corrected) {
  Table table{.key = "corrected_times",
              .title = "Warm-up beside correction, minute by minute",
              .columns = {{.key = "strategy", .title = "strategy"},
                          {.key = "duration_min", .title = "warm-up", .unit = "min", .digits = output::decimals(1)},
                          {.key = "left_um", .title = "left", .unit = "um", .digits = output::decimals(2)}},
              .detail = true};
  for (const studies::CorrectedWarmUp& strategy : corrected.strategies) {
    for (std::size_t i = 0; i < corrected.times_s.size(); ++i)
      table.rows.push_back({strategy.strategy, corrected.times_s[i] / 60.0, strategy.left_um[i]});
  }
  return table;
}

}  // namespace

output::Document document_of(const studies::WarmUpPlan& plan, const scenarios::Scenario& scenario, const Cyclogram& job,
                             const std::string& asked, const output::Provenance& made_by) {
  output::Document document{.made_by = made_by,
                            .title = fmt::format("{}: warm-up before {}", scenario.name, job.name),
                            .subtitle = fmt::format("predicted by the {}{}", plan.predicted_by,
                                                    plan.started_from.empty() ? "" : "; after " + plan.started_from)};
  output::Section& body = document.body;
  add(body, verdict_of(plan, job));
  add(body, Value{.key = "job", .datum = asked});
  add(body, named_value("tolerance_um", "tolerance", plan.tolerance_um, "um", output::significant(4)));
  add(body,
      named_value("kept_free", "of it kept free for what the model does not know", plan.kept_free, output::percent(0)));
  add(body, named_value("speed_limit_rpm", "speed limit", plan.most_speed_rpm, "rpm", output::decimals(0)));
  if (plan.most_power_W > 0.0)
    add(body, named_value("power_limit_W", "limit of a speed's heat", plan.most_power_W, "W", output::decimals(0)));
  add(body, named_value("power_at_limit_W", "heat of the fastest speed that is allowed", plan.power_at_most_W, "W",
                        output::decimals(0)));
  add(body, named_value("time_limit_min", "time limit", plan.most_s / 60.0, "min", output::decimals(0)));
  if (plan.held) {
    add(body, named_value("model_error", "machines are off by", plan.model_error, output::percent(0)));
    add(body, Value{.key = "machines", .words = "machines that the free share was chosen by", .datum = plan.held->n});
    add(body, Value{.key = "machines_kept", .words = "of them within the tolerance", .datum = plan.held->n_kept});
    add(body, Value{.key = "fresh_machines", .words = "other machines", .datum = plan.held->n_fresh});
    add(body, named_value("fresh_machines_kept", "of them within the tolerance", plan.held->n_fresh_kept));
  }
  add(body, Value{.key = "predicted_by", .datum = plan.predicted_by});
  add(body,
      Value{.key = "started_from", .datum = plan.started_from.empty() ? output::Datum() : output::Datum(plan.started_from)});
  add(body, ways_table(plan, job));
  add(body, Value{.key = "programmes_tried", .words = "programmes run on the model", .datum = plan.n_tried});
  add(body, levels_plot(plan));
  add(body, programme_plot(plan));
  add(body, job_plot(plan, job));
  if (plan.corrected) {
    add(body, corrected_table(*plan.corrected, plan));
    add(body, corrected_plot(*plan.corrected, plan));
    add(body, corrected_times_table(*plan.corrected));
  }
  Table levels{.key = "levels",
               .title = "Minutes against micrometres",
               .columns = {{.key = "duration_min", .title = "warm-up", .unit = "min", .digits = output::decimals(1)},
                           {.key = "one_speed_um", .title = "one speed", .unit = "um", .digits = output::decimals(2)},
                           {.key = "two_speeds_um", .title = "two speeds", .unit = "um", .digits = output::decimals(2)}},
               .detail = true};
  for (const studies::WarmUpLevel& level : plan.levels)
    levels.rows.push_back({level.duration_s / 60.0, level.constant_um, level.staged_um});
  add(body, std::move(levels));
  return document;
}

}  // namespace driftwright::findings
