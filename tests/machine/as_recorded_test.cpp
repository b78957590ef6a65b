// Machines whose record, instruments or materials are wrong: from YAML to records known by hand.

#include "machine/as_recorded.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "machine/reduced_machine.hpp"
#include "machine/run_record.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "solver/reduced_transient.hpp"
#include "tests/shared/column_and_head.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::scenarios::as_recorded_test {
namespace {

using fixtures::ColumnAndHead;
using ::testing::AllOf, ::testing::HasSubstr, ::testing::ThrowsMessage;

/// Two bodies: 100 W into `hot` at 1000 rpm, 2 W/K to `cold`, from there 5 W/K to the ambient.
std::string two_bodies(const std::string& effects, const std::string& more = "",
                       const std::string& sensors = "{name: t_hot, node: hot}, {name: t_cold, node: cold}") {
  return "name: two_bodies\nreference_temperature: 20 degC\nmachine: {generator: lumped}\n" + more +
         "effects:\n"
         "  - {type: node, node: hot, capacity: 1000 J/K}\n"
         "  - {type: node, node: cold, capacity: 4000 J/K}\n"
         "  - {type: heat_source, node: hot, power: 100 W, at_speed: 1000 rpm, exponent: 1}\n"
         "  - {type: link, node: hot, to: cold, conductance: 2 W/K}\n"
         "  - {type: link, node: cold, to: ambient, conductance: 5 W/K}\n" +
         effects + "ambient: [[0 h, 25 degC]]\nsensors: [" + sensors +
         "]\n"
         "displacements:\n"
         "  - {name: growth, sensitivities: [{node: hot, sensitivity: 3 um/K}, {node: cold, sensitivity: -1 um/K}]}\n"
         "cyclograms: {long: [[10 h, 1000 rpm]], rest: [[1 h, 0 rpm]]}\n"
         "solver: {relative_tolerance: 1e-7, absolute_tolerance: 1e-6 K, output_interval: 10 min}\n";
}
Scenario read(const std::string& text) {
  return read_scenario(write_file("as_recorded_test.yaml", text));
}
Record record_of(const std::string& text, const std::string& cyclogram) {
  const Scenario scenario = read(text);
  const MachineModel& model = *scenario.machine;
  const Machine machine = build(model, place(model));
  const Cyclogram& recorded = scenario.cyclogram(cyclogram);
  const MachineRun felt = felt_run(model, recorded);
  const solver::Trajectory run = solver::simulate(machine.system, felt.cyclogram, felt.ambient,
                                                  output_times_s(recorded, scenario.solver.output_interval_s),
                                                  scenario.solver.transient, start_state(model, machine));
  return as_recorded(model, run, machine.system.outputs, recorded);
}

TEST(AsRecorded, MachineFeelsTheTruthAndTheRecordTellsTheRest) {
  // 150 W at 1.5 times the speed at an ambient temperature of 27 degC: cold 27 + 30 = 57, hot 57 + 75 = 132 degC; growth
  // 3 * 112 - 37 = 299 um, and (1.5)^2 * 4 = 9 um of centrifugal force, and 6 um of the mount. Time constants of 1500 s
  // at most: settled after 10 h.
  const Record record =
      record_of(two_bodies("  - {type: speed_override, factor: 1.5}\n"
                           "  - {type: ambient, offset: 2 K}\n"
                           "  - {type: centrifugal, displacement: growth, growth: 4 um}\n"
                           "  - {type: mount_shift, displacement: growth, shift: 6 um, time: 5 h, in: long}\n"
                           "  - {type: sensor_bias, sensor: t_cold, bias: 1 K}\n"
                           "  - {type: sensor_drift, sensor: t_hot, drift: -0.5 K/h}\n"
                           "  - {type: sensor_swap, sensor: t_hot, with: t_cold}\n"),
                "long");
  EXPECT_NEAR(record.at("t_hot").values.back(), 57.0 + 1.0, 1e-4);
  EXPECT_NEAR(record.at("t_cold").values.back(), 132.0 - 5.0, 1e-4);
  EXPECT_NEAR(record.at("growth").values.back(), 299.0 + 9.0 + 6.0, 1e-3);
  EXPECT_EQ(record.at("speed").values.back(), 1000.0);
  EXPECT_NEAR(record.at("ambient").values.back(), 25.0, 1e-12);
  EXPECT_EQ(record.at("ambient").unit, "degC");
}

TEST(AsRecorded, AMissingStopCoolsTheMachineAndLeavesNoTraceInTheSpeed) {
  const Record record = record_of(two_bodies("  - {type: missing_stop, start: 100 min, length: 500 min}\n"), "long");
  EXPECT_NEAR(record.at("t_hot").values.back(), 25.0, 1e-3);  // 500 min of rest: 20 of the slowest time constants
  for (double speed_rpm : record.at("speed").values) EXPECT_EQ(speed_rpm, 1000.0);
}

TEST(AsRecorded, TheMachineStartsInTheAmbientThatItFeels) {
  const std::string warmer = "  - {type: ambient, offset: 2 K}\n";
  for (const char* start : {"start: ambient\n", "start: steady\n"}) {
    const Record record = record_of(two_bodies(warmer, start), "rest");
    for (double t_degC : record.at("t_cold").values) EXPECT_NEAR(t_degC, 27.0, 1e-6) << start;
  }
}

TEST(AsRecorded, ASensorOnTheAmbientReadsTheRecordedAmbientAndStandsForTheChannel) {
  const Record record =
      record_of(two_bodies("  - {type: ambient, offset: 2 K}\n  - {type: sensor_bias, sensor: air, bias: 0.25 K}\n", "",
                           "{name: t_cold, node: cold}, {name: air, node: ambient}"),
                "rest");
  EXPECT_NEAR(record.at("air").values.back(), 25.25, 1e-12);
  EXPECT_EQ(record.find("ambient"), nullptr);
  EXPECT_EQ(sensor_channels(record), (std::vector<std::string>{"t_cold", "air"}));
}

TEST(AsRecorded, TheAmbientIsNoSensorToChoose) {
  const Record record = record_of(two_bodies(""), "rest");
  EXPECT_EQ(sensor_channels(record), (std::vector<std::string>{"t_hot", "t_cold"}));
  EXPECT_EQ(record.channels[1].name, "ambient");
}

TEST(AsRecorded, AFactorOnANodeIsOneOnItsCapacity) {
  std::string lighter = two_bodies("");
  lighter.replace(lighter.find("4000 J/K"), 8, "2000 J/K");
  const Record a = record_of(lighter, "long"),
               b = record_of(two_bodies("  - {type: heat_capacity, node: cold, factor: 0.5}\n"), "long");
  EXPECT_EQ(a.at("t_hot").values, b.at("t_hot").values);
  EXPECT_NE(a.at("t_hot").values, record_of(two_bodies(""), "long").at("t_hot").values);
}

struct Bad {
  const char* text;
  const char* message;
  const char* remedy;
};
class BadInstrument : public ::testing::TestWithParam<Bad> {};

TEST_P(BadInstrument, IsNamedWhileReading) {
  EXPECT_THAT([] { (void)read(two_bodies(std::string("  - ") + GetParam().text + "\n")); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("as_recorded_test.yaml:10:"), HasSubstr(GetParam().message),
                                              HasSubstr(GetParam().remedy))));
}

