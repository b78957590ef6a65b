// Effects of bearings, axes, cutting, joints and time windows, as the user writes them, by value. Long,
// because each effect adds a case.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/errors.hpp"
#include "effects/bearing_formulas.hpp"
#include "effects/catalogue_table.hpp"
#include "effects/effect.hpp"
#include "tests/effects/read_entry.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::effects::effect_laws_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

HeatBalance balance_of(const std::string& text) {
  return heat_balance({read(text)});
}
Inputs moving(double x_m_s, double y_m_s, double z_m_s) {
  return {.drive = {.feed_m_s = {x_m_s, y_m_s, z_m_s}}};
}

// --- recorded columns -------------------------------------------------------------------------------------------

const Cyclogram kWithHeater{.name = "run",
                            .sections = {{90, {.speed_rpm = 100}}, {110, {.speed_rpm = 0}}},
                            .remarks = {},
                            .columns = {{"heater", "W", {{0, 60, 120, 180}, {10, 30, 30, 20}}}}};

TEST(RecordedDrive, SplitsTheDriveWhereItsColumnChanges) {
  const Effect e = read("{type: recorded_drive, node: air, column: heater_W, gain: 0.5}");
  const Cyclogram felt = true_cyclogram(drive_change({e}, "run"), kWithHeater);
  ASSERT_EQ(felt.sections.size(), 4u);  // 0, 60, 90 (speed), 180 s: nothing changes at 120 s
  const Law power_W = heat_balance({e}).heats.at(0).power_W;
  const double expected_W[] = {5, 15, 15, 10}, length_s[] = {60, 30, 90, 20};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_DOUBLE_EQ(power_W({.drive = felt.sections[i].drive}), expected_W[i]);
    EXPECT_DOUBLE_EQ(felt.sections[i].duration_s, length_s[i]);
  }
  EXPECT_EQ(felt.sections[2].drive.speed_rpm, 0.0);
  EXPECT_EQ(power_W(Inputs{}), 0.0) << "a drive without the column";
}

TEST(RecordedDrive, BehindALagKeepsTheHeatOfEachPiece) {
  const Effect e = read("{type: recorded_drive, node: air, column: heater, gain: 1, lag: 2 min}");
  const Cyclogram felt = true_cyclogram(drive_change({e}, "run"), kWithHeater);
  const Law power_W = heat_balance({e}).heats.at(0).power_W;
  // settled at 10 W; from 60 s on y = 30 - 20 exp(-(t - 60) / 120), in pieces of 30 s; from 180 s on towards 20 W.
  // As 120 y' = c - y, the mean of y over a piece is c - 120 (y_end - y_begin) / length.
  const auto y_W = [](double t_s) { return 30.0 - 20.0 * std::exp(-(t_s - 60.0) / 120.0); };
  EXPECT_DOUBLE_EQ(power_W({.drive = felt.drive(30)}), 10.0);
  EXPECT_NEAR(power_W({.drive = felt.drive(70)}), 30.0 - 4.0 * (y_W(90) - y_W(60)), 1e-12);
  EXPECT_NEAR(power_W({.drive = felt.drive(130)}), 30.0 - 4.0 * (y_W(150) - y_W(120)), 1e-12);
  EXPECT_NEAR(power_W({.drive = felt.drive(190)}), 20.0 + (y_W(180) - 20.0) * 6.0 * (1.0 - std::exp(-1.0 / 6.0)), 1e-12);
  EXPECT_EQ(felt.duration_s(), kWithHeater.duration_s());
}

TEST(RecordedDrive, ExchangesWithABodyAsWarmAsTheColumnSays) {
  // Q = G (T - c): a medium at 20 degC and heat that makes up for c
  const HeatBalance b = balance_of("{type: recorded_drive, region: frame, column: bed_degC, conductance: 3 W/K}");
  const Inputs at{.drive = {.signals = {{"bed_degC", 65.0}}}};
  EXPECT_DOUBLE_EQ(b.exchanges.at(0).coefficient(at), 3.0);
  EXPECT_DOUBLE_EQ(b.exchanges.at(0).medium_K.value(), 293.15);
  EXPECT_DOUBLE_EQ(b.heats.at(0).power_W(at), 3.0 * 45.0);
  const HeatBalance valve =
      balance_of("{type: recorded_drive, node: air, column: valve_percent, opening: 0.2, surrounding: tank}");
  EXPECT_DOUBLE_EQ(valve.exchanges.at(0).coefficient({.drive = {.signals = {{"valve_percent", 40.0}}}}), 8.0);
  EXPECT_EQ(valve.exchanges.at(0).surrounding, "tank");
  EXPECT_FALSE(valve.exchanges.at(0).medium_K);
  const HeatBalance stream =
      balance_of("{type: recorded_drive, node: air, column: valve_percent, opening: 0.2, medium: 16 degC}");
  EXPECT_DOUBLE_EQ(stream.exchanges.at(0).coefficient({.drive = {.signals = {{"valve_percent", 40.0}}}}), 8.0);
  EXPECT_DOUBLE_EQ(stream.exchanges.at(0).medium_K.value(), 289.15);
}

TEST(RecordedDrive, TakesChannelsOfTheDriveToo) {
  const Inputs at{.drive = {.feed_m_s = {0.05, 0, 0}, .cutting_power_W = 400}};
  EXPECT_DOUBLE_EQ(
      balance_of("{type: recorded_drive, node: air, column: cutting_power_W, gain: 0.3}").heats.at(0).power_W(at), 120.0);
  EXPECT_DOUBLE_EQ(balance_of("{type: recorded_drive, node: air, column: feed_x, gain: 0.01}").heats.at(0).power_W(at),
                   30.0);
}

TEST(RecordedDrive, HeatsByAPowerOfItsColumn) {
  // copper's loss by a current: 8 W at 4 A, a quarter of that at 2 A, whichever way it flows
  const Law power_W =
      balance_of("{type: recorded_drive, node: air, column: current_A, gain: 2, exponent: 2, at: 4}").heats.at(0).power_W;
  const auto at = [](double current_A) { return Inputs{.drive = {.signals = {{"current_A", current_A}}}}; };
  EXPECT_DOUBLE_EQ(power_W(at(4.0)), 8.0);
  EXPECT_DOUBLE_EQ(power_W(at(2.0)), 2.0);
  EXPECT_DOUBLE_EQ(power_W(at(-2.0)), 2.0);
  EXPECT_EQ(power_W(at(0.0)), 0.0);
}

