#include "findings/residual_sections.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/quantity.hpp"
#include "diagnosis/residual_structure.hpp"
#include "findings/residual_figure.hpp"
#include "findings/run_section.hpp"

namespace driftwright::findings {
namespace {

using diagnosis::MeasuredChannel, diagnosis::MeasuredRun, diagnosis::ResidualStructure;
using output::Datum, output::Plot, output::Section, output::Series, output::Table;

constexpr double kTells = 0.3;  // correlations of at least this are shown

/// A channel of a run in the page's units: degC, um or urad.
struct Curves {
  std::string name, unit;       ///< of readings
  std::string difference_unit;  ///< of residuals
  std::vector<double> time_min, measured, written, after;
  Eigen::VectorXd written_residual, after_residual;
  double noise = 0.0;
};

Curves curves_of(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d, std::size_t r, const MeasuredChannel& c) {
  const auto [unit, difference_unit, scale, zero] = shown_scale(m, c);
  Curves k{.name = c.name,
           .unit = unit,
           .difference_unit = difference_unit,
           .time_min = {},
           .measured = {},
           .written = {},
           .after = {},
           .written_residual = {},
           .after_residual = {},
           .noise = scale * d.noise.at(c.name).total()};
  const Eigen::VectorXd written = d.as_written[r].row(c.output), after = d.extended[r].row(c.output);
  k.written_residual = scale * (c.value - written);
  k.after_residual = scale * (c.value - after);
  for (std::size_t i = 0; i < m.runs[r].time_s.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    k.time_min.push_back(m.runs[r].time_s[i] / 60.0);
    k.measured.push_back(zero + scale * c.value[at]);
    k.written.push_back(zero + scale * written[at]);
    k.after.push_back(zero + scale * after[at]);
  }
  return k;
}

Plot drive_plot(const MeasuredRun& run) {
  Plot plot{.title = "Spindle speed", .x_label = "time [min]", .y_label = "speed [rpm]"};
  Series speed{.label = "speed", .x = {}, .y = {}, .style = Series::Style::kSteps};
  for (double t_s : run.time_s) {
    speed.x.push_back(t_s / 60.0);
    speed.y.push_back(run.cyclogram.drive(t_s).speed_rpm);
  }
  plot.series.push_back(speed);
  plot.half_width = true;
  return plot;
}

Plot ambient_plot(const MeasuredRun& run, double reference_K) {
  Plot plot{.title = run.has_ambient ? "Ambient temperature as recorded, smoothed" : "Ambient temperature of the scenario",
            .x_label = "time [min]",
            .y_label = "ambient temperature [°C]",
            .series = {{.label = "ambient", .x = {}, .y = {}}}};
  for (double t_s : run.time_s) {
    plot.series[0].x.push_back(t_s / 60.0);
    plot.series[0].y.push_back(run.ambient.at(t_s) + reference_K - kZeroCelsius_K);
  }
  plot.half_width = true;
  return plot;
}

std::vector<double> list_of(const Eigen::VectorXd& v) {
  return {v.data(), v.data() + v.size()};
}

void add_plots(const Curves& c, const std::string& after, const std::vector<output::SectionMark>& marks, Section& section) {
  Plot readings{
      .title = c.name,
      .x_label = "time [min]",
      .y_label = fmt::format("{} [{}]", c.name, output::shown_unit(c.unit)),
      .series = {{.label = "measured", .x = c.time_min, .y = c.measured, .style = Series::Style::kPoints, .width = 1.2},
                 {.label = "as written", .x = c.time_min, .y = c.written},
                 {.label = after, .x = c.time_min, .y = c.after}},
      .marks = marks,
      .half_width = true};
  Plot residuals{
      .title = c.name + ": residual",
      .x_label = "time [min]",
      .y_label = fmt::format("measured - simulated [{}]", output::shown_unit(c.difference_unit)),
      .series = {{.label = "as written", .x = c.time_min, .y = list_of(c.written_residual), .width = 1.5, .color = 1},
                 {.label = after, .x = c.time_min, .y = list_of(c.after_residual), .width = 1.5, .color = 2}},
      .bands = {{"noise ±2 sigma", -2.0 * c.noise, 2.0 * c.noise}},
      .marks = marks,
      .half_width = true};
  add(section, std::move(readings));
  add(section, std::move(residuals));
}

std::string follows(const ResidualStructure& s) {
  return s.lag ? fmt::format("{} with a lag of {:.0f} min ({:.0f} %)", s.lag->quantity, s.lag->time_s / 60.0,
                             100.0 * s.lag->share)
               : "-";
}

void add_likenesses(const std::string& channel, const ResidualStructure& s, Table& table) {
  for (const auto& l : s.likenesses) {
    double largest = 0.0;
    std::vector<Datum> row = {channel, l.quantity};
    for (double c : l.correlation) {
      row.emplace_back(c);
      if (!std::isnan(c)) largest = std::max(largest, std::abs(c));
    }
    if (largest >= kTells) table.rows.push_back(std::move(row));
  }
}

Table likeness_table(const std::string& title) {
  Table table{.title = title,
              .caption = "Correlation with what was recorded as long before; those of 0.3 and more.",
              .columns = {{.title = "channel"}, {.title = "residual against"}}};
  for (const char* lag : {"0 min", "5 min", "15 min", "60 min before"})
    table.columns.push_back({.title = lag, .digits = output::signed_decimals(2)});
  return table;
}

Section record_section(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d, std::size_t r,
                       const std::string& after) {
  const MeasuredRun& run = m.runs[r];
  Section section{.title = "Record " + run.name, .detail = true};
  add(section, drive_plot(run));
  add(section, ambient_plot(run, m.twin ? m.twin->reference_K() : kZeroCelsius_K));
  constexpr output::Digits kThreeDigits = output::significant(3), kCorrelation = output::signed_decimals(2);
  Table structure{
      .title = "Residuals against noise",
      .caption = "Lag 1: correlation of a reading's residual with the next one's; white noise stays within the bound.",
      .columns = {{.title = "channel"},
                  {.key = "unit", .title = "unit"},
                  {.title = "noise", .digits = kThreeDigits},
                  {.title = "rms as written", .digits = kThreeDigits},
                  {.title = "rms " + after, .digits = kThreeDigits},
                  {.title = "lag 1 as written", .digits = kCorrelation},
                  {.title = "lag 1 " + after, .digits = kCorrelation},
                  {.title = "bound, ±", .digits = output::decimals(2)}}};
  Table lags{.title = "What recorded quantity the residual is like with one lag",
             .caption = "With the share of its variance; from 30 %.",
             .columns = {{.title = "channel"}, {.title = "as written follows"}, {.title = after + " follows"}}};
  Table before = likeness_table("The residual as written"),
        left = likeness_table(fmt::format("The residual that is left ({})", after));
  for (const MeasuredChannel& c : run.channels) {
    const Curves k = curves_of(m, d, r, c);
    add_plots(k, after, section_marks(run.cyclogram), section);
    if (c.value.size() < 3) continue;
    const ResidualStructure w = residual_structure(run, k.written_residual), a = residual_structure(run, k.after_residual);
    structure.rows.push_back({c.name, k.difference_unit, k.noise, w.rms, a.rms, w.lag_1, a.lag_1, a.white_up_to});
    if (w.lag || a.lag) lags.rows.push_back({c.name, follows(w), follows(a)});
    add_likenesses(c.name, w, before);
    add_likenesses(c.name, a, left);
  }
  for (Table* table : {&structure, &lags, &before, &left}) add(section, std::move(*table));
  return section;
}

}  // namespace

std::vector<Section> residual_sections(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d,
                                       const std::string& after) {
  std::vector<Section> sections;
  for (std::size_t r = 0; r < m.runs.size(); ++r) sections.push_back(record_section(m, d, r, after));
  return sections;
}

}  // namespace driftwright::findings