INSTANTIATE_TEST_SUITE_P(
    Each, BadInstrument,
    ::testing::Values(
        Bad{"{type: sensor_bias, sensor: t_hat, bias: 1 K}", "there is no sensor 't_hat'", "Did you mean 't_hot'?"},
        Bad{"{type: sensor_bias, sensor: growth, bias: 1 K}", "there is no sensor 'growth'", "t_hot, t_cold"},
        Bad{"{type: sensor_swap, sensor: t_hot, with: t_cald}", "no sensor 't_cald'", "Did you mean 't_cold'?"},
        Bad{"{type: centrifugal, displacement: groth, growth: 1 um}", "no displacement 'groth'", "Did you mean 'growth'?"},
        Bad{"{type: centrifugal, displacement: growth, tilt: 1 urad}", "'growth' is a displacement", "`tilt` does not fit"},
        Bad{"{type: mount_shift, displacement: growth, shift: 1 um, time: 1 min, in: lang}", "no cyclogram 'lang'",
            "Did you mean 'long'?"},
        Bad{"{type: missing_stop, start: 1 min, length: 1 min, in: lang}", "no cyclogram 'lang'", "long, rest"}));

TEST(Names, AmbientIsThatOfTheAmbient) {
  const auto with = [](const char* sensor) { (void)read(two_bodies("", "", sensor)); };
  EXPECT_REFUSED(with("{name: ambient, node: hot}"), "that of the ambient temperature");
  EXPECT_NO_THROW(with("{name: ambient, node: ambient}"));
}

