#include "app/programme_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace driftwright::app {
namespace {

using compensation::CyclogramType;

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

output::Table error_table(const studies::ProgrammeStudy& study, bool in_percent) {
  output::Table table{.caption = in_percent
                                     ? "Largest / mean error in % of max(peak of that axis, 10 % of the peak of the vector)."
                                     : "Largest / mean error in um, tilts in urad.",
                      .headers = {"predictor", "cyclograms", "n"},
                      .rows = {}};
  for (std::size_t c = 0; c < study.channels.name.size(); ++c)
    table.headers.push_back(fmt::format("{} [{}]", study.channels.name[c], in_percent ? "%" : study.channels.unit[c]));
  for (const auto& p : study.predictors) {
    bool is_first = true;
    for (const Group& g : groups(study)) {
      std::vector<std::string> row = {is_first ? p.name() : "", g.name, ""};
      is_first = false;
      for (std::size_t c = 0; c < study.channels.name.size(); ++c) {
        const studies::Summary s = studies::summary(study, p, c, g.holds);
        row[2] = fmt::format("{}", s.n);
        row.push_back(in_percent ? fmt::format("{:.2f} / {:.2f}", s.largest_percent, s.mean_percent)
                                 : fmt::format("{:.2f} / {:.2f}", s.largest, s.mean));
      }
      table.rows.push_back(std::move(row));
    }
  }
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

output::Report programme_report(const scenarios::Scenario& scenario, const studies::ProgrammeStudy& study,
                                const output::Provenance& made_by) {
  output::Report page{.title = scenario.name + ": predictors of drift side by side",
                      .subtitle = fmt::format("Driftwright {}, scenario {}", made_by.version, made_by.scenario),
                      .blocks = {}};
  page.blocks.emplace_back(output::Preformatted{programme_text(study)});
  page.blocks.emplace_back(error_table(study, true));
  page.blocks.emplace_back(error_table(study, false));
  if (!study.scheduled.empty() && study.scheduled.front().n_cyclograms > 0) {
    output::Table table{
        .caption =
            fmt::format("Corrections planned ahead on the predictions of the random cyclograms along {}, tolerance {:g} um.",
                        study.scheduled.front().channel, scenario.programme->tolerance_um),
        .headers = {"predictor", "inside the tolerance", "worst [um]", "changes, mean", "changes, most"},
        .rows = {}};
    for (const auto& s : study.scheduled) {
      table.rows.push_back({s.predictor, fmt::format("{} of {}", s.n_inside, s.n_cyclograms),
                            fmt::format("{:.1f}", s.worst_um), fmt::format("{:.1f}", s.mean_changes),
                            fmt::format("{}", s.most_changes)});
    }
    page.blocks.emplace_back(std::move(table));
  }
  output::Table modes{
      .caption =
          "Modes identified from the tests: time constants at standstill and by how much rates grow up to the top speed.",
      .headers = {"mode", "time constant [min]", "95 % confidence [min]", "rate at top speed over standstill"},
      .rows = {}};
  for (std::size_t k = 0; k < study.identified.modes.size(); ++k) {
    const auto& m = study.identified.modes[k];
    modes.rows.push_back({fmt::format("{}", k + 1), fmt::format("{:.1f}", m.time_constant_s / 60.0),
                          fmt::format("{:.1f} to {:.1f}", m.low_s / 60.0, m.high_s / 60.0),
                          fmt::format("{:.2f}", 1.0 + m.growth)});
  }
  page.blocks.emplace_back(std::move(modes));
  if (!study.factors.empty()) {
    output::Table factors{.caption = "Factors that the tests give the hybrid's model.",
                          .headers = {"factor", "value", "95 % confidence"},
                          .rows = {}};
    for (const auto& f : study.factors)
      factors.rows.push_back({f.name, fmt::format("{:.3f}", f.value), fmt::format("{:.3f} to {:.3f}", f.low, f.high)});
    page.blocks.emplace_back(std::move(factors));
  }
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
    page.blocks.emplace_back(std::move(plot));
  }
  page.blocks.emplace_back(output::Heading{"Courses"});
  std::size_t n_random = 0;
  for (std::size_t i = 0; i < study.judged.size(); ++i) {
    if (study.judged[i].is_random && ++n_random > 3) break;
    for (std::size_t c = 0; c < study.channels.name.size(); ++c) {
      if (study.channels.unit[c] == "um") page.blocks.emplace_back(course(study, i, c));
    }
  }
  return page;
}

nlohmann::ordered_json programme_json(const studies::ProgrammeStudy& study, const output::Provenance& made_by) {
  nlohmann::ordered_json j = {{"program", "driftwright"}, {"version", made_by.version}, {"scenario", made_by.scenario}};
  for (const auto& p : study.predictors) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const Group& g : groups(study)) {
      for (std::size_t c = 0; c < study.channels.name.size(); ++c) {
        const studies::Summary s = studies::summary(study, p, c, g.holds);
        rows.push_back({{"cyclograms", g.name},
                        {"n", s.n},
                        {"channel", study.channels.name[c]},
                        {"unit", study.channels.unit[c]},
                        {"largest", s.largest},
                        {"mean", s.mean},
                        {"largest_percent", s.largest_percent},
                        {"mean_percent", s.mean_percent}});
      }
    }
    j["predictors"].push_back({{"name", p.name()}, {"errors", rows}});
  }
  j["modes_of_the_model"] = study.n_modes_wanted;
  if (!study.without_model.empty()) j["without_model"] = study.without_model;
  for (const auto& m : study.identified.modes)
    j["identified_modes"].push_back({{"time_constant_min", m.time_constant_s / 60.0},
                                     {"ci95", {m.low_s / 60.0, m.high_s / 60.0}},
                                     {"rate_growth", m.growth}});
  for (const auto& s : study.scheduled)
    j["scheduled"].push_back({{"predictor", s.predictor},
                              {"channel", s.channel},
                              {"inside", s.n_inside},
                              {"of", s.n_cyclograms},
                              {"worst_um", s.worst_um},
                              {"mean_changes", s.mean_changes},
                              {"most_changes", s.most_changes}});
  return j;
}

