#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/iso230_3_report.hpp"
#include "app/run_report.hpp"
#include "app/verbs.hpp"
#include "output/json_text.hpp"
#include "studies/prediction.hpp"

namespace driftwright::app {
namespace {

/// A displacement or tilt over the cyclogram.
struct Course {
  std::string name, unit;
  double peak = 0.0, peak_s = 0.0, end = 0.0;
};

std::vector<Course> courses_of(const Record& record) {
  std::vector<Course> courses;
  for (const Channel& channel : record.channels) {
    if (channel.unit != "um" && channel.unit != "urad") continue;
    const auto peak = std::max_element(channel.values.begin(), channel.values.end(),
                                       [](double a, double b) { return std::abs(a) < std::abs(b); });
    courses.push_back({.name = channel.name,
                       .unit = channel.unit,
                       .peak = *peak,
                       .peak_s = record.time_s[static_cast<std::size_t>(peak - channel.values.begin())],
                       .end = channel.values.back()});
  }
  return courses;
}

nlohmann::ordered_json summary_json(const studies::Prediction& prediction, const std::string& cyclogram, double duration_s,
                                    const compensation::Iso230Figures& iso, const output::Provenance& made_by) {
  using Json = nlohmann::ordered_json;
  Json j = {{"program", "driftwright"}, {"version", made_by.version},        {"scenario", made_by.scenario},
            {"cyclogram", cyclogram},   {"duration_min", duration_s / 60.0}, {"predicted_by", prediction.predicted_by}};
  j["started_from"] = prediction.started_from.empty() ? Json() : Json(prediction.started_from);
  j["start_checks"] = studies::start_checks_json(prediction);
  j["channels"] = Json::array();
  for (const Course& c : courses_of(prediction.record)) {
    j["channels"].push_back(
        {{"name", c.name}, {"unit", c.unit}, {"peak", c.peak}, {"peak_at_min", c.peak_s / 60.0}, {"at_end", c.end}});
  }
  j["iso_230_3"] = iso230_3_json(iso);
  return j;
}

output::Report prediction_report(const scenarios::Scenario& scenario, const Cyclogram& cyclogram,
                                 const studies::Prediction& prediction, const compensation::Iso230Figures& iso,
                                 const output::Provenance& made_by) {
  output::Report report{.title = fmt::format("{}: predicted drift of {}", scenario.name, cyclogram.name),
                        .subtitle = fmt::format("Driftwright {}, scenario {}; predicted by the {}{}", made_by.version,
                                                made_by.scenario, prediction.predicted_by,
                                                prediction.started_from.empty() ? "" : "; after " + prediction.started_from),
                        .blocks = {}};
  add_channel_plots(report, prediction.record, cyclogram);
  report.blocks.push_back(iso230_3_block(iso));
  return report;
}

}  // namespace

void predict(const PredictOptions& options) {
  const scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  (void)scenarios::require_machine(scenario, "predict");
  const Cyclogram cyclogram = studies::named_cyclogram(scenario, options.cyclogram);
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress;
  const studies::Prediction prediction = studies::predict_drift(
      scenario, cyclogram, {.start = options.start, .after_pause = options.after_pause, .model = options.model},
      progress.listener(), "predict");
  const std::string after = prediction.started_from.empty() ? "" : " after " + prediction.started_from;
  const compensation::Iso230Figures iso = studies::iso_figures(prediction);
  folder.write_text("record.csv",
                    record_csv(prediction.record,
                               provenance_lines(folder.made_by(), fmt::format("{}{}, predicted by the {}", options.cyclogram,
                                                                              after, prediction.predicted_by))));
  folder.write_text("summary.json", output::json_text(summary_json(prediction, options.cyclogram, cyclogram.duration_s(),
                                                                   iso, folder.made_by())));
  folder.write_text("report.html",
                    output::render_html(prediction_report(scenario, cyclogram, prediction, iso, folder.made_by())));
  folder.commit();
  progress.end();
  fmt::print("{}, {:.0f} min{}, predicted by the {}\n", options.cyclogram, cyclogram.duration_s() / 60.0, after,
             prediction.predicted_by);
  fmt::print("{}", studies::start_check_text(prediction));
  for (const Course& c : courses_of(prediction.record)) {
    fmt::print("  {:<12} peak {:7.1f} {} at {:.0f} min, {:7.1f} {} at the end\n", c.name, c.peak, c.unit, c.peak_s / 60.0,
               c.end, c.unit);
  }
  fmt::print("{}results in {}: record.csv, summary.json, report.html\n", iso230_3_text(iso), shown_path(folder.target()));
}

}  // namespace driftwright::app
