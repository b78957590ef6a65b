// Possible findings of a diagnosis, written into a scenario file and simulated from it, against the twin with the same
// changes. Its longest part is the table of these findings.

#include "diagnosis/extended_scenario.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "base/errors.hpp"
#include "diagnosis/own_effects.hpp"
#include "diagnosis/scatter.hpp"
#include "machine/as_recorded.hpp"
#include "machine/driven_before.hpp"
#include "machine/machine.hpp"
#include "machine/run_record.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "solver/transient.hpp"
#include "tests/shared/column_and_head.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::diagnosis::extended_scenario_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr solver::TransientOptions kTight{.relative_tolerance = 1e-7, .absolute_tolerance_K = 1e-7};

/// Lumped, in all ways in which a list of effects is written.
constexpr const char* kSpindle = R"(# a comment at the top
name: spindle
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: shaft, capacity: 5 kJ/K}
  # the housing
  - type: node
    node: housing
    capacity: 20 kJ/K   # cast iron
  - {type: bearing_friction, node: shaft, f0: 1.5, viscosity: 30 mm^2/s, mean_diameter: 90 mm, f1: 0.001, load: 500 N}
  - {type: motor_loss, node: housing, power: 150 W, at_speed: 1000 rpm, exponent: 1.5, idle: 30 W}
  - {type: link, node: shaft, to: housing, conductance: 12 W/K}
  - type: link
    node: housing
    to: ambient
    conductance: 9 W/K
  - {type: coolant, node: housing, tank: tank, flow: 2 L/min, passage_conductance: 15 W/K, volume: 10 L, tank_exchange: 8 W/K}
# what follows the list
ambient: [[0 min, 20 degC], [90 min, 22 degC]]
sensors:
  - {name: t_shaft, node: shaft}
  - {name: t_housing, node: housing}
displacements:
  - name: nose
    sensitivities:
      - {node: shaft, sensitivity: 3 um/K}
      - {node: housing, sensitivity: -1 um/K}
cyclograms:
  cycle: [[40 min, 1000 rpm], [20 min, 0 rpm], [30 min, 600 rpm]]
solver: {output_interval: 2 min}
)";

struct Bench {
  scenarios::Scenario scenario;
  std::vector<MeasuredRun> runs;
  AugmentedModel augmented;
  scenarios::ReducedMachine machine;
  std::optional<Twin> twin;
  Eigen::MatrixXd before;  ///< by_twin() as written
};
using Change = std::function<void(TwinState&)>;

/// Readings [K, um], n_outputs x n_times.
Eigen::MatrixXd by_twin(const Bench& b, const Change& change) {
  const Twin& twin = *b.twin;
  TwinState state = twin.as_written();
  change(state);
  Twin::Workspace workspace(twin);
  Eigen::MatrixXd readings = twin.readings(state, b.runs[0], workspace);
  for (Eigen::Index o = 0; o < readings.rows(); ++o) {
    if (twin.outputs().unit[static_cast<std::size_t>(o)] == "m") readings.row(o) *= 1e6;
  }
  return readings;
}

MeasuredRun run_of(const scenarios::Scenario& s) {
  MeasuredRun run;
  run.name = s.cyclograms.front().name;
  run.cyclogram = s.cyclograms.front();
  run.time_s = scenarios::output_times_s(run.cyclogram, s.solver.output_interval_s);
  run.ambient = s.machine->ambient;
  run.grid_s = run.time_s;  // as a simulation, whose readings are linear between its rows
  for (std::size_t i = 0; i < run.time_s.size(); ++i) run.row_in_grid.push_back(static_cast<Eigen::Index>(i));
  return run;
}

std::unique_ptr<Bench> bench(const std::string& path) {
  auto b = std::make_unique<Bench>();
  b->scenario = scenarios::read_scenario(path);
  b->runs = {run_of(b->scenario)};
  const scenarios::PlacedMachine placed = scenarios::place(*b->scenario.machine);
  b->augmented = augment(b->scenario, placed.mesh, b->runs);
  const scenarios::MachineModel& model = b->augmented.model;
  b->machine = scenarios::reduce(model, scenarios::build(model, scenarios::place(model)), b->augmented.plan);
  b->twin.emplace(b->augmented, b->machine, kTight);
  b->before = by_twin(*b, [](TwinState&) {});
  return b;
}
const Bench& spindle() {
  static const auto b = bench(write_file("spindle.yaml", kSpindle));
  return *b;
}
const Bench& column_and_head() {
  static const auto b = [] {
    fixtures::ColumnAndHead what;
    what.effects.emplace_back("{type: natural_convection, surface: front, orientation: vertical, length: 100 mm}");
    return bench(fixtures::write_column_and_head(fresh_folder("extended"), what));
  }();
  return *b;
}

