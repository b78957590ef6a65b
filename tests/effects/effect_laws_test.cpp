// Effects of bearings, axes, cutting, joints and time windows, as the user writes them, by value.

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

Inputs moving(double x_m_s, double y_m_s, double z_m_s) {
  return {.drive = {.feed_m_s = {x_m_s, y_m_s, z_m_s}}};
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

TEST(HiddenBodyAlone, IsANodeBehindItsBody) {
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

TEST(HiddenBodyAlone, HasAWayToTheAmbientWhereGiven) {
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

TEST(HeatSourceInAWave, RisesThroughZeroAtItsDelayAndIsCutIntoSteps) {
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

}  // namespace
}  // namespace driftwright::effects::effect_laws_test
