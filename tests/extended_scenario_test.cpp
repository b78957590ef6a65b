// What a diagnosis may find, written into a scenario file and simulated from there, against the twin that was told it.

#include "diagnosis/extended_scenario.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "diagnosis/scatter.hpp"
#include "scenarios/as_recorded.hpp"
#include "scenarios/machine.hpp"
#include "solver/transient.hpp"
#include "tests/column_and_head.hpp"

namespace driftwright::diagnosis {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

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
    to: hall
    conductance: 9 W/K
  - {type: coolant, node: housing, tank: tank, flow: 2 L/min, passage_conductance: 15 W/K, volume: 10 L, tank_exchange: 8 W/K}
# what follows the list
hall: [[0 min, 20 degC], [90 min, 22 degC]]
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
};

MeasuredRun run_of(const scenarios::Scenario& s) {
  MeasuredRun run;
  run.name = s.cyclograms.front().name;
  run.cyclogram = s.cyclograms.front();
  run.time_s = scenarios::output_times_s(run.cyclogram, s.solver.output_interval_s);
  run.hall = s.machine->hall;
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

ExtendedScenario extend(const Bench& b, const std::function<void(TwinState&)>& change) {
  const Twin twin(b.augmented, b.machine, kTight);
  StatedChange stated{"the change", "because", twin.as_written()};
  change(stated.state);
  return extended_scenario(b.scenario, twin, b.runs, {stated}, {"head"});
}

/// Readings [K, um], n_outputs x n_times.
Eigen::MatrixXd by_twin(const Bench& b, const std::function<void(TwinState&)>& change) {
  const Twin twin(b.augmented, b.machine, kTight);
  TwinState state = twin.as_written();
  change(state);
  Twin::Workspace workspace(twin);
  Eigen::MatrixXd readings = twin.read(state, b.runs[0], twin.respond(state, b.runs[0], workspace));
  for (Eigen::Index o = 0; o < readings.rows(); ++o) {
    if (twin.outputs().unit[static_cast<std::size_t>(o)] == "m") readings.row(o) *= 1e6;
  }
  return readings;
}
/// The same from a scenario file alone, by the full model; rows of outputs that it has.
Eigen::MatrixXd by_simulation(const std::string& path) {
  const scenarios::Scenario s = scenarios::read_scenario(path);
  const scenarios::MachineModel& model = *s.machine;
  const scenarios::Machine machine = scenarios::build(model, scenarios::place(model));
  const Cyclogram& cyclogram = s.cyclograms.front();
  const scenarios::FeltRun felt = scenarios::felt_run(model, cyclogram);
  const solver::Trajectory run = solver::simulate(machine.system, felt.cyclogram, felt.hall,
                                                  scenarios::output_times_s(cyclogram, s.solver.output_interval_s), kTight,
                                                  scenarios::start_state(model, machine));
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
  std::function<void(TwinState&)> change;
};
class AFinding : public ::testing::TestWithParam<Case> {};

void expect_runs_as_predicted(const Bench& b, const Case& finding) {
  const ExtendedScenario extended = extend(b, finding.change);
  ASSERT_THAT(extended.not_written, IsEmpty());
  const std::string path = write_file(std::string("elsewhere_") + finding.name + ".yaml", extended.text);
  const Eigen::MatrixXd predicted = by_twin(b, finding.change), simulated = by_simulation(path),
                        before = by_twin(b, [](TwinState&) {});
  const auto apart = [&](const Eigen::MatrixXd& x) {
    return (x - predicted.topRows(simulated.rows())).cwiseAbs().maxCoeff();
  };
  const double size = apart(before.topRows(simulated.rows()));
  // Five digits of a change of some 10 K or um make 0.5 mK. The reduced model of the mesh may be off by 8 mK and 16 nm, and by three
  // percent of a change of matrices that its basis was not made for (2.5 % of what another conductivity does).
  const double tolerance = finding.with_mesh ? 0.01 + 0.03 * size : 2e-3;
  EXPECT_LT(apart(simulated), tolerance) << extended.text;
  EXPECT_GT(size, 5.0 * tolerance) << "the change is too small to be tested by";
}

TEST_P(AFinding, WrittenIntoTheScenarioRunsAsTheTwinPredicted) {
  expect_runs_as_predicted(GetParam().with_mesh ? column_and_head() : spindle(), GetParam());
}

AddedHeat heat(const effects::Body& body, double power_W, AddedHeat::Shape shape) {
  AddedHeat h{.body = body, .power_W = power_W, .shape = shape};
  h.at_speed_rpm = 800.0;
  h.exponent = 1.3;
  return h;
}
ChangedExchange exchange(const std::string& name, double factor) {
  ChangedExchange c;
  c.name = name;
  c.factor = factor;
  return c;
}
std::function<void(TwinState&)> added_heat(const effects::Body& body, double power_W, AddedHeat::Shape shape) {
  return [=](TwinState& t) { t.heats.push_back(heat(body, power_W, shape)); };
}
std::function<void(TwinState&)> with_reading(std::function<void(effects::ReadingChain&)> change) {
  return [change](TwinState& t) { change(t.readings); };
}
std::function<void(TwinState&)> with_drive(std::function<void(effects::DriveChange&)> change) {
  return [change](TwinState& t) { change(t.drive); };
}

using Shape = AddedHeat::Shape;
const std::vector<Case> kCases = {
    {"constant_heat", false, added_heat(effects::node("shaft"), 40.0, Shape::kConstant)},
    {"cooled", false, added_heat(effects::node("housing"), -40.0, Shape::kConstant)},
    {"heat_by_speed", false, added_heat(effects::node("shaft"), 40.0, Shape::kPower)},
    {"more_bearing_heat", false, added_heat(effects::node("shaft"), 30.0, Shape::kAsWritten)},
    {"more_motor_heat", false, added_heat(effects::node("housing"), 30.0, Shape::kAsWritten)},
    {"heat_in_a_region", true, added_heat(effects::region("column"), 30.0, Shape::kConstant)},
    {"sun_on_a_surface", true, added_heat(effects::surface("front"), 30.0, Shape::kConstant)},
    {"more_region_heat", true, added_heat(effects::region("head"), 30.0, Shape::kAsWritten)},
    {"heat_for_a_time", false,
     [](TwinState& t) {
       t.heats.push_back(heat(effects::node("shaft"), 40.0, Shape::kConstant));
       t.heats.back().from_s = 600.0;
       t.heats.back().until_s = 2400.0;
     }},
    {"heat_in_a_wave", false,
     [](TwinState& t) {
       t.heats.push_back(heat(effects::node("shaft"), 60.0, Shape::kPeriodic));
       t.heats.back().period_s = 1500.0;
       t.heats.back().delay_s = 200.0;
       t.heats.back().mean_W = -10.0;
     }},
    {"a_link_that_loosens", false,
     [](TwinState& t) {
       t.exchanges.push_back(exchange("link housing - hall", 0.3));
       t.exchanges.back().from_s = 1800.0;
     }},
    {"a_joint_that_loosens", true,
     [](TwinState& t) {
       t.exchanges.push_back(exchange("contact column/head", 0.3));
       t.exchanges.back().from_s = 1800.0;
     }},
    {"another_exponent", false,
     [](TwinState& t) {
       t.frictions.push_back(
           {.body = effects::node("shaft"), .factor = 1.2, .change_of_exponent = 0.6, .at_speed_rpm = 700.0});
     }},
    {"friction_that_falls", false,
     [](TwinState& t) {
       t.frictions.push_back({.body = effects::node("housing"), .at_speed_rpm = 700.0, .decay_1_K = 0.03, .at_K = 293.15});
     }},
    {"another_link", false, [](TwinState& t) { t.exchanges.push_back(exchange("link housing - hall", 1.7)); }},
    {"another_coolant", false, [](TwinState& t) { t.effects[6].values[2] *= 2.0; }},
    {"another_film", true, [](TwinState& t) { t.exchanges.push_back(exchange("convection outside", 1.8)); }},
    {"another_joint", true, [](TwinState& t) { t.exchanges.push_back(exchange("contact column/head", 0.5)); }},
    {"a_draught_from_a_time_on", true,
     [](TwinState& t) {
       t.exchanges.push_back(exchange("convection outside", 3.0));
       t.exchanges.back().from_s = 1800.0;
     }},
    {"a_film_that_grows", true,
     [](TwinState& t) {
       t.exchanges.push_back({.name = "convection outside", .growth = 20.0, .at_speed_rpm = 800.0, .exponent = 0.8});
     }},
    {"another_capacity", false, [](TwinState& t) { t.bodies.push_back({.body = "housing", .heat_capacity = 1.5}); }},
    {"another_sensitivity", false,
     [](TwinState& t) { t.bodies.push_back({.body = "shaft", .expansion = 1.4, .displacement = "nose"}); }},
    {"another_conductivity", true, [](TwinState& t) { t.bodies.push_back({.body = "column", .conductivity = 0.6}); }},
    {"another_heat_capacity", true, [](TwinState& t) { t.bodies.push_back({.body = "head", .heat_capacity = 1.5}); }},
    {"another_expansion", true, [](TwinState& t) { t.bodies.push_back({.body = "head", .expansion = 1.6}); }},
    {"stratified_air", true,
     [](TwinState& t) {
       t.gradient_K_m = 5.0;
       t.level_m = -0.5;
     }},
    {"hall_offset", false, with_drive([](auto& d) { d.hall.push_back({.offset_K = 1.5}); })},
    {"hall_step_and_ramp", false, with_drive([](auto& d) {
       d.hall.push_back({1.5, 1.0 / 3600.0, 1200.0, "cycle"});
     })},
    {"other_speed", false, with_drive([](auto& d) { d.speed_factor = 1.2; })},
    {"a_stop", false, with_drive([](auto& d) {
       d.stops.push_back({600.0, 900.0, "cycle"});
     })},
    {"growth", false, with_reading([](auto& r) {
       r.growths.push_back({"nose", 5e-6, 800.0, 1.0, 480.0});
     })},
    {"centrifugal", false, with_reading([](auto& r) {
       r.growths.push_back({"nose", 5e-6, 800.0, 2.0, 0.0});
     })},
    {"a_late_scale", false, with_reading([](auto& r) {
       r.scales.push_back({"nose", 0.8, 600.0});
     })},
    {"a_shift", false, with_reading([](auto& r) {
       r.shifts.push_back({"nose", 4e-6, 1800.0, "cycle"});
     })},
    {"a_loose_sensor", false, with_reading([](auto& r) {
       r.detachments.push_back({"t_shaft", 0.4, 1500.0, "cycle"});
     })},
    {"a_late_sensor", false, with_reading([](auto& r) {
       r.lags.push_back({"t_shaft", 300.0});
     })},
    {"a_wrong_sensor", false, with_reading([](auto& r) {
       r.errors.push_back({"t_shaft", 0.7, 1.0 / 3600.0});
     })},
    {"swapped", false, with_reading([](auto& r) {
       r.swaps.push_back({"t_shaft", "t_housing"});
     })},
    {"a_late_clock", false, with_reading([](auto& r) { r.clock_offset_s = 240.0; })},
};
INSTANTIATE_TEST_SUITE_P(All, AFinding, ::testing::ValuesIn(kCases), [](const auto& i) { return i.param.name; });

/// A head whose displacement has a screw beside the mesh, and the column's growth against the screw.
const Bench& semi_closed() {
  static const auto b = [] {
    fixtures::ColumnAndHead what;
    what.effects.insert(what.effects.end(),
                        {"{type: node, node: screw, capacity: 1.8 kJ/K}", "{type: heat_source, node: screw, power: 20 W}",
                         "{type: link, node: screw, to: hall, conductance: 2 W/K}"});
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
  expect_runs_as_predicted(semi_closed(), {"a_longer_screw", true, [](TwinState& t) {
                                             t.bodies.push_back({.body = "screw", .expansion = 1.4, .displacement = "z"});
                                           }});
  expect_runs_as_predicted(semi_closed(), {"a_growing_column", true,
                                           [](TwinState& t) { t.bodies.push_back({.body = "column", .expansion = 1.6}); }});
}

TEST(SemiClosedAxis, TheScrewIsUncertainByItsSensitivityAndTheColumnByItsExpansionOnce) {
  const Twin twin(semi_closed().augmented, semi_closed().machine, kTight);
  std::vector<std::string> expansions;
  for (const Knob& k : scatter(twin)) {
    if (k.effect != "expansion") continue;
    TwinState state = twin.as_written();
    k.set(state, 1.1);
    expansions.push_back(k.where + " " + state.bodies.back().displacement);
  }
  EXPECT_THAT(expansions, ::testing::UnorderedElementsAre("column ", "head ", "screw z"));
}

TEST(ExtendedScenario, KeepsCommentsAndSaysWhatItChanged) {
  const ExtendedScenario e =
      extend(spindle(), [](TwinState& t) { t.exchanges.push_back(exchange("link housing - hall", 2.0)); });
  EXPECT_THAT(e.text, AllOf(HasSubstr("# head\n"), HasSubstr("# a comment at the top"), HasSubstr("# cast iron"),
                            HasSubstr("    conductance: 18 W/K   # diagnosis: conductance was 9 W/K; because\n")));
}

TEST(ExtendedScenario, AppendsBehindTheLastEffectAndBeforeWhatFollows) {
  const ExtendedScenario e = extend(spindle(), added_heat(effects::node("shaft"), 40.0, Shape::kConstant));
  EXPECT_THAT(
      e.text,
      HasSubstr("tank_exchange: 8 W/K}\n  - {type: heat_source, node: shaft, power: 40 W}   # because\n# what follows"));
}

TEST(ExtendedScenario, FilesAreFoundFromAnyFolder) {
  const ExtendedScenario e = extend(column_and_head(), [](TwinState& t) { t.gradient_K_m = 1.0; });
  const auto folder = std::filesystem::path(column_and_head().scenario.path).parent_path();
  EXPECT_THAT(e.text, HasSubstr("mesh: \"" + (folder / "machine.inp").string() + "\""));
}

TEST(ExtendedScenario, AddsTheMeasuredRunThatAChangeHappenedIn) {
  const Bench& b = spindle();
  std::vector<MeasuredRun> runs = {b.runs[0], b.runs[0]};
  runs[1].name = "tuesday";
  runs[1].path = write_file("tuesday.csv", "time_s,speed_rpm\n0,1000\n60,0\n120,0\n");
  const Twin twin(b.augmented, b.machine, kTight);
  StatedChange stated{"the change", "because", twin.as_written()};
  stated.state.readings.shifts.push_back({"nose", 4e-6, 60.0, "tuesday"});
  const ExtendedScenario e = extended_scenario(b.scenario, twin, runs, {stated}, {});
  EXPECT_THAT(e.not_written, IsEmpty());
  const scenarios::Scenario read = scenarios::read_scenario(write_file("with_tuesday.yaml", e.text));
  EXPECT_EQ(read.cyclogram("tuesday").duration_s(), 120.0);
  EXPECT_EQ(read.machine->effects.back().words.at("in"), "tuesday");
}

void expect_not_written(const ExtendedScenario& e, const std::string& why, const Bench& b) {
  ASSERT_THAT(e.not_written, SizeIs(1));
  EXPECT_THAT(e.not_written[0], HasSubstr(why));
  EXPECT_THAT(e.text, HasSubstr("# NOT WRITTEN: the change: "));
  // and nothing of it is: the effects are those of the scenario
  const std::string path = write_file("not_written.yaml", e.text);
  EXPECT_THAT(scenarios::read_scenario(path).machine->effects, SizeIs(b.scenario.machine->effects.size()));
}

TEST(ExtendedScenario, SaysWhatTheCatalogueCannotExpress) {
  expect_not_written(
      extend(column_and_head(), [](TwinState& t) { t.exchanges.push_back(exchange("natural_convection front", 2.0)); }),
      "no number of natural_convection front multiplies it", column_and_head());
  expect_not_written(extend(spindle(),
                            [](TwinState& t) {
                              t.exchanges.push_back(exchange("coolant housing - tank", 2.0));
                              t.exchanges.back().from_s = 600.0;
                            }),
                     "cannot end at a time", spindle());
}

TEST(ExtendedScenario, LeavesNothingHalfDone) {  // a heat that can be written beside a change that cannot
  expect_not_written(extend(spindle(),
                            [](TwinState& t) {
                              t.heats.push_back(heat(effects::node("shaft"), 40.0, Shape::kConstant));
                              t.bodies.push_back({.body = "shaft", .conductivity = 2.0});
                            }),
                     "no conductivity", spindle());
}

TEST(ExtendedScenario, SaysWhereAnEffectKnowsNoRun) {
  const Bench& b = spindle();
  const std::vector<MeasuredRun> runs = {b.runs[0], b.runs[0]};
  const Twin twin(b.augmented, b.machine, kTight);
  StatedChange stated{"the change", "because", twin.as_written()};
  stated.state.drive.hall.push_back({.offset_K = 1.0, .in = "cycle"});
  expect_not_written(extended_scenario(b.scenario, twin, runs, {stated}, {}), "ambient has no key `in`", b);
}

TEST(ExtendedScenario, RefusesANumberOutsideItsRange) {
  expect_not_written(extend(spindle(), [](TwinState& t) { t.exchanges.push_back(exchange("link housing - hall", 1e12)); }),
                     "is allowed", spindle());
}

}  // namespace
}  // namespace driftwright::diagnosis