TEST(RecordedDrive, WantsOneLawAndAColumn) {
  const auto refused = [](const std::string& text) { return ThrowsMessage<InputError>(HasSubstr(text)); };
  EXPECT_THAT([] { read("{type: recorded_drive, node: air, column: heater_W}"); }, refused("one of the three"));
  EXPECT_THAT([] { read("{type: recorded_drive, node: air, column: heater_W, gain: 1, opening: 2}"); },
              refused("one of the three"));
  EXPECT_THAT([] { read("{type: recorded_drive, node: air, gain: 1}"); }, refused("column"));
  EXPECT_THAT([] { read("{type: recorded_drive, node: air, column: heater_W, gain: 1, exponent: 2}"); },
              refused("`gain` holds"));
  EXPECT_THAT([] { read("{type: recorded_drive, node: air, column: valve_1, opening: 1, exponent: 2, at: 3}"); },
              refused("requires a `gain`"));
  EXPECT_THAT([] { read("{type: recorded_drive, node: air, column: feed_x, gain: 1, lag: 3 min}"); }, refused("at once"));
}

// --- bearings ---------------------------------------------------------------------------------------------------

TEST(Viscosity, PassesThroughItsTwoPoints) {
  EXPECT_NEAR(walther_viscosity_mm2_s(32.0, 5.4, 313.15), 32.0, 1e-12);
  EXPECT_NEAR(walther_viscosity_mm2_s(32.0, 5.4, 373.15), 5.4, 1e-12);
}

TEST(Viscosity, ByHandAt20degC) {
  // lg lg 32.8 = 0.180663, lg lg 6.2 = -0.101060; B = 0.281723 / lg(373.15 / 313.15) = 0.281723 / 0.0761312 = 3.70049;
  // at 293.15 K: 0.180663 + 3.70049 * 0.0286622 = 0.286727; 10^10^0.286727 - 0.8 = 85.34 mm^2/s.
  EXPECT_NEAR(walther_viscosity_mm2_s(32.0, 5.4, 293.15), 85.34, 0.02);  // six digits in a double exponent
}

TEST(Viscosity, IsGuarded) {
  for (double bad_K : {233.0, 453.5, std::nan("")}) EXPECT_THROW((void)walther_viscosity_mm2_s(32, 5, bad_K), RangeError);
  for (double bad : {0.29, -1.0, std::nan("")}) EXPECT_THROW((void)walther_viscosity_mm2_s(32, bad, 300), RangeError);
  for (double bad : {5.0, HUGE_VAL, std::nan("")}) EXPECT_THROW((void)walther_viscosity_mm2_s(bad, 5, 300), RangeError);
}

TEST(Preload, GrowsWithTheInnerRingAndEndsAtZero) {
  EXPECT_DOUBLE_EQ(thermal_preload_N(300.0, 20.0, 310.0, 300.0), 500.0);
  EXPECT_DOUBLE_EQ(thermal_preload_N(300.0, 20.0, 300.0, 310.0), 100.0);
  EXPECT_DOUBLE_EQ(thermal_preload_N(300.0, 20.0, 300.0, 330.0), 0.0);
  EXPECT_THROW((void)thermal_preload_N(300.0, 20.0, std::nan(""), 300.0), RangeError);
}

const std::string kOiled =
    "{type: bearing_friction, region: front, f0: 2, viscosity_40: 32 mm^2/s, viscosity_100: 5.4 mm^2/s, mean_diameter: 90 "
    "mm";

TEST(FrictionLaw, GrowsWithSpeedAndFallsWithItsOwnTemperature) {
  const std::string law = "{type: friction_law, region: front, power: 80 W, at_speed: 2000 rpm, exponent: 1.5";
  const Law power_W = balance_of(law + ", decay: 0.02 1/K, at_temperature: 30 degC}").heats.at(0).power_W;
  ASSERT_EQ(power_W.probes, std::vector<Body>{region("front")});
  const auto at = [&](double speed_rpm, double t_K) {
    return power_W({.drive = {.speed_rpm = speed_rpm}, .probe_K = {t_K}});
  };
  EXPECT_DOUBLE_EQ(at(2000.0, 303.15), 80.0);
  EXPECT_NEAR(at(8000.0, 303.15), 8 * 80.0, 1e-10);               // 4^1.5 = 8
  EXPECT_NEAR(at(2000.0, 353.15), 80.0 * std::exp(-1.0), 1e-10);  // 50 K warmer
  EXPECT_EQ(at(0.0, 303.15), 0.0);
  const Law plain_W = balance_of(law + "}").heats.at(0).power_W;
  EXPECT_TRUE(plain_W.probes.empty()) << "a law without decay leaves the machine linear";
  EXPECT_NEAR(plain_W({.drive = {.speed_rpm = 500.0}}), 10.0, 1e-12);  // (1/4)^1.5 = 1/8
}

TEST(BearingFriction, LooksAtItsOwnTemperatureForTheViscosity) {
  const Law power_W = balance_of(kOiled + "}").heats.at(0).power_W;
  ASSERT_EQ(power_W.probes, std::vector<Body>{region("front")});
  const auto at = [&](double t_K) { return power_W({.drive = {.speed_rpm = 2000.0}, .probe_K = {t_K}}); };
  EXPECT_NEAR(at(313.15), 48.86, 0.005);                                    // 32 mm^2/s: 233.28 N mm, two decimals
  EXPECT_NEAR(at(373.15) / at(313.15), std::pow(5.4 / 32, 2.0 / 3), 1e-9);  // nu n = 10800: still the upper branch
  EXPECT_THROW((void)at(500.0), RangeError);
}

TEST(BearingFriction, LooksAtTheOilAndAtBothRingsWhereTold) {
  const Law power_W = balance_of(kOiled +
                                 ", oil: tank, f1: 0.001, load: 300 N, preload_growth: 20 N/K, inner: shaft, "
                                 "outer: {node: housing}}")
                          .heats.at(0)
                          .power_W;
  ASSERT_EQ(power_W.probes, (std::vector<Body>{node("tank"), region("shaft"), node("housing")}));
  // 233.28 N mm and 0.001 * (300 + 20 * 10) * 90 = 45 N mm at 209.4395 rad/s: 58.2828 W.
  EXPECT_NEAR(power_W({.drive = {.speed_rpm = 2000.0}, .probe_K = {313.15, 320.0, 310.0}}), 58.2828, 1e-4);
  // Rings 20 K the other way: no load left.
  EXPECT_NEAR(power_W({.drive = {.speed_rpm = 2000.0}, .probe_K = {313.15, 300.0, 320.0}}), 48.8580, 1e-4);
  EXPECT_EQ(power_W({.drive = {}, .probe_K = {1.0, 300.0, 320.0}}), 0.0);  // at rest the oil does not matter
}

TEST(BearingFriction, TightensWithoutLookingAtTheOil) {
  const Law power_W = balance_of(
                          "{type: bearing_friction, node: front, f0: 2, viscosity: 32 mm^2/s, mean_diameter: 90 mm, f1: "
                          "0.001, load: 300 N, preload_growth: 20 N/K, inner: shaft, outer: bore}")
                          .heats.at(0)
                          .power_W;
  ASSERT_EQ(power_W.probes, (std::vector<Body>{region("shaft"), region("bore")}));
  EXPECT_NEAR(power_W({.drive = {.speed_rpm = 2000.0}, .probe_K = {320.0, 310.0}}), 58.2828, 1e-4);
}