/// An effect as a user would write it.
effects::Effect effect(const std::string& text) {
  return effects::read_effect(ConfigMap::read_file(write_file("one_effect.yaml", text)));
}
Change added(const std::vector<std::string>& entries) {
  return [entries](TwinState& t) {
    for (const std::string& text : entries) t.push_back(effect(text));
  };
}

ExtendedScenario extend(const Bench& b, const Change& change) {
  return extended_scenario(b.scenario, *b.twin, b.runs, {{"the change", "because", change}}, {"head"});
}

/// Readings from a scenario file alone, by the full model; rows of outputs that it has.
Eigen::MatrixXd by_simulation(const std::string& path) {
  const scenarios::Scenario s = scenarios::read_scenario(path);
  const scenarios::MachineModel& model = *s.machine;
  const scenarios::Machine machine = scenarios::build(model, scenarios::place(model));
  const Cyclogram& cyclogram = s.cyclograms.front();
  const MachineRun felt = scenarios::felt_run(model, cyclogram);
  const solver::Trajectory run = solver::simulate(
      machine.system, felt.cyclogram, felt.ambient, scenarios::output_times_s(cyclogram, s.solver.output_interval_s), kTight,
      scenarios::after_what_was_before(machine.system, felt, kTight, scenarios::start_state(model, machine)));
  const Record record = scenarios::as_recorded(model, run, machine.system.outputs, cyclogram);
  const auto& names = machine.system.outputs.name;
  Eigen::MatrixXd readings(static_cast<Eigen::Index>(names.size()), static_cast<Eigen::Index>(record.n_samples()));
  for (Eigen::Index o = 0; o < readings.rows(); ++o) {
    const Channel& c = record.at(names[static_cast<std::size_t>(o)]);
    const double zero = c.unit == "degC" ? model.reference_K - 273.15 : 0.0;
    for (Eigen::Index k = 0; k < readings.cols(); ++k) readings(o, k) = c.values[static_cast<std::size_t>(k)] - zero;
  }
  return readings;
}

struct Case {
  const char* name;
  bool with_mesh;
  Change change;
};
class AFinding : public ::testing::TestWithParam<Case> {};

void expect_runs_as_predicted(const Bench& b, const Case& finding) {
  const ExtendedScenario extended = extend(b, finding.change);
  ASSERT_THAT(extended.not_written, IsEmpty());
  const std::string path = write_file(std::string("elsewhere_") + finding.name + ".yaml", extended.text);
  const Eigen::MatrixXd predicted = by_twin(b, finding.change), simulated = by_simulation(path);
  const auto apart = [&](const Eigen::MatrixXd& x) {
    return (x - predicted.topRows(simulated.rows())).cwiseAbs().maxCoeff();
  };
  const double size = apart(b.before.topRows(simulated.rows()));
  // Six digits of a change of some 10 K or um. The reduced model of the mesh may be off by 8 mK and 16 nm, and by three
  // percent of a change of matrices that its basis was not made for (2.5 % of what another conductivity does).
  const double tolerance = finding.with_mesh ? 0.01 + 0.03 * size : 1e-3;
  EXPECT_LT(apart(simulated), tolerance) << extended.text;
  EXPECT_GT(size, 5.0 * tolerance) << "the change is too small to be tested by";
}

TEST_P(AFinding, WrittenIntoTheScenarioRunsAsTheTwinPredicted) {
  expect_runs_as_predicted(GetParam().with_mesh ? column_and_head() : spindle(), GetParam());
}

