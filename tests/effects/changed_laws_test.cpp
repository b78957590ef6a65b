// What one effect does to the law of another, and when effects hold: windows, records, a spindle that runs on.

#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "effects/effect.hpp"
#include "tests/effects/read_entry.hpp"

namespace driftwright::effects::changed_laws_test {
namespace {

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
}  // namespace driftwright::effects::changed_laws_test