// --- bodies -----------------------------------------------------------------------------------------------------

TEST(HiddenBody, IsANodeBehindItsBody) {
  const HeatBalance b = balance_of("{type: hidden_body, region: head, capacity: 8 kJ/K, conductance: 9 W/K}");
  ASSERT_EQ(b.nodes.size(), 1u);
  EXPECT_EQ(b.nodes[0].name, "head_hidden");
  EXPECT_EQ(b.nodes[0].capacity_J_K, 8000.0);
  ASSERT_EQ(b.exchanges.size(), 1u);
  EXPECT_EQ(b.exchanges[0].body, region("head"));
  EXPECT_EQ(b.exchanges[0].surrounding, "head_hidden");
  EXPECT_EQ(b.exchanges[0].per, Per::kTotal);
  EXPECT_EQ(b.exchanges[0].coefficient({}), 9.0);
}

TEST(HiddenBody, HasAWayToTheAmbientWhereGiven) {
  const HeatBalance b =
      balance_of("{type: hidden_body, node: head, capacity: 8 kJ/K, conductance: 9 W/K, hall_conductance: 2 W/K}");
  ASSERT_EQ(b.exchanges.size(), 2u);
  EXPECT_EQ(b.exchanges[0].body, node("head"));
  EXPECT_EQ(b.exchanges[1].body, node("head_hidden"));
  EXPECT_EQ(b.exchanges[1].surrounding, kAmbientName);
  EXPECT_EQ(b.exchanges[1].coefficient({}), 2.0);
}

// --- axes and cutting -------------------------------------------------------------------------------------------

TEST(Axes, ServoHoldsAndGrowsWithItsOwnFeed) {
  const Law p =
      balance_of("{type: servo_loss, region: motor, axis: y, power: 80 W, at_feed: 12 m/min, exponent: 2, idle: 15 W}")
          .heats.at(0)
          .power_W;
  EXPECT_NEAR(p(moving(0, 0.2, 0)), 95.0, 1e-9);  // 12 m/min = 0.2 m/s
  EXPECT_NEAR(p(moving(0, 0.1, 0)), 35.0, 1e-9);
  EXPECT_EQ(p(moving(0.3, 0, 0.3)), 15.0);
  // With exponent 0 the grown part is there while the axis moves, and only then.
  const Law step =
      balance_of("{type: servo_loss, region: m, axis: x, power: 80 W, at_feed: 1 m/s, exponent: 0}").heats[0].power_W;
  EXPECT_EQ(step(moving(0.1, 0, 0)), 80.0);
  EXPECT_EQ(step(moving(0, 0, 0)), 0.0);
}

TEST(Axes, BallScrewTurnsDragAndThrustIntoHeat) {
  // 2 N m, lead 10 mm, 0.2 m/s = 20 turns a second: 2 * 2 pi * 20 = 251.327 W. A thrust of 900 N at 0.9: 900 * 0.2 / 9 = 20
  // W.
  const std::string screw = "{type: ball_screw, region: nut, axis: z, torque: 2 N m, lead: 10 mm, thrust: 900 N";
  EXPECT_NEAR(balance_of(screw + "}").heats[0].power_W(moving(0, 0, 0.2)), 271.3274, 1e-4);
  EXPECT_NEAR(balance_of(screw + ", share: 0.5, efficiency: 1}").heats[0].power_W(moving(0, 0, 0.2)), 125.6637, 1e-4);
  EXPECT_EQ(balance_of(screw + "}").heats[0].power_W(moving(1, 1, 0)), 0.0);
}

TEST(Axes, BearingsOfAScrewTurnWithIt) {
  // 1/3 m/s at a lead of 10 mm: 2000 rpm, at which this bearing gives 58.2828 W (Laws.BearingFrictionAddsBothTorques...).
  const std::string bearing =
      "{type: bearing_friction, node: end, f0: 2, viscosity: 32 mm^2/s, mean_diameter: 9 cm, f1: 0.001, load: 0.5 kN";
  const Law power_W = balance_of(bearing + ", turned_by: y, lead: 10 mm}").heats[0].power_W;
  EXPECT_NEAR(power_W(moving(0, 1.0 / 3.0, 0)), 58.2828, 1e-4);
  EXPECT_EQ(power_W(moving(1, 0, 1)), 0.0);
  EXPECT_EQ(power_W({.drive = {.speed_rpm = 2000.0}}), 0.0);
  for (const char* half : {", turned_by: y}", ", lead: 10 mm}"})
    EXPECT_REFUSED(read(bearing + half), "require both") << half;
}

TEST(Axes, GuidewayRubsByLoadAndByVelocity) {
  // 0.05 * 8 kN = 400 N, and 100 N s/m * 0.25 m/s = 25 N: 425 N * 0.25 m/s = 106.25 W, half of it here.
  const std::string way =
      "{type: guideway_friction, surface: rail, axis: x, friction: 0.05, load: 8 kN, viscous: 100 N s/m, share: 0.5}";
  EXPECT_NEAR(balance_of(way).heats[0].power_W(moving(0.25, 0, 0)), 53.125, 1e-12);
  EXPECT_EQ(balance_of(way).heats[0].power_W(moving(0, 1, 1)), 0.0);
  EXPECT_EQ(balance_of(way).heats[0].body, surface("rail"));
}

TEST(Cutting, GivesItsShare) {
  const Law p = balance_of("{type: cutting_heat, node: workpiece, share: 0.15}").heats[0].power_W;
  EXPECT_DOUBLE_EQ(p({.drive = {.cutting_power_W = 2000.0}}), 300.0);
  EXPECT_EQ(p({}), 0.0);
}

// --- films, joints, windows -------------------------------------------------------------------------------------

TEST(NaturalConvection, LooksAtTheSurfaceAndItsSurrounding) {
  const Exchange film =
      balance_of("{type: natural_convection, surface: s, orientation: vertical, length: 710 mm, surrounding: air}")
          .exchanges.at(0);
  ASSERT_EQ(film.coefficient.probes, (std::vector<Body>{surface("s"), node("air")}));
  EXPECT_EQ(film.surrounding, "air");
  EXPECT_NEAR(film.coefficient({.drive = {}, .probe_K = {505.15, 296.15}}), 7.0,
              0.07);  // as film_formulas_test: the textbook's rounding
}

TEST(Joints, ConductanceOverPressureIsLinearBetweenRows) {
  const std::string joint =
      "{type: contact, joint: a/b, conductance_over_pressure: [[0 MPa, 500 W/(m^2 K)], [1 MPa, 3000 W/(m^2 K)], [4 MPa, "
      "6000 "
      "W/(m^2 K)]], pressure: ";
  EXPECT_NEAR(balance_of(joint + "0.5 MPa}").exchanges.at(0).coefficient({}), 1750.0, 1e-9);
  EXPECT_NEAR(balance_of(joint + "2 MPa}").exchanges.at(0).coefficient({}), 4000.0, 1e-9);
  EXPECT_NEAR(balance_of(joint + "4 MPa}").exchanges.at(0).coefficient({}), 6000.0, 1e-9);
}

