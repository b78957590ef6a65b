// Causes that hold for more than an instant of one record: what begins in one record and lasts in the next, what is there
// for a while, a record run in another state. Each is found in records made with it, and written so that it is found no
// more. Most of it is the table of these causes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "diagnosis/candidates.hpp"
#include "diagnosis/extended_scenario.hpp"
#include "effects/lasting.hpp"
#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis::lasting_causes_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

constexpr const char* kCooledHead =
    "{type: coolant, node: head, flow: 4 L/min, passage_conductance: 9 W/K, set_point: 18 degC}";

struct Cause {
  const char* name;
  std::vector<std::string> entries;  ///< of the truth
  const char* effect;
  const char* where;
  const char* law;  ///< part of it
  double size, tolerance;
  const char* believed = "";  ///< an effect of both
  double as_heat_W = 0.0;     ///< constant heat in that body that gives the same readings; 0: none does
};

/// What is said of the file is what it would hold: numbers of written causes are those that are written, and what is left
/// out says why and who may have taken it up.
void expect_what_is_written_is_said(const Diagnosis& d) {
  for (std::size_t c = 0; c < d.causes.size(); ++c) {
    EXPECT_EQ(d.causes[c].is_written, d.causes[c].why_not_written.empty()) << d.causes[c].effect;
    const bool is_taken_up = std::find(d.written.taken_up.begin(), d.written.taken_up.end(), c) != d.written.taken_up.end();
    EXPECT_EQ(is_taken_up, d.written.keeps_numbers && !d.causes[c].is_written) << d.causes[c].effect;
  }
  for (const Estimate& e : d.calibrated) EXPECT_EQ(e.is_written, d.written.keeps_numbers) << e.name;
  Eigen::Index at = d.written.fit.x.size();
  for (const Claim& claim : d.written.hypothesis) at -= static_cast<Eigen::Index>(claim.knobs.size());
  for (std::size_t i = 0; i < d.written.hypothesis.size(); ++i) {
    for (std::size_t k = 0; k < d.written.hypothesis[i].knobs.size(); ++k, ++at) {
      const Knob& knob = d.written.hypothesis[i].knobs[k];
      const double scale = knob.is_time ? 60.0 : 1.0;
      EXPECT_NEAR(d.causes[d.written.causes[i]].parameters[k].value, knob.value(d.written.fit.x[at]) / scale, 1e-9)
          << knob.name;
    }
  }
}

class ACause : public testing::TestWithParam<Cause> {};

/// Causes that show in two records; a third one takes twice as long, because each is also left out in turn.
constexpr std::string_view kInTwoRecords[] = {
    "a_lead_that_picks_up_the_drive",
    "a_logger_that_was_set_right",
    "a_pump_that_comes_again",
    "a_heater_at_rest",
    "preload_that_grows_with_what_a_ring_is_warmer",
    "a_gear_stage",
};
std::string two_records_of_two_nodes() {
  std::string text = kTwoNodes;
  const std::size_t from = text.find("  friday:");
  return text.erase(from, text.find("solver:") - from);
}

TEST_P(ACause, IsFoundInAllItsRecordsAtOnceAndWritten) {
  const Cause& cause = GetParam();
  const bool are_two = std::find(std::begin(kInTwoRecords), std::end(kInTwoRecords), cause.name) != std::end(kInTwoRecords);
  const std::string plain = with_effect(are_two ? two_records_of_two_nodes() : kTwoNodes, cause.believed);
  std::string truth = plain;
  for (const std::string& e : cause.entries) truth = with_effect(truth, e);
  const Found found(plain, truth, std::string(cause.name) + "_");
  const Diagnosis& d = found.d;
  ASSERT_THAT(d.causes, SizeIs(1)) << d.reason;
  expect_what_is_written_is_said(d);
  EXPECT_EQ(d.causes[0].where, cause.where);
  if (cause.as_heat_W > 0.0 && d.causes[0].effect == "heat_source") {
    EXPECT_NEAR(d.causes[0].parameters[0].value, cause.as_heat_W, 0.05 * cause.as_heat_W);
  } else {
    EXPECT_EQ(d.causes[0].effect, cause.effect);
    EXPECT_THAT(d.causes[0].law, HasSubstr(cause.law));
    EXPECT_NEAR(d.causes[0].parameters[0].value, cause.size, cause.tolerance);
  }
  found.expect_written_is_found_no_more();
}

