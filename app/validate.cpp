#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/programme_report.hpp"
#include "app/record_study.hpp"
#include "app/results.hpp"
#include "output/html_report.hpp"
#include "output/json_text.hpp"

namespace driftwright::app {
namespace {

using Json = nlohmann::ordered_json;

Json summary(const RecordStudy& study, const RecordOptions& options, const output::Provenance& made_by) {
  const auto& r = study.regression;
  Json j = {{"program", "driftwright"},
            {"version", made_by.version},
            {"scenario", made_by.scenario},
            {"target", study.target},
            {"trained_on", options.train}};
  j["regression"] = {{"intercept", r.intercept},
                     {"target_unit", r.target_unit},
                     {"rank", r.rank},
                     {"condition_number", r.condition_number}};
  for (std::size_t i = 0; i < r.inputs.size(); ++i) j["regression"]["coefficients"][r.inputs[i]] = r.coefficients[i];
  for (const JudgedPrediction& p : study.judged) {
    j["judged"].push_back({{"test", p.test},
                           {"strategy", p.strategy},
                           {"rmse", p.error.rmse},
                           {"peak", p.error.peak_abs},
                           {"mean", p.error.mean},
                           {"n", p.error.n},
                           {"unit", r.target_unit}});
  }
  return j;
}

output::Report report(const scenarios::Scenario& scenario, const RecordStudy& study, const output::Provenance& made_by) {
  const std::string unit = study.regression.target_unit;
  output::Report page{.title = scenario.name + ": regression judged on records it was not fitted on",
                      .subtitle = fmt::format("Driftwright {}, scenario {}", made_by.version, made_by.scenario),
                      .blocks = {}};
  output::Table scores{
      .caption =
          fmt::format("Error of {} (measured minus predicted) on the judged records. A strategy that does not beat both "
                      "baselines is none.",
                      study.target),
      .headers = {"record", "strategy", "RMS [" + unit + "]", "peak [" + unit + "]", "mean [" + unit + "]"},
      .rows = {}};
  for (const JudgedPrediction& p : study.judged) {
    scores.rows.push_back({std::filesystem::path(p.test).filename().string(), p.strategy,
                           fmt::format("{:.2f}", p.error.rmse), fmt::format("{:.2f}", p.error.peak_abs),
                           fmt::format("{:.2f}", p.error.mean)});
  }
  page.blocks.emplace_back(std::move(scores));
  for (std::size_t t = 0; t < study.test.size(); ++t) {
    const Record& test = study.test[t];
    std::vector<double> t_min;
    for (double t_s : test.time_s) t_min.push_back(t_s / 60.0);
    output::Plot plot{.title = std::filesystem::path(test.source).filename().string(),
                      .x_label = "time [min]",
                      .y_label = study.target + " [" + unit + "]",
                      .series = {{.label = "measured", .x = t_min, .y = test.at(study.target).values, .width = 3.0}}};
    for (std::size_t k = 0; k < 3; ++k)
      plot.series.push_back({.label = study.judged[3 * t + k].strategy, .x = t_min, .y = study.judged[3 * t + k].predicted});
    page.blocks.emplace_back(std::move(plot));
  }
  output::Table ranking{.caption = "Grey relational grades on the training records. " + study.ranking.reason,
                        .headers = {"rank", "channel", "grade [-]"},
                        .rows = {}};
  for (std::size_t i = 0; i < study.ranking.channels.size(); ++i) {
    const auto& c = study.ranking.channels[i];
    ranking.rows.push_back({fmt::format("{}", i + 1), c.name, c.grade ? fmt::format("{:.4f}", *c.grade) : c.note});
  }
  page.blocks.emplace_back(std::move(ranking));
  return page;
}

void validate_programme(const scenarios::Scenario& scenario, const CommonOptions& options) {
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress;
  const std::vector<Cyclogram> tests = scenarios::test_cyclograms(*scenario.programme),
                               random = scenarios::random_cyclograms(*scenario.programme);
  std::vector<const Cyclogram*> asked;
  for (const auto* list : {&tests, &random, &scenario.programme->cyclograms}) {
    for (const Cyclogram& c : *list) asked.push_back(&c);
  }
  const Model model = open_model(scenario, asked, progress, false);
  const ProgrammeStudy study = study_programme(scenario, model, progress);
  progress.begin("writing");
  folder.write_text("programme.csv", programme_csv(study));
  folder.write_text("summary.json", output::json_text(programme_json(study, folder.made_by())));
  folder.write_text("report.html", output::render_html(programme_report(scenario, study, folder.made_by())));
  folder.commit();
  progress.end();
  fmt::print("{}\n{}{}", model.words(), programme_text(study), schedule_text(study));
  for (const auto& p : study.predictors) fmt::print("one prediction by {}: {:.2f} ms\n", p.name, 1e3 * p.seconds);
  fmt::print("report in {}\n", shown_path(folder.target() / "report.html"));
}

}  // namespace

void validate(const RecordOptions& options) {
  const scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  if (options.train.empty() && options.test.empty()) {
    if (!scenario.programme) {
      throw InputError(
          fmt::format("{}: `validate` wants records (--train, --test), or the key `programme` in the scenario "
                      "(docs/prediction.md)",
                      scenario.path));
    }
    return validate_programme(scenario, options);
  }
  for (const auto& [list, name] : {std::pair{&options.train, "--train"}, std::pair{&options.test, "--test"}}) {
    if (list->empty()) throw InputError(fmt::format("`validate` on records wants {} too, at least once", name));
  }
  const scenarios::Study& settings = require_study(scenario, "validate");
  RecordStudy study = read_records(settings, options);
  fit_and_judge(study, settings);
  output::ResultsFolder folder = open_results(options, scenario.name);
  folder.write_text("summary.json", output::json_text(summary(study, options, folder.made_by())));
  folder.write_text("report.html", output::render_html(report(scenario, study, folder.made_by())));
  folder.commit();
  const auto& r = study.regression;
  fmt::print("{} from {}, fitted on {} samples (rank {} of {}, condition number {:.0f})\n", study.target,
             fmt::join(r.inputs, ", "), r.n_samples, r.rank, r.inputs.size(), r.condition_number);
  for (const JudgedPrediction& p : study.judged) {
    fmt::print("  {:<24} {:<34} RMS {:6.2f} {u}  peak {:6.2f} {u}  {} rows\n",
               std::filesystem::path(p.test).filename().string(), p.strategy, p.error.rmse, p.error.peak_abs, p.error.n,
               fmt::arg("u", r.target_unit));
  }
  for (std::size_t t = 0; t < study.test.size(); ++t) {
    const bool beats_both =
        study.judged[3 * t].error.rmse < std::min(study.judged[3 * t + 1].error.rmse, study.judged[3 * t + 2].error.rmse);
    fmt::print("  {}: the regression {}\n", std::filesystem::path(study.test[t].source).filename().string(),
               beats_both ? "beats both baselines" : "does NOT beat both baselines; do not use it");
  }
  fmt::print("report in {}\n", shown_path(folder.target() / "report.html"));
}

}  // namespace driftwright::app