TEST(Study, ChoosesTheAmbientOnlyWhereItIsNamed) {
  const std::string study =
      "study: {target: growth, train: [long], judge: rest, sensors_to_choose: 2, candidates: [t_hot, ambient]}\n";
  EXPECT_EQ(read(two_bodies("") + study).study->candidates.size(), 2u);
  const std::string with_ambient = "{name: t_hot, node: hot}, {name: air, node: ambient}";
  EXPECT_REFUSED(read(two_bodies("", "", with_ambient) + study), "no sensor 'ambient'");
  const std::string too_many = "study: {target: growth, train: [long], judge: rest, sensors_to_choose: 3}\n";
  EXPECT_REFUSED(read(two_bodies("") + too_many), "3 of 2 sensors cannot be chosen");
}

TEST(CheckCyclogram, TriesLawsAtTheSpeedThatTheMachineTurnsAt) {
  // A stop or an override cannot be seen in the record; a law that ends at 13 057 rpm must not be left by it.
  ColumnAndHead machine;
  machine.effects.push_back("{type: rotating_cylinder, surface: front, diameter: 500 mm}");
  machine.cyclograms = "{cycle: [[10 min, 400 rpm]]}";
  const auto folder = fresh_folder("felt_speed");
  EXPECT_NO_THROW((void)read_scenario(fixtures::write_column_and_head(folder, machine)));
  machine.effects.push_back("{type: speed_override, factor: 2}");
  EXPECT_THAT([&] { (void)read_scenario(fixtures::write_column_and_head(folder, machine)); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("rotating_cylinder"), HasSubstr("800 rpm"))));
}

// --- materials
// ---------------------------------------------------------------------------------------------------------------

Machine column_and_head(const ColumnAndHead& what) {
  const Scenario scenario = read_scenario(fixtures::write_column_and_head(fresh_folder("factors"), what));
  return build(*scenario.machine, place(*scenario.machine));
}
ColumnAndHead of(const char* conductivity, const char* heat_capacity, const char* expansion) {
  ColumnAndHead machine;
  machine.materials = fmt::format(
      "{{head: cast_iron_gjl250, column: {{density: 7200 kg/m^3, conductivity: {}, heat_capacity: {}, youngs_modulus: 110 "
      "GPa, "
      "poisson_ratio: 0.26, expansion: {}, source: made up}}}}",
      conductivity, heat_capacity, expansion);
  return machine;
}
ColumnAndHead with(ColumnAndHead machine, std::vector<std::string> effects) {
  machine.effects.insert(machine.effects.end(), effects.begin(), effects.end());
  return machine;
}
/// Largest difference of what heat and displacements follow from, relative.
double difference(const Machine& a, const Machine& b) {
  const double k = (a.system.conduction - b.system.conduction).norm() / b.system.conduction.norm();
  const double m = (a.system.mass - b.system.mass).norm() / b.system.mass.norm();
  const double u = (a.system.outputs.state - b.system.outputs.state).norm() / b.system.outputs.state.norm();
  return std::max({k, m, u});
}

TEST(MaterialFactors, AreThoseOfTheMaterialWrittenSo) {
  const ColumnAndHead plain = of("50 W/(m K)", "500 J/(kg K)", "11e-6 1/K");
  const auto same = [&](const char* type, const ColumnAndHead& written) {
    const Machine machine = column_and_head(with(plain, {fmt::format("{{type: {}, region: column, factor: 2}}", type),
                                                         fmt::format("{{type: {}, region: column, factor: 0.75}}", type)}));
    EXPECT_LT(difference(machine, column_and_head(written)), 1e-12) << type;  // rounding through two solvers
    EXPECT_GT(difference(machine, column_and_head(plain)), 1e-6) << type;
  };
  same("conductivity", of("75 W/(m K)", "500 J/(kg K)", "11e-6 1/K"));
  same("heat_capacity", of("50 W/(m K)", "750 J/(kg K)", "11e-6 1/K"));
  same("expansion", of("50 W/(m K)", "500 J/(kg K)", "16.5e-6 1/K"));
}

