#include "app/table_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/run_report.hpp"
#include "base/quantity.hpp"
#include "studies/table_strategy.hpp"

namespace driftwright::app {
namespace {

using compensation::ProbeErrors;
using compensation::ProbeRow;
using output::Heading;
using output::Paragraph;
using output::Plot;
using output::Series;
using output::Table;

std::string um(double m, int decimals = 1) {
  return fmt::format("{:.{}f}", 1e6 * m, decimals);
}

/// How much less than without correction [%].
double less_percent(double left_m, double none_m) {
  return none_m > 0.0 ? 100.0 * (1.0 - left_m / none_m) : 0.0;
}

std::vector<double> hours(const std::vector<double>& time_s) {
  std::vector<double> t_h;
  for (double t_s : time_s) t_h.push_back(t_s / 3600.0);
  return t_h;
}

const studies::TableStrategy& strategy(const studies::TableStudy& study, const std::string& name) {
  return *std::find_if(study.strategies.begin(), study.strategies.end(), [&](const auto& s) { return s.name == name; });
}

Plot series_plot(const scenarios::Scenario& scenario, const studies::TableStudy& study) {
  const studies::TableRun& run = study.run;
  std::vector<double> x_um, table_um, scale_um;  // the latter since the start: from 20 degC on they would dwarf the rest
  for (std::size_t i = 0; i < run.table_only_x_um.size(); ++i) {
    table_um.push_back(run.table_only_x_um[i] - run.table_only_x_um[0]);
    scale_um.push_back(run.scale_only_x_um[i] - run.scale_only_x_um[0]);
  }
  for (std::size_t i = 0; i < run.table_only_x_um.size(); ++i)
    x_um.push_back(run.table_only_x_um[i] - run.scale_only_x_um[i]);
  const std::vector<double> t_h = hours(run.table.time_s);
  Plot plot{.title = "X error over the table's length: computed, and as published",
            .x_label = "time [h]",
            .y_label = "growth from end to end [um]",
            .series = {{.label = "table less scale", .x = t_h, .y = x_um},
                       {.label = "table alone, since the start", .x = t_h, .y = table_um, .style = Series::Style::kDashed},
                       {.label = "scale alone, since the start", .x = t_h, .y = scale_um, .style = Series::Style::kDashed}}};
  if (const auto& readings = scenario.table->readings)
    plot.series.push_back({.label = "published",
                           .x = hours(readings->time_s),
                           .y = readings->x_um,
                           .style = Series::Style::kPoints,
                           .width = 4.0});
  return plot;
}

Plot temperatures_plot(const scenarios::Scenario& scenario, const studies::TableStudy& study) {
  Plot plot{.title = "Temperatures", .x_label = "time [h]", .y_label = "temperature [degC]"};
  for (const auto& sensor : scenario.machine->sensors) {
    plot.series.push_back(
        {.label = sensor.name, .x = hours(study.run.table.time_s), .y = study.run.record.at(sensor.name).values});
  }
  return plot;
}

Plot strategies_plot(const studies::TableStudy& study) {
  std::vector<double> t_h = hours(study.run.table.time_s);
  t_h.resize(study.n_judged);
  Plot plot{.title = "Largest position error anywhere on the table", .x_label = "time [h]", .y_label = "error [um]"};
  for (const char* name : {"none", "hall temperature", "model alone", "rings", "rings, thermometers between",
                           "rings and model of the whole table"}) {
    const studies::TableStrategy& s = strategy(study, name);
    plot.series.push_back({.label = name, .x = t_h, .y = s.course_um});
  }
  return plot;
}

/// Error along X over the table's length at the end of the judged time, without and with the frame of the last measurement.
Plot profile_plot(const scenarios::Scenario& scenario, const studies::TableStudy& study) {
  const auto n_x = static_cast<std::size_t>(scenario.table->n_x),
             row = n_x * static_cast<std::size_t>(scenario.table->n_y / 2);
  std::vector<double> x_m, before_um, after_um;
  const compensation::Frame frame = study.frame.frame();
  for (std::size_t p = row; p < row + n_x; ++p) {
    const Eigen::Vector3d& at_m = study.run.table.points_m[p];
    const double error_m = study.run.table.error_m[study.n_judged - 1](0, static_cast<Eigen::Index>(p));
    x_m.push_back(at_m[0]);
    before_um.push_back(1e6 * error_m);
    after_um.push_back(1e6 * (error_m - (frame.map(at_m)[0] - at_m[0])));
  }
  return {.title = "X error along the table, at the end of what is judged",
          .x_label = "x [m]",
          .y_label = "error [um]",
          .series = {{.label = "without correction", .x = x_m, .y = before_um},
                     {.label = "with the frame of the last measurement", .x = x_m, .y = after_um}}};
}

Table strategies_table(const studies::TableStudy& study) {
  Table table{
      .caption =
          "Largest errors anywhere on the table in the judged time, median of five repetitions (other noise, another "
          "wrong model); 'all' is the length of the error vector.",
      .headers = {"correction", "X [um]", "Y [um]", "Z [um]", "all [um]", "worst of five", "less X [%]", "less [%]"}};
  const auto& none = study.strategies.front().peak;
  for (const studies::TableStrategy& s : study.strategies) {
    table.rows.push_back({s.name, um(s.peak.x_m), um(s.peak.y_m), um(s.peak.z_m), um(s.peak.position_m),
                          um(s.worst.position_m), fmt::format("{:.0f}", less_percent(s.peak.x_m, none.x_m)),
                          fmt::format("{:.0f}", less_percent(s.peak.position_m, none.position_m))});
  }
  return table;
}

Table intervals_table(const studies::TableStudy& study) {
  Table table{.caption = "Largest position error against the time between two measurements of the rings.",
              .headers = {"every [min]", "rings [um]", "rings, thermometers between [um]",
                          "rings and model of the whole table [um]"}};
  for (const studies::IntervalRow& row : study.intervals)
    table.rows.push_back({fmt::format("{:.0f}", row.every_s / 60.0), um(row.rings_m), um(row.warmth_m), um(row.carried_m)});
  return table;
}

Table hall_table(const studies::TableStudy& study) {
  Table table{.caption = "What the published readings of X carry: each model fitted to all, and to all but one in turn.",
              .headers = {"model", "numbers fitted", "misfit [um]", "left out [um]", "R^2", "parameters (95 %)"}};
  for (const auto& m : study.hall_models) {
    table.rows.push_back({m.name, fmt::format("{}", m.n_parameters), fmt::format("{:.1f}", m.rms),
                          fmt::format("{:.1f}", m.rms_left_out), fmt::format("{:.2f}", m.r_squared), m.parameters});
  }
  table.rows.push_back({"this machine, not fitted", "0", fmt::format("{:.1f}", study.computed_rms_um),
                        fmt::format("{:.1f}", study.computed_rms_um), "", ""});
  return table;
}

/// The worst of a feed and motion over the three axes.
ProbeErrors worst_of_axes(const studies::TableStudy& study, double feed_m_s, const std::string& motion) {
  ProbeErrors worst;
  for (const ProbeRow& row : study.probe.rows) {
    if (row.feed_m_s != feed_m_s || row.motion != motion) continue;
    for (auto member : {&ProbeErrors::plain_m, &ProbeErrors::latched_m, &ProbeErrors::by_speed_m, &ProbeErrors::whole_m,
                        &ProbeErrors::corrected_m})
      worst.*member = std::max(worst.*member, row.worst.*member);
  }
  return worst;
}

std::vector<std::string> motions(const studies::TableStudy& study) {
  std::vector<std::string> found;
  for (const ProbeRow& row : study.probe.rows) {
    if (std::find(found.begin(), found.end(), row.motion) == found.end()) found.push_back(row.motion);
  }
  return found;
}

Table probe_table(const scenarios::Scenario& scenario, const studies::TableStudy& study) {
  Table table{.caption =
                  "Largest distance of a touch from where slow touches put the surface, worst of the three axes [um]; feed "
                  "in mm/min.",
              .headers = {"motion", "feed", "as seen", "latch", "less N v T", "N cycles undone", "one cycle",
                          "latch and increments"}};
  for (const std::string& motion : motions(study)) {
    for (double feed_m_s : scenario.table->probe.feeds_m_s) {
      const ProbeErrors e = worst_of_axes(study, feed_m_s, motion);
      table.rows.push_back({motion, fmt::format("{:.0f}", 6e4 * feed_m_s), um(e.plain_m), um(e.latched_m), um(e.by_speed_m),
                            um(e.whole_m), um(feed_m_s * scenario.table->probe.system.cycle_s), um(e.corrected_m, 2)});
    }
  }
  return table;
}

Plot probe_plot(const scenarios::Scenario& scenario, const studies::TableStudy& study) {
  std::vector<double> feed;
  for (double f : scenario.table->probe.feeds_m_s) feed.push_back(6e4 * f);
  Plot plot{.title = "Touches while braking", .x_label = "feed [mm/min]", .y_label = "largest error [um]"};
  const auto add = [&](const char* label, double ProbeErrors::*member) {
    Series series{.label = label, .x = feed};
    for (double f : scenario.table->probe.feeds_m_s) series.y.push_back(1e6 * (worst_of_axes(study, f, "braking").*member));
    plot.series.push_back(std::move(series));
  };
  add("as seen", &ProbeErrors::plain_m);
  add("less N v T", &ProbeErrors::by_speed_m);
  add("N cycles undone", &ProbeErrors::whole_m);
  add("latch and increments", &ProbeErrors::corrected_m);
  return plot;
}

Table calibration_table(const studies::TableStudy& study) {
  Table table{.caption = "Lag found by calibration touches.",
              .headers = {"axis", "N, whole cycles", "lag [cycles]", "standard error"}};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto& c = study.probe.calibration[a];
    table.rows.push_back({std::string(1, "xyz"[a]), fmt::format("{}", c.whole_cycles), fmt::format("{:.3f}", c.lag_cycles),
                          fmt::format("{:.3f}", c.lag_cycles_sd)});
  }
  return table;
}

Table shift_table(const studies::TableStudy& study) {
  Table table{.caption = "What the probe alone does to TEMP_SHIFT and TEMP_SCALE, where nothing has moved.",
              .headers = {"touches a ring", "feed before, now [mm/min]", "reading", "TEMP_SHIFT worst [um]", "rms [um]",
                          "TEMP_SCALE worst [1e-6]"}};
  for (const auto& row : study.probe.shifts) {
    table.rows.push_back({row.touches, fmt::format("{:.0f}, {:.0f}", 6e4 * row.feed_before_m_s, 6e4 * row.feed_now_m_s),
                          row.reading, um(row.worst_shift_m), um(row.rms_shift_m),
                          fmt::format("{:.2f}", 1e6 * row.worst_scale)});
  }
  return table;
}

std::string interval_words(const studies::TableStudy& study, double tolerance_m) {
  const auto words = [&](bool with_model) {
    const studies::IntervalRow* row = longest_interval(study, tolerance_m, with_model);
    return row ? fmt::format("every {:.0f} min", row->every_s / 60.0) : std::string("not even every 10 min");
  };
  return fmt::format("{:.0f} um anywhere on the table: rings {}, with the model between them {}", 1e6 * tolerance_m,
                     words(false), words(true));
}

}  // namespace