const Cause kCauses[] = {
    Cause{"a_thermometer_that_stays_off",
          {"{type: sensor_detached, sensor: t_column, share: 0.6, time: 100 min, in: tuesday}",
           "{type: sensor_detached, sensor: t_column, share: 0.6, time: 0 min, in: friday}"},
          "sensor_detached",
          "t_column",
          "all later records",
          0.6,
          0.05},
    Cause{"an_ambient_that_stays_warmer",
          {"{type: ambient, offset: 1.5 K, from: 120 min, in: monday}", "{type: ambient, offset: 1.5 K, in: tuesday}",
           "{type: ambient, offset: 1.5 K, in: friday}"},
          "ambient",
          "ambient",
          "all later records",
          1.5,
          0.15},
    Cause{"a_gate_that_stands_open_for_a_while",
          {"{type: ambient, offset: -3 K, from: 80 min, until: 170 min, in: tuesday}"},
          "ambient",
          "ambient",
          "another one for a while",
          -3.0,
          0.3},
    Cause{"a_fan_that_is_off_for_a_while",
          {"{type: changed_law, law: link column - ambient, factor: 0.3, from: 100 min, until: 190 min, in: monday}"},
          "contact",
          "column,ambient",
          "less of it for a while",
          0.3,
          0.1},
    Cause{"a_fan_that_stays_on",
          {"{type: changed_law, law: link column - ambient, factor: 1.8, from: 100 min, in: tuesday}",
           "{type: changed_law, law: link column - ambient, factor: 1.8, in: friday}"},
          "contact",
          "column,ambient",
          "all later records",
          1.8,
          0.2},
    Cause{"a_thermometer_mounted_anew",
          {"{type: sensor_place, sensor: t_column, body: head, share: 0.15, in: tuesday}",
           "{type: sensor_place, sensor: t_column, body: head, share: 0.15, in: friday}"},
          "sensor_place",
          "t_column",
          "_tuesday on",
          0.15,
          0.02},
    Cause{"a_fan_that_was_taken_away",
          {"{type: changed_law, law: link column - ambient, factor: 1.8, in: monday}",
           "{type: changed_law, law: link column - ambient, factor: 1.8, in: tuesday}"},
          "contact",
          "column,ambient",
          "up to a_fan_that_was_taken_away_tuesday",
          1.8,
          0.2},
    Cause{"a_pump_on_two_days_of_three",
          {"{type: heat_source, node: column, power: 40 W, in: monday}",
           "{type: heat_source, node: column, power: 40 W, in: friday}"},
          "heat_source",
          "column",
          "in a_pump_on_two_days_of_three_monday, a_pump_on_two_days_of_three_friday",
          40.0,
          4.0},
    Cause{"a_scale_that_lags_from_the_second_day_on",
          {"{type: scale_expansion, displacement: nose, lag: 6 min, in: tuesday}",
           "{type: scale_expansion, displacement: nose, lag: 6 min, in: friday}"},
          "scale_expansion",
          "nose",
          "in a_scale_that_lags_from_the_second_day_on_tuesday, a_scale_that_lags_from_the_second_day_on_friday",
          6.0,
          0.6},
    Cause{"a_lead_that_picks_up_the_drive",
          {"{type: sensor_bias, sensor: t_column, bias: 0.4 K, errs: while_spindle_turns}"},
          "sensor_bias",
          "t_column",
          "while the spindle turns",
          0.4,
          0.04},
    Cause{"a_thermometer_of_another_class",
          {"{type: sensor_bias, sensor: t_head, bias: 0 K, slope: 0.04}"},
          "sensor_bias",
          "t_head",
          "in proportion to what it is warmer",
          0.04,
          0.006},
    Cause{"a_bump_that_was_mended",
          {"{type: mount_shift, displacement: nose, shift: 3 um, time: 80 min, until_time: 170 min, in: tuesday}"},
          "mount_shift",
          "nose",
          "step for a while, in a_bump_that_was_mended_tuesday",
          3.0,
          0.2},
    Cause{"a_logger_that_was_set_right",
          {"{type: clock_offset, offset: 3 min, from_time: 130 min, in: tuesday}"},
          "clock_offset",
          "clock",
          "from a time on, in a_logger_that_was_set_right_tuesday",
          3.0,
          0.5},
    Cause{"an_indicator_that_was_set_up_anew",
          {"{type: mount_shift, displacement: nose, shift: 4 um, time: 0 min, in: tuesday}",
           "{type: mount_shift, displacement: nose, shift: 4 um, time: 0 min, in: friday}"},
          "mount_shift",
          "nose",
          "another zero, from an_indicator_that_was_set_up_anew_tuesday on",
          4.0,
          0.2},
    Cause{"a_stand_that_creeps_on_the_second_day",
          {"{type: mount_shift, displacement: nose, shift: 8 um, time: 0 min, creep: 25 min, in: tuesday}"},
          "mount_shift",
          "nose",
          "creep from the start of each record on, in a_stand_that_creeps_on_the_second_day_tuesday",
          8.0,
          0.8},
    Cause{"a_film_in_a_turning_bearing",
          {"{type: changed_law, law: link head - column, growth: 1.2, growth_exponent: 1, at_speed: 1000 rpm}"},
          "contact",
          "head,column",
          "grows with speed",
          1.2,
          0.3},
    Cause{"a_pump_for_a_while",
          {"{type: heat_window, node: head, power: 60 W, windows: [[90 min, 130 min]], in: tuesday}"},
          "heat_window",
          "head",
          "heat for a while",
          60.0,
          6.0},
    Cause{"a_pump_that_comes_again",
          {"{type: heat_window, node: head, power: 60 W, windows: [[30 min, 50 min], [140 min, 165 min]], in: monday}",
           "{type: heat_window, node: head, power: 60 W, windows: [[90 min, 130 min]], in: tuesday}"},
          "heat_window",
          "head",
          "windows of one size",
          60.0,
          6.0},
    Cause{"a_cold_workpiece_that_stays",
          {"{type: hidden_body, node: head, capacity: 3 kJ/K, conductance: 5 W/K, windows: [[150 min, 301 min]], in: "
           "monday}"},
          "hidden_body",
          "head",
          "comes and stays",
          3000.0,
          450.0},
    Cause{"air_that_a_turning_part_stirs",
          {"{type: changed_law, law: link head - ambient, growth: 1.5, growth_exponent: 0.75, at_speed: 1000 rpm}"},
          "forced_convection",
          "head,ambient",
          "grows with speed",
          1.5,
          0.4},
    Cause{"a_chiller_that_was_turned_up_for_a_day",
          {"{type: changed_law, law: coolant head, warmer: 2 K, in: tuesday}"},
          "coolant",
          "head",
          "another set point, in a_chiller_that_was_turned_up_for_a_day_tuesday",
          20.0,
          0.2,
          kCooledHead},
    Cause{"a_chiller_that_fails",
          {"{type: changed_law, law: coolant head, warmer: 4 K, from: 120 min, in: tuesday}",
           "{type: changed_law, law: coolant head, warmer: 4 K, in: friday}"},
          "coolant",
          "head",
          "another set point from a time on",
          22.0,
          0.3,
          kCooledHead,
          36.0},
    Cause{"a_filter_that_clogs",
          {"{type: changed_law, law: coolant head, factor: 0.543326, in: friday}"},
          "coolant",
          "head",
          "another flow, in a_filter_that_clogs_friday",
          0.1,  // L/min: W (1 - exp(-9/W)) is 4.804 W/K then, and 8.842 W/K at 4 L/min
          0.01,
          kCooledHead},
    Cause{"grease_that_runs_in",
          {"{type: heat_source, node: head, power: 60 W, at_speed: 1000 rpm, exponent: 1, fades: 45 min, in: monday}"},
          "heat_source",
          "head",
          "that fades",
          60.0,
          9.0},
    Cause{"a_heater_at_rest",
          {"{type: heat_source, node: head, power: 60 W, runs: while_spindle_stands}"},
          "heat_source",
          "head",
          "while the spindle is at rest",
          60.0,
          6.0},
    Cause{"coolant_that_runs_with_the_spindle",
          {"{type: coolant, node: head, flow: 100 L/min, passage_conductance: 5 W/K, set_point: 14 degC, runs: "
           "while_spindle_turns}"},
          "coolant",
          "head",
          "which runs while the spindle turns",
          5.0,
          0.5},
    Cause{"a_thermometer_that_the_fan_blows_at",
          {"{type: sensor_place, sensor: t_column, body: ambient, share: 0.2, acts: while_spindle_turns}"},
          "sensor_place",
          "t_column",
          "a share of the air while the spindle turns",
          0.2,
          0.03},
    Cause{"drives_on_standby",
          {"{type: heat_source, node: column, power: 30 W, runs: while_spindle_turns, runs_on: 20 min}"},
          "heat_source",
          "column",
          "while the spindle turns and some minutes more",
          30.0,
          3.0},
    Cause{"free_convection",
          {"{type: changed_law, law: link column - ambient, difference_exponent: 0.3, at_difference: 10 K}"},
          "natural_convection",
          "column,ambient",
          "a power of the temperature difference",
          0.3,
          0.02},
    Cause{"preload_that_grows_with_what_a_ring_is_warmer",
          {"{type: changed_law, law: heat_source head, decay: -0.02 1/K, over: column}"},
          "friction_law",
          "head",
          "heat that falls as its body becomes warmer than column; < 0: it grows",
          -0.02,
          0.003},
    Cause{"fit_that_tightens",
          {"{type: changed_law, law: link head - column, decay: -0.03 1/K, over: column}"},
          "contact",
          "head,column",
          "a conductance that falls as head becomes warmer than column; < 0: it grows",
          -0.03,
          0.004},
    Cause{"oil_that_carries_heat_while_it_runs",
          {"{type: link, node: head, to: column, conductance: 8 W/K, runs: while_spindle_turns}"},
          "link",
          "head,column",
          "a path of heat while the spindle turns",
          8.0,
          0.8},
    Cause{"oil_that_passes_a_thermometer",
          {"{type: sensor_place, sensor: t_column, body: head, share: 0.15, acts: while_spindle_turns}"},
          "sensor_place",
          "t_column",
          "reads a share of head while the spindle turns",
          0.15,
          0.01},
    Cause{"a_fan_that_runs_on",
          {"{type: link, node: head, to: ambient, conductance: 6 W/K, runs: while_spindle_turns, runs_on: 8 min}"},
          "forced_convection",
          "head,ambient",
          "a fan that runs while the spindle turns and some minutes more",
          6.0,
          0.6},
    Cause{"an_amplifier_that_warms_up",
          {"{type: sensor_bias, sensor: t_column, bias: -0.8 K, fades: 14 min}"},
          "sensor_bias",
          "t_column",
          "error that fades from the start of each record on",
          -0.8,
          0.1},
    Cause{"a_drive_at_its_limit",
          {"{type: speed_override, at_most: 1500 rpm}"},
          "speed_override",
          "spindle",
          "a speed that is never exceeded",
          1500.0,
          40.0},
    Cause{"a_machine_that_had_run",
          {"{type: run_state, warmed_up: 35 min, rested: 8 min, in: tuesday}"},
          "run_state",
          "record",
          "as warm at its start as after so long of its mean drive, in a_machine_that_had_run_tuesday",
          35.0,
          6.0},
    Cause{"a_bearing_that_starves",
          {"{type: changed_law, law: heat_source head, growth_beyond: 0.2, beyond: 1100 rpm}"},
          "friction_law",
          "head",
          "another share beyond a speed",
          0.2,
          0.15},
    Cause{"a_gear_stage",
          {"{type: changed_law, law: heat_source head, factor_below: 1.7, below: 800 rpm}"},
          "friction_law",
          "head",
          "another factor below",
          1.7,
          0.15},
    Cause{"a_tool_changer",
          {"{type: heat_source, node: column, power: 150 W, runs: while_spindle_stands, lasts: 6 min}"},
          "heat_source",
          "column",
          "for some minutes after each stop",
          150.0,
          30.0},
    Cause{"a_brakes_resistor",
          {"{type: heat_source, node: column, power: 60 W, at_speed: 1000 rpm, exponent: 2, runs: while_spindle_stands, "
           "lasts: 8 min}"},
          "heat_source",
          "column",
          "by the square of the speed before it",
          60.0,
          12.0},
    Cause{"a_fixture_that_stays",
          {"{type: hidden_body, node: column, capacity: 20 kJ/K, conductance: 15 W/K, in: tuesday}",
           "{type: hidden_body, node: column, capacity: 20 kJ/K, conductance: 15 W/K, in: friday}"},
          "hidden_body",
          "column",
          "in a_fixture_that_stays_tuesday, a_fixture_that_stays_friday",
          15.0,
          1.5},
    Cause{"another_oil",
          {"{type: run_state, factor: 1.6, in: monday}", "{type: run_state, factor: 1.6, in: friday}"},
          "run_state",
          "record",
          "friday",
          1.6,
          0.1}};