const std::vector<Case> kCases = {
    {"constant_heat", false, added({"{type: heat_source, node: shaft, power: 40 W}"})},
    {"cooled", false, added({"{type: heat_source, node: housing, power: -40 W}"})},
    {"heat_by_speed", false, added({"{type: heat_source, node: shaft, power: 40 W, at_speed: 800 rpm, exponent: 1.3}"})},
    {"heat_that_falls_with_speed", false,
     added({"{type: heat_source, node: shaft, power: 40 W, at_speed: 800 rpm, exponent: -0.7}"})},
    {"heat_that_goes_with_the_spindle", false,
     added({"{type: heat_source, node: shaft, power: 40 W, runs: while_spindle_turns}"})},
    {"more_bearing_heat", false, added({"{type: changed_law, law: bearing_friction shaft, factor: 1.6}"})},
    {"heat_in_a_region", true, added({"{type: heat_source, region: column, power: 30 W}"})},
    {"sun_on_a_surface", true, added({"{type: heat_source, surface: front, power: 30 W}"})},
    {"heat_for_a_time", false, added({"{type: heat_source, node: shaft, power: 40 W, from: 10 min, until: 40 min}"})},
    {"heat_in_this_run", false, added({"{type: heat_source, node: shaft, power: 40 W, in: cycle}"})},
    {"heat_in_a_wave", false,
     added({"{type: heat_source, node: shaft, power: 60 W, period: 25 min, delay: 200 s, mean: -10 W, until: 90 min}"})},
    {"a_link_that_loosens", false,
     added({"{type: changed_law, law: link housing - ambient, factor: 0.3, from: 30 min, in: cycle}"})},
    {"a_joint_that_loosens", true, added({"{type: changed_law, law: contact column/head, factor: 0.3, from: 30 min}"})},
    {"another_exponent", false,
     added({"{type: changed_law, law: bearing_friction shaft, factor: 1.2, exponent: 0.6, at_speed: 700 rpm}"})},
    {"heat_that_levels_off", false,
     added({"{type: changed_law, law: motor_loss housing, growth_beyond: 0.1, beyond: 900 rpm}"})},
    {"heat_of_two_laws_that_falls", false,
     added({"{type: changed_law, law: motor_loss housing, exponent: 0.3, at_speed: 700 rpm, decay: 0.03 1/K}"})},
    {"a_path_that_was_missing", false, added({"{type: link, node: shaft, to: ambient, conductance: 3 W/K}"})},
    {"a_hidden_body", false, added({"{type: hidden_body, node: housing, capacity: 30 kJ/K, conductance: 9 W/K}"})},
    {"a_hidden_body_with_a_way_out", false,
     added({"{type: hidden_body, node: shaft, capacity: 4 kJ/K, conductance: 6 W/K, hall_conductance: 2 W/K}"})},
    {"two_hidden_bodies", false,
     added({"{type: hidden_body, node: shaft, capacity: 4 kJ/K, conductance: 6 W/K}",
            "{type: hidden_body, node: housing, capacity: 9 kJ/K, conductance: 6 W/K}"})},
    {"a_hidden_body_behind_a_region", true,
     added({"{type: hidden_body, region: head, capacity: 8 kJ/K, conductance: 9 W/K, hall_conductance: 4 W/K}"})},
    {"another_link", false, added({"{type: changed_law, law: link housing - ambient, factor: 1.7}"})},
    {"a_link_of_another_number", false, [](TwinState& t) { t[5].set("conductance", 15.3); }},
    {"another_coolant", false, [](TwinState& t) { t[6].values[2] *= 2.0; }},
    {"a_coolant_where_there_is_none", false,
     added({"{type: coolant, node: shaft, flow: 100 L/min, passage_conductance: 5 W/K, set_point: 17 degC}"})},
    {"a_coolant_in_a_region", true,
     added({"{type: coolant, region: column, flow: 100 L/min, passage_conductance: 5 W/K, set_point: 12 degC}"})},
    {"a_door", false,
     added({"{type: exchange_window, node: housing, conductance: 20 W/K, windows: [[10 min, 25 min], [50 min, 60 min]]}"})},
    {"a_door_again_and_again", true,
     added({"{type: exchange_window, surface: outside, film: 60 W/(m^2 K), windows: [[5 min, 9 min]], every: 12 min, "
            "until_time: 80 min}"})},
    {"a_pump_for_a_while", false,
     added({"{type: heat_window, node: housing, power: 40 W, windows: [[10 min, 25 min], [50 min, 60 min]]}"})},
    {"another_state_of_running", false,
     added({"{type: run_state, factor: 1.3, in: cycle}", "{type: run_state, of: exchange, factor: 0.8, in: cycle}"})},
    {"another_film", true, added({"{type: changed_law, law: convection outside, factor: 1.8}"})},
    {"a_film_by_formula", true, added({"{type: changed_law, law: natural_convection front, factor: 3}"})},
    {"a_film_by_formula_of_another_factor", true, [](TwinState& t) { t.back().set("factor", 3.0); }},
    {"another_joint", true, added({"{type: changed_law, law: contact column/head, factor: 0.5}"})},
    {"a_draught_from_a_time_on", true, added({"{type: changed_law, law: convection outside, factor: 3, from: 30 min}"})},
    {"a_film_that_grows", true,
     added({"{type: forced_convection, surface: outside, growth: 20 W/(m^2 K), at_speed: 800 rpm, exponent: 0.8}"})},
    {"another_capacity", false, added({"{type: heat_capacity, node: housing, factor: 1.5}"})},
    {"a_capacity_of_another_number", false, [](TwinState& t) { t[1].set("capacity", 3e4); }},
    {"another_sensitivity", false, added({"{type: expansion, node: shaft, factor: 1.4, displacement: nose}"})},
    {"another_conductivity", true, added({"{type: conductivity, region: column, factor: 0.6}"})},
    {"another_heat_capacity", true, added({"{type: heat_capacity, region: head, factor: 1.5}"})},
    {"another_expansion", true, added({"{type: expansion, region: head, factor: 1.6}"})},
    {"stratified_air", true, added({"{type: stratification, gradient: 5 K/m, level: -0.5 m}"})},
    {"heat_behind_each_stop", false,
     added({"{type: heat_source, node: housing, power: 50 W, at_speed: 900 rpm, exponent: 2, runs: while_spindle_stands, "
            "lasts: 7 min}"})},
    {"heat_that_runs_on", false,
     added({"{type: heat_source, node: housing, power: 50 W, runs: while_spindle_turns, runs_on: 7 min}"})},
    {"a_warm_start", false, added({"{type: run_state, warmed_up: 40 min, rested: 6 min, in: cycle}"})},
    {"a_warm_start_beside_what_goes_by_the_clock", false,
     added({"{type: run_state, warmed_up: 40 min, rested: 6 min, in: cycle}",
            "{type: heat_source, node: shaft, power: 200 W, from: 20 min}",
            "{type: heat_source, node: shaft, power: 200 W, fades: 15 min}"})},
    {"a_warm_start_of_a_mesh", true, added({"{type: run_state, warmed_up: 40 min, in: cycle}"})},
    {"an_axis_that_holds_a_weight", false,
     added({"{type: servo_loss, node: housing, power: 0 W, at_feed: 0.1 m/s, holding: 20 W, axis: x}"})},
    {"ambient_offset", false, added({"{type: ambient, offset: 1.5 K}"})},
    {"ambient_of_a_late_clock", false, added({"{type: ambient, late: 7 min}"})},
    {"ambient_of_a_slow_thermometer", false, added({"{type: ambient, lag: 7 min, in: cycle}"})},
    {"ambient_with_speed", false, added({"{type: ambient, with_speed: 1.5 K, at_speed: 700 rpm, behind: 12 min}"})},
    {"ambient_step_and_ramp", false, added({"{type: ambient, offset: 1.5 K, ramp: 1 K/h, from: 20 min, in: cycle}"})},
    {"other_speed", false, added({"{type: speed_override, factor: 1.2}"})},
    {"a_stop", false, added({"{type: missing_stop, start: 10 min, length: 15 min, in: cycle}"})},
    {"growth", false, added({"{type: spindle_growth, displacement: nose, growth: 5 um, at_speed: 800 rpm, lag: 8 min}"})},
    {"centrifugal", false, added({"{type: centrifugal, displacement: nose, growth: 5 um, at_speed: 800 rpm}"})},
    {"a_late_scale", false, added({"{type: scale_expansion, displacement: nose, factor: 0.8, lag: 10 min}"})},
    {"a_late_probe", false, added({"{type: probe_lag, displacement: nose, lag: 0.3 ms, feed: 1000 mm/min}"})},
    {"a_shift", false, added({"{type: mount_shift, displacement: nose, shift: 4 um, time: 30 min, in: cycle}"})},
    {"a_loose_sensor", false, added({"{type: sensor_detached, sensor: t_shaft, share: 0.4, time: 25 min, in: cycle}"})},
    {"a_late_sensor", false, added({"{type: sensor_lag, sensor: t_shaft, lag: 5 min}"})},
    {"a_wrong_sensor", false,
     added({"{type: sensor_bias, sensor: t_shaft, bias: 0.7 K, in: cycle}",
            "{type: sensor_drift, sensor: t_shaft, drift: 1 K/h}"})},
    {"swapped", false, added({"{type: sensor_swap, sensor: t_shaft, with: t_housing}"})},
    {"a_late_clock", false, added({"{type: clock_offset, offset: 4 min}"})},
};
INSTANTIATE_TEST_SUITE_P(All, AFinding, ::testing::ValuesIn(kCases), [](const auto& i) { return i.param.name; });