const studies::IntervalRow* longest_interval(const studies::TableStudy& study, double tolerance_m, bool with_model) {
  const studies::IntervalRow* longest = nullptr;
  for (const studies::IntervalRow& row : study.intervals) {
    if ((with_model ? row.carried_m : row.rings_m) > tolerance_m) break;
    longest = &row;
  }
  return longest;
}

std::string table_terminal(const scenarios::Scenario& scenario, const studies::TableStudy& study) {
  const auto& none = study.strategies.front().peak;
  std::string text = fmt::format("{}: position error anywhere on the table within {:.0f} h, rings every {:.0f} min\n",
                                 scenario.name, scenario.table->judge_until_s / 3600.0, scenario.table->every_s / 60.0);
  for (const studies::TableStrategy& s : study.strategies) {
    text +=
        fmt::format("  {:<34} {:6.1f} um ({:3.0f} % less), X {:6.1f} um ({:3.0f} % less)\n", s.name, 1e6 * s.peak.position_m,
                    less_percent(s.peak.position_m, none.position_m), 1e6 * s.peak.x_m, less_percent(s.peak.x_m, none.x_m));
  }
  text += "  " + interval_words(study, scenario.table->tolerance_m) + "\n";
  const double quick = scenario.table->probe.feeds_m_s.back();
  ProbeErrors worst;
  for (const std::string& motion : motions(study)) {
    const ProbeErrors e = worst_of_axes(study, quick, motion);
    worst.plain_m = std::max(worst.plain_m, e.plain_m);
    worst.whole_m = std::max(worst.whole_m, e.whole_m);
    worst.corrected_m = std::max(worst.corrected_m, e.corrected_m);
  }
  text += fmt::format(
      "  probe at {:.0f} mm/min: {:.0f} um as seen, {:.0f} um with N cycles undone, {:.1f} um with latch and increments\n",
      6e4 * quick, 1e6 * worst.plain_m, 1e6 * worst.whole_m, 1e6 * worst.corrected_m);
  return text;
}

