#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <optional>
#include <set>

#include "app/diagnosis_files.hpp"
#include "app/end_request.hpp"
#include "app/results.hpp"
#include "base/delimited_text.hpp"
#include "diagnosis/happening.hpp"
#include "findings/diagnosis_document.hpp"

namespace driftwright::app {
namespace {

std::vector<std::string> head_of(const diagnosis::Diagnosis& d, const DiagnoseOptions& options) {
  std::vector<std::string> head = {fmt::format("{} with what `driftwright diagnose` found written in; verdict: {}",
                                               clean_name(options.scenario), diagnosis::word(d.verdict))};
  for (const diagnosis::Cause& c : d.causes) {
    head.push_back(fmt::format("  {}{}: {} at {} ({}){}{}", diagnosis::word(c.standing),
                               c.is_written ? "" : ", not written in", c.effect, c.where, c.law,
                               c.parameters.empty() ? "" : ": ", findings::parameters_text(c)));
    if (!c.is_written) head.push_back(fmt::format("    not written, since {}", c.why_not_written));
    for (const diagnosis::Cause& a : c.alternatives) head.push_back(fmt::format("    or {} at {}", a.effect, a.where));
  }
  if (!d.written.keeps_numbers) head.push_back(fmt::format("  nothing is written in: {}", d.written.why_nothing));
  if (const std::string taken_up = findings::taken_up_text(d); !taken_up.empty()) head.push_back("  " + taken_up);
  for (const std::string& path : options.measured) head.push_back("  measured: " + clean_name(path));
  if (d.written.keeps_numbers)
    head.emplace_back(options.causes_only || d.written.causes_alone
                          ? "  the scenario's own numbers are as they were"
                          : "  the scenario's own numbers are as fitted beside the causes (`calibration` in comments); "
                            "--causes-only leaves them");
  head.emplace_back("");
  return head;
}

}  // namespace

void diagnose(const DiagnoseOptions& options) {
  const scenarios::Scenario scenario = read_scenario(options);
  (void)scenarios::require_machine(scenario, "diagnose");
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
  studies::MeasuredTwin m = studies::open_measured_twin(scenario, "diagnose", options.measured, progress.listener());
  m.how.without = {options.without.begin(), options.without.end()};
  if (!options.without.empty()) {
    std::set<std::string> keys;
    for (const diagnosis::Candidate& c : diagnosis::candidates(*m.twin, m.runs, {})) keys.insert(c.effect);
    keys.insert(std::begin(diagnosis::kEventKeys), std::end(diagnosis::kEventKeys));
    for (const std::string& key : options.without) {
      if (keys.contains(key)) continue;
      throw InputError(fmt::format("--without {}: no candidate has that key; there are {}", key, fmt::join(keys, ", ")));
    }
  }
  Listener listener = progress.listener();
  listener.wants_end_now = EndRequest::is_made;
  std::optional<EndRequest> end_request(std::in_place);
  diagnosis::Diagnosis d =
      diagnosis::diagnose(*m.twin, m.on_other_mesh ? &*m.on_other_mesh : nullptr, m.runs, m.how, listener);
  end_request.reset();
  progress.begin("writing");
  if (options.causes_only) diagnosis::leave_numbers(d);
  std::string difference;
  std::vector<diagnosis::StatedChange> changes;  // in the order in which the fit applies them
  if (d.written.keeps_numbers) changes = stated_scatter(d, options.causes_only);
  for (diagnosis::StatedChange& cause : stated_causes(d)) changes.push_back(std::move(cause));
  const diagnosis::ExtendedScenario extended =
      write_scenario("extended", m, changes, head_of(d, options), folder, &difference);
  if (extended.not_written.empty()) simulate_written(m, extended, d);
  write_missing_heat(m.mesh, d.statements, folder);
  finish(findings::diagnosis_document({m, d, extended, difference, "extended.yaml"}, folder.made_by()), folder, progress,
         options, "", "diagnosis.json");
  std::fflush(stdout);
  if (!d.ended_at.empty()) throw EndedEarly(fmt::format("ended at \"{}\": the diagnosis is incomplete", d.ended_at));
}

}  // namespace driftwright::app