TEST(AnotherRun, WhatHappenedInItDoesNothingHere) {
  for (const char* text :
       {"{type: heat_source, node: shaft, power: 40 W, in: tuesday}", "{type: ambient, offset: 2 K, in: tuesday}",
        "{type: sensor_bias, sensor: t_shaft, bias: 1 K, in: tuesday}", "{type: speed_override, factor: 2, in: tuesday}",
        "{type: changed_law, law: link housing - ambient, factor: 3, in: tuesday}",
        "{type: exchange_window, node: shaft, conductance: 9 W/K, windows: [[0 min, 90 min]], in: tuesday}"}) {
    EXPECT_EQ(by_twin(spindle(), added({text})), spindle().before) << text;
  }
}

/// A head whose displacement has a screw beside the mesh, and the column's growth against the screw.
const Bench& semi_closed() {
  static const auto b = [] {
    fixtures::ColumnAndHead what;
    what.effects.insert(what.effects.end(),
                        {"{type: node, node: screw, capacity: 1.8 kJ/K}", "{type: heat_source, node: screw, power: 20 W}",
                         "{type: link, node: screw, to: ambient, conductance: 2 W/K}"});
    const std::string path = fixtures::write_column_and_head(fresh_folder("semi_closed"), what);
    std::string text = what.text();
    text.insert(text.find("}\ncyclograms:"),
                ", sensitivities: [{node: screw, sensitivity: -5.75 um/K}, {region: column, sensitivity: 5.5 um/K}]");
    std::ofstream(path) << text;
    return bench(path);
  }();
  return *b;
}

