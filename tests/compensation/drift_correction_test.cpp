// The C code of controls, stage by stage, against closed forms.

#include "compensation/control/drift_correction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/errors.hpp"
#include "compensation/predictors/drift_model.hpp"
#include "compensation/predictors/fail_safe.hpp"

namespace driftwright::compensation::drift_correction_test {
namespace {

using ::testing::ElementsAre;

drift_term term(double lag_s) {
  return {.input = 0, .is_rise = 0, .holds = 1, .is_running = 0, .power = 1, .coefficient = 1.0, .lag_s = lag_s};
}

// On for 40 steps of 30 s, then off: 1 - exp(-t/tau), then exp(-(t - on)/tau) of what it was. The speed does not matter,
// its sign neither.
TEST(DriftTerm, OfRunningIsTheMemoryOfOnAndOff) {
  drift_term t = term(600.0);
  t.is_running = 1;
  for (const double speed_rpm : {1.0, 3000.0, -500.0, 1e-9}) {
    drift_term_state state{};
    const double after_on = 1.0 - std::exp(-40 * 30.0 / 600.0);
    for (int i = 0; i <= 100; ++i) {
      const double time_s = 30.0 * i, got = drift_term_value(&t, &state, i < 40 ? speed_rpm : 0.0, 30.0);
      const double wanted = i <= 40 ? 1.0 - std::exp(-time_s / 600.0) : after_on * std::exp(-(time_s - 1200.0) / 600.0);
      EXPECT_NEAR(got, wanted, 1e-14) << speed_rpm << " row " << i;
    }
  }
  t.lag_s = 0.0;
  drift_term_state state{};
  EXPECT_EQ(drift_term_value(&t, &state, 123.0, 1.0), 1.0);
  EXPECT_EQ(drift_term_value(&t, &state, 0.0, 1.0), 0.0);
  EXPECT_TRUE(std::isnan(drift_term_value(&t, &state, NAN, 1.0)));
}

// Through the model of the program: 2 um + 5 um while it turns, of which 3 um come after a lag.
TEST(DriftModel, CountsRunningInPlaceOfTheSpeed) {
  const DriftModel model{.kind = "",
                         .target = "d",
                         .target_unit = "um",
                         .intercept = 2.0,
                         .terms = {{.input = "n", .unit = "rpm", .coefficient = 2.0, .is_running = true},
                                   {.input = "n", .unit = "rpm", .coefficient = 3.0, .lag_s = 100.0, .is_running = true}}};
  const Record r{.source = "r", .time_s = {0, 100, 200, 300}, .channels = {{"n", "rpm", {0, 6000, 1, 0}}}};
  const double e = std::exp(-1.0);
  const std::vector<double> d = model.predict(r);
  EXPECT_EQ(d[0], 2.0);
  EXPECT_EQ(d[1], 4.0);
  EXPECT_NEAR(d[2], 4.0 + 3.0 * (1.0 - e), 1e-14);
  EXPECT_NEAR(d[3], 2.0 + 3.0 * (1.0 - e * e), 1e-14);
}

// A step response does not depend on where the rows lie: missing ones are made up for.
TEST(DriftTerm, MakesUpForMissingReadingsOfWhatHolds) {
  const drift_term t = term(100.0);
  drift_term_state state{};
  double last = 0.0;
  for (int i = 0; i <= 61; ++i) {
    const bool is_missing = i % 7 == 3 || i % 7 == 4;
    const double got = drift_term_value(&t, &state, is_missing ? (i % 2 ? NAN : INFINITY) : 5.0, 10.0);
    EXPECT_EQ(std::isnan(got), is_missing);
    if (!is_missing) last = got;
  }
  EXPECT_NEAR(last, 5.0 * (1.0 - std::exp(-6.1)), 1e-13);
}

// 0.5 T^3 of rises: 0 in the first row, whatever it reads.
TEST(DriftFormula, CountsRisesFromTheFirstReadingAndRaisesThemToTheirPower) {
  drift_term t = term(0.0);
  t.is_rise = 1;
  t.power = 3;
  t.coefficient = 0.5;
  const drift_formula formula{.intercept_um = 1.0, .n_terms = 1, .terms = &t};
  drift_term_state state{};
  std::vector<double> got;
  for (const double T : {20.0, 22.0, 17.0}) got.push_back(drift_formula_value(&formula, &state, &T, 1.0));
  EXPECT_THAT(got, ElementsAre(1.0, 5.0, -12.5));
}

drift_guard plain_guard() {
  return {.is_rise = 0,
          .low = 0.0,
          .high = 100.0,
          .most_jump = HUGE_VAL,
          .others_intercept = 0.0,
          .others_coefficient = nullptr,
          .most_apart = 0.0,
          .start_offset = 0.0,
          .start_weight = 0.0};
}
drift_fail_safe plain_safe(const drift_guard* guards, int n) {
  return {.n_inputs = n,
          .guards = guards,
          .most_replaced = 1,
          .period_s = 10.0,
          .stale_s = 50.0,
          .fade_s = 100.0,
          .back_after_s = 300.0,
          .back_within = 0.5,
          .most_start = HUGE_VAL,
          .start_s = HUGE_VAL,
          .lowest_um = -50.0,
          .highest_um = 80.0,
          .most_rate_um_s = 0.25};
}

// The last stage alone, with a prediction from elsewhere: trust (1 - exp(-t/fade)), the clamp, 0.25 um/s.
TEST(DriftGuarded, SlewsClampsFadesAndHoldsWhateverPredicts) {
  const drift_fail_safe safe = plain_safe(nullptr, 0);
  drift_state state{};
  EXPECT_EQ(drift_guarded_um(&safe, &state, 1.0, NAN, 1e9), 0.0);  // nothing was predicted yet
  EXPECT_EQ(drift_guarded_um(&safe, &state, 1.0, 7.0, 10.0), 2.5);
  EXPECT_EQ(drift_guarded_um(&safe, &state, 1.0, NAN, 10.0), 5.0);  // 7 um still hold
  EXPECT_EQ(drift_guarded_um(&safe, &state, 1.0, INFINITY, 10.0), 7.0);
  EXPECT_EQ(drift_guarded_um(&safe, &state, 1.0, -1e9, 4.0), 6.0);
  EXPECT_EQ(drift_guarded_um(&safe, &state, 1.0, -1e9, 1e4), -50.0);
  EXPECT_EQ(state.trust, 1.0);
  drift_guarded_um(&safe, &state, 0.0, 40.0, 100.0);
  EXPECT_NEAR(state.trust, std::exp(-1.0), 1e-15);
  // steps that are none take no time
  const double before_um = state.correction_um, trust = state.trust;
  for (const double dt_s : {0.0, -5.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    EXPECT_EQ(drift_guarded_um(&safe, &state, 0.0, 40.0, dt_s), before_um);
    EXPECT_EQ(state.trust, trust);
  }
}

TEST(DriftRepair, SaysWhichInputIsInDoubtAndWhy) {
  const double twin[] = {0.0, 1.0, 0.0, 0.0}, other[] = {1.0, 0.0, 0.0, 0.0};
  std::vector<drift_guard> guards(4, plain_guard());
  guards[0].others_coefficient = twin;
  guards[1].others_coefficient = other;
  guards[0].most_apart = guards[1].most_apart = 4.0;
  guards[0].most_jump = 5.0;
  const drift_fail_safe safe = plain_safe(guards.data(), 4);
  drift_state state{};
  std::vector<drift_input_state> inputs(4);
  std::vector<double> room(20), repaired(4);
  const auto row = [&](double a, double b, double c, double dt_s) {
    const double read[] = {a, b, c, 50.0};
    return drift_repair(&safe, &state, inputs.data(), room.data(), read, dt_s, repaired.data());
  };
  EXPECT_EQ(row(20, 20, 30, 123.0), 1.0);
  EXPECT_EQ(row(26.5, 20, 30, 10.0), 1.0);  // a jump of 6.5 where 5 are allowed: replaced by its twin
  EXPECT_EQ(inputs[0].is_doubted, 1);
  EXPECT_EQ(inputs[0].doubt, DRIFT_JUMP);
  EXPECT_EQ(inputs[0].doubt_size, 6.5);
  EXPECT_THAT(repaired, ElementsAre(20, 20, 30, 50));
  EXPECT_EQ(row(20.5, 20, NAN, 10.0), 1.0);  // the third holds for 50 s
  EXPECT_EQ(inputs[0].doubt, DRIFT_JUMP);    // back by 6
  for (int i = 0; i < 4; ++i) EXPECT_EQ(row(20.5, 20, INFINITY, 10.0), 1.0);
  EXPECT_EQ(inputs[2].is_doubted, 0);
  EXPECT_EQ(row(20.5, 20, NAN, 10.0), 0.0);  // 60 s: no reading shows it
  EXPECT_EQ(inputs[2].doubt, DRIFT_NO_READING);
  EXPECT_EQ(inputs[0].is_doubted, 1);
  for (int i = 0; i < 26; ++i) row(20.5, 20, 30, 10.0);  // 300 s after its last jump the first counts again
  EXPECT_EQ(inputs[0].is_doubted, 0);
  EXPECT_EQ(repaired[0], 20.5);
  row(20.5, 26.0, 30, 10.0);  // 5.5 apart where 4 are allowed; of two that say the same of each other the first
  EXPECT_EQ(inputs[0].is_doubted + inputs[1].is_doubted, 1);
  EXPECT_EQ(inputs[0].doubt, DRIFT_APART);
  EXPECT_EQ(inputs[0].doubt_size, -5.5);
}

// A machine that begins warm has other differences between its thermometers. What all have in common is the weather.
TEST(DriftRepair, TrustsNoStartThatIsHalfAsWarmAsWorkUntilItIsForgotten) {
  std::vector<drift_guard> guards(3, plain_guard());  // the third is a drive
  guards[0].start_offset = 1.0;
  guards[1].start_offset = -1.0;
  guards[0].start_weight = 0.05;  // work: the first is 10 K, the second -10 K from the mean of both
  guards[1].start_weight = -0.05;
  const auto trusts = [&](double start_s, double a, double b, double b_of_second_row = 19.0) {
    drift_fail_safe safe = plain_safe(guards.data(), 3);
    safe.most_start = 0.5;
    safe.start_s = start_s;
    drift_state state{};
    std::vector<drift_input_state> inputs(3);
    std::vector<double> room(12), repaired(3), trust;
    for (int row = 0; row < 3; ++row) {
      const double read[] = {row == 0 ? a : 21.0, row == 0 ? b : row == 1 ? b_of_second_row : 19.0, 90.0};
      trust.push_back(drift_repair(&safe, &state, inputs.data(), room.data(), read, 50.0, repaired.data()));
    }
    return trust;
  };
  EXPECT_THAT(trusts(100.0, 21.0, 19.0), ElementsAre(1.0, 1.0, 1.0));
  EXPECT_THAT(trusts(100.0, 31.0, 29.0), ElementsAre(1.0, 1.0, 1.0));
  EXPECT_THAT(trusts(100.0, 30.9, 19.0), ElementsAre(1.0, 1.0, 1.0));  // 9.9 K apart: 0.495
  const std::vector<double> forgets = {0.0, 1.0 - std::exp(-0.5), 1.0 - std::exp(-1.0)};
  EXPECT_EQ(trusts(100.0, 31.1, 19.0), forgets);
  EXPECT_EQ(trusts(100.0, 21.0, 29.1), forgets);  // or as much colder
  EXPECT_THAT(trusts(HUGE_VAL, 31.1, 19.0), ElementsAre(0.0, 0.0, 0.0));
  // a thermometer whose first reading comes later is judged by that
  EXPECT_THAT(trusts(HUGE_VAL, 21.0, NAN, 29.1), ElementsAre(0.0, 0.0, 0.0));
}

// Two steps at once are the stages one by one.
TEST(DriftCorrectionStep, IsItsThreeStages) {
  drift_guard guard = plain_guard();
  guard.is_rise = 1;
  const drift_fail_safe safe = plain_safe(&guard, 1);
  drift_term t = term(0.0);
  t.is_rise = 1;
  t.coefficient = 2.0;
  const drift_formula formula{.intercept_um = 0.5, .n_terms = 1, .terms = &t};
  drift_state state{};
  drift_input_state input{};
  drift_term_state term_state{};
  double repaired = 0.0, room[2];
  const drift_arrays arrays{.inputs = &input, .terms = &term_state, .repaired = &repaired, .room = room};
  std::vector<double> got;
  for (const double T : {21.0, 21.75, 22.0, 150.0})
    got.push_back(drift_correction_step(&safe, &formula, &state, &arrays, &T, 4.0));
  // 0.5, then 2 um/K of 0.75 and 1 K, at most 1 um in 4 s; at the end a rise of 129, 29 beyond 100 of the range: trust
  // goes to 0.71
  EXPECT_THAT(got, ElementsAre(0.5, 1.5, 2.5, 3.5));
  EXPECT_EQ(repaired, 121.0);
  EXPECT_NEAR(state.deserved, 0.71, 1e-14);
  EXPECT_NEAR(state.trust, 1.0 - 0.29 * (1.0 - std::exp(-0.04)), 1e-14);
}

TEST(Repaired, OfARecordWithoutAnInputIsRefused) {
  const FailSafe safe{.guards = {{.input = "T", .unit = "degC", .low = 0, .high = 50, .others_coefficient = {}}}};
  EXPECT_THROW((void)repaired(safe, {.source = "r", .time_s = {0}, .channels = {{"U", "degC", {20}}}}), InputError);
}

// Readings that are infinite are as good as none, through the program's own functions, too.
TEST(Repaired, TakesInfiniteReadingsForMissing) {
  FailSafe safe{
      .guards = {{.input = "T", .unit = "degC", .low = 0, .high = 50, .most_jump = 1e9, .others_coefficient = {}}}};
  safe.period_s = 10.0;
  safe.stale_s = 50.0;
  for (const bool from_start : {false, true}) {
    safe.from_start = from_start;
    const Record r{.source = "r", .time_s = {0, 10, 20}, .channels = {{"T", "degC", {20, INFINITY, 21}}}};
    EXPECT_THAT(repaired(safe, r).readings.channels[0].values, ElementsAre(20, 20, 21));
  }
}

}  // namespace
}  // namespace driftwright::compensation::drift_correction_test
