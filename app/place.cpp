#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/kept_pieces.hpp"
#include "app/results.hpp"
#include "base/option_quantity.hpp"
#include "findings/placement_document.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "studies/placement_yaml.hpp"

namespace driftwright::app {
namespace {

constexpr int kMostThermometers = 12, kLeastPoints = 50, kMostPoints = 3000;

int count(const std::string& option, int value, int least, int most) {
  if (value >= least && value <= most) return value;
  throw InputError(fmt::format("{} {}: {} to {} is allowed", option, value, least, most));
}

studies::PlacementOptions options_of(const PlaceOptions& options, const scenarios::Scenario& scenario) {
  studies::PlacementOptions how;
  if (options.count) how.n = count("--count", *options.count, 1, kMostThermometers);
  how.where = {.regions = options.regions, .excluded = options.excluded};
  if (options.points) how.where.n_points = count("--points", *options.points, kLeastPoints, kMostPoints);
  how.mounted = options.mounted;
  how.channels = options.channels;
  how.train = options.train;
  how.test = options.test;
  if (options.placed_for == "observer") how.placed_for = studies::PlacedFor::kObserver;
  if (options.placed_for == "regression") how.placed_for = studies::PlacedFor::kRegression;
  how.any_may_fail = !options.none_fails;
  if (!options.noise.empty()) {
    how.noise_K = option_quantity("--noise", options.noise, "K");
    if (!(how.noise_K >= 1e-3 && how.noise_K <= 10.0))
      throw InputError(fmt::format("--noise '{}': 0.001 K to 10 K is allowed", options.noise));
  } else if (scenario.validation) {
    how.noise_K = std::max(0.01, scenario.validation->noise_K);
  }
  return how;
}

/// Every option that changes the result.
std::vector<std::string> words_of(const PlaceOptions& options) {
  std::vector<std::string> words = {
      "place", options.placed_for, options.noise,
      fmt::format("{} {} {}", options.count.value_or(0), options.points.value_or(0), options.none_fails)};
  for (const auto* list :
       {&options.regions, &options.excluded, &options.mounted, &options.channels, &options.train, &options.test}) {
    words.emplace_back("-");
    words.insert(words.end(), list->begin(), list->end());
  }
  return words;
}

}  // namespace

void place(const PlaceOptions& options) {
  const scenarios::Scenario scenario = read_scenario(options);
  scenarios::require_nothing_before(scenarios::require_machine(scenario, "place"), "place");
  const studies::PlacementOptions how = options_of(options, scenario);
  (void)studies::with_sensors(scenario.path, {"{name: tried}"},
                              {});  // refuses a scenario that cannot be edited before the long computation
  KeptPieces kept(checked_results(options, scenario.name), options, options.scenario, words_of(options));
  Progress progress(options.quiet);
  const std::optional<studies::Placement> placed =
      studies::place_thermometers(scenario, how, progress.listener(), kept.pieces());
  progress.end();
  if (!placed) {
    const std::string said = kept.finish_shard("the same command with");
    if (!options.quiet && !options.json) fmt::print("{}: {}", scenario.name, said);
    return;
  }
  const studies::Placement& placement = *placed;
  output::ResultsFolder folder = open_results(options, scenario.name);
  const std::vector<int>& set = placement.chosen.sets[static_cast<std::size_t>(placement.options.n) - 1];
  std::vector<std::string> entries;
  for (std::size_t i = 0; i < placement.names.size(); ++i)
    entries.push_back(studies::sensor_entry(placement.names[i],
                                            placement.spots[static_cast<std::size_t>(set[placement.mounted.size() + i])]));
  const std::vector<std::string> head =
      provenance_lines(folder.made_by(), fmt::format("thermometers placed on {}", scenario.name));
  std::string sensors;
  for (const std::string& line : head) sensors += fmt::format("# {}\n", line);
  folder.write_text("sensors.yaml", sensors + fmt::format("sensors:\n  - {}\n", fmt::join(entries, "\n  - ")));
  folder.write_text("placed.yaml", studies::with_sensors(scenario.path, entries, head, folder.target()));
  finish(findings::document_of(placement, scenario, entries, folder.made_by()), folder, progress, options, "", "place.json");
  kept.remove();
}

}  // namespace driftwright::app
