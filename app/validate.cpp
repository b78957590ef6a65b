#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "app/model_files.hpp"
#include "app/results.hpp"
#include "base/option_quantity.hpp"
#include "findings/programme_section.hpp"
#include "findings/strategy_section.hpp"
#include "findings/travel_section.hpp"
#include "output/document_csv.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "scenarios/reader/travel_places.hpp"
#include "studies/record_study.hpp"
#include "studies/validation_study.hpp"

namespace driftwright::app {
namespace {

using Judge = std::function<compensation::StrategyMatrix(const scenarios::Scenario&)>;

void write_strategies(const compensation::StrategyMatrix& matrix, output::ResultsFolder& folder, const Listener& listener) {
  const compensation::StrategySettings& how = matrix.settings.strategies;
  folder.write_text((how.place ? how.target + "_" : "") + "strategies.csv",
                    output::table_csv(findings::cases_table(matrix), folder.made_by()));
  write_models(matrix, folder, listener);
}

/// Judges for the study's target, or for each of the places of its screw, writes the files, and adds what is found.
/// @param places  of scenarios::places_along(); none: the target alone
/// @return what is said of the records, a sentence each
std::vector<std::string> add_strategies(const scenarios::Scenario& scenario,
                                        const std::vector<scenarios::DisplacementOutput>& places, const Judge& judge,
                                        output::Document& document, output::ResultsFolder& folder,
                                        const Listener& listener) {
  if (places.empty()) {
    const compensation::StrategyMatrix matrix = judge(scenario);
    write_strategies(matrix, folder, listener);
    document.body.sections.push_back(findings::strategy_section(matrix, scenario, folder.made_by()));
    return matrix.findings;
  }
  const studies::JudgedTravel judged = studies::judge_places(scenario, places, judge);
  document.body.sections.push_back(findings::travel_section(judged, folder.made_by()));
  for (const compensation::StrategyMatrix& matrix : judged.places) {
    const std::string& target = matrix.settings.strategies.target;
    write_strategies(matrix, folder, listener);
    output::Section section = findings::strategy_section(matrix, scenario, folder.made_by());
    section.title = "The place of " + target;
    section.item = output::Item{"place", target};
    section.detail = true;
    document.body.sections.push_back(std::move(section));
  }
  return judged.places.front().findings;
}

std::optional<compensation::Probing> probing_of(const RecordOptions& options) {
  if (options.probe.empty()) return std::nullopt;
  compensation::Probing p{.every_s = {},
                          .noise_um = option_quantity("--probe-noise", options.probe_noise, "um"),
                          .takes_s = option_quantity("--probing-time", options.probing_time, "s", 0.0, 3600.0)};
  for (std::size_t from = 0; from <= options.probe.size();) {  // between commas
    const std::size_t comma = std::min(options.probe.find(',', from), options.probe.size());
    p.every_s.push_back(option_quantity("--probe", options.probe.substr(from, comma - from), "s"));
    from = comma + 1;
  }
  if (!(p.noise_um > 0.0) || std::any_of(p.every_s.begin(), p.every_s.end(), [](double s) { return !(s > 0.0); }))
    throw InputError(fmt::format("--probe '{}' and --probe-noise '{}' must be above 0", options.probe, options.probe_noise));
  return p;
}

/// What strategies are judged on where the scenario does not say it, in words for the user.
std::string judge_by_default(scenarios::Scenario& scenario) {
  try {
    scenario.validation = scenarios::default_validation(scenario.cyclograms, scenario.study->tolerance_um);
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}", scenario.path, e.what()));
  }
  std::vector<std::string> fitted, judged;
  for (const Cyclogram& c : scenario.validation->train) fitted.push_back(c.name);
  for (const auto& family : scenario.validation->families)
    judged.push_back(family.name == "random" ? "two random cyclograms at their speeds" : family.name);
  return fmt::format(
      "the scenario has no key `validation`: strategies are fitted on {} and judged on {}, in its own ambient and 5 K "
      "cooler and warmer, "
      "with readings of 0.1 K and 1 um. The key `validation` chooses others (docs/how-to/validation.md)",
      fmt::join(fitted, ", "), fmt::join(judged, ", "));
}

/// The displacement that is corrected where no `study` names it.
std::string only_target(const scenarios::Scenario& scenario) {
  std::vector<std::string> names;
  for (const auto& d : scenario.machine->displacements) names.push_back(d.name);
  if (names.size() == 1) return names.front();
  throw InputError(fmt::format("{}: `validate` must know the target: add --target CHANNEL or the key `study`; {}",
                               scenario.path,
                               names.empty() ? std::string("the scenario has no `displacements`")
                                             : fmt::format("there are {}", fmt::join(names, ", "))));
}

/// The places of the target's screw that all records have read; none: the target alone.
std::vector<scenarios::DisplacementOutput> read_places(const scenarios::Scenario& scenario,
                                                       const studies::StudyRecords& records) {
  if (!scenario.machine) return {};
  std::vector<scenarios::DisplacementOutput> places = scenarios::places_along(*scenario.machine, scenario.study->target);
  std::erase_if(places, [&](const scenarios::DisplacementOutput& d) {
    const auto has_none = [&](const MachineRun& run) { return run.readings.find(d.name) == nullptr; };
    return std::any_of(records.train.begin(), records.train.end(), has_none) ||
           std::any_of(records.test.begin(), records.test.end(), has_none);
  });
  if (places.size() < 2) places.clear();
  return places;
}

/// The strategies of `validation`, the predictors of `programme`, or both.
void validate_machine(scenarios::Scenario scenario, const std::string& note, const RecordOptions& options) {
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
  std::vector<scenarios::DisplacementOutput> places;
  if (scenario.validation) {
    places = scenarios::places_along(*scenario.machine, scenario.study->target);
    scenarios::add_places_between(*scenario.machine, scenario.study->target);
  }
  const scenarios::Model model = scenarios::open_model(scenario, pointers, progress.listener(), false);
  output::Document document{.made_by = folder.made_by(),
                            .title = scenario.name + (scenario.validation ? ": strategies" : ": predictors of drift") +
                                     " judged on cyclograms they were not fitted on",
                            .subtitle = model.words()};
  std::string seconds;
  if (scenario.validation) {
    const auto judge = [&](const scenarios::Scenario& of_target) {
      return studies::validate_strategies(of_target, model, probing_of(options), progress.listener());
    };
    add_strategies(scenario, places, judge, document, folder, progress.listener());
    if (!note.empty())
      document.body.sections.push_back({.blocks = {output::Notes{.key = "notes", .sort = "note", .lines = {note}}}});
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
    if (scenario.study)
      throw InputError("--target: it is for a scenario without `study`, which would name the target itself");
    scenario.study.emplace().target = options.target;
    scenario.study->count_from_start = scenario.machine.has_value();  // a model predicts drift since the start
  }
  if (on_records && !scenario.study)
    throw InputError(fmt::format(
        "{}: `validate` must know the target: add --target CHANNEL, a displacement of the records, or the key `study`",
        scenario.path));
  if (!on_records) {
    if (scenario.machine) scenarios::require_nothing_before(*scenario.machine, "validate");
    if (!scenario.machine)
      throw InputError(fmt::format("{}: without a `machine` `validate` requires records (--train, --test)", scenario.path));
    std::string note;
    if (!scenario.programme && !scenario.validation) {
      if (!scenario.study) scenario.study.emplace().target = only_target(scenario);
      note = judge_by_default(scenario);
    }
    return validate_machine(scenario, note, options);
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
  output::Document document{.made_by = folder.made_by(),
                            .title = scenario.name + ": strategies judged on records they were not fitted on"};
  const auto judge = [&](const scenarios::Scenario& of_target) {
    return studies::validate_on_records(of_target, records, probing_of(options), progress.listener());
  };
  const std::vector<std::string> found =
      add_strategies(scenario, read_places(scenario, records), judge, document, folder, progress.listener());
  warnings.insert(warnings.end(), found.begin(), found.end());
  document.body.sections.push_back({.blocks = {output::Notes{.key = "warnings", .sort = "warning", .lines = warnings}}});
  finish(document, folder, progress, options);
}

}  // namespace driftwright::app