nlohmann::ordered_json table_json(const scenarios::Scenario& scenario, const studies::TableStudy& study,
                                  const output::Provenance& made_by) {
  nlohmann::ordered_json json = {{"program", "driftwright"},
                                 {"version", made_by.version},
                                 {"scenario", made_by.scenario},
                                 {"judged_h", scenario.table->judge_until_s / 3600.0},
                                 {"rings_every_min", scenario.table->every_s / 60.0}};
  const auto& none = study.strategies.front().peak;
  for (const studies::TableStrategy& s : study.strategies) {
    json["strategies"].push_back({{"name", s.name},
                                  {"x_um", 1e6 * s.peak.x_m},
                                  {"y_um", 1e6 * s.peak.y_m},
                                  {"z_um", 1e6 * s.peak.z_m},
                                  {"position_um", 1e6 * s.peak.position_m},
                                  {"worst_position_um", 1e6 * s.worst.position_m},
                                  {"less_x_percent", less_percent(s.peak.x_m, none.x_m)},
                                  {"less_position_percent", less_percent(s.peak.position_m, none.position_m)}});
  }
  for (const studies::IntervalRow& row : study.intervals) {
    json["intervals"].push_back({{"every_min", row.every_s / 60.0},
                                 {"rings_um", 1e6 * row.rings_m},
                                 {"rings_and_thermometers_um", 1e6 * row.warmth_m},
                                 {"rings_and_model_um", 1e6 * row.carried_m}});
  }
  const auto& f = study.frame;
  json["frame"] = {{"TEMP_SCALE_minus_1", f.x.scale - 1.0}, {"TEMP_SHIFT_um", 1e6 * f.x.shift_m},
                   {"shift_y_um", 1e6 * f.shift_y_m},       {"shift_z_um", 1e6 * f.shift_z_m},
                   {"turn_urad", 1e6 * f.turn_rad},         {"tilt_urad", 1e6 * f.tilt_rad}};
  const auto& c = study.control;
  json["control"] = {{"T0_degC", c.reference_K - kZeroCelsius_K},
                     {"slope_per_K", c.slope_1_K},
                     {"K0_um", 1e6 * c.k0_m},
                     {"K0_um_per_K", 1e6 * c.k0_m_K}};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto& p = study.probe.calibration[a];
    json["probe"]["calibration"].push_back(
        {{"axis", std::string(1, "xyz"[a])}, {"whole_cycles", p.whole_cycles}, {"lag_cycles", p.lag_cycles}});
  }
  for (const ProbeRow& row : study.probe.rows) {
    json["probe"]["rows"].push_back({{"axis", std::string(1, "xyz"[row.axis])},
                                     {"motion", row.motion},
                                     {"feed_mm_min", 6e4 * row.feed_m_s},
                                     {"plain_um", 1e6 * row.worst.plain_m},
                                     {"latched_um", 1e6 * row.worst.latched_m},
                                     {"by_speed_um", 1e6 * row.worst.by_speed_m},
                                     {"whole_um", 1e6 * row.worst.whole_m},
                                     {"corrected_um", 1e6 * row.worst.corrected_m}});
  }
  for (const auto& row : study.probe.shifts) {
    json["probe"]["temp_shift"].push_back({{"touches", row.touches},
                                           {"feed_before_mm_min", 6e4 * row.feed_before_m_s},
                                           {"feed_now_mm_min", 6e4 * row.feed_now_m_s},
                                           {"reading", row.reading},
                                           {"worst_um", 1e6 * row.worst_shift_m},
                                           {"rms_um", 1e6 * row.rms_shift_m}});
  }
  for (const auto& m : study.hall_models) {
    json["readings"]["models"].push_back({{"name", m.name},
                                          {"parameters", m.n_parameters},
                                          {"rms_um", m.rms},
                                          {"rms_left_out_um", m.rms_left_out},
                                          {"r_squared", m.r_squared},
                                          {"words", m.parameters}});
  }
  if (!study.hall_models.empty()) json["readings"]["computed_rms_um"] = study.computed_rms_um;
  return json;
}

