#include "app/identify_beside.hpp"

#include <fmt/format.h>

#include "app/diagnosis_files.hpp"
#include "app/results.hpp"
#include "base/delimited_text.hpp"
#include "base/errors.hpp"
#include "findings/identification_document.hpp"
#include "studies/remainder.hpp"

namespace driftwright::app {

void identify_beside(const IdentifyOptions& asked) {
  IdentifyOptions options = asked;
  options.scenario = asked.prior;
  const scenarios::Scenario scenario = scenarios::read_scenario(options.prior);
  (void)scenarios::require_machine(scenario, "identify --prior");
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
  const studies::MeasuredTwin m =
      studies::open_measured_twin(scenario, "identify --prior", options.records, progress.listener(), options.as_recorded);
  auto [beside, learned] = studies::learn_beside(m, m.twin->as_written(), progress.listener());
  progress.begin("writing");
  std::vector<std::string> head = {
      fmt::format("{} with what it misses, learned by `driftwright identify --prior` (docs/how-to/identification.md)",
                  studies::name_in_comments(options.prior))};
  for (const std::string& path : options.records) head.push_back("  record: " + studies::name_in_comments(path));
  head.emplace_back("");
  const studies::WrittenScenario written =
      studies::written_scenario(m, studies::stated_extension(learned), head, folder.target() / "extended.yaml");
  if (!written.is_readable())
    throw InputError(
        fmt::format("{}: what was learned could not be written: {}", options.prior, written.extended.not_written.front()));
  write_scenario("extended", written, folder);
  const studies::BesideRecords again = studies::beside(m.runs, studies::read_of(m, written.effects), m.twin->reference_K());
  for (identification::IdentifiedChannel& c : learned.channels) c.missed_simulated = studies::missed(again, c.name);
  findings::IdentificationFindings found{scenario.name, beside.measured, learned, {}};
  for (const diagnosis::MeasuredRun& run : m.runs) {
    for (const DataFinding& f : run.findings)
      found.notes.push_back(
          fmt::format("{}: {}{}", clean_name(run.path), f.channel.empty() ? "" : f.channel + ": ", f.what));
  }
  found.difference = written.difference;
  finish(findings::document_of(found, folder.made_by()), folder, progress, options);
}

}  // namespace driftwright::app
