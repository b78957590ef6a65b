#include <fmt/format.h>

#include <algorithm>

#include "app/model_files.hpp"
#include "app/results.hpp"
#include "findings/programme_section.hpp"
#include "findings/strategy_section.hpp"
#include "output/document_csv.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "studies/record_study.hpp"
#include "studies/validation_study.hpp"

namespace driftwright::app {
namespace {

void write_strategies(const compensation::StrategyMatrix& matrix, const scenarios::Scenario& scenario,
                      output::ResultsFolder& folder) {
  folder.write_text("strategies.csv", output::table_csv(findings::cases_table(matrix), folder.made_by()));
  write_models(matrix, scenario.machine ? scenario.machine->effects : std::vector<effects::Effect>{}, folder);
}

/// The strategies of `validation`, the predictors of `programme`, or both.
void validate_machine(const scenarios::Scenario& scenario, const CommonOptions& options) {
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
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
  output::Document document{.made_by = folder.made_by(),
                            .title = scenario.name + (scenario.validation ? ": strategies" : ": predictors of drift") +
                                     " judged on cyclograms they were not fitted on",
                            .subtitle = model.words()};
  std::string seconds;
  if (scenario.validation) {
    const compensation::StrategyMatrix matrix = studies::validate_strategies(scenario, model, progress.listener());
    write_strategies(matrix, scenario, folder);
    document.body.sections.push_back(findings::strategy_section(matrix));
  }
  if (scenario.programme) {
    const studies::ProgrammeStudy study = studies::study_programme(scenario, model, progress.listener());
    folder.write_text("programme.csv", output::table_csv(findings::predictions_table(study), folder.made_by()));
    document.body.sections.push_back(findings::programme_section(study, scenario));
    for (const auto& p : study.predictors)
      seconds += fmt::format("one prediction by {}: {:.2f} ms\n", p.name(), 1e3 * p.seconds);
  }
  finish(document, folder, progress, options, seconds);
}

}  // namespace

void validate(const RecordOptions& options) {
  const bool on_records = !options.train.empty() || !options.test.empty();
  for (const auto& [list, name] : {std::pair{&options.train, "--train"}, std::pair{&options.test, "--test"}}) {
    if (on_records && list->empty())
      throw InputError(fmt::format("`validate` on records requires {} too, at least once", name));
  }
  scenarios::Scenario scenario = read_scenario(options);
  if (!options.target.empty()) {
    if (!on_records || scenario.study)
      throw InputError("--target: it is for records of a scenario without `study`, which would name the target itself");
    scenario.study.emplace().target = options.target;
    scenario.study->count_from_start = scenario.machine.has_value();  // a model knows drift since the start
  }
  if (on_records && !scenario.study)
    throw InputError(fmt::format(
        "{}: `validate` must know the target: add --target CHANNEL, a displacement of the records, or the key `study`",
        scenario.path));
  if (!on_records) {
    if (scenario.machine) scenarios::require_nothing_before(*scenario.machine, "validate");
    if (!scenario.programme && !scenario.validation) {
      throw InputError(fmt::format(
          "{}: `validate` requires records (--train, --test), or the key `validation` or `programme` in the scenario "
          "(docs/how-to/validation.md, docs/how-to/prediction.md)",
          scenario.path));
    }
    return validate_machine(scenario, options);
  }
  const scenarios::Study& settings = *scenario.study;
  studies::StudyRecords records = studies::read_records(scenario, options);
  const std::vector<Record> training = studies::whole_records(records.train, settings.target);
  std::vector<std::string> warnings;
  if (studies::has_thermometers(settings, training.front()))
    warnings = studies::sensor_warnings(training, studies::candidate_sensors(settings, training.front()));
  warnings.insert(warnings.begin(), records.notes.begin(), records.notes.end());
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
  const compensation::StrategyMatrix matrix =
      studies::validate_on_records(scenario, std::move(records), progress.listener());
  warnings.insert(warnings.end(), matrix.findings.begin(), matrix.findings.end());
  write_strategies(matrix, scenario, folder);
  output::Document document{.made_by = folder.made_by(),
                            .title = scenario.name + ": strategies judged on records they were not fitted on"};
  document.body.sections.push_back(findings::strategy_section(matrix));
  document.body.sections.push_back({.blocks = {output::Notes{.key = "warnings", .sort = "warning", .lines = warnings}}});
  finish(document, folder, progress, options);
}

}  // namespace driftwright::app