TEST(SemiClosedAxis, FindingsOfScrewAndColumnRunAsTheTwinPredicted) {
  expect_runs_as_predicted(
      semi_closed(), {"a_longer_screw", true, added({"{type: expansion, node: screw, factor: 1.4, displacement: z}"})});
  expect_runs_as_predicted(semi_closed(),
                           {"a_growing_column", true, added({"{type: expansion, region: column, factor: 1.6}"})});
}

TEST(SemiClosedAxis, TheScrewIsUncertainByItsSensitivityAndTheColumnByItsExpansionOnce) {
  const Twin& twin = *semi_closed().twin;
  std::vector<std::string> expansions;
  for (const Knob& k : scatter(twin)) {
    if (k.effect != "expansion") continue;
    TwinState state = twin.as_written();
    k.set(state, 1.1);
    expansions.push_back(k.where + " " + state.back().words.at("displacement"));
  }
  EXPECT_THAT(expansions, ::testing::UnorderedElementsAre("column ", "head ", "screw z"));
}

TEST(SemiClosedAxis, APathThatWasMissingRunsAsTheTwinPredicted) {
  expect_runs_as_predicted(semi_closed(),
                           {"a_path", true, added({"{type: link, region: column, to: screw, conductance: 6 W/K}"})});
}

/// A machine that starts from its steady state, and one in air that is written as warmer above.
const Bench& written_with(const std::string& start, const std::string& effect) {
  static std::vector<std::unique_ptr<Bench>> all;
  fixtures::ColumnAndHead what;
  what.start = start;
  if (!effect.empty()) what.effects.push_back(effect);
  all.push_back(bench(fixtures::write_column_and_head(fresh_folder("written_" + std::to_string(all.size())), what)));
  return *all.back();
}

TEST(AHiddenBody, StartsSteadyAsTheRest) {
  for (const char* body :
       {"{type: hidden_body, region: head, capacity: 8 kJ/K, conductance: 9 W/K}",
        "{type: hidden_body, region: head, capacity: 8 kJ/K, conductance: 9 W/K, hall_conductance: 4 W/K}"}) {
    expect_runs_as_predicted(written_with("steady", "{type: heat_source, region: column, power: 25 W}"),
                             {"steady", true, added({body})});
  }
}

TEST(WrittenStratification, OfAnotherGradientRunsAsTheTwinPredicted) {
  const Bench& b = written_with("ambient", "{type: stratification, gradient: 1 K/m, level: 0.1 m}");
  expect_runs_as_predicted(b, {"gradient", true, [](TwinState& t) { t.back().set("gradient", 13.0); }});
  expect_runs_as_predicted(b, {"level", true, [](TwinState& t) {
                                 t.back().set("gradient", 13.0);
                                 t.back().set("level", -0.4);
                               }});
}