/// Quantities, places and courses in time of each sort; the others are run AtLength.
constexpr std::string_view kOfEachSort[] = {
    "a_thermometer_that_stays_off",
    "a_lead_that_picks_up_the_drive",
    "a_logger_that_was_set_right",
    "a_pump_that_comes_again",
    "a_heater_at_rest",
    "preload_that_grows_with_what_a_ring_is_warmer",
    "an_indicator_that_was_set_up_anew",
    "a_fixture_that_stays",
    "a_gear_stage",
    "a_filter_that_clogs",
};

std::vector<Cause> causes(bool are_of_each_sort) {
  std::vector<Cause> chosen;
  for (const Cause& cause : kCauses) {
    const bool is_one = std::find(std::begin(kOfEachSort), std::end(kOfEachSort), cause.name) != std::end(kOfEachSort);
    if (is_one == are_of_each_sort) chosen.push_back(cause);
  }
  return chosen;
}
std::string name_of(const ::testing::TestParamInfo<Cause>& one) {
  return one.param.name;
}
INSTANTIATE_TEST_SUITE_P(OfEachSort, ACause, ::testing::ValuesIn(causes(true)), name_of);
INSTANTIATE_TEST_SUITE_P(OthersAtLength, ACause, ::testing::ValuesIn(causes(false)), name_of);

