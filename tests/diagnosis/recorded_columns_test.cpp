// Recorded columns that drive the machine, and displacements that follow one body more: simulated, written into records,
// found in them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/residual_structure.hpp"
#include "diagnosis/scene.hpp"
#include "machine/as_recorded.hpp"
#include "machine/machine.hpp"
#include "machine/run_record.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "solver/transient.hpp"
#include "tests/shared/lumped_records.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::diagnosis::recorded_columns_test {
namespace {

using ::testing::SizeIs;

constexpr const char* kMachine = R"(name: three_nodes
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: head, capacity: 6 kJ/K}
  - {type: node, node: column, capacity: 40 kJ/K}
  - {type: node, node: bed, capacity: 60 kJ/K}
  - {type: heat_source, node: head, power: 100 W, at_speed: 1000 rpm, exponent: 1.3}
  - {type: link, node: head, to: column, conductance: 12 W/K}
  - {type: link, node: column, to: bed, conductance: 9 W/K}
  - {type: link, node: column, to: ambient, conductance: 14 W/K}
  - {type: link, node: bed, to: ambient, conductance: 11 W/K}
ambient: [[0 min, 20 degC], [200 min, 22 degC], [400 min, 21 degC]]
sensors:
  - {name: t_head, node: head}
  - {name: t_column, node: column}
  - {name: t_bed, node: bed}
displacements:
  - name: nose
    sensitivities:
      - {node: head, sensitivity: 3 um/K}
cyclograms:
)";
constexpr const char* kColumns = "[duration, speed, heater_W, sun_W_m2, lid_1, stove_degC]";
constexpr const char* kRows[] = {
    "[[60 min, 600 rpm, 0 W, 100 W/m^2, 0, 25 degC], [60 min, 1900 rpm, 90 W, 300 W/m^2, 0, 60 degC], [40 min, 0 rpm, 0 W, "
    "500 W/m^2, 1, 40 degC], [80 min, 1000 rpm, 120 W, 50 W/m^2, 1, 30 degC], [60 min, 1400 rpm, 30 W, 0 W/m^2, 0, 70 "
    "degC]]",
    "[[50 min, 1800 rpm, 60 W, 400 W/m^2, 1, 20 degC], [70 min, 300 rpm, 0 W, 20 W/m^2, 0, 50 degC], [60 min, 1000 rpm, 110 "
    "W, 0 W/m^2, 1, 80 degC], [60 min, 0 rpm, 50 W, 350 W/m^2, 0, 35 degC], [60 min, 2000 rpm, 0 W, 200 W/m^2, 0, 25 "
    "degC]]"};

/// The scenario with further effects. @param with_columns  whether its cyclograms say more than speeds
std::string scenario_with(const std::string& entry, bool with_columns = true) {
  std::string text = with_effect(kMachine, entry);
  if (!with_columns) return text + "  idle: [[60 min, 500 rpm]]\nsolver: {output_interval: 1 min}\n";
  for (int i = 0; i < 2; ++i)
    text += std::string(i == 0 ? "  monday" : "  tuesday") + ": {columns: " + kColumns + ", rows: " + kRows[i] + "}\n";
  return text + "solver: {output_interval: 1 min}\n";
}

Record simulated(const scenarios::MachineModel& model, const Cyclogram& cyclogram) {
  const scenarios::Machine machine = scenarios::build(model, scenarios::place(model));
  const MachineRun felt = scenarios::felt_run(model, cyclogram);
  return scenarios::as_recorded(
      model,
      solver::simulate(machine.system, felt.cyclogram, felt.ambient, scenarios::output_times_s(cyclogram, 60.0),
                       {.relative_tolerance = 1e-8, .absolute_tolerance_K = 1e-8}, scenarios::start_state(model, machine)),
      machine.system.outputs, cyclogram);
}

struct Hidden {
  const char* name;
  const char* entry;     ///< of the truth
  const char* believed;  ///< of the scenario that is diagnosed
  const char* effect;    ///< as it is called, and where
  const char* where;
  const char* parameter;
  double value;         ///< of the first number
  const char* written;  ///< in extended.yaml
};

class ARecordedColumn : public testing::TestWithParam<Hidden> {};

TEST_P(ARecordedColumn, IsFoundAndWritten) {
  const Hidden& hidden = GetParam();
  const Found found(scenario_with(hidden.believed, false), scenario_with(hidden.entry),
                    fmt::format("columns_{}_", hidden.name), {.seed = 3});
  const Diagnosis& d = found.d;
  EXPECT_EQ(d.verdict, Verdict::kNamed) << d.reason;
  ASSERT_THAT(d.causes, SizeIs(1)) << d.reason;
  EXPECT_EQ(d.causes[0].effect, hidden.effect);
  EXPECT_EQ(d.causes[0].where, hidden.where);
  EXPECT_EQ(d.causes[0].parameters[0].name, hidden.parameter);
  EXPECT_NEAR(d.causes[0].parameters[0].value, hidden.value, 0.1 * hidden.value);
  found.expect_written_is_found_no_more(hidden.written);
}