TEST(ExtendedScenario, KeepsCommentsAndSaysWhatItChanged) {
  const ExtendedScenario e = extend(spindle(), [](TwinState& t) { t[5].set("conductance", 18.0); });
  EXPECT_THAT(e.text, AllOf(HasSubstr("# head\n"), HasSubstr("# a comment at the top"), HasSubstr("# cast iron"),
                            HasSubstr("    conductance: 18 W/K   # diagnosis: conductance was 9 W/K; because\n")));
}

TEST(OwnEffects, AreCalledAsTheFileCallsThem) {
  const Twin& twin = *spindle().twin;
  const auto called = [&](const Change& change) { return own_effects(twin.as_written(), change); };
  EXPECT_EQ(called([](TwinState& t) { t[5].set("conductance", 18.0); }), "link at housing,ambient, line 14");
  EXPECT_EQ(called(added({"{type: changed_law, law: bearing_friction shaft, factor: 1.6}"})),
            "bearing_friction at shaft, line 11");
  EXPECT_EQ(called(added({"{type: changed_law, law: link housing - ambient, factor: 1.7}"})),
            "link at housing,ambient, line 14");
  EXPECT_EQ(called(added({"{type: changed_law, law: bearing_friction shaft, factor: 1.6}",
                          "{type: changed_law, law: motor_loss housing, factor: 1.6}"})),
            "bearing_friction at shaft, line 11 and motor_loss at housing, line 12");
  EXPECT_EQ(called(added({"{type: heat_capacity, node: housing, factor: 1.5}"})), "node at housing, line 8");
  EXPECT_EQ(called(added({"{type: heat_source, node: shaft, power: 40 W}"})), "");
  EXPECT_EQ(called(added({"{type: expansion, node: shaft, factor: 1.4, displacement: nose}"})), "");
}

TEST(ExtendedScenario, KeepsTheUnitOfTheFileAndWritesTemperaturesWhole) {
  const ExtendedScenario e = extend(spindle(), [](TwinState& t) { t[0].values[0] *= 1.5; });  // 5 kJ/K, held in J/K
  EXPECT_THAT(e.text, HasSubstr("capacity: 7.5 kJ/K"));
}

TEST(ExtendedScenario, WritesAFactorOnTheCapacityOfANodeAsItsCapacity) {
  const ExtendedScenario e = extend(spindle(), added({"{type: heat_capacity, node: housing, factor: 1.53}"}));
  EXPECT_THAT(e.text,
              AllOf(HasSubstr("    capacity: 30.6 kJ/K   # cast iron   # diagnosis: capacity was 20 kJ/K; because\n"),
                    ::testing::Not(HasSubstr("heat_capacity"))));
}

TEST(ExtendedScenario, AppendsBehindTheLastEffectAndBeforeWhatFollows) {
  const ExtendedScenario e = extend(spindle(), added({"{type: heat_source, node: shaft, power: 40 W}"}));
  EXPECT_THAT(
      e.text,
      HasSubstr("tank_exchange: 8 W/K}\n  - {type: heat_source, node: shaft, power: 40 W}   # because\n# what follows"));
}

TEST(ExtendedScenario, FilesAreFoundFromAnyFolder) {
  const ExtendedScenario e = extend(column_and_head(), added({"{type: stratification, gradient: 1 K/m}"}));
  const auto folder = std::filesystem::path(column_and_head().scenario.path).parent_path();
  EXPECT_THAT(e.text, HasSubstr("mesh: \"" + (folder / "machine.inp").string() + "\""));
}

TEST(ExtendedScenario, AddsTheMeasuredRunThatAChangeHappenedIn) {
  const Bench& b = spindle();
  std::vector<MeasuredRun> runs = {b.runs[0], b.runs[0]};
  runs[1].name = "tuesday";
  runs[1].path = write_file("tuesday.csv", "time_s,speed_rpm\n0,1000\n60,0\n120,0\n");
  const StatedChange stated{"the change", "because", added({"{type: ambient, offset: 1 K, in: tuesday}"})};
  const ExtendedScenario e = extended_scenario(b.scenario, *b.twin, runs, {stated}, {});
  EXPECT_THAT(e.not_written, IsEmpty());
  const scenarios::Scenario read = scenarios::read_scenario(write_file("with_tuesday.yaml", e.text));
  EXPECT_EQ(read.cyclogram("tuesday").duration_s(), 120.0);
  EXPECT_EQ(read.machine->effects.back().in, "tuesday");
}