// Between speeds that each hold for a while, a tenth apart and more; of many the widest.
TEST(AGearStage, IsLookedForBetweenTheSpeedsOfTheRecords) {
  const Beside beside(write_file("plain.yaml", kTwoNodes), noisy_records(write_file("truth.yaml", kTwoNodes), "geared_"));
  std::vector<std::string> stages;
  for (const Candidate& c : candidates(*beside.twin, beside.runs, {})) {
    for (const Variant& v : c.variants) {
      if (c.where == "head" && v.law.starts_with("heat by another factor below")) stages.push_back(v.law.substr(29));
    }
  }
  EXPECT_THAT(stages, testing::UnorderedElementsAre("450 rpm", "750 rpm", "950 rpm", "1200 rpm", "1500 rpm", "1700 rpm"));
}

// Whatever a search may say of some records a scenario can say, too.
TEST(OfSomeRecords, EveryLawCanBeWrittenAndReadAgain) {
  const std::vector<std::string> records = noisy_records(write_file("truth.yaml", kTwoNodes), "some_");
  const Beside beside(write_file("plain.yaml", kTwoNodes), records);
  int n_laws = 0;
  for (const Candidate& c : candidates(*beside.twin, beside.runs, {})) {
    for (const Variant& v : c.variants) {
      if (!v.of_some_runs || !v.in.empty()) continue;
      const Variant law = law_of(effects::of_runs(*v.of_some_runs, {"some_monday", "some_friday"}));
      EXPECT_THAT(law.law, HasSubstr("in some_monday, some_friday"));
      Eigen::VectorXd x = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(law.knobs.size()));
      x[0] = law.trial_x;
      const Claim claim{.knobs = law.knobs, .all_or_nothing = law.all_or_nothing};
      const ExtendedScenario extended =
          extended_scenario(beside.scenario, *beside.twin, beside.runs, {{"it", "because", change_of(claim, x)}}, {});
      EXPECT_THAT(extended.text,
                  AllOf(HasSubstr("in: some_monday"), HasSubstr("in: some_friday"), Not(HasSubstr("in: some_tuesday"))))
          << c.effect << " at " << c.where << ": " << law.law;
      EXPECT_NO_THROW((void)scenarios::read_scenario(write_file("extended.yaml", extended.text))) << extended.text;
      ++n_laws;
    }
  }
  EXPECT_GT(n_laws, 30);
}