TEST(MaterialFactors, DoubleDisplacementsWhereEverythingExpandsTwice) {
  const Machine plain = column_and_head({}),
                twice = column_and_head(with(
                    {}, {"{type: expansion, region: column, factor: 2}", "{type: expansion, region: head, factor: 2}"}));
  const Eigen::VectorXd z = plain.system.outputs.state.col(3);
  EXPECT_LT((twice.system.outputs.state.col(3) - 2.0 * z).norm(), 1e-12 * z.norm());
}

TEST(MaterialFactors, ScaleCurvesAndEachAxis) {
  const solver::Material m =
      column_and_head(
          with(of("[[20 degC, 50 W/(m K)], [70 degC, 40 W/(m K)]]", "[[20 degC, 500 J/(kg K)], [90 degC, 540 J/(kg K)]]",
                  "[10e-6 1/K, 11e-6 1/K, 12e-6 1/K]"),
               {"{type: conductivity, region: column, factor: 3}", "{type: heat_capacity, region: column, factor: 0.5}",
                "{type: expansion, region: column, factor: 2}"}))
          .placed.materials.at(0);
  EXPECT_DOUBLE_EQ(m.conductivity_curve.at(343.15), 120.0);
  EXPECT_DOUBLE_EQ(m.heat_capacity_curve.at(363.15), 270.0);
  EXPECT_DOUBLE_EQ(m.expansion_1_K.x, 20e-6);
  EXPECT_DOUBLE_EQ(m.expansion_1_K.y, 22e-6);
  EXPECT_DOUBLE_EQ(m.expansion_1_K.z, 24e-6);
}

TEST(MaterialFactors, OfAnUnknownRegionAreRefused) {
  EXPECT_THAT([] { (void)column_and_head(with({}, {"{type: expansion, region: colum, factor: 2}"})); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("'colum'"), HasSubstr("Did you mean 'column'?"))));
}

// --- reduced machines
// --------------------------------------------------------------------------------------------------------

TEST(ReducedMachines, FollowWhatTheFullOneFeels) {
  ColumnAndHead what;
  what.start = "ambient";
  what = with(what, {"{type: speed_override, factor: 1.4}", "{type: missing_stop, start: 15 min, length: 7 min}",
                     "{type: ambient, offset: 1.5 K, ramp: 2 K/h, from: 25 min}", "{type: ambient, offset: -1 K}",
                     "{type: conductivity, region: head, factor: 0.6}", "{type: sensor_lag, sensor: t_head, lag: 4 min}"});
  const Scenario scenario = read_scenario(fixtures::write_column_and_head(fresh_folder("felt_reduced"), what));
  const MachineModel& model = *scenario.machine;
  const Cyclogram& recorded = scenario.cyclograms.front();
  const Machine full = build(model, place(model));
  const ReducedMachine reduced = reduce(model, full, reduction_plan(scenario, {&recorded}));
  const MachineRun felt = felt_run(model, recorded);
  const std::vector<double> times_s = output_times_s(recorded, 300.0);
  const solver::TransientOptions fine{.relative_tolerance = 1e-7, .absolute_tolerance_K = 1e-7};
  const Record a = as_recorded(
      model, solver::simulate(full.system, felt.cyclogram, felt.ambient, times_s, fine, start_state(model, full)),
      full.system.outputs, recorded);
  const Record b =
      as_recorded(model, solver::simulate(reduced.system, felt.cyclogram, felt.ambient, times_s, fine, reduced.start),
                  reduced.system.outputs, recorded);
  for (const char* sensor : {"t_head", "t_column"}) {
    for (std::size_t i = 0; i < times_s.size(); ++i) {
      EXPECT_NEAR(a.at(sensor).values[i], b.at(sensor).values[i], 8e-3) << sensor << " at " << times_s[i];  // as asked
    }
  }
  EXPECT_GT(a.at("t_head").values.back(), a.at("t_head").values.front() + 1.0);
  EXPECT_NEAR(a.at("t_head").values.front(), 19.0, 1e-9);
}

}  // namespace
}  // namespace driftwright::scenarios::as_recorded_test
