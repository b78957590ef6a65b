#pragma once
// Lumped machines and noisy records of them, for tests of a diagnosis.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <optional>

#include "base/random.hpp"
#include "diagnosis/diagnosis.hpp"
#include "diagnosis/extended_scenario.hpp"
#include "machine/as_recorded.hpp"
#include "machine/driven_before.hpp"
#include "machine/machine.hpp"
#include "machine/run_record.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "solver/transient.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::diagnosis {

/// Two lumped bodies, their thermometers, an indicator, and three records of 3 to 5 h.
inline constexpr const char* kTwoNodes = R"(name: two_nodes
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: head, capacity: 6 kJ/K}
  - {type: node, node: column, capacity: 40 kJ/K}
  - {type: heat_source, node: head, power: 100 W, at_speed: 1000 rpm, exponent: 1.3}
  - {type: link, node: head, to: column, conductance: 12 W/K}
  - {type: link, node: column, to: ambient, conductance: 14 W/K}
  - {type: link, node: head, to: ambient, conductance: 4 W/K}
ambient: [[0 min, 20 degC], [200 min, 22 degC], [400 min, 21 degC]]
sensors:
  - {name: t_head, node: head}
  - {name: t_column, node: column}
displacements:
  - name: nose
    sensitivities:
      - {node: head, sensitivity: 3 um/K}
cyclograms:
  monday: [[60 min, 600 rpm], [60 min, 1900 rpm], [40 min, 0 rpm], [80 min, 1000 rpm], [60 min, 1400 rpm]]
  tuesday: [[50 min, 1800 rpm], [70 min, 300 rpm], [60 min, 1000 rpm], [60 min, 0 rpm], [60 min, 2000 rpm]]
  friday: [[40 min, 900 rpm], [60 min, 0 rpm], [80 min, 1600 rpm]]
solver: {output_interval: 1 min}
)";

/// A scenario's text with one more effect, before its key `ambient`.
inline std::string with_effect(std::string text, const std::string& entry) {
  if (!entry.empty()) text.insert(text.find("ambient: [["), "  - " + entry + "\n");
  return text;
}

struct RecordNoise {
  double row_s = 60.0, noise_K = 0.03, noise_um = 0.2;
  std::uint64_t seed = 5;
};

/// Records of all cyclograms of a scenario, by the full model, with noise and all columns of the cyclogram, as files.
inline std::vector<std::string> noisy_records(const std::string& scenario, const std::string& prefix,
                                              const RecordNoise& as = {}) {
  const scenarios::Scenario s = scenarios::read_scenario(scenario);
  const scenarios::MachineModel& model = *s.machine;
  const scenarios::Machine machine = scenarios::build(model, scenarios::place(model));
  const solver::TransientOptions exact{.relative_tolerance = 1e-7, .absolute_tolerance_K = 1e-7};
  Random random(as.seed, 0);
  std::vector<std::string> paths;
  for (const Cyclogram& c : s.cyclograms) {
    const MachineRun felt = scenarios::felt_run(model, c);
    Record r = scenarios::as_recorded(
        model,
        solver::simulate(
            machine.system, felt.cyclogram, felt.ambient, scenarios::output_times_s(c, as.row_s), exact,
            scenarios::after_what_was_before(machine.system, felt, exact, scenarios::start_state(model, machine))),
        machine.system.outputs, c);
    for (Channel& channel : r.channels) {
      const bool is_reading = channel.name != "ambient" && !c.column(channel.name);
      const double noise = is_reading && channel.unit == "degC" ? as.noise_K
                           : is_reading && channel.unit == "um" ? as.noise_um
                                                                : 0.0;
      for (double& v : channel.values) v += noise * random.normal();
    }
    for (const Cyclogram::Column& column : c.columns) {
      if (r.find(column.name)) continue;
      r.channels.push_back({column.name, column.unit, {}});
      for (double t_s : r.time_s) r.channels.back().values.push_back(column.at(t_s));
    }
    paths.push_back(write_file(prefix + c.name + ".csv", record_csv(r)));
  }
  return paths;
}

/// A scenario's twin with records.
struct Beside {
  scenarios::Scenario scenario;
  std::vector<MeasuredRun> runs;
  AugmentedModel augmented;
  scenarios::ReducedMachine machine;
  std::optional<Twin> twin;