TEST(ExtendedScenario, TheMeasuredRunOfALoggersFileComesWithTheColumnsThatItIsReadBy) {
  std::string text = kSpindle;
  text +=
      "columns:\n  separator: \";\"\n  decimal: \",\"\n  time: {column: Zeit, format: \"%d.%m.%Y %H:%M:%S\"}\n"
      "  channels:\n    speed: {column: \"Spindel [1/min]\", unit: rpm, magnitude: true}\n"
      "    t_shaft: {column: \"T1 (°C)\", unit: degC}\n";
  const auto b = bench(write_file("raw.yaml", text));
  std::vector<MeasuredRun> runs = {b->runs[0], b->runs[0]};
  runs[1].name = "montag";
  runs[1].path = write_file("montag.csv",
                            "Zeit;Spindel [1/min];T1 (°C)\n02.11.2026 07:30:00;-1000,5;20,1\n02.11.2026 07:31:00;0;20,2\n"
                            "02.11.2026 07:32:00;0;20,3\n");
  const StatedChange stated{"the change", "because", added({"{type: ambient, offset: 1 K, in: montag}"})};
  const ExtendedScenario e = extended_scenario(b->scenario, *b->twin, runs, {stated}, {});
  const scenarios::Scenario read = scenarios::read_scenario(write_file("with_montag.yaml", e.text));
  EXPECT_EQ(read.cyclogram("montag").duration_s(), 120.0);
  EXPECT_EQ(read.cyclogram("montag").sections.front().drive.speed_rpm, 1000.5);
  runs[1].path = write_file("tuesday_plain.csv",
                            "time_s,speed_rpm\n0,1000\n60,0\n120,0\n");  // as a program may have read it, without the map
  const ExtendedScenario plain = extended_scenario(b->scenario, *b->twin, runs, {stated}, {});
  EXPECT_EQ(scenarios::read_scenario(write_file("with_plain.yaml", plain.text)).cyclogram("montag").duration_s(), 120.0);
}

TEST(ExtendedScenario, AFileInWhichMuchStandsInQuotesIsEditedInPlace) {
  fixtures::ColumnAndHead what;
  what.effects.back() = "{type: contact, joint: \"column/head\", conductance: '2000 W/(m^2 K)'}";
  const auto folder = fresh_folder("quoted");
  const std::string path = fixtures::write_column_and_head(folder, what);
  std::string text = what.text() + "# at the end\n";
  for (const std::string& file : {std::string("machine.inp")})
    text.replace(text.find(file), file.size(), "\"" + file + "\"");
  std::ofstream(path) << text;
  const auto b = bench(path);
  const ExtendedScenario e = extend(*b, [](TwinState& t) { t[2].set("conductance", 3000.0); });
  EXPECT_THAT(e.text, AllOf(HasSubstr("mesh: \"" + (folder / "machine.inp").string() + "\""), HasSubstr("# at the end"),
                            HasSubstr("joint: \"column/head\", conductance: 3000 W/(m^2 K)}"),
                            ::testing::Not(HasSubstr("written anew"))));
}

/// The spindle with its last link in a writing that leaves no room for an edit.
void expect_written_all_the_same(const std::string& name, const std::string& link, const std::string& anchor) {
  std::string text = kSpindle;
  const std::string was = "  - type: link\n    node: housing\n    to: ambient\n    conductance: 9 W/K\n";
  text.replace(text.find(was), was.size(), link);
  text.insert(text.find("12 W/K"), anchor);
  const auto b = bench(write_file(name + ".yaml", text));
  const Change change = [](TwinState& t) { t[5].set("conductance", 15.3); };
  expect_runs_as_predicted(*b, {name.c_str(), false, change});
  const ExtendedScenario e = extend(*b, change);
  const auto read = scenarios::read_scenario(write_file(name + "_extended.yaml", e.text)).machine->effects;
  std::vector<double> conductances;
  for (const effects::Effect& one : read) {
    if (one.kind->key == "link") conductances.push_back(one["conductance"]);
  }
  EXPECT_THAT(conductances, ::testing::UnorderedElementsAre(12.0, 15.3)) << e.text;
}