TEST(Joints, AirGapConductsAtRestAndMoreWithSpeed) {
  // Air at 300 K: k = 26.3e-3, nu = 15.89e-6. At rest k / gap = 26.3 W/(m^2 K). 3000 rpm: Ta = 98696 * 0.0505 * 1e-9 /
  // (15.89e-6)^2 = 19739.9; Nu = 0.409 * 19739.9^0.241 = 4.4351; h = 4.4351 * 26.3e-3 / 2e-3 = 58.32 W/(m^2 K).
  const Law h = balance_of("{type: air_gap, joint: rotor/stator, diameter: 100 mm, gap: 1 mm, air: 300 K}")
                    .exchanges.at(0)
                    .coefficient;
  EXPECT_NEAR(h({}), 26.3, 1e-10);
  EXPECT_NEAR(h({.drive = {.speed_rpm = 3000.0}}), 58.32, 0.01);
  EXPECT_THROW((void)h({.drive = {.speed_rpm = 1e5}}), RangeError);  // Ta = 2.2e7
}

TEST(Windows, BeginInclusivelyEndExclusivelyAndStopTheIntegrator) {
  const HeatBalance b = balance_of("{type: convection, surface: door, film: 40 W/(m^2 K), from: 10 min, until: 0.5 h}");
  EXPECT_EQ(b.change_times_s, (std::vector<double>{600.0, 1800.0}));
  const Law& htc = b.exchanges.at(0).coefficient;
  EXPECT_EQ(htc({.drive = {}, .time_s = 599.0}), 0.0);
  EXPECT_EQ(htc({.drive = {}, .time_s = 600.0}), 40.0);
  EXPECT_EQ(htc({.drive = {}, .time_s = 1799.0}), 40.0);
  EXPECT_EQ(htc({.drive = {}, .time_s = 1800.0}), 0.0);
  EXPECT_TRUE(balance_of("{type: heat_source, node: n, power: 5 W}").change_times_s.empty());
  const HeatBalance open = balance_of("{type: heat_source, node: n, power: 5 W, from: 60 s}");
  EXPECT_EQ(open.change_times_s, std::vector<double>{60.0});
  EXPECT_EQ(open.heats.at(0).power_W({.drive = {}, .time_s = 1e9}), 5.0);
}

TEST(Windows, JointsAndLinksHaveThem) {
  const Law joint =
      balance_of("{type: contact, joint: a/b, conductance: 2000 W/(m^2 K), until: 60 s}").exchanges.at(0).coefficient;
  EXPECT_EQ(joint({.drive = {}, .time_s = 59.0}), 2000.0);
  EXPECT_EQ(joint({.drive = {}, .time_s = 60.0}), 0.0);
  const Law link =
      balance_of("{type: link, node: n, to: ambient, conductance: 3 W/K, from: 60 s}").exchanges.at(0).coefficient;
  EXPECT_EQ(link({.drive = {}, .time_s = 59.0}), 0.0);
  EXPECT_EQ(link({.drive = {}, .time_s = 60.0}), 3.0);
}

TEST(HeatSource, InAWaveRisesThroughZeroAtItsDelayAndIsCutIntoSteps) {
  const HeatBalance b = balance_of("{type: heat_source, node: n, power: 8 W, period: 40 min, delay: 5 min, until: 80 min}");
  const Law& power_W = b.heats.at(0).power_W;
  for (double time_s : {300.0, 320.0, 449.0})  // the same at all times of a step: as in its middle
    EXPECT_NEAR(power_W({.drive = {}, .time_s = time_s}), 8.0 * 0.195090, 1e-5);  // sin 11.25 deg
  EXPECT_NEAR(power_W({.drive = {}, .time_s = 225.0}), -8.0 * 0.195090, 1e-5);    // before its delay
  EXPECT_NEAR(power_W({.drive = {}, .time_s = 900.0}), 8.0 * 0.980785, 1e-5);     // a quarter later, and half a step
  EXPECT_NEAR(power_W({.drive = {}, .time_s = 2100.0}), -8.0 * 0.980785, 1e-5);   // three quarters
  EXPECT_EQ(power_W({.drive = {}, .time_s = 4800.0}), 0.0);
  EXPECT_EQ(b.change_times_s.size(), 32U);  // 31 between, and the end: every 150 s
}

// --- documentation and errors -----------------------------------------------------------------------------------