std::string programme_csv(const studies::ProgrammeStudy& study) {
  std::string text = "predictor,cyclogram,type,channel,unit,peak,largest,mean,percent_of,largest_percent,mean_percent\n";
  for (const auto& p : study.predictors) {
    for (std::size_t i = 0; i < study.judged.size(); ++i) {
      for (std::size_t c = 0; c < study.channels.name.size(); ++c) {
        const studies::PredictionError& e = p.errors[i][c];
        text += fmt::format("\"{}\",{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", p.name(),
                            study.judged[i].cyclogram.name, compensation::word(study.judged[i].type), study.channels.name[c],
                            study.channels.unit[c], e.peak, e.largest, e.mean, e.of, e.largest_percent(), e.mean_percent());
      }
    }
  }
  return text;
}

std::string programme_text(const studies::ProgrammeStudy& study) {
  std::string text =
      fmt::format("{} cyclograms; largest error in % of max(peak of the axis, 10 % of the vector's)\n", study.judged.size());
  std::size_t width = 0;
  for (const auto& p : study.predictors) width = std::max(width, p.name().size());
  text += fmt::format("  {:<{}}", "", width);
  for (const std::string& name : study.channels.name) text += fmt::format("  {:>8}", name);
  text += "\n";
  for (const auto& p : study.predictors) {
    text += fmt::format("  {:<{}}", p.name(), width);
    for (std::size_t c = 0; c < study.channels.name.size(); ++c)
      text += fmt::format(
          "  {:8.2f}", studies::summary(study, p, c, [](const studies::JudgedCyclogram&) { return true; }).largest_percent);
    text += "\n";
  }
  if (!study.error_by_modes.empty()) {
    text += study.n_modes_wanted > 0
                ? fmt::format("{} modes of the reduced model and its steady responses keep every error below 1 %\n",
                              study.n_modes_wanted)
                : fmt::format("no number of modes keeps every error below 1 %; the best leaves {:.2f} %\n",
                              study.error_by_modes.back().second);
  }
  if (!study.without_model.empty()) text += fmt::format("no modes of the model, no hybrid: {}\n", study.without_model);
  return text;
}

std::string schedule_text(const studies::ProgrammeStudy& study) {
  std::string text;
  for (const auto& s : study.scheduled) {
    if (s.n_cyclograms == 0) continue;
    text += fmt::format(
        "scheduled along {} by {}: {} of {} random cyclograms inside, worst {:.1f} um, {:.1f} changes on average, {} at "
        "most\n",
        s.channel, s.predictor, s.n_inside, s.n_cyclograms, s.worst_um, s.mean_changes, s.most_changes);
  }
  return text;
}

}  // namespace driftwright::app