TEST(ExtendedScenario, WritesWhereANumberStandsInQuotes) {
  expect_written_all_the_same("quoted", "  - {type: link, node: housing, to: ambient, conductance: \"9 W/K\"}\n", "");
}
TEST(ExtendedScenario, WritesWhereANumberIsAnAlias) {
  expect_written_all_the_same("aliased", "  - {type: link, node: housing, to: ambient, conductance: *way}\n", "&way ");
}

TEST(ExtendedScenario, WritesIntoAListInBracketsThatEndsWithACommaAndBeforeTheEndOfTheDocument) {
  const std::string text = R"(name: flow
reference_temperature: 20 degC
machine: {generator: lumped}
ambient: [[0 min, 20 degC], [90 min, 22 degC]]
sensors: [{name: t, node: a}]
cyclograms: {cycle: [[40 min, 1000 rpm], [20 min, 0 rpm]]}
solver: {output_interval: 2 min}
)";
  const std::string effects =
      "{type: node, node: a, capacity: 5 kJ/K}, {type: link, node: a, to: ambient, conductance: 9 W/K}";
  const std::vector<std::string> lists = {"effects: [" + effects + ",   # the last\n]\n", "effects: [" + effects + "]\n",
                                          "effects:\n  - {type: node, node: a, capacity: 5 kJ/K}\n  - {type: link, node: a, "
                                          "to: ambient, conductance: 9 W/K}\n...\n"};
  for (const std::string& list : lists) {
    const auto b = bench(write_file("flow.yaml", text + list));
    expect_runs_as_predicted(*b, {"flow", false, added({"{type: heat_source, node: a, power: 40 W}"})});
  }
}

TEST(ExtendedScenario, StartsInTheAmbientThatTheRunReallyHad) {
  std::string text = kSpindle;
  text.insert(text.find("ambient: [["), "start: ambient\n");
  const auto b = bench(write_file("in_the_ambient.yaml", text));
  const Change change = added({"{type: ambient, offset: 3 K, in: cycle}"});
  const ExtendedScenario e = extend(*b, change);
  const scenarios::Scenario s = scenarios::read_scenario(write_file("in_the_ambient_extended.yaml", e.text));
  EXPECT_NEAR(scenarios::warmer_start_K(*s.machine, s.cyclograms.front()), 3.0, 1e-12);
  Cyclogram another = s.cyclograms.front();
  another.name = "another";
  EXPECT_EQ(scenarios::warmer_start_K(*s.machine, another), 0.0);
  EXPECT_NEAR(by_twin(*b, change)(0, 0), 3.0, 1e-9);
}

const std::string kWarm = "{type: run_state, warmed_up: 40 min, rested: 5 min, in: cycle}";

TEST(AMachineThatHadRun, IsWarmerByWhatFirstReadingsSayAtTheStartOfTheRecord) {
  const Twin& twin = *spindle().twin;
  TwinState state = twin.as_written();
  state.push_back(effect(kWarm));
  Twin::Workspace workspace(twin);
  MeasuredRun run = spindle().runs[0];
  const Eigen::VectorXd without = twin.states(state, run, workspace).col(0);
  run.start_K = Eigen::VectorXd::Constant(twin.warmer_bodies().cols(), 2.0);
  const Eigen::VectorXd expected = without + twin.warmer_bodies() * run.start_K;
  EXPECT_LT((twin.states(state, run, workspace).col(0) - expected).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_GT((without - twin.states(twin.as_written(), spindle().runs[0], workspace).col(0)).cwiseAbs().maxCoeff(), 0.1);
}

TEST(AMachineThatHadRun, KnowsNothingBeforeOfWhatGoesByATimeOfTheRecord) {
  const std::string pump = "{type: heat_source, node: shaft, power: 400 W, from: 20 min}";
  EXPECT_LT(
      (by_twin(spindle(), added({kWarm, pump})).col(0) - by_twin(spindle(), added({kWarm})).col(0)).cwiseAbs().maxCoeff(),
      1e-9);
}

TEST(AMachineThatHadRun, IsRefusedByWhatBeginsEveryCyclogramAtTheStart) {
  std::string text = kSpindle;
  text.insert(text.find("ambient: [["), "  - " + kWarm + "\n");
  const scenarios::Scenario s = scenarios::read_scenario(write_file("warm_before.yaml", text));
  EXPECT_REFUSED(scenarios::require_nothing_before(*s.machine, "sweep"), "`sweep` begins every cyclogram");
}

}  // namespace
}  // namespace driftwright::diagnosis::extended_scenario_test
