#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/programme_report.hpp"
#include "app/results.hpp"
#include "app/strategy_report.hpp"
#include "output/html_report.hpp"
#include "output/json_text.hpp"
#include "studies/record_study.hpp"
#include "studies/validation_study.hpp"

namespace driftwright::app {
namespace {

using Json = nlohmann::ordered_json;

Json provenance(const output::Provenance& made_by) {
  return {{"program", "driftwright"}, {"version", made_by.version}, {"scenario", made_by.scenario}};
}

/// The strategies of `validation`, the predictors of `programme`, or both.
void validate_machine(const scenarios::Scenario& scenario, const CommonOptions& options) {
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress;
  std::vector<Cyclogram> asked;
  if (const auto& p = scenario.programme) {
    asked = scenarios::test_cyclograms(*p);
    for (const auto& list : {scenarios::random_cyclograms(*p), p->cyclograms})
      asked.insert(asked.end(), list.begin(), list.end());
  }
  if (const auto& v = scenario.validation) {
    for (const auto& family : v->families) asked.insert(asked.end(), family.cyclograms.begin(), family.cyclograms.end());
  }
  std::vector<const Cyclogram*> pointers;
  for (const Cyclogram& c : asked) pointers.push_back(&c);
  const scenarios::Model model = scenarios::open_model(scenario, pointers, progress.listener(), false);
  Json summary = provenance(folder.made_by());
  output::Report page{
      .title = scenario.name + ": strategies judged on cyclograms they were not fitted on",
      .subtitle = fmt::format("Driftwright {}, scenario {}", folder.made_by().version, folder.made_by().scenario),
      .blocks = {}};
  std::string text = model.words() + "\n";
  if (scenario.validation) {
    const compensation::StrategyMatrix matrix = studies::validate_strategies(scenario, model, progress.listener());
    progress.begin("writing");
    summary["validation"] = strategy_json(matrix);
    page.blocks = strategy_blocks(matrix);
    folder.write_text("strategies.csv", strategy_csv(matrix));
    write_models(matrix, scenario.machine->effects, folder);
    text += strategy_text(matrix);
  }
  if (scenario.programme) {
    const studies::ProgrammeStudy study = studies::study_programme(scenario, model, progress.listener());
    progress.begin("writing");
    folder.write_text("programme.csv", programme_csv(study));
    const Json of_programme = programme_json(study, folder.made_by());
    summary.update(of_programme);
    output::Report programme = programme_report(scenario, study, folder.made_by());
    if (page.blocks.empty()) page.title = programme.title;
    if (!page.blocks.empty()) page.blocks.emplace_back(output::Heading{programme.title});
    std::move(programme.blocks.begin(), programme.blocks.end(), std::back_inserter(page.blocks));
    text += programme_text(study) + schedule_text(study);
    for (const auto& p : study.predictors)
      text += fmt::format("one prediction by {}: {:.2f} ms\n", p.name(), 1e3 * p.seconds);
  }
  folder.write_text("summary.json", output::json_text(summary));
  folder.write_text("report.html", output::render_html(page));
  folder.commit();
  progress.end();
  fmt::print("{}report in {}\n", text, shown_path(folder.target() / "report.html"));
}

}  // namespace

void validate(const RecordOptions& options) {
  const scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  if (options.train.empty() && options.test.empty()) {
    if (!scenario.programme && !scenario.validation) {
      throw InputError(fmt::format(
          "{}: `validate` wants records (--train, --test), or the key `validation` or `programme` in the scenario "
          "(docs/validation.md, docs/prediction.md)",
          scenario.path));
    }
    return validate_machine(scenario, options);
  }
  for (const auto& [list, name] : {std::pair{&options.train, "--train"}, std::pair{&options.test, "--test"}}) {
    if (list->empty()) throw InputError(fmt::format("`validate` on records wants {} too, at least once", name));
  }
  const scenarios::Study& settings = scenarios::require_study(scenario, "validate");
  studies::StudyRecords records = studies::read_records(scenario, options);
  const std::vector<Record> training = studies::whole_records(records.train, settings.target);
  std::vector<std::string> warnings =
      studies::sensor_warnings(training, studies::candidate_sensors(settings, training.front()));
  warnings.insert(warnings.begin(), records.notes.begin(), records.notes.end());
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress;
  const compensation::StrategyMatrix matrix =
      studies::validate_on_records(scenario, std::move(records), progress.listener());
  progress.end();
  warnings.insert(warnings.end(), matrix.findings.begin(), matrix.findings.end());
  Json summary = provenance(folder.made_by());
  summary["validation"] = strategy_json(matrix);
  summary["warnings"] = warnings;
  output::Report page{
      .title = scenario.name + ": strategies judged on records they were not fitted on",
      .subtitle = fmt::format("Driftwright {}, scenario {}", folder.made_by().version, folder.made_by().scenario),
      .blocks = strategy_blocks(matrix)};
  for (const std::string& warning : warnings) page.blocks.emplace_back(output::Paragraph{"Warning: " + warning + "."});
  folder.write_text("summary.json", output::json_text(summary));
  folder.write_text("strategies.csv", strategy_csv(matrix));
  write_models(matrix, scenario.machine ? scenario.machine->effects : std::vector<effects::Effect>{}, folder);
  folder.write_text("report.html", output::render_html(page));
  folder.commit();
  fmt::print("{}", strategy_text(matrix));
  for (const std::string& warning : warnings) fmt::print("warning: {}\n", warning);
  fmt::print("report in {}\n", shown_path(folder.target() / "report.html"));
}

}  // namespace driftwright::app