output::Report table_report(const scenarios::Scenario& scenario, const studies::TableStudy& study,
                            const output::Provenance& made_by) {
  output::Report report{
      .title = fmt::format("{}: correction of a table through the control's frame", scenario.name),
      .subtitle = fmt::format("Driftwright {}, scenario {}; judged over {:.0f} h, rings every {:.0f} min, probe "
                              "noise {} um",
                              made_by.version, made_by.scenario, scenario.table->judge_until_s / 3600.0,
                              scenario.table->every_s / 60.0, um(scenario.table->probe_noise_m))};
  const auto add = [&](auto block) { report.blocks.emplace_back(std::move(block)); };
  const studies::TableStrategy &none = study.strategies.front(), &rings = strategy(study, "rings"),
                               &warmth = strategy(study, "rings, thermometers between"),
                               &both = strategy(study, "rings and model of the whole table");
  add(output::Verdict{
      .kind = output::Verdict::Kind::kNeutral,
      .title = fmt::format(
          "{} um of position error become {} um with rings, {} um with thermometers between them, {} um with the "
          "model",
          um(none.peak.position_m), um(rings.peak.position_m), um(warmth.peak.position_m), um(both.peak.position_m)),
      .text = interval_words(study, scenario.table->tolerance_m) + "."});
  add(strategies_table(study));
  add(Paragraph{
      studies::instrument_words(*scenario.table) +
      " Thermometers between: what table and scales would do if each were evenly warm, with expansions as wrong as the "
      "model's and nothing fitted. They tell the scale of Y, too, which rings on one line do not. The minimax frame "
      "knows every error; no frame leaves 1 % less."});
  add(strategies_plot(study));
  add(profile_plot(scenario, study));
  add(intervals_table(study));
  add(Heading{"The table over the run"});
  add(series_plot(scenario, study));
  add(temperatures_plot(scenario, study));
  if (!study.hall_models.empty()) {
    add(hall_table(study));
    add(
        Paragraph{"Left out one at a time, the readings are missed by more than any fit suggests, and the lags may be "
                  "almost anything: they "
                  "do not carry a model of hall temperature. On the second morning the error rises while the hall stands "
                  "still. What is "
                  "missing is a channel: a thermometer on the table and one on its scale."});
  }
  add(Heading{"The probe"});
  add(calibration_table(study));
  add(probe_table(scenario, study));
  add(probe_plot(scenario, study));
  add(shift_table(study));
  return report;
}

std::string strategies_csv(const studies::TableStudy& study, const std::vector<std::string>& comments) {
  Record record{.source = "table", .time_s = study.run.table.time_s, .channels = {}};
  record.time_s.resize(study.n_judged);
  for (const studies::TableStrategy& s : study.strategies) {
    std::string name = s.name;
    for (char& c : name) {
      if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    }
    record.channels.push_back({name, "um", s.course_um});
  }
  return record_csv(record, comments);
}

std::string probe_csv(const studies::TableStudy& study, const std::vector<std::string>& comments) {
  std::string text;
  for (const std::string& comment : comments) text += "# " + comment + "\n";
  text += "axis,motion,feed_mm_min,plain_um,latched_um,by_speed_um,whole_cycles_um,latch_and_increments_um\n";
  for (const ProbeRow& row : study.probe.rows) {
    text += fmt::format("{},{},{:.0f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f}\n", "xyz"[row.axis], row.motion, 6e4 * row.feed_m_s,
                        1e6 * row.worst.plain_m, 1e6 * row.worst.latched_m, 1e6 * row.worst.by_speed_m,
                        1e6 * row.worst.whole_m, 1e6 * row.worst.corrected_m);
  }
  return text;
}

}  // namespace driftwright::app