// What holds in some records takes no part in the state at rest from which all begin.
TEST(OfSomeRecords, HeatIsFoundWhereRecordsBeginAtRest) {
  const std::string machine = "start: steady\n" + std::string(kTwoNodes);
  std::string truth = with_effect(machine, "{type: heat_source, node: column, power: 40 W, in: monday}");
  truth = with_effect(truth, "{type: heat_source, node: column, power: 40 W, in: friday}");
  const Found found(machine, truth, "rest_");
  const Diagnosis& d = found.d;
  ASSERT_THAT(d.causes, SizeIs(1)) << d.reason;
  EXPECT_EQ(d.causes[0].effect, "heat_source");
  EXPECT_EQ(d.causes[0].where, "column");
  EXPECT_THAT(d.causes[0].law, HasSubstr("in rest_monday, rest_friday"));
  EXPECT_NEAR(d.causes[0].parameters[0].value, 40.0, 4.0);
}

// A scale that more than doubles what it measures is five of the catalogue's sigmas away: the readings, not the
// catalogue, say by how much.
TEST(FarBeyondTheUsual, ASizeIsNotDrawnBackToIt) {
  std::string machine = two_records_of_two_nodes();
  const std::string one = "      - {node: head, sensitivity: 3 um/K}\n";
  machine.insert(machine.find(one) + one.size(), "      - {node: column, sensitivity: 2 um/K}\n");
  const std::string truth = with_effect(machine, "{type: scale_expansion, displacement: nose, factor: 2.5}");
  const Found found(machine, truth, "far_");
  const Diagnosis& d = found.d;
  ASSERT_THAT(d.causes, SizeIs(1)) << d.reason;
  EXPECT_EQ(d.causes[0].effect, "scale_expansion");
  const Estimate& factor = d.causes[0].parameters[0];
  EXPECT_GT(factor.value, 2.2);
  EXPECT_LT(factor.low, 2.5);
  EXPECT_GT(factor.high, 2.5);
}

