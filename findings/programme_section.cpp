#include "findings/programme_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace driftwright::findings {
namespace {

using compensation::CyclogramType;
using output::Datum, output::Section, output::Table, output::Value;

struct Group {
  std::string name;
  std::function<bool(const studies::JudgedCyclogram&)> holds;
};

std::vector<Group> groups(const studies::ProgrammeStudy& study) {
  std::vector<Group> list;
  for (const CyclogramType type : {CyclogramType::kContinuous, CyclogramType::kStepwiseUp, CyclogramType::kIntermittent,
                                   CyclogramType::kStepwiseDown, CyclogramType::kChaotic}) {
    list.push_back(
        {compensation::word(type), [type](const studies::JudgedCyclogram& j) { return !j.is_random && j.type == type; }});
  }
  list.push_back({"random", [](const studies::JudgedCyclogram& j) { return j.is_random; }});
  std::erase_if(list, [&](const Group& g) { return std::none_of(study.judged.begin(), study.judged.end(), g.holds); });
  return list;
}

/// The largest error of all cyclograms, for the terminal and the top of the page.
Table overview_table(const studies::ProgrammeStudy& study) {
  Table table{.key = "largest_errors_percent",
              .title = fmt::format("Largest error over {} cyclograms, in % of max(peak of the axis, 10 % of the vector's)",
                                   study.judged.size()),
              .columns = {{.key = "predictor", .title = "predictor"}}};
  for (const std::string& name : study.channels.name)
    table.columns.push_back({.key = name, .title = name, .unit = "percent", .digits = output::decimals(2)});
  for (const auto& p : study.predictors) {
    std::vector<Datum> row = {p.name()};
    for (std::size_t c = 0; c < study.channels.name.size(); ++c)
      row.emplace_back(studies::summary(study, p, c, [](const studies::JudgedCyclogram&) { return true; }).largest_percent);
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// The answer: the predictor with the smallest largest error, if there are predictors.
std::optional<output::Verdict> best_predictor(const studies::ProgrammeStudy& study) {
  const auto all = [](const studies::JudgedCyclogram&) { return true; };
  const auto largest_percent = [&](const studies::JudgedPredictor& p) {
    double largest = 0.0;
    for (std::size_t c = 0; c < study.channels.name.size(); ++c)
      largest = std::max(largest, studies::summary(study, p, c, all).largest_percent);
    return largest;
  };
  if (study.predictors.empty()) return std::nullopt;
  const auto best = std::min_element(study.predictors.begin(), study.predictors.end(),
                                     [&](const auto& a, const auto& b) { return largest_percent(a) < largest_percent(b); });
  return output::Verdict{
      .key = "",
      .title = fmt::format("Best predictor: {}", best->name()),
      .text = fmt::format("It errs by {:.2f} % at most over {} cyclograms that it was not fitted on, in every channel.",
                          largest_percent(*best), study.judged.size())};
}

/// A predictor's errors by kinds of cyclograms, an item of the list `predictors`.
Section predictor_section(const studies::ProgrammeStudy& study, const studies::JudgedPredictor& p) {
  Section section{.key = "predictors", .item = output::Item{"name", p.name()}, .detail = true};
  Table table{.key = "errors",
              .title = "Errors of " + p.name(),
              .caption = "In per cent: of max(peak of that axis, 10 % of the peak of the vector).",
              .columns = {{.key = "cyclograms", .title = "cyclograms"},
                          {.key = "n", .title = "n"},
                          {.key = "channel", .title = "channel"},
                          {.key = "unit", .title = "unit"},
                          {.key = "largest", .title = "largest", .digits = output::decimals(2)},
                          {.key = "mean", .title = "mean", .digits = output::decimals(2)},
                          {.key = "largest_percent", .title = "largest", .unit = "percent", .digits = output::decimals(2)},
                          {.key = "mean_percent", .title = "mean", .unit = "percent", .digits = output::decimals(2)}}};
  for (const Group& g : groups(study)) {
    for (std::size_t c = 0; c < study.channels.name.size(); ++c) {
      const studies::Summary s = studies::summary(study, p, c, g.holds);
      table.rows.push_back({g.name, s.n, study.channels.name[c], study.channels.unit[c], s.largest, s.mean,
                            s.largest_percent, s.mean_percent});
    }
  }
  add(section, std::move(table));
  return section;
}

Table scheduled_table(const studies::ProgrammeStudy& study, double tolerance_um) {
  Table table{.key = "scheduled",
              .title = fmt::format(
                  "Corrections planned ahead on the predictions of the random cyclograms, tolerance {:g} µm", tolerance_um),
              .columns = {{.key = "predictor", .title = "predictor"},
                          {.key = "channel", .title = "channel"},
                          {.key = "inside", .title = "inside the tolerance"},
                          {.key = "of", .title = "of"},
                          {.key = "worst_um", .title = "worst", .unit = "um"},
                          {.key = "mean_changes", .title = "changes, mean"},
                          {.key = "most_changes", .title = "changes, most"}}};
  for (const auto& s : study.scheduled)
    table.rows.push_back({s.predictor, s.channel, s.n_inside, s.n_cyclograms, s.worst_um, s.mean_changes, s.most_changes});
  return table;
}

Table modes_table(const studies::ProgrammeStudy& study) {
  Table table{
      .key = "identified_modes",
      .title = "Modes identified from the tests",
      .caption = "Time constants at standstill and by how much rates grow up to the top speed.",
      .columns = {{.key = "mode", .title = "mode"},
                  {.key = "time_constant_min", .title = "time constant", .unit = "min"},
                  {.key = "ci95", .title = "95 % confidence", .unit = "min"},
                  {.key = "rate_growth"},
                  {.key = "rate_at_top_speed", .title = "rate at top speed over standstill", .digits = output::decimals(2)}},
      .detail = true};
  for (std::size_t k = 0; k < study.identified.modes.size(); ++k) {
    const auto& m = study.identified.modes[k];
    table.rows.push_back(
        {k + 1, m.time_constant_s / 60.0, std::vector<double>{m.low_s / 60.0, m.high_s / 60.0}, m.growth, 1.0 + m.growth});
  }
  return table;
}

Table factors_table(const studies::ProgrammeStudy& study) {
  Table table{.key = "factors",
              .title = "Factors that the tests give the hybrid's model",
              .columns = {{.key = "factor", .title = "factor"},
                          {.key = "value", .title = "value", .digits = output::decimals(3)},
                          {.key = "ci95", .title = "95 % confidence", .digits = output::decimals(3)}},
              .detail = true};
  for (const auto& f : study.factors) table.rows.push_back({f.name, f.value, std::vector<double>{f.low, f.high}});
  return table;
}

output::Plot course(const studies::ProgrammeStudy& study, std::size_t cyclogram, std::size_t channel) {
  const studies::JudgedCyclogram& j = study.judged[cyclogram];
  std::vector<double> t_min;
  for (double t_s : j.time_s) t_min.push_back(t_s / 60.0);
  const auto row = [&](const Eigen::MatrixXd& rows) {
    const Eigen::VectorXd r = rows.row(static_cast<Eigen::Index>(channel));
    return std::vector<double>(r.begin(), r.end());
  };
  output::Plot plot{.title = fmt::format("{} ({})", j.cyclogram.name, compensation::word(j.type)),
                    .x_label = "time [min]",
                    .y_label = fmt::format("{} [{}]", study.channels.name[channel], study.channels.unit[channel]),
                    .series = {{.label = "simulated", .x = t_min, .y = row(j.truth), .width = 4.0}},
                    .half_width = true};
  for (const auto& p : study.predictors)
    plot.series.push_back({.label = p.name(), .x = t_min, .y = row(p.predicted[cyclogram])});
  double start_s = 0.0;
  if (j.cyclogram.sections.size() <= 8) {
    for (const auto& s : j.cyclogram.sections) {
      plot.marks.push_back({start_s / 60.0, fmt::format("{:g}", s.drive.speed_rpm)});
      start_s += s.duration_s;
    }
  }
  return plot;
}

}  // namespace

Section programme_section(const studies::ProgrammeStudy& study, const scenarios::Scenario& scenario) {
  Section section{.title = "Predictors of drift side by side"};
  if (const auto answer = best_predictor(study)) add(section, *answer);
  add(section, overview_table(study));
  if (!study.error_by_modes.empty()) {
    add(section,
        output::Text{study.n_modes_wanted > 0
                         ? fmt::format("{} modes of the reduced model and its steady responses keep every error below 1 %",
                                       study.n_modes_wanted)
                         : fmt::format("no number of modes keeps every error below 1 %; the best leaves {:.2f} %",
                                       study.error_by_modes.back().second)});
  }
  add(section, Value{.key = "modes_of_the_model", .datum = study.n_modes_wanted});
  if (!study.without_model.empty())
    add(section, Value{.key = "without_model", .words = "no modes of the model, no hybrid:", .datum = study.without_model});
  add(section, scheduled_table(study, scenario.programme->tolerance_um));
  add(section, modes_table(study));
  add(section, factors_table(study));
  if (!study.error_by_modes.empty()) {
    output::Plot plot{.title = "Largest error of all cyclograms and channels by the number of the model's modes",
                      .x_label = "modes, beside the steady responses",
                      .y_label = "largest error [%]",
                      .series = {{.label = "largest error", .x = {}, .y = {}, .style = output::Series::Style::kPoints}},
                      .bands = {{.label = "1 %", .low = 1.0, .high = 1.0}}};
    for (const auto& [n, percent] : study.error_by_modes) {
      plot.series[0].x.push_back(n);
      plot.series[0].y.push_back(percent);
    }
    add(section, std::move(plot));
  }
  for (const auto& p : study.predictors) section.sections.push_back(predictor_section(study, p));
  Section courses{.title = "Courses"};
  std::size_t n_random = 0;
  for (std::size_t i = 0; i < study.judged.size(); ++i) {
    if (study.judged[i].is_random && ++n_random > 3) break;
    for (std::size_t c = 0; c < study.channels.name.size(); ++c) {
      if (study.channels.unit[c] == "um") add(courses, course(study, i, c));
    }
  }
  section.sections.push_back(std::move(courses));
  return section;
}

Table predictions_table(const studies::ProgrammeStudy& study) {
  Table table{.key = "predictions", .title = "Errors of predictors, cyclogram by cyclogram", .file = "programme.csv"};
  for (const char* key : {"predictor", "cyclogram", "type", "channel", "unit", "peak", "largest", "mean", "percent_of",
                          "largest_percent", "mean_percent"})
    table.columns.push_back({.key = key});
  for (const auto& p : study.predictors) {
    for (std::size_t i = 0; i < study.judged.size(); ++i) {
      for (std::size_t c = 0; c < study.channels.name.size(); ++c) {
        const studies::PredictionError& e = p.errors[i][c];
        table.rows.push_back({p.name(), study.judged[i].cyclogram.name, compensation::word(study.judged[i].type),
                              study.channels.name[c], study.channels.unit[c], e.peak, e.largest, e.mean, e.of,
                              e.largest_percent(), e.mean_percent()});
      }
    }
  }
  return table;
}

}  // namespace driftwright::findings
