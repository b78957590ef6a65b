#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "app/axis_loop_report.hpp"
#include "app/iso230_3_report.hpp"
#include "app/machine_study_output.hpp"
#include "app/run_report.hpp"

namespace driftwright::app {
namespace {

using compensation::CorrectedRun;
using output::Heading;
using output::Paragraph;
using output::Plot;
using output::Series;
using output::Table;
using output::Verdict;

Verdict verdict(const scenarios::Study& settings, const studies::MachineStudy& study) {
  const auto of_target = study.of_channel(settings.target);
  const auto best = *std::min_element(of_target.begin(), of_target.end(), [](const CorrectedRun* a, const CorrectedRun* b) {
    return a->after.peak_abs < b->after.peak_abs;
  });
  std::vector<std::string> failing;
  for (const CorrectedRun* c : of_target) {
    if (!c->inside_tolerance)
      failing.push_back(fmt::format("{} by {} ({:.1f} um)", c->predictor, c->actuator, c->after.peak_abs));
  }
  const std::string text = fmt::format(
      "{} on '{}', which no strategy was fitted on: {:.1f} um before correction, {:.1f} um after {} by {}.{}",
      settings.target, settings.judge, best->before.peak_abs, best->after.peak_abs, best->predictor, best->actuator,
      failing.empty() ? "" : fmt::format(" Not inside {:g} um: {}.", settings.tolerance_um, fmt::join(failing, ", ")));
  return {best->inside_tolerance ? Verdict::Kind::kGood : Verdict::Kind::kBad,
          best->inside_tolerance ? fmt::format("Inside {:g} um by at least one strategy", settings.tolerance_um)
                                 : fmt::format("No strategy stays inside {:g} um", settings.tolerance_um),
          text};
}

Table strategies_table(const studies::MachineStudy& study) {
  Table table{.caption =
                  "Peak and RMS of the drift before correction and of what is left after it, on the judged "
                  "cyclogram. The injector acts on thermometer readings of the run; a schedule is planned ahead, on the "
                  "temperatures that the modal model predicts. The thermal modes are those of the judged machine "
                  "itself: their error is that of few modes, not of a wrong model.",
              .headers = {"channel", "predictor", "actuator", "peak before [um]", "peak after [um]", "RMS after [um]",
                          "inside tolerance"},
              .rows = {}};
  for (const CorrectedRun& c : study.corrections) {
    table.rows.push_back({c.channel, c.predictor, c.actuator, fmt::format("{:.1f}", c.before.peak_abs),
                          fmt::format("{:.1f}", c.after.peak_abs), fmt::format("{:.2f}", c.after.rmse),
                          c.inside_tolerance ? "yes" : "no"});
  }
  return table;
}

Plot residual_plot(const std::string& channel, const scenarios::Scenario& scenario, const studies::MachineStudy& study) {
  const Record& record = study.judged.record;
  const double tolerance_um = scenario.study->tolerance_um;
  Plot plot{.title = channel + " before and after correction",
            .x_label = "time [min]",
            .y_label = channel + " [um]",
            .series = {{.label = "before", .x = minutes(record), .y = record.at(channel).values, .width = 3.0}},
            .bands = {{fmt::format("tolerance ±{:g} um", tolerance_um), -tolerance_um, tolerance_um}},
            .marks = section_marks(scenario.cyclogram(scenario.study->judge))};
  for (const CorrectedRun* c : study.of_channel(channel)) {
    plot.series.push_back({.label = c->predictor + " by " + c->actuator, .x = minutes(record), .y = c->residual_um});
  }
  return plot;
}

/// δ over T: one curve per cyclogram; were drift a function of temperature they would coincide.
Plot drift_over_temperature(const std::string& sensor, const std::string& target, const studies::MachineStudy& study) {
  Plot plot{.title = "Drift over temperature at " + sensor,
            .x_label = sensor + " [degC]",
            .y_label = target + " [um]",
            .series = {}};
  const auto add = [&](const Record& r) {
    plot.series.push_back({.label = r.source, .x = r.at(sensor).values, .y = r.at(target).values});
  };
  for (const scenarios::SimulatedRun& run : study.train) add(run.record);
  add(study.judged.record);
  return plot;
}

Table ranking_table(const studies::MachineStudy& study) {
  Table table{.caption = "Grey relational grade of each thermometer against the target. " + study.ranking.reason,
              .headers = {"rank", "sensor", "grade [-]", "chosen"},
              .rows = {}};
  const auto& chosen = study.regressions.front().inputs;
  for (std::size_t i = 0; i < study.ranking.channels.size(); ++i) {
    const auto& c = study.ranking.channels[i];
    const bool is_chosen = std::find(chosen.begin(), chosen.end(), c.name) != chosen.end();
    table.rows.push_back(
        {fmt::format("{}", i + 1), c.name, c.grade ? fmt::format("{:.4f}", *c.grade) : c.note, is_chosen ? "yes" : ""});
  }
  return table;
}

Table regression_table(const studies::MachineStudy& study) {
  Table table{.caption =
                  "Multiple linear regression (QR) on the training records; RMS is that of its residual "
                  "there. A condition number far above 100 says that the chosen sensors tell the same story twice.",
              .headers = {"channel", "intercept [um]"},
              .rows = {}};
  for (const std::string& input : study.regressions.front().inputs) table.headers.push_back(input + " [um/K]");
  table.headers.insert(table.headers.end(), {"RMS [um]", "condition [-]"});
  for (const auto& r : study.regressions) {
    std::vector<std::string> row = {r.target, fmt::format("{:.2f}", r.intercept)};
    for (double b : r.coefficients) row.push_back(fmt::format("{:.3f}", b));
    row.push_back(fmt::format("{:.2f}", r.residual_rms));
    row.push_back(fmt::format("{:.0f}", r.condition_number));
    table.rows.push_back(row);
  }
  return table;
}

Table modal_table(const studies::MachineStudy& study) {
  Table table{.caption = "Largest difference between the modal model and the full model on the judged cyclogram.",
              .headers = {"basis", "worst sensor", "temperature [K]"},
              .rows = {}};
  for (const std::string& d : study.displacements) table.headers.push_back(d + " [um]");
  for (const studies::ModalError& e : study.modal_errors) {
    std::vector<std::string> row = {
        fmt::format("modes ({}) {}", e.n_modes, e.with_steady_responses ? "and steady responses" : "alone"), e.worst_sensor,
        fmt::format("{:.3f}", e.worst_temperature_K)};
    for (double d_um : e.worst_displacement_um) row.push_back(fmt::format("{:.2f}", d_um));
    table.rows.push_back(row);
  }
  return table;
}

void add_ambiguity(output::Report& report, const std::string& target, const studies::MachineStudy& study) {
  const auto& [sensor, a] = study.ambiguities.front();
  report.blocks.emplace_back(Heading{"Drift is not a function of temperature"});
  report.blocks.emplace_back(
      Paragraph{fmt::format("At {} = {:.2f} degC, {} is {:.1f} um in '{}' (at {:.0f} min) and {:.1f} um in '{}' (at "
                            "{:.0f} min). No "
                            "correction from this temperature alone can serve both.",
                            sensor, a.temperature, target, a.first.displacement_um, a.first.source, a.first.time_s / 60.0,
                            a.second.displacement_um, a.second.source, a.second.time_s / 60.0)});
  for (const std::string& shown : {study.single_sensor.front().inputs.front(), sensor}) {
    Plot plot = drift_over_temperature(shown, target, study);
    plot.half_width = true;
    report.blocks.emplace_back(std::move(plot));
  }
  Table table{.caption =
                  "Largest spread of the drift at one temperature, |d1 - d2| / min(|d1|, |d2|), between two "
                  "cyclograms; drifts below 5 um "
                  "do not count.",
              .headers = {"sensor", "temperature [degC]", "drift 1 [um]", "drift 2 [um]", "spread [%]", "cyclogram 1",
                          "cyclogram 2"},
              .rows = {}};
  for (const auto& [name, b] : study.ambiguities) {
    table.rows.push_back({name, fmt::format("{:.2f}", b.temperature), fmt::format("{:.1f}", b.first.displacement_um),
                          fmt::format("{:.1f}", b.second.displacement_um), fmt::format("{:.0f}", 100.0 * b.spread),
                          b.first.source, b.second.source});
  }
  report.blocks.emplace_back(std::move(table));
}

}  // namespace

output::Report study_report(const scenarios::Scenario& scenario, const scenarios::Model& model,
                            const studies::MachineStudy& study, const output::Provenance& made_by) {
  const scenarios::Study& settings = *scenario.study;
  const Cyclogram& judged = scenario.cyclogram(settings.judge);
  output::Report report{
      .title = scenario.name + ": thermal drift and its correction",
      .subtitle = fmt::format("Driftwright {}, scenario {}; {} nodes, {} cells; {}", made_by.version, made_by.scenario,
                              model.mesh().n_nodes(), model.mesh().cells.size(), model.words()),
      .blocks = {}};
  const auto add = [&](auto block) { report.blocks.emplace_back(std::move(block)); };
  add(verdict(settings, study));
  add(strategies_table(study));
  add(residual_plot(settings.target, scenario, study));
  if (study.axis_loop)
    add_axis_loop(report, *scenario.axis_loop, *study.axis_loop, settings.tolerance_um, section_marks(judged));
  add(Heading{"The judged cyclogram: " + settings.judge});
  std::vector<std::string> temperatures = study.judged.record.names_with_unit("degC");
  const auto half = static_cast<std::ptrdiff_t>((temperatures.size() + 1) / 2);
  add(channels_plot("Displacements of the tool against the table", "displacement [um]", study.judged.record,
                    study.displacements, judged));
  add(channels_plot("Temperatures (1)", "temperature [degC]", study.judged.record,
                    {temperatures.begin(), temperatures.begin() + half}, judged));
  add(channels_plot("Temperatures (2)", "temperature [degC]", study.judged.record,
                    {temperatures.begin() + half, temperatures.end()}, judged));
  if (!scenario.machine->tilts.empty()) {
    add(channels_plot("Tilts of the spindle against the table", "tilt [urad]", study.judged.record,
                      study.judged.record.names_with_unit("urad"), judged));
  }
  report.blocks.push_back(iso230_3_block(compensation::iso230_3_figures(study.judged.record)));
  add(heat_plot(study.judged.trajectory, judged));
  add(heat_table(study.judged.trajectory));
  add(inner_heat_table(study.judged.trajectory));
  if (!study.judged.trajectory.overshoots.empty()) add(overshoot_table(study.judged.trajectory, model));
  for (const std::string& d : study.displacements) {
    if (d != settings.target) add(residual_plot(d, scenario, study));
  }
  add(Heading{"Sensors and regression"});
  add(ranking_table(study));
  add(regression_table(study));
  if (!study.ambiguities.empty()) add_ambiguity(report, settings.target, study);
  add(Heading{"Thermal modes"});
  std::vector<std::string> tau;
  for (double tau_s : study.modal_time_constant_s) tau.push_back(fmt::format("{:.1f}", tau_s / 60.0));
  add(Paragraph{
      fmt::format("Time constants of the {} slowest modes at standstill [min]: {}.", tau.size(), fmt::join(tau, ", "))});
  add(modal_table(study));
  add(Heading{"Correction schedules"});
  add(output::Preformatted{schedule_text(study)});
  add(Heading{"Training cyclograms"});
  for (const scenarios::SimulatedRun& run : study.train) {
    Plot plot = channels_plot(run.record.source, "displacement [um]", run.record, study.displacements,
                              scenario.cyclogram(run.record.source));
    plot.half_width = true;
    add(std::move(plot));
  }
  return report;
}

}  // namespace driftwright::app