constexpr const char* kTwoRecords = R"(name: first_machine
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: spindle, capacity: 5.6 kJ/K}
  - {type: node, node: housing, capacity: 19 kJ/K}
  - {type: heat_source, node: spindle, power: 150 W, at_speed: 6000 rpm, exponent: 1.5}
  - {type: link, node: spindle, to: housing, conductance: 12 W/K}
  - {type: link, node: housing, to: ambient, conductance: 5 W/K}
ambient: [[0 min, 20 degC]]
sensors:
  - {name: t_spindle, node: spindle}
  - {name: t_housing, node: housing}
displacements: [{name: nose_z, sensitivities: [{node: spindle, sensitivity: 2.5 um/K}]}]
cyclograms:
  warm_up: [[90 min, 6000 rpm], [60 min, 0 rpm]]
  shift: [[120 min, 6000 rpm], [30 min, 0 rpm], [90 min, 3000 rpm]]
)";

TEST(KeptOutRecords, ArePredictedWithTheCause) {
  const std::string truth = with_effect(kTwoRecords, "{type: heat_source, node: housing, power: 40 W}");
  const Found found(kTwoRecords, truth, "pump_", {.noise_K = 0.1, .noise_um = 0.5});
  const Diagnosis& d = found.d;
  ASSERT_THAT(d.causes, SizeIs(1)) << d.reason;
  EXPECT_EQ(d.causes[0].effect, "heat_source");
  EXPECT_GT(d.misses.as_written, 5.0);
  EXPECT_LT(d.misses.extended, 1.3);
}