  Beside(const std::string& path, const std::vector<std::string>& records) : scenario(scenarios::read_scenario(path)) {
    const scenarios::PlacedMachine placed = scenarios::place(*scenario.machine);
    const solver::Outputs names = scenarios::output_names(*scenario.machine, placed);
    for (const std::string& r : records)
      runs.push_back(measured_run(read_record(r, std::nullopt), *scenario.machine, names));
    augmented = augment(scenario, placed.mesh, runs);
    machine = scenarios::reduce(augmented.model, scenarios::build(augmented.model, scenarios::place(augmented.model)),
                                augmented.plan);
    twin.emplace(augmented, machine, solver::TransientOptions{.relative_tolerance = 1e-5, .absolute_tolerance_K = 1e-4});
  }
  Beside(const Beside&) = delete;  // the twin refers to its parts
  Beside& operator=(const Beside&) = delete;
  [[nodiscard]] Diagnosis diagnosed(int most_effects = 3) const {
    DiagnosisOptions how;
    how.most_effects = most_effects;
    return diagnose(*twin, nullptr, runs, how);
  }
};

/// A spindle in its housing, two thermometers, a nose. @param rpm  at which it loses 150 W and runs first; slow_rpm: later
inline std::string spindle_in_housing(int rpm, int slow_rpm, const std::string& more_displacements = "") {
  return fmt::format(R"(name: spindle
reference_temperature: 20 degC
start: ambient
machine: {{generator: lumped}}
effects:
  - {{type: node, node: shaft, capacity: 5 kJ/K}}
  - {{type: node, node: housing, capacity: 20 kJ/K}}
  - {{type: motor_loss, node: shaft, power: 150 W, at_speed: {0} rpm, exponent: 1.5}}
  - {{type: link, node: shaft, to: housing, conductance: 12 W/K}}
  - {{type: link, node: housing, to: ambient, conductance: 9 W/K}}
ambient: [[0 min, 20 degC]]
sensors:
  - {{name: t_shaft, node: shaft}}
  - {{name: t_housing, node: housing}}
displacements:
  - name: nose
    sensitivities:
      - {{node: shaft, sensitivity: 3 um/K}}
      - {{node: housing, sensitivity: -1 um/K}}
{2}cyclograms:
  cycle: [[100 min, {0} rpm], [60 min, 0 rpm], [80 min, {1} rpm]]
solver: {{output_interval: 1 min}}
)",
                     rpm, slow_rpm, more_displacements);
}

/// A scenario's twin, and the run that it has by itself: its first cyclogram, without readings.
struct AloneTwin {
  scenarios::Scenario scenario;
  std::vector<MeasuredRun> runs{1};
  AugmentedModel augmented;
  scenarios::ReducedMachine machine;
  std::optional<Twin> twin;

  explicit AloneTwin(const std::string& path) : scenario(scenarios::read_scenario(path)) {
    MeasuredRun& run = runs[0];
    run.name = run.path = "cycle";
    run.cyclogram = scenario.cyclograms.front();
    run.time_s = scenarios::output_times_s(run.cyclogram, scenario.solver.output_interval_s);
    run.ambient = scenario.machine->ambient;
    run.has_ambient = true;
    set_grid(run);
    const scenarios::PlacedMachine placed = scenarios::place(*scenario.machine);
    augmented = augment(scenario, placed.mesh, runs);
    machine = scenarios::reduce(augmented.model, scenarios::build(augmented.model, scenarios::place(augmented.model)),
                                augmented.plan);
    twin.emplace(augmented, machine, solver::TransientOptions{});
  }
  AloneTwin(const AloneTwin&) = delete;  // the twin refers to its parts
  AloneTwin& operator=(const AloneTwin&) = delete;
};

/// Records of a truth, a scenario's twin beside them, and what is found.
struct Found {
  std::vector<std::string> records;
  Beside beside;
  Diagnosis d;

  /// @param plain, truth  texts of scenarios
  Found(const std::string& plain, const std::string& truth, const std::string& prefix, const RecordNoise& as = {},
        int most_effects = 3)
      : records(noisy_records(write_file("truth.yaml", truth), prefix, as)),
        beside(write_file("plain.yaml", plain), records),
        d(beside.diagnosed(most_effects)) {}
  /// The scenario's text with the first cause written into it.
  [[nodiscard]] std::string written() const {
    const Claim& claim = d.search.hypothesis.at(0);
    const Eigen::VectorXd x = d.search.fit.x.tail(static_cast<Eigen::Index>(claim.knobs.size()));
    const ExtendedScenario extended =
        extended_scenario(beside.scenario, *beside.twin, beside.runs, {{"it", "because", change_of(claim, x)}}, {});
    EXPECT_TRUE(extended.not_written.empty());
    return extended.text;
  }
  /// With what is written nothing is found any more in the same records. @param words  that are written
  void expect_written_is_found_no_more(const std::string& words = "") const {
    const std::string text = written();
    EXPECT_NE(text.find(words), std::string::npos) << text;
    const Diagnosis again = Beside(write_file("extended.yaml", text), records).diagnosed();
    EXPECT_EQ(again.verdict, Verdict::kConsistent) << again.reason;
  }
};

}  // namespace driftwright::diagnosis
