// What is hidden in blind cases, each law by a value worked out by hand.

#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "blind/case.hpp"

namespace driftwright::blind::blind_laws_test {
namespace {

const Subject& spindle() {
  static const Subject s = make_subject("tests/blind/machines", "motor_spindle");
  return s;
}

/// A balance with every kind of entry that a hidden law changes; laws are looked at, nothing is solved.
effects::HeatBalance balance() {
  effects::HeatBalance b;
  const auto constant = [](double value) { return effects::Law([value](const effects::Inputs&) { return value; }); };
  b.heats = {{"bearing_friction a", effects::node("a"), constant(10.0)}, {"spare a", effects::node("a"), constant(0.0)}};
  b.exchanges.push_back(effects::make_film("convection s", "s", constant(8.0)));
  b.exchanges.push_back(effects::make_film("forced_convection s", "s", constant(5.0)));
  b.exchanges.push_back(effects::make_film("spare s", "s", constant(0.0)));
  b.exchanges.push_back(effects::make_link("link a - ambient", effects::node("a"), constant(4.0)));
  b.exchanges.push_back(effects::make_contact("contact a/b", "a/b", constant(2000.0)));
  return b;
}

effects::Inputs at(double speed_rpm, double time_s = 0.0, std::vector<double> probe_K = {}) {
  return {.drive = {.speed_rpm = speed_rpm}, .ambient_K = 0.0, .time_s = time_s, .probe_K = std::move(probe_K)};
}

effects::HeatBalance with(const Hidden& h, const Cyclogram& drive = {}) {
  effects::HeatBalance b = balance();
  hide_in_heat(h, spindle(), drive, b);
  return b;
}

TEST(BlindHeat, ConstantAndOfSpeed) {
  EXPECT_DOUBLE_EQ(with({.what = Hide::kHeatConstant, .where = "a", .size = 30.0}).heats[1].power_W(at(0.0)), 30.0);
  EXPECT_DOUBLE_EQ(with({.what = Hide::kRadiation, .where = "a", .size = 30.0}).heats[1].power_W(at(500.0)), 30.0);
  EXPECT_DOUBLE_EQ(with({.what = Hide::kCoolant, .where = "a", .size = 30.0}).heats[1].power_W(at(0.0)), -30.0);
  const Hidden of_speed{.what = Hide::kHeatOfSpeed, .where = "a", .size = 100.0, .at_speed_rpm = 2000.0, .exponent = 2.0};
  EXPECT_DOUBLE_EQ(with(of_speed).heats[1].power_W(at(1000.0)), 25.0);  // 100 W / 2^2
}

TEST(BlindHeat, FrictionByExponentAndByTemperature) {
  const Hidden exponent{.what = Hide::kFrictionExponent, .where = "a", .size = 0.5, .at_speed_rpm = 1000.0};
  EXPECT_DOUBLE_EQ(with(exponent).heats[0].power_W(at(1000.0)), 10.0);
  EXPECT_DOUBLE_EQ(with(exponent).heats[0].power_W(at(4000.0)), 20.0);  // 10 W x 4^0.5
  EXPECT_DOUBLE_EQ(with(exponent).heats[0].power_W(at(0.0)), 0.0);
  const auto decay = with({.what = Hide::kFrictionDecay, .where = "a", .size = 0.02});
  ASSERT_EQ(decay.heats[0].power_W.probes.size(), 1U);
  const double reference_K = spindle().model.reference_K;
  EXPECT_DOUBLE_EQ(decay.heats[0].power_W(at(1000.0, 0.0, {reference_K})), 10.0);
  EXPECT_NEAR(decay.heats[0].power_W(at(1000.0, 0.0, {reference_K + 10.0})), 8.187308, 1e-6);  // 10 exp(-0.2)
}

TEST(BlindHeat, FilmsJointsAndLinks) {
  const double ln2 = std::log(2.0);
  EXPECT_NEAR(with({.what = Hide::kFilmFactor, .where = "s", .size = ln2}).exchanges[0].coefficient(at(0.0)), 16.0, 1e-12);
  EXPECT_NEAR(with({.what = Hide::kForcedFactor, .where = "s", .size = -ln2}).exchanges[1].coefficient(at(0.0)), 2.5, 1e-12);
  EXPECT_NEAR(with({.what = Hide::kContactFactor, .where = "a/b", .size = ln2}).exchanges[4].coefficient(at(0.0)), 4000.0,
              1e-9);
  EXPECT_NEAR(with({.what = Hide::kContactFactor, .where = "a,ambient", .size = ln2}).exchanges[3].coefficient(at(0.0)), 8.0,
              1e-12);
  const auto loosens = with({.what = Hide::kContactLater, .where = "a,ambient", .size = -ln2, .time_s = 600.0});
  EXPECT_DOUBLE_EQ(loosens.exchanges[3].coefficient(at(0.0, 599.0)), 4.0);
  EXPECT_NEAR(loosens.exchanges[3].coefficient(at(0.0, 600.0)), 2.0, 1e-12);
  const auto draught = with({.what = Hide::kDraught, .where = "s", .size = 20.0, .time_s = 600.0});
  EXPECT_DOUBLE_EQ(draught.exchanges[2].coefficient(at(0.0, 599.0)), 0.0);
  EXPECT_DOUBLE_EQ(draught.exchanges[2].coefficient(at(0.0, 600.0)), 20.0);
  const auto grows = with({.what = Hide::kForcedNew, .where = "s", .size = 30.0, .at_speed_rpm = 4000.0, .exponent = 0.5});
  EXPECT_DOUBLE_EQ(grows.exchanges[2].coefficient(at(1000.0)), 15.0);  // 30 x (1/4)^0.5
  EXPECT_DOUBLE_EQ(with({.what = Hide::kStratification, .where = "ambient", .size = 1.5}).stratifications.at(0).gradient_K_m,
                   1.5);
}

TEST(BlindHeat, LawsOfNoCatalogue) {
  const auto swings = with({.what = Hide::kOscillatingHeat, .where = "a", .size = 40.0, .lag_s = 2400.0});
  EXPECT_NEAR(swings.heats[1].power_W(at(0.0, 600.0)), 40.0, 1e-9);  // a quarter of the period
  EXPECT_NEAR(swings.heats[1].power_W(at(0.0, 1800.0)), -40.0, 1e-9);
  const Cyclogram drive{.name = "c", .sections = {{600.0, {.speed_rpm = 1000.0}}, {600.0, {.speed_rpm = 400.0}}}};
  const auto speeds_up = with({.what = Hide::kAcceleratingHeat, .where = "a", .size = 3.0}, drive);
  EXPECT_DOUBLE_EQ(speeds_up.heats[1].power_W(at(1000.0, 30.0)), 50.0);  // 3 J/rpm x 1000 rpm / 60 s
  EXPECT_DOUBLE_EQ(speeds_up.heats[1].power_W(at(1000.0, 300.0)), 0.0);
  EXPECT_DOUBLE_EQ(speeds_up.heats[1].power_W(at(400.0, 660.0)), 30.0);  // 3 J/rpm x 600 rpm / 60 s
}

TEST(BlindValues, MaterialsAndCapacitiesTakeTheFactor) {
  Values v = nominal_values(spindle());
  hide_in_values({.what = Hide::kHeatCapacity, .where = "stator", .size = std::log(3.0)}, spindle(), v);
  EXPECT_NEAR(balance_of(spindle(), v).nodes[3].capacity_J_K, 3.0 * 4500.0, 1e-9);
  const Hidden h{.what = Hide::kHeatCapacity, .where = "stator", .size = std::log(3.0)};
  EXPECT_NEAR(parameters_of(h).at(0).value, 3.0, 1e-12);
  int n_left = 0;
  for (const ScatterParameter& p : spindle().scatter) n_left += stands_on(h, p) ? 1 : 0;
  EXPECT_EQ(n_left, 1);  // its own capacity and nothing else
}

TEST(BlindDrive, TrueSpeedAndAStopThatTheRecordLacks) {
  const Cyclogram told{.name = "c", .sections = {{600.0, {.speed_rpm = 1000.0}}, {600.0, {.speed_rpm = 500.0}}}};
  EXPECT_DOUBLE_EQ(true_drive({.what = Hide::kSpeedOverride, .size = -0.1}, told).speed_rpm(0.0), 900.0);
  const Cyclogram stood = true_drive({.what = Hide::kMissingStop, .size = 300.0, .time_s = 480.0}, told);  // until 780 s
  ASSERT_EQ(stood.sections.size(), 4U);
  EXPECT_DOUBLE_EQ(stood.duration_s(), 1200.0);
  for (const auto& [t_s, speed_rpm] : std::map<double, double>{{470, 1000}, {490, 0}, {610, 0}, {770, 0}, {790, 500}}) {
    EXPECT_DOUBLE_EQ(stood.speed_rpm(t_s), speed_rpm) << t_s;
  }
}

TEST(BlindAmbient, OffsetRampAndStep) {
  EXPECT_DOUBLE_EQ(ambient_error_K({.what = Hide::kAmbientOffset, .size = 2.0}, 0.0), 2.0);
  EXPECT_DOUBLE_EQ(ambient_error_K({.what = Hide::kAmbientRamp, .size = 2.0}, 1800.0), 1.0);
  const Hidden step{.what = Hide::kAmbientStep, .size = 2.0, .time_s = 600.0};
  EXPECT_DOUBLE_EQ(ambient_error_K(step, 599.0), 0.0);
  EXPECT_DOUBLE_EQ(ambient_error_K(step, 600.0), 2.0);
}

/// Two thermometers and an indicator over 50 min, every 20 s: a = t in min [K], b = 10 K, d = 0.
Readings readings() {
  Readings r{.step_s = 20.0,
             .name = {"a", "b", "d"},
             .value = Eigen::MatrixXd::Zero(3, 151),
             .ambient_K = Eigen::VectorXd::Constant(151, 4.0)};
  for (Eigen::Index k = 0; k < 151; ++k) r.value(0, k) = r.time_s(k) / 60.0;
  r.value.row(1).setConstant(10.0);
  return r;
}

Eigen::MatrixXd read(const Hidden& h) {
  const Cyclogram drive{.name = "c", .sections = {{1200.0, {.speed_rpm = 1000.0}}, {1800.0, {.speed_rpm = 500.0}}}};
  Readings r = readings();
  hide_in_readings(h, drive, 1000.0, r);
  return r.value;
}

TEST(BlindReadings, Sensors) {
  EXPECT_DOUBLE_EQ(read({.what = Hide::kSensorBias, .where = "b", .size = 0.5})(1, 0), 10.5);
  EXPECT_DOUBLE_EQ(read({.what = Hide::kSensorDrift, .where = "b", .size = 1.2})(1, 150), 11.0);  // 1.2 K/h for 50 min
  const auto detached = read({.what = Hide::kSensorDetached, .where = "b", .size = 0.25, .time_s = 600.0});
  EXPECT_DOUBLE_EQ(detached(1, 29), 10.0);
  EXPECT_DOUBLE_EQ(detached(1, 30), 8.5);  // 0.25 x 4 + 0.75 x 10
  const auto swapped = read({.what = Hide::kSensorSwap, .where = "a,b"});
  EXPECT_DOUBLE_EQ(swapped(0, 7), 10.0);
  EXPECT_DOUBLE_EQ(swapped(1, 150), 50.0);
  // A first-order lag follows a ramp late by the lag once it has settled: 50 min - 2 min (1 - exp(-25)).
  EXPECT_NEAR(read({.what = Hide::kSensorLag, .where = "a", .size = 120.0})(0, 150), 48.0, 1e-9);
  EXPECT_NEAR(read({.what = Hide::kSensorLag, .where = "a", .size = 1500.0})(0, 75), 25.0 * std::exp(-1.0),
              1e-9);  // t = lag
}

TEST(BlindReadings, ClockLateAndEarly) {
  const auto late = read({.what = Hide::kClockOffset, .size = 90.0});
  EXPECT_NEAR(late(0, 150), 48.5, 1e-9);
  EXPECT_DOUBLE_EQ(late(0, 3), 0.0);  // before the first, the first
  EXPECT_NEAR(read({.what = Hide::kClockOffset, .size = -90.0})(0, 60), 21.5, 1e-9);
}

TEST(BlindReadings, Displacements) {
  const auto centrifugal = read({.what = Hide::kCentrifugal, .where = "d", .size = 8.0, .at_speed_rpm = 1000.0});
  EXPECT_NEAR(centrifugal(2, 60), 8e-6, 1e-18);
  EXPECT_NEAR(centrifugal(2, 61), 2e-6, 1e-18);
  const auto growth =
      read({.what = Hide::kSpindleGrowth, .where = "d", .size = 10.0, .at_speed_rpm = 1000.0, .lag_s = 1200.0});
  EXPECT_NEAR(growth(2, 60), 10e-6 * (1.0 - std::exp(-1.0)), 1e-15);  // after one lag
  const auto shift = read({.what = Hide::kMountShift, .where = "d", .size = -3.0, .time_s = 600.0});
  EXPECT_DOUBLE_EQ(shift(2, 29), 0.0);
  EXPECT_DOUBLE_EQ(shift(2, 30), -3e-6);
  const auto creep = read({.what = Hide::kTravelCreep, .where = "d", .size = 6.0});
  EXPECT_NEAR(creep(2, 150), 3.5e-6, 1e-15);  // 20 min at top speed and 30 min at half of it, 6 um/h
}

TEST(BlindLoudness, NoLouderThanItsNoiseAllowsAndQuietWhereScatterExplainsIt) {
  CasePlan plan = draw_plan(spindle(), 0);
  const Loudness loudness(spindle(), plan);
  const Hidden bias{.what = Hide::kSensorBias, .where = "t_stator", .size = 0.2};
  double n_rows = 0.0;
  for (std::size_t r = 0; r < plan.n_measured(); ++r) n_rows += plan.records[r].drive.duration_s() / 60.0 + 1.0;
  const double alone = 0.2 * std::sqrt(n_rows) / plan.noise[3].against_slow(60.0);  // without any scatter
  EXPECT_LT(loudness.d_prime(bias), alone);
  EXPECT_GT(loudness.d_prime(bias), 0.3 * alone);
  // One standard deviation of a number that scatters is no effect, however large it is in the records.
  const Hidden capacity{.what = Hide::kHeatCapacity, .where = "stator", .size = 0.1};
  const Eigen::VectorXd s = loudness.signature({capacity});
  EXPECT_GT(s.norm(), 5.0);
  EXPECT_LT(loudness.d_prime(capacity), 1.0);
}

TEST(BlindLoudness, SizesAreTunedToIt) {
  const CasePlan plan = draw_plan(spindle(), 0);
  const Loudness loudness(spindle(), plan);
  Hidden lag{.what = Hide::kSensorLag, .where = "t_stator", .size = 100.0, .low = 10.0, .high = 3000.0};
  const double d = tune(loudness, lag, 25.0);
  EXPECT_NEAR(d, 25.0, 1.5);
  EXPECT_DOUBLE_EQ(loudness.d_prime(lag), d);
}

TEST(BlindPlan, ClassesOf400SeedsAndOfEachPrefixOf40) {
  std::map<CaseClass, int> count;
  for (std::uint64_t seed = 0; seed < 400; ++seed) ++count[class_of(seed)];
  EXPECT_EQ(count[CaseClass::kOne], 120);
  EXPECT_EQ(count[CaseClass::kTwo], 100);
  EXPECT_EQ(count[CaseClass::kNone], 100);
  EXPECT_EQ(count[CaseClass::kOutside], 50);
  EXPECT_EQ(count[CaseClass::kConfounded], 30);
  std::map<std::pair<CaseClass, std::size_t>, int> met;
  for (std::uint64_t seed = 0; seed < 400; ++seed) ++met[{class_of(seed), subject_of(seed)}];
  EXPECT_EQ(met.size(), 5 * subject_names().size());  // each class meets each machine
}

TEST(BlindPlan, RecordsAreAsTheirRulesSay) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const CasePlan plan = draw_plan(spindle(), seed);
    ASSERT_EQ(plan.records.size(), 3U);
    for (const RecordPlan& r : plan.records) {
      const auto& sections = r.drive.sections;
      EXPECT_THAT(sections.size(), testing::AllOf(testing::Ge(4U), testing::Le(8U)));
      EXPECT_TRUE(std::any_of(sections.begin(), sections.end(), [](const auto& s) { return s.drive.speed_rpm == 0.0; }));
      EXPECT_THAT(r.drive.duration_s() / 60.0, testing::AllOf(testing::Ge(140.0), testing::Le(380.0)));
      for (const auto& s : sections) EXPECT_DOUBLE_EQ(std::fmod(s.duration_s, 300.0), 0.0);
    }
  }
}

TEST(BlindRandom, NormalNumbersAreNormal) {
  Random random(7);
  double sum = 0.0, squares = 0.0;
  constexpr int kN = 40000;
  for (int i = 0; i < kN; ++i) {
    const double z = random.normal();
    sum += z;
    squares += z * z;
  }
  EXPECT_NEAR(sum / kN, 0.0, 0.02);      // 4 standard errors
  EXPECT_NEAR(squares / kN, 1.0, 0.03);  // 4 of sqrt(2 / n)
}

}  // namespace
}  // namespace driftwright::blind::blind_laws_test