TEST(AShortStop,
     IsFoundThoughItLiesBetweenTheTimesThatAreTriedFirst) {  // 2.5 min of a record of 5 h: rarer than any grid of stops
  const std::string machine = two_records_of_two_nodes();
  const std::string truth = with_effect(machine, "{type: missing_stop, start: 216 min, length: 2.5 min, in: monday}");
  const Found found(machine, truth, "stop_", {.row_s = 30.0, .noise_K = 0.1, .noise_um = 1.0});
  const Diagnosis& d = found.d;
  ASSERT_THAT(d.causes, SizeIs(1)) << d.reason;
  EXPECT_EQ(d.causes[0].effect, "missing_stop");
  EXPECT_NE(d.causes[0].standing, Standing::kSuspected);
  for (const auto& other : d.causes[0].alternatives)
    EXPECT_THAT(other.effect, testing::AnyOf("heat_window", "exchange_window"));  // less heat for as long is nearly the same
  EXPECT_GT(d.causes[0].odds.kind, 0.5);
  EXPECT_NEAR(d.causes[0].parameters[0].value, 2.5, 0.3);
  EXPECT_NEAR(d.causes[0].parameters[1].value, 216.0, 0.5);
}

TEST(AnotherSpeedForAWhile, IsFoundInAllItsWindowsWhereTwoHeatsFollowTheSpeed) {  // heat in one body would not do
  const std::string machine =
      with_effect(two_records_of_two_nodes(), "{type: heat_source, node: column, power: 80 W, at_speed: 1000 rpm}");
  const std::string truth = with_effect(
      machine, "{type: speed_override, factor: 0.55, windows: [[20 min, 45 min], [180 min, 210 min]], in: monday}");
  const Found found(machine, truth, "speed_");
  const Diagnosis& d = found.d;
  ASSERT_THAT(d.causes, SizeIs(1)) << d.reason;
  EXPECT_EQ(d.causes[0].effect, "speed_override");
  EXPECT_EQ(d.causes[0].standing, Standing::kNamed);
  EXPECT_THAT(d.causes[0].law, HasSubstr("2 windows of one size"));
  ASSERT_THAT(d.causes[0].parameters, SizeIs(5));  // the factor, and when each window begins and ends
  EXPECT_NEAR(d.causes[0].parameters[0].value, 0.55, 0.03);
  const double times_min[] = {20.0, 45.0, 180.0, 210.0};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(d.causes[0].parameters[i + 1].value, times_min[i], 1.0);
  found.expect_written_is_found_no_more();
}

// The state of rest that a machine starts from follows its numbers, also where a law follows temperature: a weaker path
// to the ambient, with heat that is always there, is a warmer start and nothing that happened.
TEST(ASteadyStart, FollowsTheNumbersOfAMachineWhoseFrictionFollowsTemperature) {
  std::string nominal = with_effect(kTwoNodes, "{type: heat_source, node: column, power: 60 W}");
  nominal = with_effect(nominal,
                        "{type: friction_law, node: head, power: 50 W, at_speed: 1000 rpm, exponent: 1.3, decay: 0.0125 "
                        "1/K, at_temperature: 20 degC}");
  nominal.insert(nominal.find("machine:"), "start: steady\n");
  std::string truth = nominal;
  const std::string path = "to: ambient, conductance: 14 W/K";
  truth.replace(truth.find(path), path.size(), "to: ambient, conductance: 12 W/K");
  const Found found(nominal, truth, "rest_");
  const Diagnosis& d = found.d;
  EXPECT_EQ(d.verdict, Verdict::kConsistent) << d.reason;
}

}  // namespace
}  // namespace driftwright::diagnosis::lasting_causes_test