std::string hidden_name(const ::testing::TestParamInfo<Hidden>& one) {
  return one.param.name;
}
// What drives, leads away, opens with a stream of its own, changes, loads or lags: one of each.
INSTANTIATE_TEST_SUITE_P(
    OfEachSort, ARecordedColumn,
    ::testing::Values(Hidden{"heater", "{type: recorded_drive, node: column, column: heater_W, gain: 0.7}", "",
                             "recorded_drive", "column", "gain", 0.7, "column: heater_W"},
                      Hidden{"stove", "{type: recorded_drive, node: bed, column: stove_degC, conductance: 2.5 W/K}", "",
                             "recorded_drive", "bed", "conductance", 2.5, "column: stove_degC"},
                      Hidden{"stream", "{type: recorded_drive, node: head, column: lid_1, opening: 6, medium: 8 degC}", "",
                             "recorded_drive", "head", "opening", 6.0, "medium: "},
                      Hidden{"element",
                             "{type: recorded_drive, node: column, column: heater_W, gain: 1}\n"
                             "  - {type: changed_law, law: recorded_drive column heater_W, factor: 0.5, in: tuesday}",
                             "{type: recorded_drive, node: column, column: heater_W, gain: 1}", "recorded_drive", "column",
                             "factor", 0.5, "in: columns_element_tuesday"},
                      Hidden{"force", "{type: displacement_path, displacement: nose, column: heater_W, gain: 0.05}", "",
                             "displacement_path", "nose", "gain", 0.05, "gain: 0.05"},
                      Hidden{"lagging",
                             "{type: displacement_path, displacement: nose, body: head, sensitivity: 2.5 um/K, lag: 40 min}",
                             "", "displacement_path", "nose", "sensitivity", 2.5, "body: head"}),
    hidden_name);
INSTANTIATE_TEST_SUITE_P(
    OthersAtLength, ARecordedColumn,
    ::testing::Values(Hidden{"sun", "{type: recorded_drive, node: bed, column: sun_W_m2, gain: 0.3}", "", "recorded_drive",
                             "bed", "gain", 0.3, "column: sun_W_m2"},
                      Hidden{"lid", "{type: recorded_drive, node: head, column: lid_1, opening: 6}", "", "recorded_drive",
                             "head", "opening", 6.0, "column: lid_1"},
                      Hidden{"gain", "{type: recorded_drive, node: column, column: heater_W, gain: 3}",
                             "{type: recorded_drive, node: column, column: heater_W, gain: 1}", "recorded_drive", "column",
                             "gain", 3.0, "gain was 1"},
                      Hidden{"square",
                             "{type: recorded_drive, node: column, column: heater_W, gain: 0.7, exponent: 2, at: 120}", "",
                             "recorded_drive", "column", "gain", 0.7, "exponent: "},
                      Hidden{"elsewhere",
                             "{type: recorded_drive, node: head, column: heater_W, gain: 0.5}\n"
                             "  - {type: recorded_drive, node: column, column: heater_W, gain: 0.7}",
                             "{type: recorded_drive, node: head, column: heater_W, gain: 0.5}", "recorded_drive", "column",
                             "gain", 0.7, "type: recorded_drive, node: column"},
                      Hidden{"path", "{type: displacement_path, displacement: nose, body: bed, sensitivity: 4 um/K}", "",
                             "displacement_path", "nose", "sensitivity", 4.0, "body: bed"},
                      Hidden{"follows",
                             "{type: displacement_path, displacement: nose, column: stove_degC, sensitivity: 0.5 um/K}", "",
                             "displacement_path", "nose", "sensitivity", 0.5, "column: stove_degC"}),
    hidden_name);

// Two wings alike in everything, thermometers beside them: the readings show that the sun heats a wing, but not which one.
TEST(RecordedColumns, ThatHeatOneOfTwoLikeBodiesAreNamedAndTheirPlaceIsLeftOpen) {
  const std::string wings =
      "{type: node, node: left, capacity: 9 kJ/K}\n  - {type: node, node: right, capacity: 9 kJ/K}\n"
      "  - {type: link, node: left, to: column, conductance: 7 W/K}\n"
      "  - {type: link, node: right, to: column, conductance: 7 W/K}";
  const std::string sun = "\n  - {type: recorded_drive, node: left, column: sun_W_m2, gain: 0.3}";
  const Found found(scenario_with(wings, false), scenario_with(wings + sun), "columns_wings_", {.seed = 3});
  const Diagnosis& d = found.d;
  EXPECT_EQ(d.verdict, Verdict::kNamed) << d.reason;
  ASSERT_THAT(d.causes, SizeIs(1)) << d.reason;
  const Cause& cause = d.causes[0];
  EXPECT_EQ(cause.effect, "recorded_drive");
  EXPECT_GE(cause.odds.kind, kSure);
  EXPECT_NEAR(cause.odds.place, 0.5, 0.05);  // what the two fits converge to
  ASSERT_THAT(cause.alternatives, SizeIs(1)) << d.reason;
  EXPECT_EQ(cause.alternatives[0].effect, "recorded_drive");
  EXPECT_THAT((std::vector<std::string>{cause.where, cause.alternatives[0].where}),
              testing::UnorderedElementsAre("left", "right"));
}