TEST(Documentation, HoldsTheTableThatTheCatalogueMakes) {
  // after a change of the catalogue: driftwright list effects --markdown, put into docs/reference/effects.md in place of
  // the table there
  std::ifstream file("docs/reference/effects.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(text.find("\n\n" + catalogue_table()), std::string::npos);
}

// --- what one law does to another, and when -------------------------------------------------------------------------

/// The first heat of a list of effects, or its first exchange.
Law law_of(const std::vector<std::string>& entries) {
  std::vector<Effect> effects;
  for (const std::string& text : entries) effects.push_back(read(text));
  const HeatBalance b = heat_balance(effects);
  return b.heats.empty() ? b.exchanges.at(0).coefficient : b.heats[0].power_W;
}
Inputs at(double speed_rpm, double time_s = 0.0, std::string_view run = {}, std::vector<double> probe_K = {}) {
  Inputs u{.drive = {.speed_rpm = speed_rpm}, .ambient_K = 0.0, .time_s = time_s, .probe_K = std::move(probe_K)};
  u.run = run;
  return u;
}

TEST(ChangedLaw, MultipliesByAFactorAPowerOfSpeedAndADecay) {
  const std::string motor = "{type: motor_loss, region: m, power: 100 W, at_speed: 1000 rpm, exponent: 1, idle: 20 W}";
  const Law law = law_of({motor,
                          "{type: changed_law, law: motor_loss m, factor: 1.5, exponent: 2, at_speed: 500 rpm, decay: 0.02 "
                          "1/K, at_temperature: 20 degC}"});
  ASSERT_EQ(law.probes, std::vector<Body>{region("m")});
  // 1000 rpm: 120 W x 1.5 x (1000/500)^2 x exp(-0.02 x 10)
  EXPECT_NEAR(law(at(1000.0, 0.0, "", {303.15})), 120.0 * 1.5 * 4.0 * std::exp(-0.2), 1e-9);
  EXPECT_EQ(law(at(0.0, 0.0, "", {303.15})), 0.0);
}

TEST(ChangedLaw, AddsAGrowthWithSpeedToWhatIsThereAtStandstill) {
  const Law law =
      law_of({"{type: link, node: a, to: ambient, conductance: 10 W/K}",
              "{type: changed_law, law: link a - ambient, growth: 0.6, growth_exponent: 0.5, at_speed: 2000 rpm}"});
  EXPECT_EQ(law(at(0.0)), 10.0);
  EXPECT_NEAR(law(at(2000.0)), 16.0, 1e-12);
  EXPECT_NEAR(law(at(500.0)), 13.0, 1e-12);  // 10 (1 + 0.6 (500/2000)^0.5)
  const Law twice = law_of({"{type: link, node: a, to: ambient, conductance: 10 W/K}",
                            "{type: changed_law, law: link a - ambient, factor: 2, growth: 0.6, growth_exponent: 0.5, "
                            "at_speed: 2000 rpm}"});
  EXPECT_NEAR(twice(at(2000.0)), 32.0, 1e-12);  // of the law as changed
}

TEST(ChangedLaw, FallsWithWhatItsBodyIsWarmerThanAnother) {
  const std::string over = "decay: -0.02 1/K, over: c}";
  const Law preload =
      law_of({"{type: heat_source, node: a, power: 100 W}", "{type: changed_law, law: heat_source a, " + over});
  ASSERT_EQ(preload.probes, (std::vector<Body>{node("a"), node("c")}));
  EXPECT_NEAR(preload(at(0.0, 0.0, "", {303.0, 298.0})), 110.0, 1e-9);  // 100 (1 + 0.02 (303 - 298))
  EXPECT_NEAR(preload(at(0.0, 0.0, "", {298.0, 298.0})), 100.0, 1e-9);
  EXPECT_EQ(preload(at(0.0, 0.0, "", {238.0, 298.0})), 0.0);  // lost altogether, and no cold
  // beside a power of the difference at its own ends
  const Law both = law_of({"{type: link, node: a, to: b, conductance: 10 W/K}",
                           "{type: changed_law, law: link a - b, difference_exponent: 0.25, at_difference: 16 K, " + over});
  ASSERT_EQ(both.probes, (std::vector<Body>{node("a"), node("c"), node("a"), node("b")}));
  EXPECT_NEAR(both(at(0.0, 0.0, "", {303.0, 298.0, 303.0, 302.0})), 5.5, 1e-9);
}

TEST(ChangedLaw, FollowsAPowerOfTheTemperatureDifference) {
  const std::string film = "{type: link, node: a, to: b, conductance: 10 W/K}";
  const Law free = law_of({film, "{type: changed_law, law: link a - b, difference_exponent: 0.25, at_difference: 16 K}"});
  ASSERT_EQ(free.probes, (std::vector<Body>{node("a"), node("b")}));
  EXPECT_NEAR(free(at(0.0, 0.0, "", {309.0, 293.0})), 10.0, 1e-12);
  EXPECT_NEAR(free(at(0.0, 0.0, "", {293.0, 294.0})), 5.0, 1e-12);  // 10 (1/16)^0.25, whichever is the warmer
  EXPECT_NEAR(free(at(0.0, 0.0, "", {293.0, 293.0})), 10.0 * std::pow(0.05 / 16.0, 0.25), 1e-12);
  // beside a decay, which also depends on its own body
  const Law both =
      law_of({film,
              "{type: changed_law, law: link a - b, difference_exponent: 0.25, at_difference: 16 K, decay: 0.02 1/K, "
              "at_temperature: 20 degC}"});
  ASSERT_EQ(both.probes, (std::vector<Body>{node("a"), node("a"), node("b")}));
  EXPECT_NEAR(both(at(0.0, 0.0, "", {303.15, 303.15, 302.15})), 5.0 * std::exp(-0.2), 1e-12);
}

TEST(HeatSource, ThatGoesWithTheSpindleRunsOnForAWhile) {
  const std::string standby = "{type: heat_source, node: a, power: 40 W, runs: while_spindle_turns, runs_on: 10 min}";
  const Law law = law_of({standby});
  const DriveChange change = drive_change({read(standby)}, "");
  const Cyclogram felt = true_cyclogram(change, {.name = "", .sections = {{600, {.speed_rpm = 1000}}, {3600, {}}}});
  const auto heat_W = [&](double time_s) {
    return law(Inputs{.drive = felt.drive(time_s), .ambient_K = 0.0, .time_s = time_s, .probe_K = {}});
  };
  EXPECT_EQ(heat_W(300.0), 40.0);
  EXPECT_EQ(heat_W(1190.0), 40.0);
  EXPECT_EQ(heat_W(1210.0), 0.0);
}

TEST(HeatSource, BehindEachStopLastsForAWhileAndGrowsWithTheSpeedBefore) {
  const Cyclogram recorded = {.name = "",
                              .sections = {{300, {}},
                                           {600, {.speed_rpm = 1000}},
                                           {600, {.speed_rpm = 3000}},
                                           {1800, {}},
                                           {600, {.speed_rpm = 1500}},
                                           {60, {}},
                                           {600, {.speed_rpm = 1500}}}};
  const auto heat_W = [&](const std::string& more, double time_s) {
    const std::string entry =
        "{type: heat_source, node: a, power: 40 W, runs: while_spindle_stands, lasts: 5 min" + more + "}";
    const Cyclogram felt = true_cyclogram(drive_change({read(entry)}, ""), recorded);
    return law_of({entry})(Inputs{.drive = felt.drive(time_s), .ambient_K = 0.0, .time_s = time_s, .probe_K = {}});
  };
  const std::string by_square = ", exponent: 2, at_speed: 1000 rpm";
  for (const std::string& more : {std::string(), by_square}) {
    EXPECT_EQ(heat_W(more, 100.0), 0.0);   // it has not turned yet
    EXPECT_EQ(heat_W(more, 800.0), 0.0);   // it turns
    EXPECT_EQ(heat_W(more, 1000.0), 0.0);  // faster, which is no stop
    EXPECT_EQ(heat_W(more, 1810.0), 0.0);  // 310 s after a stop
    EXPECT_EQ(heat_W(more, 3970.0), 0.0);  // it turns again
  }
  EXPECT_EQ(heat_W("", 1510.0), 40.0);
  EXPECT_EQ(heat_W("", 1790.0), 40.0);
  EXPECT_EQ(heat_W("", 3930.0), 40.0);
  EXPECT_EQ(heat_W(by_square, 1510.0), 360.0);
  const Cyclogram slows = {.name = "", .sections = {{600, {.speed_rpm = 3000}}, {1, {.speed_rpm = 300}}, {900, {}}}};
  const std::string brake =
      "{type: heat_source, node: a, power: 40 W, runs: while_spindle_stands, lasts: 5 min, exponent: "
      "2, at_speed: 1000 rpm}";
  const Cyclogram felt = true_cyclogram(drive_change({read(brake)}, ""), slows);
  EXPECT_EQ(law_of({brake})(Inputs{.drive = felt.drive(700.0), .ambient_K = 0.0, .time_s = 700.0, .probe_K = {}}),
            360.0);  // a row just before rest is no other stop
  EXPECT_EQ(heat_W(by_square, 3930.0), 90.0);
}

TEST(ChangedLaw, IsTimesAFactorBelowASpeed) {
  const std::string motor = "{type: motor_loss, region: m, power: 100 W, at_speed: 1000 rpm, exponent: 2, idle: 20 W}";
  const Law law = law_of({motor, "{type: changed_law, law: motor_loss m, factor_below: 1.5, below: 1200 rpm}"});
  EXPECT_EQ(law(at(1000.0)), 180.0);
  EXPECT_EQ(law(at(1200.0)), 164.0);
  EXPECT_EQ(law(at(2000.0)), 420.0);
  EXPECT_EQ(law(at(0.0)), law_of({motor})(at(0.0)));  // no gear takes part where nothing turns
}

TEST(ServoLoss, HoldsAWeightWhileItsAxisStands) {
  const Law law =
      law_of({"{type: servo_loss, region: m, power: 80 W, at_feed: 0.2 m/s, idle: 5 W, holding: 30 W, axis: z}"});
  Inputs u = at(0.0);
  EXPECT_EQ(law(u), 35.0);
  u.drive.feed_m_s[2] = 0.1;
  EXPECT_NEAR(law(u), 45.0, 1e-12);
}

TEST(ChangedLaw, GrowsByAnotherShareBeyondASpeed) {
  const std::string motor = "{type: motor_loss, region: m, power: 100 W, at_speed: 1000 rpm, exponent: 2, idle: 20 W}";
  const auto changed = [&](const std::string& share) {
    return law_of({motor, "{type: changed_law, law: motor_loss m, growth_beyond: " + share + ", beyond: 2000 rpm}"});
  };
  EXPECT_EQ(changed("0")(at(2000.0)), 420.0);  // as written up to there
  EXPECT_EQ(changed("0")(at(3000.0)), 420.0);
  EXPECT_NEAR(changed("0.5")(at(3000.0)), 420.0 + 0.5 * 500.0, 1e-9);
  EXPECT_NEAR(changed("-0.5")(at(3000.0)), 420.0 - 0.5 * 500.0, 1e-9);
  EXPECT_EQ(changed("-3")(at(3000.0)), 0.0);  // and never takes heat away
  const Law rests = law_of({"{type: heat_source, node: a, power: 40 W, runs: while_spindle_stands}",
                            "{type: changed_law, law: heat_source a, growth_beyond: 0.5, beyond: 100 rpm}"});
  EXPECT_EQ(rests(at(0.0)), 40.0);
  EXPECT_EQ(rests(at(3000.0)), 0.0);
}

TEST(ChangedLaw, LeavesALawThatLooksAtTemperaturesItsOwnProbes) {
  const Law law = law_of({"{type: friction_law, node: a, power: 80 W, decay: 0.01 1/K, at_temperature: 20 degC}",
                          "{type: changed_law, law: friction_law a, factor: 2, decay: 0.03 1/K, at_temperature: 20 degC}"});
  ASSERT_EQ(law.probes.size(), 2u);
  EXPECT_NEAR(law(at(1000.0, 0.0, "", {303.15, 303.15})), 160.0 * std::exp(-0.1) * std::exp(-0.3), 1e-9);
}

TEST(ChangedLaw, HoldsForAWhileAndInOneRunAndTellsWhenItJumps) {
  const std::vector<std::string> entries = {
      "{type: link, node: a, to: ambient, conductance: 10 W/K}",
      "{type: changed_law, law: link a - ambient, factor: 0.2, from: 10 min, until: 20 min, in: monday}"};
  const Law law = law_of(entries);
  EXPECT_EQ(law(at(0.0, 599.0, "monday")), 10.0);
  EXPECT_EQ(law(at(0.0, 600.0, "monday")), 2.0);
  EXPECT_EQ(law(at(0.0, 1200.0, "monday")), 10.0);
  EXPECT_EQ(law(at(0.0, 700.0, "tuesday")), 10.0);
  EXPECT_EQ(law(at(0.0, 700.0)), 10.0);
  const HeatBalance b = heat_balance({read(entries[0]), read(entries[1])});
  EXPECT_EQ(b.change_times_s, (std::vector<double>{600.0, 1200.0}));
}

TEST(HiddenBody, IsJoinedWithinItsWindowsAndOtherwiseAsWarmAsTheAmbient) {
  const HeatBalance b = balance_of(
      "{type: hidden_body, node: head, capacity: 6 kJ/K, conductance: 9 W/K, hall_conductance: 2 W/K, windows: [[10 min, 20 "
      "min]], in: monday}");
  ASSERT_EQ(b.nodes.size(), 1u);
  ASSERT_EQ(b.exchanges.size(), 3u);
  const Law &to_body = b.exchanges[0].coefficient, &always = b.exchanges[1].coefficient, &away = b.exchanges[2].coefficient;
  EXPECT_EQ(b.exchanges[0].surrounding, "head_hidden");
  EXPECT_EQ(b.exchanges[1].body, node("head_hidden"));
  EXPECT_EQ(b.exchanges[1].surrounding, kAmbientName);
  EXPECT_EQ(b.exchanges[2].body, node("head_hidden"));
  EXPECT_EQ(b.exchanges[2].surrounding, kAmbientName);
  EXPECT_EQ(to_body(at(0.0, 900.0, "monday")), 9.0);
  EXPECT_EQ(always(at(0.0, 900.0, "monday")), 2.0);
  EXPECT_EQ(away(at(0.0, 900.0, "monday")), 0.0);
  for (const Inputs& elsewhere : {at(0.0, 599.0, "monday"), at(0.0, 1201.0, "monday"), at(0.0, 900.0, "tuesday")}) {
    EXPECT_EQ(to_body(elsewhere), 0.0);
    EXPECT_EQ(away(elsewhere), 100.0);  // 6 kJ/K in a minute
  }
  EXPECT_EQ(b.change_times_s, (std::vector<double>{600.0, 1200.0}));
}

TEST(HiddenBody, IsThereInOneRecordAlone) {
  const std::string begin = "{type: hidden_body, node: head, capacity: 6 kJ/K, conductance: 9 W/K";
  const HeatBalance b = heat_balance(
      {read(begin + ", hall_conductance: 2 W/K, in: monday}"), read(begin + ", hall_conductance: 2 W/K, in: friday}")});
  ASSERT_EQ(b.nodes.size(), 2u);  // each its own
  EXPECT_EQ(b.nodes[0].name, "head_hidden in monday");
  EXPECT_EQ(b.nodes[1].name, "head_hidden in friday");
  ASSERT_EQ(b.exchanges.size(), 4u);
  EXPECT_EQ(b.exchanges[0].surrounding, "head_hidden in monday");
  EXPECT_EQ(b.exchanges[0].coefficient(at(0.0, 900.0, "monday")), 9.0);
  EXPECT_EQ(b.exchanges[0].coefficient(at(0.0, 900.0, "friday")), 0.0);
  EXPECT_EQ(b.exchanges[0].coefficient(at(0.0, 0.0)), 0.0);  // nor in the state at rest
  EXPECT_EQ(b.exchanges[1].surrounding, kAmbientName);
  EXPECT_EQ(b.exchanges[1].coefficient(at(0.0, 900.0, "monday")), 2.0);
  const HeatBalance closed = balance_of(begin + ", in: monday}");
  ASSERT_EQ(closed.exchanges.size(), 2u);  // where nothing joins it, some way out lets a state at rest be found
  EXPECT_NEAR(closed.exchanges[1].coefficient(at(0.0)), 1e-4, 1e-12);
}

TEST(InOneRun, AnEffectActsDuringItAlone) {
  const Law law = law_of({"{type: heat_source, node: a, power: 50 W, from: 1 min, in: monday}"});
  EXPECT_EQ(law(at(0.0, 59.0, "monday")), 0.0);
  EXPECT_EQ(law(at(0.0, 60.0, "monday")), 50.0);
  EXPECT_EQ(law(at(0.0, 60.0, "tuesday")), 0.0);
  EXPECT_EQ(law(at(0.0, 60.0)), 0.0);
}

TEST(HeatSource, GoesWithTheSpindleOrFallsWithSpeed) {
  const Law pump = law_of({"{type: heat_source, node: a, power: 50 W, runs: while_spindle_turns}"});
  EXPECT_EQ(pump(at(0.0)), 0.0);
  EXPECT_EQ(pump(at(10.0)), 50.0);
  EXPECT_EQ(pump(at(9000.0)), 50.0);
  const Law falls = law_of({"{type: heat_source, node: a, power: 50 W, at_speed: 1000 rpm, exponent: -0.5}"});
  EXPECT_EQ(falls(at(0.0)), 0.0);  // not infinite
  EXPECT_NEAR(falls(at(4000.0)), 25.0, 1e-12);
  const Law wave = law_of({"{type: heat_source, node: a, power: 10 W, mean: 30 W, period: 400 s, until: 2000 s}"});
  EXPECT_NEAR(wave(at(0.0, 100.0)), 30.0 + 10.0 * 0.980785, 1e-5);
  EXPECT_NEAR(wave(at(0.0, 300.0)), 30.0 - 10.0 * 0.980785, 1e-5);
}

TEST(ExchangeWindow, OpensAndClosesOnceOrAgainAndAgain) {
  const Law once = law_of({"{type: exchange_window, node: a, conductance: 8 W/K, windows: [[10 s, 20 s], [50 s, 60 s]]}"});
  for (const auto& [t_s, c_W_K] :
       std::vector<std::pair<double, double>>{{9, 0}, {10, 8}, {19, 8}, {20, 0}, {55, 8}, {60, 0}, {1010, 0}})
    EXPECT_EQ(once(at(0.0, t_s)), c_W_K) << t_s;
  const std::string again =
      "{type: exchange_window, surface: s, film: 8 W/(m^2 K), windows: [[10 s, 20 s]], every: 100 s, until_time: 250 s}";
  const Law many = law_of({again});
  for (const auto& [t_s, film] :
       std::vector<std::pair<double, double>>{{15, 8}, {30, 0}, {110, 8}, {120, 0}, {215, 8}, {310, 0}})
    EXPECT_EQ(many(at(0.0, t_s)), film) << t_s;
  const HeatBalance b = heat_balance({read(again)});
  EXPECT_EQ(b.change_times_s, (std::vector<double>{10, 20, 110, 120, 210, 220}));
}

TEST(HeatWindow, HeatsWithinItsWindowsOnceOrAgainAndAgain) {
  const std::string pump =
      "{type: heat_window, node: a, power: 30 W, windows: [[10 s, 20 s], [50 s, 60 s]], every: 100 s, until_time: 150 s}";
  const HeatBalance b = heat_balance({read(pump)});
  ASSERT_EQ(b.heats.size(), 1u);
  for (const auto& [t_s, power_W] :
       std::vector<std::pair<double, double>>{{9, 0}, {10, 30}, {20, 0}, {55, 30}, {60, 0}, {115, 30}, {155, 30}, {215, 0}})
    EXPECT_EQ(b.heats[0].power_W(at(0.0, t_s)), power_W) << t_s;
  EXPECT_EQ(b.change_times_s, (std::vector<double>{10, 20, 50, 60, 110, 120, 150, 160}));
  EXPECT_THROW((void)read("{type: heat_window, node: a, power: 30 W, windows: [[20 s, 10 s]]}"), InputError);
}

TEST(RunState, ChangesAllHeatOrAllExchangeWithTheAmbientOfOneRecord) {
  const std::vector<Effect> machine = {read("{type: heat_source, node: a, power: 50 W}"),
                                       read("{type: link, node: a, to: ambient, conductance: 4 W/K}"),
                                       read("{type: link, node: a, to: b, conductance: 7 W/K}")};
  const auto in_state = [&](const std::string& state) {
    std::vector<Effect> all = machine;
    all.push_back(read(state));
    return heat_balance(all);
  };
  const HeatBalance oil = in_state("{type: run_state, factor: 1.4, in: tuesday}");
  EXPECT_EQ(oil.heats[0].power_W(at(0.0, 60.0, "monday")), 50.0);
  EXPECT_NEAR(oil.heats[0].power_W(at(0.0, 60.0, "tuesday")), 70.0, 1e-12);
  EXPECT_EQ(oil.exchanges[0].coefficient(at(0.0, 60.0, "tuesday")), 4.0);
  const HeatBalance cover = in_state("{type: run_state, of: exchange, factor: 0.5, in: tuesday}");
  EXPECT_EQ(cover.heats[0].power_W(at(0.0, 60.0, "tuesday")), 50.0);
  EXPECT_EQ(cover.exchanges[0].coefficient(at(0.0, 60.0, "tuesday")), 2.0);
  EXPECT_EQ(cover.exchanges[0].coefficient(at(0.0, 60.0, "monday")), 4.0);
  EXPECT_EQ(cover.exchanges[1].coefficient(at(0.0, 60.0, "tuesday")), 7.0);  // between bodies
  EXPECT_THROW((void)read("{type: run_state, factor: 1.4}"), InputError);
}

TEST(Coolant, WithoutATankIsHeldAtItsSetPoint) {
  const HeatBalance b = heat_balance(
      {read("{type: coolant, region: r, flow: 6 L/min, medium_heat_capacity: 4000 J/(L K), passage_conductance: 400 W/K, "
            "set_point: 18 degC}")});
  ASSERT_EQ(b.exchanges.size(), 1u);
  EXPECT_TRUE(b.nodes.empty() && b.heats.empty() && b.thermostats.empty());
  EXPECT_NEAR(*b.exchanges[0].medium_K, 291.15, 1e-12);
  EXPECT_EQ(b.exchanges[0].per, Per::kTotal);
  EXPECT_NEAR(b.exchanges[0].coefficient(at(0.0)), 400.0 * (1.0 - std::exp(-1.0)), 1e-9);  // W = 0.1 L/s x 4000 J/(L K)
}

TEST(ChangedLaw, WarmsTheMediumOfACircuit) {  // Q = G (T - T_medium): with 3 K more G 3 K of heat
  const std::string circuit =
      "{type: coolant, region: r, flow: 6 L/min, medium_heat_capacity: 4000 J/(L K), passage_conductance: 400 W/K, "
      "set_point: 18 degC}";
  const HeatBalance b = heat_balance(
      {read(circuit), read("{type: changed_law, law: coolant r, warmer: 3 K, factor: 2, from: 5 min, in: monday}")});
  ASSERT_EQ(b.heats.size(), 1u);
  const double twice_W_K = 800.0 * (1.0 - std::exp(-1.0));
  EXPECT_NEAR(b.exchanges.at(0).coefficient(at(0.0, 300.0, "monday")), twice_W_K, 1e-9);
  EXPECT_NEAR(b.heats[0].power_W(at(0.0, 300.0, "monday")), 3.0 * twice_W_K, 1e-9);
  EXPECT_EQ(b.heats[0].power_W(at(0.0, 299.0, "monday")), 0.0);
  EXPECT_EQ(b.heats[0].power_W(at(0.0, 300.0, "tuesday")), 0.0);
  EXPECT_EQ(b.heats[0].body, region("r"));
  // in either order
  const std::string warmer = "{type: changed_law, law: coolant r, warmer: 3 K}",
                    half = "{type: changed_law, law: coolant r, factor: 0.5}";
  for (const auto& [first, second] : {std::pair{warmer, half}, std::pair{half, warmer}}) {
    const HeatBalance both = heat_balance({read(circuit), read(first), read(second)});
    EXPECT_NEAR(both.heats.at(0).power_W(at(0.0)), 3.0 * 0.25 * twice_W_K, 1e-9) << first;
  }
}

TEST(HeatSource, MayBeOfAHeaterAtRest) {
  const Law power_W = law_of({"{type: heat_source, node: n, power: 8 W, runs: while_spindle_stands}"});
  EXPECT_EQ(power_W(at(0.0)), 8.0);
  EXPECT_EQ(power_W(at(1.0)), 0.0);
}

TEST(HeatSource, ThatFadesGivesItsPowerTimesItsTime) {
  const HeatBalance b =
      balance_of("{type: heat_source, node: n, power: 8 W, at_speed: 1000 rpm, exponent: 1, fades: 40 min, from: 5 min}");
  const Law& power_W = b.heats.at(0).power_W;
  ASSERT_GE(b.change_times_s.size(), 48u);
  double energy_J = 0.0;
  std::vector<double> times_s = b.change_times_s;
  std::sort(times_s.begin(), times_s.end());
  for (std::size_t i = 0; i + 1 < times_s.size(); ++i) {
    const double middle_s = 0.5 * (times_s[i] + times_s[i + 1]), length_s = times_s[i + 1] - times_s[i];
    energy_J += power_W(at(500.0, middle_s)) * length_s;
    EXPECT_NEAR(power_W(at(500.0, middle_s)), 4.0 * std::exp(-(middle_s - 300.0) / 2400.0), 0.004);
  }
  EXPECT_NEAR(energy_J, 4.0 * 2400.0 * (1.0 - std::exp(-6.0)), 1e-6);
  EXPECT_EQ(power_W(at(500.0, 299.0)), 0.0);
  EXPECT_EQ(power_W(at(0.0, 400.0)), 0.0);
}

TEST(Link, OfAFanGoesWithTheSpindleAndRunsOn) {
  const Effect fan =
      read("{type: link, node: a, to: ambient, conductance: 6 W/K, runs: while_spindle_turns, runs_on: 2 min}");
  const Cyclogram recorded{.name = "run",
                           .sections = {{60, {}}, {90, {.speed_rpm = 100}}, {50, {}}, {40, {.speed_rpm = 50}}, {300, {}}}};
  const Cyclogram felt = true_cyclogram(drive_change({fan}, "run"), recorded);
  const Law conductance_W_K = heat_balance({fan}).exchanges.at(0).coefficient;
  const auto at_s = [&](double t_s) { return conductance_W_K({.drive = felt.drive(t_s)}); };
  EXPECT_EQ(at_s(30), 0.0);  // it has not turned yet
  EXPECT_EQ(at_s(100), 6.0);
  EXPECT_EQ(at_s(180), 6.0);  // between two turns
  EXPECT_EQ(at_s(359), 6.0);  // it stops at 240 s
  EXPECT_EQ(at_s(361), 0.0);
  EXPECT_EQ(felt.duration_s(), recorded.duration_s());
  EXPECT_TRUE(changes_drive(fan));
  // a stop that the record does not have stops the fan, at any position in the list
  const Effect stop = read("{type: missing_stop, start: 1.5 min, length: 1.5 min}");
  for (const auto& list : {std::vector<Effect>{fan, stop}, std::vector<Effect>{stop, fan}}) {
    const Cyclogram long_run{.name = "run", .sections = {{600, {.speed_rpm = 100}}}};
    const Cyclogram stopped = true_cyclogram(drive_change(list, "run"), long_run);
    EXPECT_EQ(conductance_W_K({.drive = stopped.drive(170)}), 6.0);  // it runs on: from 90 to 180 s
  }
  const Effect long_stop = read("{type: missing_stop, start: 1.5 min, length: 5 min}");
  const Cyclogram stopped =
      true_cyclogram(drive_change({fan, long_stop}, "run"), {.name = "run", .sections = {{600, {.speed_rpm = 100}}}});
  EXPECT_EQ(conductance_W_K({.drive = stopped.drive(300)}), 0.0);
  const Effect at_once = read("{type: link, node: a, to: ambient, conductance: 6 W/K, runs: while_spindle_turns}");
  EXPECT_FALSE(changes_drive(at_once));
  EXPECT_EQ(heat_balance({at_once}).exchanges.at(0).coefficient(at(0.0)), 0.0);
  EXPECT_EQ(heat_balance({at_once}).exchanges.at(0).coefficient(at(10.0)), 6.0);
}

TEST(FilmsByFormula, TakeAFactor) {
  const std::string air = "{type: rotating_cylinder, surface: s, diameter: 100 mm";
  EXPECT_NEAR(law_of({air + ", factor: 1.7}"})(at(2000.0)), 1.7 * law_of({air + "}"})(at(2000.0)), 1e-12);
}

}  // namespace
}  // namespace driftwright::effects::effect_laws_test
