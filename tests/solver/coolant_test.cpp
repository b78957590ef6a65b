// The coolant circuit: its passage, its balance, and the saw-tooth of its thermostat, against closed forms.

#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "solver/steady_state.hpp"
#include "solver/transient.hpp"
#include "tests/shared/effect_list.hpp"
#include "tests/shared/fixtures.hpp"

namespace driftwright::solver::coolant_test {
namespace {

using fixtures::flow;

const TimeSeries kStillAmbient{{0.0}, {0.0}};

Cyclogram rest(double duration_s) {
  return {.name = "rest", .sections = {{duration_s, {}}}};
}

TEST(Coolant, PassageFollowsItsNumberOfTransferUnits) {
  // 6 L/min of 3800 J/(L K) carry 380 W/K; a passage of 380 W/K has one transfer unit: 380 (1 - 1/e) = 240.206 W/K.
  const effects::HeatBalance b = fixtures::balance_of(
      {"{type: coolant, region: spindle, tank: tank, flow: 6 L/min, passage_conductance: 380 W/K, volume: 20 L}"});
  EXPECT_NEAR(b.exchanges.at(0).coefficient({}), 380.0 * (1.0 - std::exp(-1.0)), 1e-9);
  EXPECT_EQ(b.exchanges.at(0).body, effects::region("spindle"));
  EXPECT_EQ(b.exchanges.at(0).surrounding, "tank");
  EXPECT_NEAR(b.nodes.at(0).capacity_J_K, 76e3, 1e-9);
  EXPECT_TRUE(b.thermostats.empty());  // no chiller
}

TEST(Coolant, BringsWhatItTakesToItsTank) {
  // 300 W in the spindle and 100 W of the pump leave by the tank's 40 W/K: 10 K. Spindle: 300 / 240.206 = 1.24893 K more.
  const FullSystem system = fixtures::lumped_system({"{type: node, node: spindle, capacity: 5 kJ/K}",
                                                     "{type: heat_source, node: spindle, power: 300 W}",
                                                     "{type: coolant, node: spindle, tank: tank, flow: 6 L/min, "
                                                     "passage_conductance: 380 W/K, volume: 20 L, tank_exchange: 40 "
                                                     "W/K, pump_power: 100 W, medium_heat_capacity: 3.8 kJ/(L K)}"});
  const Eigen::VectorXd theta = steady_state(system, {}, Eigen::VectorXd::Zero(2));
  EXPECT_NEAR(theta[1], 10.0, 1e-9);
  EXPECT_NEAR(theta[0], 10.0 + 300.0 / (380.0 * (1.0 - std::exp(-1.0))), 1e-9);
}

TEST(Coolant, RestsWithTheSpindleWhereToldButTheTankGoesOnLosing) {
  const effects::HeatBalance b = fixtures::balance_of(
      {"{type: coolant, region: s, tank: t, flow: 6 L/min, passage_conductance: 380 W/K, volume: 20 L, pump_power: 100 W, "
       "tank_exchange: 5 W/K, runs: while_spindle_turns}"});
  const effects::Inputs turning{.drive = {.speed_rpm = 1.0}};
  EXPECT_EQ(b.exchanges.at(0).coefficient({}), 0.0);
  EXPECT_GT(b.exchanges.at(0).coefficient(turning), 240.0);
  EXPECT_EQ(b.heats.at(0).power_W({}), 0.0);
  EXPECT_EQ(b.heats.at(0).power_W(turning), 100.0);
  EXPECT_EQ(b.exchanges.at(1).coefficient({}), 5.0);
}

/// 38 kJ/K of coolant, heated by 500 W, cooled by 1500 W from 26 degC down to 24 degC; it starts at 20 degC.
FullSystem cycling_tank() {
  FullSystem system = fixtures::lumped_system({"{type: node, node: spindle, capacity: 5 kJ/K}",
                                               "{type: coolant, node: spindle, tank: tank, flow: 6 L/min, "
                                               "passage_conductance: 0 W/K, volume: 10 L, pump_power: 500 W, "
                                               "cooling_power: 1.5 kW, set_point: 25 degC, hysteresis: 2 K}"});
  fixtures::observe_unknowns(system, {1});
  return system;
}

TEST(Coolant, ThermostatDrawsTheSawToothOfItsPowers) {
  // Up by 500 W / 38 kJ/K: 6 K take 456 s to the first switch, 2 K take 152 s. Down by 1000 W: 2 K take 76 s. Period 228 s.
  std::vector<double> times_s;
  std::vector<double> expected_K;
  for (int period = 0; period < 40; ++period) {
    times_s.push_back(456.0 + 228.0 * period);
    expected_K.push_back(6.0);
    times_s.push_back(456.0 + 228.0 * period + 38.0);
    expected_K.push_back(5.0);
    times_s.push_back(456.0 + 228.0 * period + 76.0);
    expected_K.push_back(4.0);
    times_s.push_back(456.0 + 228.0 * period + 152.0);
    expected_K.push_back(5.0);
  }
  const Trajectory run =
      simulate(cycling_tank(), rest(times_s.back()), kStillAmbient, times_s, {}, Eigen::VectorXd::Zero(2));
  double worst_K = 0.0;
  for (std::size_t k = 0; k < times_s.size(); ++k) {
    worst_K = std::max(worst_K, std::abs(run.outputs(0, static_cast<Eigen::Index>(k)) - expected_K[k]));
  }
  RecordProperty("worst_K", std::to_string(1e9 * worst_K) + "e-9");
  // Between switches the temperature is linear, which every step integrates exactly: what is left is where the root finder
  // puts 80 switches, each to some 1e-12 s of 1e4 s.
  EXPECT_LT(worst_K, 1e-8);
  EXPECT_LT(run.energy_gap(), 1e-9);
}

TEST(Coolant, ChillerTakesAwayWhatComesInOverWholePeriods) {
  const double begin_s = 456.0, end_s = begin_s + 100 * 228.0;
  const Trajectory run =
      simulate(cycling_tank(), rest(end_s), kStillAmbient, {begin_s - 1e-3, end_s - 1e-3}, {}, Eigen::VectorXd::Zero(2));
  const Eigen::Index chiller = flow(run, "coolant chiller tank");
  const double taken_J = -(run.heat_J(chiller, 1) - run.heat_J(chiller, 0));
  EXPECT_NEAR(taken_J, 100 * 228.0 * 500.0, 1e-3);  // 11.4 MJ; times of switches to 1e-9 s at 1500 W, a hundred times
  EXPECT_NEAR(taken_J / (1500.0 * 100 * 228.0), 1.0 / 3.0, 1e-9);  // duty = heat load / cooling power
}

TEST(Coolant, ThermostatOfALoadedSpindleHoldsTheTankWithinItsHysteresis) {
  // The whole circuit on a cyclogram: after the warm-up the tank stays within set point +- half of the hysteresis.
  FullSystem system =
      fixtures::lumped_system({"{type: node, node: spindle, capacity: 5 kJ/K}",
                               "{type: motor_loss, node: spindle, power: 400 W, at_speed: 1000 rpm}",
                               "{type: coolant, node: spindle, tank: tank, flow: 6 L/min, passage_conductance: 100 W/K, "
                               "volume: 10 L, tank_exchange: 8 "
                               "W/K, pump_power: 50 W, cooling_power: 1.5 kW, set_point: 22 degC, hysteresis: 1 K}"});
  fixtures::observe_unknowns(system, {1});
  std::vector<double> times_s;
  for (int i = 0; i <= 1200; ++i) times_s.push_back(3600.0 + 5.0 * i);
  const Cyclogram cycle{.name = "c",
                        .sections = {{4800, {.speed_rpm = 2000}}, {2400, {.speed_rpm = 1200}}, {2400, {.speed_rpm = 2500}}}};
  const Trajectory run = simulate(system, cycle, kStillAmbient, times_s, {}, Eigen::VectorXd::Zero(2));
  // Event location is to rounding; dense output between steps to the tolerances, 5e-4 K + 1e-4 of some kelvin.
  EXPECT_LT(run.outputs.maxCoeff(), 22.5 - 20.0 + 1e-3);
  EXPECT_GT(run.outputs.minCoeff(), 21.5 - 20.0 - 1e-3);
  EXPECT_GT(run.outputs.maxCoeff() - run.outputs.minCoeff(), 0.98);  // and uses it
  EXPECT_LT(run.energy_gap(), 1e-9);
}

TEST(Coolant, HasNoSteadyStateWhereItsChillerSwitches) {
  const auto steady_at = [](double ambient_K) {
    const FullSystem system =
        fixtures::lumped_system({"{type: node, node: spindle, capacity: 5 kJ/K}",
                                 "{type: coolant, node: spindle, tank: tank, flow: 6 L/min, passage_conductance: 380 W/K, "
                                 "volume: 10 L, tank_exchange: "
                                 "10 W/K, pump_power: 20 W, cooling_power: 1.5 kW, set_point: 25 degC, hysteresis: 2 K}"});
    return steady_state(system, {.drive = {}, .ambient_K = ambient_K}, Eigen::VectorXd::Constant(2, ambient_K));
  };
  EXPECT_NEAR(steady_at(0.0)[1], 2.0, 1e-9);              // 20 W by 10 W/K: 22 degC, the chiller stays off
  EXPECT_THROW((void)steady_at(4.5), InputError);         // 26.5 degC without the chiller, which starts off and comes on
  EXPECT_THROW((void)steady_at(10.0), InputError);        // on from the start: -118 degC
  EXPECT_NEAR(steady_at(160.0)[1], 160.0 - 148.0, 1e-9);  // 32 degC with a chiller that never rests
}

TEST(Coolant, AThermostatThatSwitchesWithoutEndIsNamed) {
  // A period of 228 s: 40 switches take 4560 s.
  try {
    (void)simulate(cycling_tank(), rest(86400), kStillAmbient, {86400}, {.most_switches = 40}, Eigen::VectorXd::Zero(2));
    FAIL() << "no error";
  } catch (const SolveError& e) {
    EXPECT_NE(std::string(e.what()).find("thermostat 'tank' switched for the 41th time"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace driftwright::solver::coolant_test
