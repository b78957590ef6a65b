#include "findings/warm_up_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "findings/run_section.hpp"

namespace driftwright::findings {
namespace {

using output::Plot;
using output::Series;
using output::Table;
using output::Value;
using output::Verdict;
using studies::WarmUp;
using studies::WarmUpPlan;

constexpr double kShorter = 0.3;  // a second speed that saves less is not worth a programme of its own

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

Table ways_table(const WarmUpPlan& plan) {
  Table table{.key = "ways",
              .title = "Ways to begin",
              .caption = "Peak: of the job's drift from its first row, where the tool is set. Where no time is enough, the least peak that was found.",
              .columns = {{.key = "way", .title = "way"},
                          {.key = "is_enough", .title = "enough"},
                          {.key = "duration_min", .title = "takes", .unit = "min", .digits = output::decimals(1)},
                          {.key = "peak_um", .title = "peak of the job", .unit = "um", .digits = output::decimals(2)},
                          {.key = "channel", .title = "of"},
                          {.key = "programme", .title = "programme"}}};
  for (const WarmUp* way : {&plan.at_once, &plan.at_rest, &plan.by_jobs, &plan.constant, &plan.staged}) {
    table.rows.push_back({way->way, way->is_enough, way->duration_s() / 60.0, way->peak_um, way->peak_channel,
                          way->sections.empty() ? "nothing" : speeds_words(way->sections)});
  }
  return table;
}

Verdict verdict_of(const WarmUpPlan& plan, const Cyclogram& job) {
  const std::string tolerance = fmt::format("{:g} µm", plan.tolerance_um);
  if (plan.at_once.is_enough)
    return {.kind = Verdict::Kind::kGood,
            .title = "No warm-up is needed",
            .text = fmt::format("{} drifts by {:.1f} µm at most when it begins at once, within {}.", job.name, plan.at_once.peak_um, tolerance)};
  if (!plan.staged.is_enough)
    return {.kind = Verdict::Kind::kBad,
            .title = "No warm-up is enough",
            .text = fmt::format("Within {:.0f} min and {:.0f} rpm the job drifts by {:.1f} µm at least ({}), more than {}: its own changes of speed move "
                                "the machine by as much. Correct the drift (`schedule`, `compensate`), or allow more time or speed.",
                                plan.most_s / 60.0, plan.most_speed_rpm, plan.staged.peak_um, plan.staged.peak_channel, tolerance)};
  std::string text = fmt::format("{}; then {} drifts by {:.1f} µm at most, within {}.", speeds_words(plan.staged.sections), job.name,
                                 plan.staged.peak_um, tolerance);
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  if (plan.constant.is_enough) {
    const double saved = 1.0 - plan.staged.duration_s() / plan.constant.duration_s();
    text += fmt::format(" The best single speed takes {:.1f} min", plan.constant.duration_s() / 60.0);
    const bool at_limit = !plan.constant.sections.empty() && plan.constant.sections.front().drive.speed_rpm > 0.95 * plan.most_speed_rpm;
    if (saved >= kShorter) {
      text += fmt::format(", {:.0f} % more of it saved by two.", 100.0 * saved);
    } else if (at_limit) {
      text += fmt::format("; two save {:.0f} %, since the fastest speed already is the best single one: what is missing is heat, and nothing brings it sooner.", 100.0 * saved);
    } else {
      text += fmt::format("; two save {:.0f} %: the single speed that is best leaves the machine nearly as the job keeps it.", 100.0 * saved);
    }
  } else {
    text += " No single speed is enough.";
  }
  return {.kind = Verdict::Kind::kGood, .title = fmt::format("Warm up for {:.1f} min", plan.staged.duration_s() / 60.0), .text = text};
}

Plot levels_plot(const WarmUpPlan& plan) {
  Plot plot{.title = "Minutes against micrometres",
            .x_label = "warm-up [min]",
            .y_label = "least peak of the job's drift [µm]",
            .series = {{.label = "one speed"}, {.label = "two speeds"}},
            .bands = {{.label = "tolerance", .low = 0.0, .high = plan.tolerance_um}},
            .marks = {},
            .half_width = true};
  for (const studies::WarmUpLevel& level : plan.levels) {
    for (Series& series : plot.series) series.x.push_back(level.duration_s / 60.0);
    plot.series[0].y.push_back(level.constant_um);
    plot.series[1].y.push_back(level.staged_um);
  }
  return plot;
}

Plot programme_plot(const WarmUpPlan& plan) {
  Plot plot{.title = "Shortest warm-up",
            .x_label = "time before the job [min]",
            .y_label = "speed [rpm]",
            .series = {},
            .bands = {},
            .marks = {},
            .half_width = true};
  for (const WarmUp* way : {&plan.constant, &plan.staged}) {
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
            .series = {},
            .bands = {{.label = "tolerance", .low = -plan.tolerance_um, .high = plan.tolerance_um}},
            .marks = section_marks(job)};
  for (const std::string& name : plan.channels) {
    const int color = static_cast<int>(plot.series.size() / 2);
    plot.series.push_back({.label = name + ", at once", .x = minutes(plan.job_at_once), .y = plan.job_at_once.at(name).values, .style = Series::Style::kDashed, .color = color});
    plot.series.push_back({.label = name + ", warmed up", .x = minutes(plan.job_warm), .y = plan.job_warm.at(name).values, .color = color});
  }
  return plot;
}

}  // namespace

output::Document document_of(const studies::WarmUpPlan& plan, const scenarios::Scenario& scenario, const Cyclogram& job,
                             const std::string& asked, const output::Provenance& made_by) {
  output::Document document{
      .made_by = made_by,
      .title = fmt::format("{}: warm-up before {}", scenario.name, job.name),
      .subtitle = fmt::format("predicted by the {}{}", plan.predicted_by, plan.started_from.empty() ? "" : "; after " + plan.started_from)};
  output::Section& body = document.body;
  add(body, verdict_of(plan, job));
  add(body, Value{.key = "job", .datum = asked});
  add(body, Value{.key = "tolerance_um", .words = "tolerance", .datum = plan.tolerance_um, .unit = "um", .digits = output::significant(4)});
  add(body, Value{.key = "kept_free", .words = "of it kept free for what the model does not know", .datum = plan.kept_free, .digits = output::percent(0)});
  add(body, Value{.key = "speed_limit_rpm", .words = "speed limit", .datum = plan.most_speed_rpm, .unit = "rpm", .digits = output::decimals(0)});
  add(body, Value{.key = "time_limit_min", .words = "time limit", .datum = plan.most_s / 60.0, .unit = "min", .digits = output::decimals(0)});
  add(body, Value{.key = "predicted_by", .datum = plan.predicted_by});
  add(body, Value{.key = "started_from", .datum = plan.started_from.empty() ? output::Datum() : output::Datum(plan.started_from)});
  add(body, ways_table(plan));
  add(body, Value{.key = "programmes_tried", .words = "programmes run on the model", .datum = plan.n_tried});
  add(body, levels_plot(plan));
  add(body, programme_plot(plan));
  add(body, job_plot(plan, job));
  Table levels{.key = "levels",
               .title = "Minutes against micrometres",
               .columns = {{.key = "duration_min", .title = "warm-up", .unit = "min", .digits = output::decimals(1)},
                           {.key = "one_speed_um", .title = "one speed", .unit = "um", .digits = output::decimals(2)},
                           {.key = "two_speeds_um", .title = "two speeds", .unit = "um", .digits = output::decimals(2)}},
               .rows = {},
               .detail = true};
  for (const studies::WarmUpLevel& level : plan.levels) levels.rows.push_back({level.duration_s / 60.0, level.constant_um, level.staged_um});
  add(body, std::move(levels));
  return document;
}

}  // namespace driftwright::findings
