#include "findings/machine_study_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "findings/axis_loop_section.hpp"
#include "findings/iso230_3_section.hpp"
#include "findings/run_section.hpp"

namespace driftwright::findings {
namespace {

using compensation::CorrectedDrift;
using output::Column, output::Datum, output::Plot, output::Section, output::Table, output::Text, output::Value;
using output::Verdict;

Verdict verdict(const scenarios::Study& settings, const studies::MachineStudy& study) {
  const auto of_target = study.of_channel(settings.target);
  const auto best = *std::min_element(
      of_target.begin(), of_target.end(),
      [](const CorrectedDrift* a, const CorrectedDrift* b) { return a->after.peak_abs < b->after.peak_abs; });
  std::vector<std::string> failing;
  for (const CorrectedDrift* c : of_target) {
    if (!c->inside_tolerance)
      failing.push_back(fmt::format("{} by {} ({:.1f} µm)", c->predictor, c->actuator, c->after.peak_abs));
  }
  const std::string text = fmt::format(
      "{} on '{}', a duty cycle that no strategy was fitted to: {:.1f} µm before correction, {:.1f} µm after correction by "
      "{} through {}.{}",
      settings.target, settings.judge, best->before.peak_abs, best->after.peak_abs, best->predictor, best->actuator,
      failing.empty() ? "" : fmt::format(" Not inside {:g} µm: {}.", settings.tolerance_um, fmt::join(failing, ", ")));
  return {.kind = best->inside_tolerance ? Verdict::Kind::kGood : Verdict::Kind::kBad,
          .title = best->inside_tolerance ? fmt::format("Inside {:g} µm by at least one strategy", settings.tolerance_um)
                                          : fmt::format("No strategy stays inside {:g} µm", settings.tolerance_um),
          .text = text};
}

Table corrections_table(const studies::MachineStudy& study) {
  Table table{
      .key = "corrections",
      .title = "Drift before correction and what is left of it",
      .caption =
          "On the judged cyclogram. The injector acts on thermometer readings of the run; a schedule is planned ahead, on "
          "the temperatures that the modal model predicts. The thermal modes are those of the judged machine itself: their "
          "error is that of few modes, not of a wrong model.",
      .columns = {{.key = "channel", .title = "channel"},
                  {.key = "predictor", .title = "predictor"},
                  {.key = "actuator", .title = "actuator"},
                  {.key = "before.peak_um", .title = "peak before", .unit = "um"},
                  {.key = "after.peak_um", .title = "peak after", .unit = "um"},
                  {.key = "before.rmse_um", .title = "RMS before", .unit = "um", .digits = output::decimals(2)},
                  {.key = "after.rmse_um", .title = "RMS after", .unit = "um", .digits = output::decimals(2)},
                  {.key = "before.mean_um", .title = ""},
                  {.key = "after.mean_um", .title = ""},
                  {.key = "inside_tolerance", .title = "inside tolerance"},
                  {.key = "schedule", .title = ""}}};
  for (const CorrectedDrift& c : study.corrections) {
    table.rows.push_back({c.channel, c.predictor, c.actuator, c.before.peak_abs, c.after.peak_abs, c.before.rmse,
                          c.after.rmse, c.before.mean, c.after.mean, c.inside_tolerance,
                          c.schedule ? Datum(compensation::to_text(*c.schedule)) : Datum()});
  }
  return table;
}

Plot residual_plot(const std::string& channel, const scenarios::Scenario& scenario, const studies::MachineStudy& study) {
  const Record& record = study.judged.record;
  const double tolerance_um = scenario.study->tolerance_um;
  Plot plot{.title = channel + " before and after correction",
            .x_label = "time [min]",
            .y_label = channel + " [µm]",
            .series = {{.label = "before", .x = minutes(record), .y = record.at(channel).values, .width = 3.0}},
            .bands = {{fmt::format("tolerance ±{:g} µm", tolerance_um), -tolerance_um, tolerance_um}},
            .marks = section_marks(scenario.cyclogram(scenario.study->judge))};
  for (const CorrectedDrift* c : study.of_channel(channel)) {
    plot.series.push_back({.label = c->predictor + " by " + c->actuator, .x = minutes(record), .y = c->residual_um});
  }
  return plot;
}

/// δ over T: one curve per cyclogram; if the drift were a function of temperature they would coincide.
Plot drift_over_temperature(const std::string& sensor, const std::string& target, const studies::MachineStudy& study) {
  Plot plot{.title = "Drift over temperature at " + sensor, .x_label = sensor + " [°C]", .y_label = target + " [µm]"};
  const auto add = [&](const Record& r) {
    plot.series.push_back({.label = r.source, .x = r.at(sensor).values, .y = r.at(target).values});
  };
  for (const scenarios::SimulatedRun& run : study.train) add(run.record);
  add(study.judged.record);
  return plot;
}

Section ranking_section(const studies::MachineStudy& study) {
  Section section{.key = "ranking"};
  Table table{.key = "channels",
              .title = "Grey relational grade of each thermometer against the target",
              .caption = study.ranking.reason,
              .columns = {{.key = "rank", .title = "rank"},
                          {.key = "name", .title = "sensor"},
                          {.key = "grade", .title = "grade", .digits = output::decimals(4)},
                          {.key = "reversed", .title = ""},
                          {.key = "chosen", .title = "chosen"},
                          {.key = "note", .title = "note"}},
              .detail = true};
  const auto& chosen = study.regressions.front().inputs;
  for (std::size_t i = 0; i < study.ranking.channels.size(); ++i) {
    const auto& c = study.ranking.channels[i];
    const bool is_chosen = std::find(chosen.begin(), chosen.end(), c.name) != chosen.end();
    table.rows.push_back({i + 1, c.name, c.grade, c.reversed, is_chosen, c.note});
  }
  add(section, Value{.key = "image_reason", .datum = study.ranking.reason});
  add(section, Value{.key = "chosen", .words = "sensors chosen for the regression:", .datum = chosen});
  add(section, std::move(table));
  return section;
}

Table regression_table(const studies::MachineStudy& study) {
  Table table{.key = "regressions",
              .title = "Multiple linear regression (QR) on the training records",
              .caption =
                  "RMS is that of its residual there. A condition number far above 100 means that the chosen sensors carry "
                  "the same information twice.",
              .columns = {{.key = "target", .title = "channel"},
                          {.key = "intercept_um", .title = "intercept", .unit = "um", .digits = output::decimals(2)}},
              .detail = true};
  for (const std::string& input : study.regressions.front().inputs)
    table.columns.push_back(
        {.key = "coefficients_um_per_K." + input, .title = input, .unit = "um/K", .digits = output::decimals(3)});
  for (const Column& column : {Column{.key = "residual_rms_um", .title = "RMS", .unit = "um", .digits = output::decimals(2)},
                               Column{.key = "condition_number", .title = "condition", .digits = output::decimals(0)},
                               Column{.key = "rank", .title = ""}, Column{.key = "n_samples", .title = "samples"}})
    table.columns.push_back(column);
  for (const auto& r : study.regressions) {
    std::vector<Datum> row = {r.target, r.intercept};
    for (double b : r.coefficients) row.emplace_back(b);
    row.insert(row.end(), {r.residual_rms, r.condition_number, r.rank, r.n_samples});
    table.rows.push_back(std::move(row));
  }
  return table;
}

Section modal_section(const studies::MachineStudy& study) {
  Section section{.key = "modal", .title = "Thermal modes"};
  std::vector<double> tau_min;
  for (double tau_s : study.modal_time_constant_s) tau_min.push_back(tau_s / 60.0);
  add(section, Value{.key = "time_constants_min",
                     .words = fmt::format("time constants of the {} slowest modes at standstill", tau_min.size()),
                     .datum = tau_min,
                     .unit = "min",
                     .detail = true});
  Table table{
      .key = "errors_against_full_model",
      .title = "Largest difference between the modal model and the full model on the judged cyclogram",
      .caption = "",
      .columns = {{.key = "n_modes", .title = "modes"},
                  {.key = "with_steady_responses", .title = "with steady responses"},
                  {.key = "worst_sensor", .title = "worst sensor"},
                  {.key = "worst_temperature_K", .title = "temperature", .unit = "K", .digits = output::decimals(3)}}};
  for (const std::string& d : study.displacements)
    table.columns.push_back({.key = "worst_" + d + "_um", .title = d, .unit = "um", .digits = output::decimals(2)});
  for (const studies::ModalError& e : study.modal_errors) {
    std::vector<Datum> row = {e.n_modes, e.with_steady_responses, e.worst_sensor, e.worst_temperature_K};
    for (double d_um : e.worst_displacement_um) row.emplace_back(d_um);
    table.rows.push_back(std::move(row));
  }
  add(section, std::move(table));
  return section;
}

Section ambiguity_section(const std::string& target, const studies::MachineStudy& study) {
  Section section;
  Table table{.key = "drift_at_one_temperature",
              .title = "Largest spread of the drift at one temperature",
              .caption = "|d1 - d2| / min(|d1|, |d2|), between two cyclograms; drifts below 5 µm do not count.",
              .columns = {{.key = "sensor", .title = "sensor"},
                          {.key = "temperature_degC", .title = "temperature", .unit = "degC", .digits = output::decimals(2)},
                          {.key = "first.displacement_um", .title = "drift 1", .unit = "um"},
                          {.key = "second.displacement_um", .title = "drift 2", .unit = "um"},
                          {.key = "spread", .title = "spread", .digits = output::percent(0)},
                          {.key = "first.cyclogram", .title = "cyclogram 1"},
                          {.key = "second.cyclogram", .title = "cyclogram 2"},
                          {.key = "first.time_s", .title = ""},
                          {.key = "second.time_s", .title = ""}},
              .detail = true};
  for (const auto& [name, b] : study.ambiguities) {
    table.rows.push_back({name, b.temperature, b.first.displacement_um, b.second.displacement_um, b.spread, b.first.source,
                          b.second.source, b.first.time_s, b.second.time_s});
  }
  if (!study.ambiguities.empty()) {
    section.title = "Drift is not a function of temperature";
    const auto& [sensor, a] = study.ambiguities.front();
    add(section,
        Text{fmt::format("At {} = {:.2f} °C, {} is {:.1f} µm in '{}' (at {:.0f} min) and {:.1f} µm in '{}' (at {:.0f} "
                         "min). No correction from this temperature alone can serve both.",
                         sensor, a.temperature, target, a.first.displacement_um, a.first.source, a.first.time_s / 60.0,
                         a.second.displacement_um, a.second.source, a.second.time_s / 60.0)});
    for (const std::string& shown : {study.single_sensor.front().inputs.front(), sensor}) {
      Plot plot = drift_over_temperature(shown, target, study);
      plot.half_width = true;
      add(section, std::move(plot));
    }
  }
  add(section, std::move(table));
  return section;
}

Section model_section(const scenarios::Model& model) {
  Section section{.key = "model"};
  add(section, Value{.key = "nodes", .datum = model.mesh().n_nodes()});
  add(section, Value{.key = "cells", .datum = model.mesh().cells.size()});
  add(section, Value{.key = "temperature_unknowns", .datum = model.n_unknowns()});
  if (const scenarios::ReducedMachine* reduced = model.reduced()) {
    add(section, Value{.key = "reduced_states", .datum = reduced->system.size()});
    add(section, Value{.key = "estimated_error.temperature_K", .datum = reduced->error.temperature_K});
    add(section, Value{.key = "estimated_error.displacement_um", .datum = 1e6 * reduced->error.displacement_m});
    add(section, Value{.key = "estimated_error.angle_urad", .datum = 1e6 * reduced->error.angle_rad});
  }
  return section;
}

Section judged_section(const scenarios::Scenario& scenario, const scenarios::Model& model,
                       const studies::MachineStudy& study) {
  const Cyclogram& judged = scenario.cyclogram(scenario.study->judge);
  const Record& record = study.judged.record;
  Section section{.title = "The judged cyclogram: " + judged.name};
  const std::vector<std::string> temperatures = record.names_with_unit("degC");
  const auto half = temperatures.begin() + static_cast<std::ptrdiff_t>((temperatures.size() + 1) / 2);
  add(section, channels_plot("Displacements of the tool against the table", "displacement [µm]", record, study.displacements,
                             judged));
  add(section, channels_plot("Temperatures (1)", "temperature [°C]", record, {temperatures.begin(), half}, judged));
  add(section, channels_plot("Temperatures (2)", "temperature [°C]", record, {half, temperatures.end()}, judged));
  if (!scenario.machine->tilts.empty())
    add(section, channels_plot("Tilts of the spindle against the table", "tilt [µrad]", record,
                               record.names_with_unit("urad"), judged));
  add_heat(section, study.judged.trajectory, judged);
  add_overshoots(section, study.judged.trajectory, model);
  for (const std::string& d : study.displacements) {
    if (d != scenario.study->target) add(section, residual_plot(d, scenario, study));
  }
  const auto add_iso = [&](const std::string& cyclogram, const Record& of) {
    Section figures = iso230_3_section(compensation::iso230_3_figures(of));
    figures.item = {"cyclogram", cyclogram};
    figures.title += ": " + cyclogram;
    figures.detail = true;
    section.sections.push_back(std::move(figures));
  };
  add_iso(judged.name, record);
  for (const scenarios::SimulatedRun& run : study.train) add_iso(run.record.source, run.record);
  return section;
}

Section training_section(const scenarios::Scenario& scenario, const studies::MachineStudy& study) {
  Section section{.title = "Training cyclograms"};
  for (const scenarios::SimulatedRun& run : study.train) {
    Plot plot = channels_plot(run.record.source, "displacement [µm]", run.record, study.displacements,
                              scenario.cyclogram(run.record.source));
    plot.half_width = true;
    add(section, std::move(plot));
  }
  return section;
}

}  // namespace

output::Document document_of(const studies::MachineStudy& study, const scenarios::Scenario& scenario,
                             const scenarios::Model& model, const WorstMoment& worst, const output::Provenance& made_by) {
  const scenarios::Study& settings = *scenario.study;
  output::Document document{.made_by = made_by,
                            .title = scenario.name + ": thermal drift and its correction",
                            .subtitle = fmt::format("judged on '{}', fitted on {}; {} nodes, {} cells; {}", settings.judge,
                                                    fmt::join(settings.train, ", "), model.mesh().n_nodes(),
                                                    model.mesh().cells.size(), model.words())};
  Section& body = document.body;
  add(body, Value{.key = "name", .datum = scenario.name});
  add(body, verdict(settings, study));
  add_machine(body, *scenario.machine, model.mesh(), settings.judge, worst);
  add(body, Value{.key = "trained_on", .datum = settings.train});
  add(body, Value{.key = "judged_on", .datum = settings.judge});
  add(body, Value{.key = "target", .datum = settings.target});
  add(body, Value{.key = "tolerance_um", .datum = settings.tolerance_um});
  add(body, Value{.key = "energy_balance_gap", .datum = study.worst_energy_gap});
  add(body, residual_plot(settings.target, scenario, study));
  add(body, corrections_table(study));
  body.sections.push_back(model_section(model));
  if (study.axis_loop)
    body.sections.push_back(axis_loop_section(*scenario.axis_loop, *study.axis_loop, settings.tolerance_um,
                                              section_marks(scenario.cyclogram(settings.judge))));
  body.sections.push_back(judged_section(scenario, model, study));
  body.sections.push_back(
      {.title = "Sensors and regression", .sections = {ranking_section(study), {.blocks = {regression_table(study)}}}});
  body.sections.push_back(ambiguity_section(settings.target, study));
  body.sections.push_back(modal_section(study));
  body.sections.push_back({.title = "Correction schedules", .blocks = {output::Preformatted{.text = schedule_text(study)}}});
  body.sections.push_back(training_section(scenario, study));
  return document;
}

std::string schedule_text(const studies::MachineStudy& study) {
  std::string text =
      "# Correction schedules: one line per operation, n-{intervals in min}-{corrections in um, "
      "increments}.\n"
      "# The axis moves by minus the sum of the increments so far.\n";
  for (const CorrectedDrift& c : study.corrections) {
    if (c.schedule)
      text += fmt::format("\n# {}, predicted by {}\n{}", c.channel, c.predictor, compensation::to_text(*c.schedule));
  }
  return text;
}

}  // namespace driftwright::findings