TEST(RecordedColumns, AreNoCauseWhereNothingIsWrong) {
  const Found found(scenario_with("", false), scenario_with(""), "columns_none_", {.seed = 3});
  ASSERT_THAT(scene_of(*found.beside.twin, found.beside.runs).columns, SizeIs(4));
  EXPECT_EQ(found.d.verdict, Verdict::kConsistent) << found.d.reason;
}

TEST(RecordedColumns, OfASimulatedRecordDriveItAgain) {
  // heater after a lag, stove and lid: the record carries the columns, and as a cyclogram gives the same temperatures,
  // but for what pieces of the lag average: 75 s there, rows of 60 s here.
  const std::string entries =
      "{type: recorded_drive, node: column, column: heater, gain: 1, lag: 5 min}\n  - {type: recorded_drive, node: bed, "
      "column: stove_degC, conductance: 2 W/K}\n  - {type: recorded_drive, node: head, column: lid_1, opening: 3}";
  const scenarios::Scenario s = scenarios::read_scenario(write_file("driven.yaml", scenario_with(entries)));
  const Record first = simulated(*s.machine, s.cyclogram("monday"));
  for (const char* name : {"heater_W", "stove_degC", "lid_1"}) ASSERT_TRUE(first.find(name)) << name;
  EXPECT_FALSE(first.find("sun_W_m2")) << "no effect asks for it";
  const std::string csv = write_file("driven.csv", record_csv(first));
  std::string text = scenario_with(entries);
  text.insert(text.find("  monday:"), "  again: {csv: " + csv + "}\n");
  const scenarios::Scenario t = scenarios::read_scenario(write_file("driven_again.yaml", text));
  const Record second = simulated(*t.machine, t.cyclogram("again"));
  ASSERT_EQ(first.n_samples(), second.n_samples());
  for (const Channel& c : first.channels) {
    ASSERT_TRUE(second.find(c.header())) << c.name;
    for (std::size_t i = 0; i < c.values.size(); ++i)
      ASSERT_NEAR(c.values[i], second.at(c.header()).values[i], 5e-3) << c.name;
  }
}

TEST(RecordedColumns, ThatAreMissingAreRefused) {
  const std::string entry = "{type: recorded_drive, node: column, column: heater_W, gain: 1}";
  const scenarios::Scenario s = scenarios::read_scenario(write_file("idle.yaml", scenario_with(entry, false)));
  EXPECT_REFUSED(scenarios::felt_run(*s.machine, s.cyclogram("idle")), "recorded_drive column", "'heater_W'",
                 "cyclogram 'idle'");
  const std::vector<std::string> files = noisy_records(
      write_file("truth.yaml", scenario_with("{type: sensor_bias, sensor: t_bed, bias: 0.1 K}")), "columns_missing_");
  Record r = read_record_csv(files[0]);
  std::erase_if(r.channels, [](const Channel& c) { return c.name == "heater"; });
  EXPECT_REFUSED(measured_run(read_record(write_file("no_heater.csv", record_csv(r)), std::nullopt), *s.machine,
                              scenarios::output_names(*s.machine, scenarios::place(*s.machine))),
                 "'heater_W'", "sun_W_m2");
  const std::string follows = "{type: displacement_path, displacement: nose, column: heater_W, sensitivity: 1 um/K}";
  const scenarios::Scenario f = scenarios::read_scenario(write_file("follows.yaml", scenario_with(follows)));
  EXPECT_REFUSED(scenarios::felt_run(*f.machine, f.cyclogram("monday")), "temperatures in degC");
}

TEST(RecordedColumns, AreWhatAResidualIsComparedWith) {
  MeasuredRun run;
  run.name = "run";
  TimeSeries heater;
  Eigen::VectorXd residual(300);
  double behind = 80.0, before_W = 80.0;
  for (int i = 0; i < 300; ++i) {
    const double power_W = (i / 37) % 2 == 0 ? 80.0 : 10.0;
    run.time_s.push_back(60.0 * i);
    heater.time_s.push_back(60.0 * i);
    heater.value.push_back(power_W);
    behind += (before_W - behind) * -std::expm1(-60.0 / 900.0);
    before_W = power_W;
    residual[i] = 0.02 * behind;
  }
  run.cyclogram = {.name = "run", .sections = {{18000.0, {}}}, .remarks = {}, .columns = {{"heater", "W", heater}}};
  run.ambient = {{0.0}, {0.0}};
  const ResidualStructure s = residual_structure(run, residual);
  ASSERT_TRUE(s.lag);
  EXPECT_EQ(s.lag->quantity, "heater_W");
  EXPECT_NEAR(s.lag->time_s, 900.0, 100.0);  // 20 a decade, and the row's own minute
  EXPECT_EQ(s.likenesses.back().quantity, "heater_W");
}

}  // namespace
}  // namespace driftwright::diagnosis::recorded_columns_test
