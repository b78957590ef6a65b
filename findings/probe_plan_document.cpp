#include "findings/probe_plan_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "findings/columns.hpp"
#include "findings/named_value.hpp"

namespace driftwright::findings {
namespace {

using output::Plot, output::Series, output::Table, output::Value, output::Verdict;
using studies::PlannedProbing, studies::ProbePlace, studies::ProbePlan, studies::ProbeSequence;

std::string probings_words(std::size_t n) {
  return n == 1 ? "1 probing" : fmt::format("{} probings", n);
}

std::string place_words(const ProbePlace& place) {
  return place.line > 0 ? fmt::format("{} at line {}", place.where, place.line) : place.where;
}

std::string allowed_words(const ProbePlan& plan) {
  if (plan.kept_free == 0.0) return fmt::format("{:g} µm", plan.tolerance_um);
  return fmt::format("{:.3g} µm ({:g} µm, of which {:.0f} % are kept free)", plan.allowed_um(), plan.tolerance_um,
                     100.0 * plan.kept_free);
}

/// How the plan compares with equal intervals, and why it is not much better where it is not. Empty for a single probing,
/// which has no interval.
std::string beside_equal(const ProbePlan& plan) {
  const ProbeSequence* equal = plan.equal();
  if (!plan.best || plan.best->probings.size() < 2 || !equal) return "";
  constexpr double kMuch = 2.0 / 3.0;
  return fmt::format(
      " At equal intervals as many leave {:.1f} µm{}.", equal->worst_um,
      plan.best->worst_um <= kMuch * equal->worst_um
          ? ""
          : ": errors of a correction grow alike at all times, so equal intervals are nearly the best wherever "
            "places of this job are near them");
}

Verdict verdict_of(const ProbePlan& plan) {
  const std::string allowed = allowed_words(plan);
  if (!plan.best) {
    const ProbeSequence& least = plan.shown();
    const std::size_t n = least.probings.size();
    return {
        .kind = Verdict::Kind::kBad,
        .title = "No number of probings keeps the tolerance",
        .text = fmt::format(
            "Allowed are {}. {} the largest half width of the 95 % interval {} {:.1f} µm, {:.0f} min from the start of the "
            "job. No number of probings lowers it by {}1 %: a place for a probing is missing before, or the probe is too "
            "noisy. Allow a probing in between (a tool change, M0, or a pause between parts), a larger tolerance, or use a "
            "predictor that leaves less.",
            allowed, n == 0 ? std::string("Without a probing") : fmt::format("With {}", probings_words(n)),
            n == 0 ? "is" : "is still", least.worst_um, least.worst_s / 60.0, n == 0 ? "" : "another ")};
  }
  if (plan.best->probings.empty())
    return {
        .kind = Verdict::Kind::kGood,
        .title = "No probing is needed",
        .text = fmt::format("The half width of the 95 % interval of {} stays within {:.1f} µm during the job; allowed are "
                            "{}.",
                            plan.target, plan.best->worst_um, allowed)};
  return {
      .kind = Verdict::Kind::kGood,
      .title = fmt::format("{} {} the tolerance", probings_words(plan.best->probings.size()),
                           plan.best->probings.size() == 1 ? "keeps" : "keep"),
      .text = fmt::format("{:.1f} min are lost. The half width of the 95 % interval of {} stays within {:.1f} µm at each "
                          "moment of the work; allowed are {}. Without a probing it reaches {:.1f} µm.{}",
                          plan.best->lost_s / 60.0, plan.target, plan.best->worst_um, allowed,
                          plan.curve.front().best.worst_um, beside_equal(plan))};
}

Table probings_table(const ProbePlan& plan) {
  Table table{.key = "probings",
              .title = "When to probe",
              .caption =
                  "Before: half width of the 95 % interval when the work stops for the probing. After: when it goes on. "
                  "The time counts from the start of the job, without earlier probings.",
              .columns = {{.key = "at_min", .title = "at", .unit = "min", .digits = output::decimals(1)},
                          {.key = "part", .title = "part"},
                          {.key = "where", .title = "where"},
                          {.key = "line", .title = "before line"},
                          um_column("before_um", "before"),
                          um_column("after_um", "after"),
                          {.key = "lost_min", .title = "lost", .unit = "min", .digits = output::decimals(1)}},
              .detail = false,
              .file = "probe_plan.csv"};
  if (!plan.best) return table;
  for (const PlannedProbing& p : plan.best->probings) {
    const ProbePlace& place = plan.job.places[p.place];
    table.rows.push_back({place.time_s / 60.0, place.part, place.where,
                          place.line > 0 ? output::Datum(place.line) : output::Datum(), p.before_um, p.after_um,
                          p.lost_s / 60.0});
  }
  return table;
}

Table probe_curve_table(const ProbePlan& plan) {
  Table table{.key = "curve",
              .title = "Minutes against micrometres",
              .caption =
                  "Half width: the largest of the 95 % interval during the work. RMS: expected, of what is left, over "
                  "the work. Equal: as many probings at equal intervals, each at the nearest place.",
              .columns = {{.key = "n", .title = "probings"},
                          {.key = "lost_min", .title = "lost", .unit = "min", .digits = output::decimals(1)},
                          um_column("half_width_um", "half width", 2),
                          um_column("rms_um", "RMS", 2),
                          um_column("equal_half_width_um", "equal, half width", 2),
                          um_column("equal_rms_um", "equal, RMS", 2),
                          {.key = "keeps", .title = "keeps the tolerance"}}};
  for (const studies::ProbeCurveRow& row : plan.curve)
    table.rows.push_back({row.n, row.best.lost_s / 60.0, row.best.worst_um, row.best.rms_um, row.equal.worst_um,
                          row.equal.rms_um, row.best.worst_um <= plan.allowed_um()});
  return table;
}

Series width_series(const ProbePlan& plan, const ProbeSequence& sequence, const std::string& label,
                    Series::Style style = Series::Style::kLine) {
  Series series{.label = label, .style = style};
  for (const studies::WidthAt& w : widths_of(plan.job, plan.axis, sequence)) {
    series.x.push_back(w.time_s / 60.0);
    series.y.push_back(w.um);
  }
  return series;
}

Plot widths_plot(const ProbePlan& plan) {
  Plot plot{.title = "What is not known of " + plan.target,
            .x_label = "time in the job [min]",
            .y_label = "half width of the 95 % interval [µm]",
            .bands = {{.label = "allowed", .low = 0.0, .high = plan.allowed_um()}}};
  const ProbeSequence& shown = plan.shown();
  plot.series.push_back(width_series(plan, shown, fmt::format("planned, {}", probings_words(shown.probings.size()))));
  if (const ProbeSequence* equal = plan.equal(); equal && !equal->probings.empty())
    plot.series.push_back(width_series(plan, *equal, "as many at equal intervals", Series::Style::kDashed));
  Series places{.label = "places for a probing", .style = Series::Style::kPoints};
  for (const ProbePlace& p : plan.job.places) {
    places.x.push_back(p.time_s / 60.0);
    places.y.push_back(0.0);
  }
  plot.series.push_back(std::move(places));
  return plot;
}

Plot probe_curve_plot(const ProbePlan& plan) {
  Plot plot{.title = "Minutes against micrometres",
            .x_label = "time of all probings [min]",
            .y_label = "largest half width of the 95 % interval [µm]",
            .series = {{.label = "planned", .style = Series::Style::kPoints},
                       {.label = "equal intervals", .style = Series::Style::kPoints}},
            .bands = {{.label = "allowed", .low = 0.0, .high = plan.allowed_um()}}};
  for (const studies::ProbeCurveRow& row : plan.curve) {
    plot.series[0].x.push_back(row.best.lost_s / 60.0);
    plot.series[0].y.push_back(row.best.worst_um);
    plot.series[1].x.push_back(row.equal.lost_s / 60.0);
    plot.series[1].y.push_back(row.equal.worst_um);
  }
  return plot;
}

Table points_table(const studies::PointChoice& choice) {
  Table table{
      .key = "points",
      .title = "What to probe",
      .caption = fmt::format(
          "Left: root mean square of the standard deviations of the errors of {} points, of {} rows, after a probing of "
          "these points with a noise of {:.3g} µm each. Least mean: A-optimal. Most information: D-optimal.",
          choice.counting.size(), choice.errors.n_rows, choice.noise_um),
      .columns = {{.key = "n", .title = "points"},
                  {.key = "least_mean", .title = "least mean"},
                  um_column("left_um", "left", 2),
                  um_column("worst_um", "worst point", 2),
                  {.key = "worst", .title = "which"},
                  {.key = "most_information", .title = "most information"},
                  um_column("information_left_um", "left", 2),
                  {.key = "nats", .title = "information", .unit = "nats", .digits = output::decimals(1)}}};
  const auto names = [&](const studies::PointSet& set) {
    std::vector<std::string> list;
    for (std::size_t k : set.points) list.push_back(choice.errors.names[k]);
    return list;
  };
  const studies::PointSet& none = choice.without;
  table.rows.push_back(
      {0, names(none), none.left_um, none.worst_um, choice.errors.names[none.worst], names(none), none.left_um, none.nats});
  for (std::size_t n = 0; n < choice.by_variance.size(); ++n) {
    const studies::PointSet& a = choice.by_variance[n];
    const studies::PointSet& d = choice.by_determinant[n];
    table.rows.push_back(
        {n + 1, names(a), a.left_um, a.worst_um, choice.errors.names[a.worst], names(d), d.left_um, d.nats});
  }
  return table;
}

std::vector<std::string> what_next(const ProbePlan& plan) {
  std::vector<std::string> sentences;
  if (plan.touch)
    sentences.emplace_back(
        "The programs in control/ touch the gauge and add the offset (docs/how-to/touch_cycle.md). Those for Siemens and "
        "Heidenhain have not been run on a control: run them with the gauge taken away first.");
  if (!plan.best || plan.best->probings.empty()) return sentences;
  const ProbePlace& first = plan.job.places[plan.best->probings.front().place];
  sentences.push_back(
      fmt::format("Probe {} first {:.0f} min from the start of the job ({}, part {}), then as the table says.", plan.target,
                  first.time_s / 60.0, place_words(first), first.part));
  if (plan.touch) return sentences;
  sentences.emplace_back(
      "Give each value to `follow` (docs/how-to/probing.md). If it says that the errors of this run are larger than usual, "
      "probe earlier than planned.");
  return sentences;
}

}  // namespace

output::Document document_of(const ProbePlan& plan, const scenarios::Scenario& scenario,
                             const std::vector<std::string>& warnings, const output::Provenance& made_by) {
  output::Document document{
      .made_by = made_by,
      .title = fmt::format("{}: probings of {} during {}", scenario.name, plan.target, plan.job.name),
      .subtitle =
          fmt::format("corrected by '{}'; what it leaves has a standard deviation of {:.2f} µm and a time constant of "
                      "{:.0f} min",
                      plan.predictor, plan.axis.process.deviation_um, plan.axis.process.time_constant_s / 60.0)};
  output::Section& body = document.body;
  add(body, verdict_of(plan));
  add(body, widths_plot(plan));
  body.sections.push_back(output::next_section(what_next(plan)));
  output::Section numbers;
  add(numbers, Value{.key = "predictor", .words = "predictor", .datum = plan.predictor});
  add(numbers, Value{.key = "target", .words = "axis", .datum = plan.target});
  add(numbers, named_value("tolerance_um", "tolerance", plan.tolerance_um, "um", output::significant(4)));
  add(numbers, named_value("kept_free", "of it kept free for all that is not thermal", plan.kept_free, output::percent(0)));
  add(numbers, named_value("work_min", "end of the work", plan.job.work.back().until_s / 60.0, "min", output::decimals(1)));
  add(numbers, Value{.key = "n_places", .words = "places for a probing", .datum = plan.job.places.size()});
  add(numbers, named_value("probe_noise_um", "noise of a probing", plan.axis.probe.noise_um, "um", output::significant(3)));
  add(numbers, named_value("probe_lag_s", "lag of the probe", plan.axis.probe.lag_s, "s", output::significant(3)));
  add(numbers, named_value("probing_min", "time of a probing", plan.axis.probing_s / 60.0, "min", output::significant(3)));
  add(numbers, named_value("known_at_start", "the drift counts from the start of the job", plan.axis.is_known_at_start));
  if (plan.touch) {
    add(numbers, named_value("first_step_um", "touch cycle: largest first offset", plan.touch->first_um, "um",
                             output::significant(4)));
    add(numbers, named_value("step_um", "touch cycle: largest step", plan.touch->step_um, "um", output::significant(4)));
    add(numbers, named_value("most_um", "touch cycle: largest offset", plan.touch->most_um, "um", output::significant(4)));
  }
  add(numbers, probings_table(plan));
  add(numbers, probe_curve_table(plan));
  if (plan.points) add(numbers, points_table(*plan.points));
  add(numbers, probe_curve_plot(plan));
  if (!warnings.empty()) add(numbers, output::Notes{.key = "warnings", .sort = "warning", .lines = warnings});
  body.sections.push_back(std::move(numbers));
  return document;
}

}  // namespace driftwright::findings
