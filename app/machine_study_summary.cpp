#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/axis_loop_report.hpp"
#include "app/iso230_3_report.hpp"
#include "app/machine_study_output.hpp"

namespace driftwright::app {
namespace {

using compensation::CorrectedRun;
using Json = nlohmann::ordered_json;

Json json_of(const compensation::Score& s) {
  return {{"rmse_um", s.rmse}, {"peak_um", s.peak_abs}, {"mean_um", s.mean}};
}

Json json_of(const CorrectedRun& c) {
  Json j = {{"channel", c.channel},        {"predictor", c.predictor},  {"actuator", c.actuator},
            {"before", json_of(c.before)}, {"after", json_of(c.after)}, {"inside_tolerance", c.inside_tolerance}};
  if (c.schedule) j["schedule"] = compensation::to_text(*c.schedule);
  return j;
}

Json json_of(const compensation::Regression& r) {
  Json j = {{"target", r.target}, {"intercept_um", r.intercept}, {"coefficients_um_per_K", Json::object()}};
  for (std::size_t i = 0; i < r.inputs.size(); ++i) j["coefficients_um_per_K"][r.inputs[i]] = r.coefficients[i];
  j["residual_rms_um"] = r.residual_rms;
  j["condition_number"] = r.condition_number;
  j["rank"] = r.rank;
  j["n_samples"] = r.n_samples;
  return j;
}

Json json_of(const compensation::Crossing& c) {
  return {{"cyclogram", c.source}, {"time_s", c.time_s}, {"displacement_um", c.displacement_um}};
}

}  // namespace

std::string terminal_summary(const scenarios::Scenario& scenario, const studies::MachineStudy& study) {
  const scenarios::Study& settings = *scenario.study;
  std::string text =
      fmt::format("{}: judged on '{}', fitted on {}\n", scenario.name, settings.judge, fmt::join(settings.train, ", "));
  std::string drift = "  peak drift before correction            ";
  for (const std::string& d : study.displacements)
    drift += fmt::format("  {} {:6.1f} um", d, study.of_channel(d).front()->before.peak_abs);
  text += drift + "\n";
  for (const compensation::DeployedPredictor& predictor : study.predictors) {
    if (predictor.target != study.displacements.front()) continue;  // each predictor once, all displacements on its lines
    for (const char* actuator : {"pulse injector", "schedule"}) {
      text += fmt::format("  after {:<15} by {:<14} ", predictor.name, actuator);
      bool inside = false;
      for (const CorrectedRun& c : study.corrections) {
        if (c.predictor != predictor.name || c.actuator != actuator) continue;
        text += fmt::format("  {} {:6.1f} um", c.channel, c.after.peak_abs);
        if (c.channel == settings.target) inside = c.inside_tolerance;
      }
      text += fmt::format("   {} {} {:g} um\n", settings.target, inside ? "stays inside" : "LEAVES", settings.tolerance_um);
    }
  }
  if (study.axis_loop) text += axis_loop_line(*scenario.axis_loop, *study.axis_loop);
  text += fmt::format("  sensors chosen for the regression: {} (grey relational grade {:.3f} to {:.3f})\n",
                      fmt::join(study.regressions.front().inputs, ", "), *study.ranking.channels.front().grade,
                      study.ranking.channels[study.regressions.front().inputs.size() - 1].grade.value());
  const studies::ModalError& bare = study.modal_errors.front();
  const studies::ModalError& full = study.modal_errors.back();
  text += fmt::format(
      "  {} thermal modes miss the full model by {:.2f} K (at {}); with steady responses by {:.2f} K (the judged machine's "
      "own modes)\n",
      bare.n_modes, bare.worst_temperature_K, bare.worst_sensor, full.worst_temperature_K);
  if (!study.ambiguities.empty()) {
    const auto& [sensor, a] = study.ambiguities.front();
    text += fmt::format("  drift is no function of temperature: at {} = {:.1f} degC {} is {:.1f} um or {:.1f} um\n", sensor,
                        a.temperature, settings.target, a.first.displacement_um, a.second.displacement_um);
  }
  return text;
}

Json summary_json(const scenarios::Scenario& scenario, const scenarios::Model& model, const studies::MachineStudy& study,
                  const output::Provenance& made_by) {
  const scenarios::Study& settings = *scenario.study;
  Json j = {
      {"program", "driftwright"}, {"version", made_by.version}, {"scenario", made_by.scenario}, {"name", scenario.name}};
  j["model"] = {
      {"nodes", model.mesh().n_nodes()}, {"cells", model.mesh().cells.size()}, {"temperature_unknowns", model.n_unknowns()}};
  if (const scenarios::ReducedMachine* reduced = model.reduced()) {
    j["model"]["reduced_states"] = reduced->system.size();
    j["model"]["estimated_error"] = {{"temperature_K", reduced->error.temperature_K},
                                     {"displacement_um", 1e6 * reduced->error.displacement_m},
                                     {"angle_urad", 1e6 * reduced->error.angle_rad}};
  }
  j["trained_on"] = settings.train;
  j["judged_on"] = settings.judge;
  j["target"] = settings.target;
  j["tolerance_um"] = settings.tolerance_um;
  j["energy_balance_gap"] = study.worst_energy_gap;
  j["ranking"] = {{"image_reason", study.ranking.reason}, {"channels", Json::array()}};
  for (const auto& c : study.ranking.channels) {
    j["ranking"]["channels"].push_back(
        {{"name", c.name}, {"grade", c.grade ? Json(*c.grade) : Json()}, {"reversed", c.reversed}});
  }
  j["regressions"] = Json::array();
  for (const auto& r : study.regressions) j["regressions"].push_back(json_of(r));
  j["modal"] = {{"time_constants_min", Json::array()}, {"errors_against_full_model", Json::array()}};
  for (double tau_s : study.modal_time_constant_s) j["modal"]["time_constants_min"].push_back(tau_s / 60.0);
  for (const studies::ModalError& e : study.modal_errors) {
    Json error = {{"n_modes", e.n_modes},
                  {"with_steady_responses", e.with_steady_responses},
                  {"worst_sensor", e.worst_sensor},
                  {"worst_temperature_K", e.worst_temperature_K}};
    for (std::size_t d = 0; d < study.displacements.size(); ++d)
      error["worst_" + study.displacements[d] + "_um"] = e.worst_displacement_um[d];
    j["modal"]["errors_against_full_model"].push_back(error);
  }
  j["corrections"] = Json::array();
  for (const CorrectedRun& c : study.corrections) j["corrections"].push_back(json_of(c));
  if (study.axis_loop) j["axis_loop"] = axis_loop_json(*scenario.axis_loop, *study.axis_loop);
  j["iso_230_3"] = Json::array();
  const auto add_iso = [&](const std::string& cyclogram, const Record& record) {
    Json figures = {{"cyclogram", cyclogram}};
    figures.update(iso230_3_json(compensation::iso230_3_figures(record)));
    j["iso_230_3"].push_back(figures);
  };
  add_iso(settings.judge, study.judged.record);
  for (const scenarios::SimulatedRun& run : study.train) add_iso(run.record.source, run.record);
  j["drift_at_one_temperature"] = Json::array();
  for (const auto& [sensor, a] : study.ambiguities) {
    j["drift_at_one_temperature"].push_back({{"sensor", sensor},
                                             {"temperature_degC", a.temperature},
                                             {"spread", a.spread},
                                             {"first", json_of(a.first)},
                                             {"second", json_of(a.second)}});
  }
  return j;
}

std::string schedule_text(const studies::MachineStudy& study) {
  std::string text =
      "# Correction schedules: one line per operation, n-{intervals in min}-{corrections in um, "
      "increments}.\n"
      "# The axis moves by minus the sum of the increments so far.\n";
  for (const CorrectedRun& c : study.corrections) {
    if (c.schedule)
      text += fmt::format("\n# {}, predicted by {}\n{}", c.channel, c.predictor, compensation::to_text(*c.schedule));
  }
  return text;
}

}  // namespace driftwright::app
