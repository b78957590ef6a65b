#include "findings/table_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/quantity.hpp"
#include "findings/columns.hpp"
#include "findings/named_value.hpp"
#include "studies/table_strategy.hpp"

namespace driftwright::findings {
namespace {

using compensation::ProbeErrors, compensation::ProbeRow;
using output::Column, output::Plot, output::Section, output::Series, output::Table, output::Text, output::Value;

std::string um(double m, int decimals = 1) {
  return fmt::format("{:.{}f}", 1e6 * m, decimals);
}

/// Reduction against no correction [%].
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
  const studies::TableCourse& course = study.course;
  // The latter since the start, because counted from 20 degC they would dwarf the rest.
  std::vector<double> x_um, table_um, scale_um;
  for (std::size_t i = 0; i < course.table_only_x_um.size(); ++i) {
    table_um.push_back(course.table_only_x_um[i] - course.table_only_x_um[0]);
    scale_um.push_back(course.scale_only_x_um[i] - course.scale_only_x_um[0]);
  }
  for (std::size_t i = 0; i < course.table_only_x_um.size(); ++i)
    x_um.push_back(course.table_only_x_um[i] - course.scale_only_x_um[i]);
  const std::vector<double> t_h = hours(course.table.time_s);
  Plot plot{.title = "X error over the table's length: computed, and as published",
            .x_label = "time [h]",
            .y_label = "growth from end to end [µm]",
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
  Plot plot{.title = "Temperatures", .x_label = "time [h]", .y_label = "temperature [°C]"};
  for (const auto& sensor : scenario.machine->sensors) {
    plot.series.push_back(
        {.label = sensor.name, .x = hours(study.course.table.time_s), .y = study.course.record.at(sensor.name).values});
  }
  return plot;
}

Plot strategies_plot(const studies::TableStudy& study) {
  std::vector<double> t_h = hours(study.course.table.time_s);
  t_h.resize(study.n_judged);
  Plot plot{.title = "Largest position error anywhere on the table", .x_label = "time [h]", .y_label = "error [µm]"};
  for (const char* name : {"none", "ambient temperature", "model alone", "rings", "rings, thermometers between",
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
    const Eigen::Vector3d& at_m = study.course.table.points_m[p];
    const double error_m = study.course.table.error_m[study.n_judged - 1](0, static_cast<Eigen::Index>(p));
    x_m.push_back(at_m[0]);
    before_um.push_back(1e6 * error_m);
    after_um.push_back(1e6 * (error_m - (frame.map(at_m)[0] - at_m[0])));
  }
  return {.title = "X error along the table, at the end of what is judged",
          .x_label = "x [m]",
          .y_label = "error [µm]",
          .series = {{.label = "without correction", .x = x_m, .y = before_um},
                     {.label = "with the frame of the last measurement", .x = x_m, .y = after_um}}};
}

Table strategies_table(const studies::TableStudy& study) {
  Table table{
      .key = "strategies",
      .title = "Largest errors anywhere on the table in the judged time",
      .caption = "Median of five repetitions (other noise, another wrong model); 'all' is the length of the error vector.",
      .columns = {{.key = "name", .title = "correction"},
                  um_column("x_um", "X"),
                  um_column("y_um", "Y"),
                  um_column("z_um", "Z"),
                  um_column("position_um", "all"),
                  um_column("worst_position_um", "worst of five"),
                  percent_column("less_x_percent", "less X"),
                  percent_column("less_position_percent", "less")}};
  const auto& none = study.strategies.front().peak;
  for (const studies::TableStrategy& s : study.strategies) {
    table.rows.push_back({s.name, 1e6 * s.peak.x_m, 1e6 * s.peak.y_m, 1e6 * s.peak.z_m, 1e6 * s.peak.position_m,
                          1e6 * s.worst.position_m, less_percent(s.peak.x_m, none.x_m),
                          less_percent(s.peak.position_m, none.position_m)});
  }
  return table;
}

Table intervals_table(const studies::TableStudy& study) {
  Table table{.key = "intervals",
              .title = "Largest position error against the time between two measurements of the rings",
              .columns = {{.key = "every_min", .title = "every", .unit = "min", .digits = output::decimals(0)},
                          um_column("rings_um", "rings"),
                          um_column("rings_and_thermometers_um", "rings, thermometers between"),
                          um_column("rings_and_model_um", "rings and model of the whole table")},
              .detail = true};
  for (const studies::IntervalRow& row : study.intervals)
    table.rows.push_back({row.every_s / 60.0, 1e6 * row.rings_m, 1e6 * row.warmth_m, 1e6 * row.carried_m});
  return table;
}

Section readings_section(const studies::TableStudy& study) {
  Section section{.key = "readings", .detail = true};
  Table table{.key = "models",
              .title = "What the published readings of X carry",
              .caption = "Each model fitted to all, and to all but one in turn.",
              .columns = {{.key = "name", .title = "model"},
                          {.key = "parameters", .title = "numbers fitted"},
                          um_column("rms_um", "misfit"),
                          um_column("rms_left_out_um", "left out"),
                          {.key = "r_squared", .title = "R²", .digits = output::decimals(2)},
                          {.key = "words", .title = "parameters (95 %)"}}};
  for (const auto& m : study.ambient_models)
    table.rows.push_back({m.name, m.n_parameters, m.rms, m.rms_left_out, m.r_squared, m.parameters});
  add(section, std::move(table));
  add(section, named_value("computed_rms_um", "misfit of this machine, not fitted", study.computed_rms_um, "um"));
  add(section, Text{"Left out one at a time, the readings are missed by more than any fit suggests, and the lags may be "
                    "almost anything: "
                    "they do not carry a model of ambient temperature. On the second morning the error rises while the "
                    "ambient does not change. "
                    "What is missing is a channel: a thermometer on the table and one on its scale."});
  return section;
}

/// The worst values of a feed and motion over the three axes.
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

Table worst_touches_table(const scenarios::Scenario& scenario, const studies::TableStudy& study) {
  Table table{.key = "worst_of_axes",
              .title = "Largest distance of a touch from where slow touches put the surface, worst of the three axes",
              .columns = {{.key = "motion", .title = "motion"},
                          {.key = "feed_mm_min", .title = "feed", .unit = "mm_min", .digits = output::decimals(0)},
                          um_column("plain_um", "as seen"),
                          um_column("latched_um", "latch"),
                          um_column("by_speed_um", "less N v T"),
                          um_column("whole_um", "N cycles undone"),
                          um_column("one_cycle_um", "one cycle"),
                          um_column("corrected_um", "latch and increments", 2)}};
  for (const std::string& motion : motions(study)) {
    for (double feed_m_s : scenario.table->probe.feeds_m_s) {
      const ProbeErrors e = worst_of_axes(study, feed_m_s, motion);
      table.rows.push_back({motion, 6e4 * feed_m_s, 1e6 * e.plain_m, 1e6 * e.latched_m, 1e6 * e.by_speed_m, 1e6 * e.whole_m,
                            1e6 * feed_m_s * scenario.table->probe.system.cycle_s, 1e6 * e.corrected_m});
    }
  }
  return table;
}

/// Values of each axis, for probe.csv; the page shows the worst of the three.
Table touches_table(const studies::TableStudy& study) {
  Table table{.key = "rows",
              .title = "Largest distance of a touch from where slow touches put the surface, axis by axis",
              .columns = {{.key = "axis", .title = "axis"},
                          {.key = "motion", .title = "motion"},
                          {.key = "feed_mm_min", .title = "feed", .unit = "mm_min", .digits = output::decimals(0)},
                          um_column("plain_um", "as seen"),
                          um_column("latched_um", "latch"),
                          um_column("by_speed_um", "less N v T"),
                          um_column("whole_um", "N cycles undone"),
                          um_column("corrected_um", "latch and increments", 2)},
              .detail = true,
              .file = "probe.csv"};
  for (const ProbeRow& row : study.probe.rows) {
    const ProbeErrors& e = row.worst;
    table.rows.push_back({std::string(1, "xyz"[row.axis]), row.motion, 6e4 * row.feed_m_s, 1e6 * e.plain_m,
                          1e6 * e.latched_m, 1e6 * e.by_speed_m, 1e6 * e.whole_m, 1e6 * e.corrected_m});
  }
  return table;
}

Plot probe_plot(const scenarios::Scenario& scenario, const studies::TableStudy& study) {
  std::vector<double> feed;
  for (double f : scenario.table->probe.feeds_m_s) feed.push_back(6e4 * f);
  Plot plot{.title = "Touches while braking", .x_label = "feed [mm/min]", .y_label = "largest error [µm]"};
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
  Table table{.key = "calibration",
              .title = "Lag found by calibration touches",
              .columns = {{.key = "axis", .title = "axis"},
                          {.key = "whole_cycles", .title = "N, whole cycles"},
                          {.key = "lag_cycles", .title = "lag [cycles]", .digits = output::decimals(3)},
                          {.key = "lag_cycles_sd", .title = "standard error", .digits = output::decimals(3)}},
              .detail = true};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto& c = study.probe.calibration[a];
    table.rows.push_back({std::string(1, "xyz"[a]), c.whole_cycles, c.lag_cycles, c.lag_cycles_sd});
  }
  return table;
}

Table shift_table(const studies::TableStudy& study) {
  Table table{
      .key = "temp_shift",
      .title = "What the probe alone does to TEMP_SHIFT and TEMP_SCALE, where nothing has moved",
      .columns = {{.key = "touches", .title = "touches a ring"},
                  {.key = "feed_before_mm_min", .title = "feed before", .unit = "mm_min", .digits = output::decimals(0)},
                  {.key = "feed_now_mm_min", .title = "feed now", .unit = "mm_min", .digits = output::decimals(0)},
                  {.key = "reading", .title = "reading"},
                  um_column("worst_um", "TEMP_SHIFT worst"),
                  um_column("rms_um", "TEMP_SHIFT RMS"),
                  {.key = "worst_scale_1e_6", .title = "TEMP_SCALE worst", .unit = "1e-6", .digits = output::decimals(2)}},
      .detail = true};
  for (const auto& row : study.probe.shifts) {
    table.rows.push_back({row.touches, 6e4 * row.feed_before_m_s, 6e4 * row.feed_now_m_s, row.reading,
                          1e6 * row.worst_shift_m, 1e6 * row.rms_shift_m, 1e6 * row.worst_scale});
  }
  return table;
}

Section frame_section(const studies::TableStudy& study) {
  Section section{.detail = true};
  const auto& f = study.frame;
  const auto& c = study.control;
  const auto number = [&](const char* key, const char* words, double value, const char* unit) {
    add(section, Value{.key = key, .words = words, .datum = value, .unit = unit, .digits = output::significant(4)});
  };
  add(section, Text{"The frame of the last measurement, and how the control follows a thermometer:"});
  number("frame.TEMP_SCALE_minus_1", "TEMP_SCALE - 1", f.x.scale - 1.0, "");
  number("frame.TEMP_SHIFT_um", "TEMP_SHIFT", 1e6 * f.x.shift_m, "um");
  number("frame.shift_y_um", "shift Y", 1e6 * f.shift_y_m, "um");
  number("frame.shift_z_um", "shift Z", 1e6 * f.shift_z_m, "um");
  number("frame.arc_out_of_round_um", "an arc in X Y of 100 mm radius is out of round by", 1e5 * std::abs(f.x.scale - 1.0),
         "um");
  number("frame.turn_urad", "turn", 1e6 * f.turn_rad, "urad");
  number("frame.tilt_urad", "tilt", 1e6 * f.tilt_rad, "urad");
  number("control.T0_degC", "T0", c.reference_K - kZeroCelsius_K, "degC");
  number("control.slope_per_K", "slope", c.slope_1_K, "1/K");
  number("control.K0_um", "K0", 1e6 * c.k0_m, "um");
  number("control.K0_um_per_K", "K0 per kelvin", 1e6 * c.k0_m_K, "um/K");
  return section;
}

std::string interval_words(const studies::TableStudy& study, double tolerance_m) {
  const auto words = [&](bool with_model) {
    const studies::IntervalRow* row = longest_interval(study, tolerance_m, with_model);
    return row ? fmt::format("every {:.0f} min", row->every_s / 60.0) : std::string("not even every 10 min");
  };
  return fmt::format("{:.0f} µm anywhere on the table: rings {}, with the model between them {}", 1e6 * tolerance_m,
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

output::Document document_of(const studies::TableStudy& study, const scenarios::Scenario& scenario, const mesh::Mesh& mesh,
                             const WorstMoment& worst, const output::Provenance& made_by) {
  const scenarios::TableSettings& s = *scenario.table;
  const auto peak_um = [&](const char* name) { return um(strategy(study, name).peak.position_m); };
  output::Document document{.made_by = made_by,
                            .title = fmt::format("{}: correction of a table through the control's frame", scenario.name),
                            .subtitle = fmt::format("judged over {:.0f} h, rings every {:.0f} min, probe noise {} µm",
                                                    s.judge_until_s / 3600.0, s.every_s / 60.0, um(s.probe_noise_m))};
  Section& body = document.body;
  add(body, output::Verdict{
                .key = "verdict",
                .kind = output::Verdict::Kind::kNeutral,
                .title = fmt::format("{} µm of position error become {} µm with rings, {} µm with thermometers between "
                                     "them, {} µm with the model",
                                     um(study.strategies.front().peak.position_m), peak_um("rings"),
                                     peak_um("rings, thermometers between"), peak_um("rings and model of the whole table")),
                .text = interval_words(study, s.tolerance_m) + "."});
  add_machine(body, *scenario.machine, mesh, s.cyclogram, worst);
  add(body, Value{.key = "judged_h", .datum = s.judge_until_s / 3600.0});
  add(body, Value{.key = "rings_every_min", .datum = s.every_s / 60.0});
  add(body, strategies_table(study));
  add(body,
      Text{.words = studies::instrument_words(s) +
                    " Thermometers between: what table and scales would do if each were evenly warm, with expansions as "
                    "wrong as the model's and nothing fitted. They give the scale of Y, too, which rings on one line do "
                    "not. The minimax frame knows every error; no frame leaves 1 % less.",
           .detail = true});
  add(body, strategies_plot(study));
  add(body, profile_plot(scenario, study));
  add(body, intervals_table(study));
  body.sections.push_back(frame_section(study));
  Section over_time{.title = "The table over the run"};
  add(over_time, series_plot(scenario, study));
  add(over_time, temperatures_plot(scenario, study));
  if (!study.ambient_models.empty()) over_time.sections.push_back(readings_section(study));
  body.sections.push_back(std::move(over_time));
  Section probe{.key = "probe", .title = "The probe"};
  add(probe, calibration_table(study));
  add(probe, worst_touches_table(scenario, study));
  add(probe, touches_table(study));
  add(probe, probe_plot(scenario, study));
  add(probe, shift_table(study));
  body.sections.push_back(std::move(probe));
  return document;
}

std::string strategies_csv(const studies::TableStudy& study, const std::vector<std::string>& comments) {
  Record record{.source = "table", .time_s = study.course.table.time_s, .channels = {}};
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

}  // namespace driftwright::findings
