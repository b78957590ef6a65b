// Laws given to a system by name and by place, whatever the order they come in.

#include "solver/bind_laws.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/linearise.hpp"
#include "solver/live_rate.hpp"
#include "solver/propagator.hpp"
#include "solver/reduced_model.hpp"
#include "tests/shared/effect_list.hpp"

namespace driftwright::solver::bind_laws_test {
namespace {

using effects::HeatBalance, effects::Law;

const std::vector<std::string> kMachine = {
    "{type: node, node: head, capacity: 6 kJ/K}",
    "{type: node, node: column, capacity: 40 kJ/K}",
    "{type: heat_source, node: head, power: 150 W, at_speed: 2000 rpm, exponent: 1.3}",
    "{type: motor_loss, node: column, power: 40 W, at_speed: 1000 rpm, idle: 10 W}",
    "{type: link, node: head, to: column, conductance: 12 W/K}",
    "{type: link, node: column, to: ambient, conductance: 14 W/K}",
    "{type: coolant, node: head, flow: 10 L/min, passage_conductance: 3 W/K, set_point: 22 degC}"};

/// The full system of lumped nodes as a reduced one.
ReducedSystem reduced(const std::vector<std::string>& entries) {
  const FullSystem full = fixtures::lumped_system(entries);
  const Eigen::MatrixXd mass = full.mass;
  return project(full, Eigen::MatrixXd(mass.diagonal().cwiseSqrt().cwiseInverse().asDiagonal()));
}

Eigen::VectorXd end(const ReducedSystem& system) {
  const Cyclogram run{.name = "monday", .sections = {{1800.0, {.speed_rpm = 1500.0}}, {1800.0, {}}}};
  Eigen::MatrixXd states;
  (void)Propagator(system).run(run, {{0.0}, {1.0}}, {3600.0}, Eigen::VectorXd::Zero(system.size()), false, &states);
  return states.col(0);
}

TEST(BindLaws, TheOrderOfTheListDoesNotMatter) {
  const ReducedSystem as_assembled = reduced(kMachine);
  HeatBalance balance = fixtures::balance_of(kMachine);
  std::reverse(balance.heats.begin(), balance.heats.end());
  std::reverse(balance.exchanges.begin(), balance.exchanges.end());
  ReducedSystem bound = as_assembled;
  for (auto& s : bound.sources) s.power_W = BoundLaw([](const effects::Inputs&) { return 1e9; });
  for (auto& e : bound.exchanges) e.coefficient = BoundLaw([](const effects::Inputs&) { return 1e9; });
  bind_laws(bound, balance);
  EXPECT_EQ(end(bound), end(as_assembled));
}

TEST(BindLaws, WhatHasNoEntryOfItsNameAddsUpAtItsPlace) {
  std::vector<std::string> more = kMachine;
  more.insert(more.end(),
              {"{type: friction_law, node: head, power: 30 W, at_speed: 1000 rpm}",
               "{type: exchange_window, node: column, conductance: 5 W/K, windows: [[10 min, 20 min]], in: monday}"});
  ReducedSystem bound = reduced(kMachine);
  bind_laws(bound, fixtures::balance_of(more));
  EXPECT_LT((end(bound) - end(reduced(more))).cwiseAbs().maxCoeff(), 1e-9 * end(bound).cwiseAbs().maxCoeff());
  EXPECT_GT((end(bound) - end(reduced(kMachine))).cwiseAbs().maxCoeff(), 0.01 * end(bound).cwiseAbs().maxCoeff());
}

TEST(BindLaws, EntriesThatNothingComesToRest) {
  std::vector<std::string> fewer = kMachine;
  fewer.erase(fewer.begin() + 3);
  ReducedSystem bound = reduced(kMachine);
  bind_laws(bound, fixtures::balance_of(fewer));
  EXPECT_LT((end(bound) - end(reduced(fewer))).cwiseAbs().maxCoeff(), 1e-12 * end(bound).cwiseAbs().maxCoeff());
}

TEST(BindLaws, AMediumTakesTheTemperatureOfTheBalance) {
  std::vector<std::string> colder = kMachine;
  colder.back() = "{type: coolant, node: head, flow: 10 L/min, passage_conductance: 3 W/K, set_point: 12 degC}";
  ReducedSystem bound = reduced(kMachine);
  bind_laws(bound, fixtures::balance_of(colder));
  EXPECT_LT((end(bound) - end(reduced(colder))).cwiseAbs().maxCoeff(), 1e-12 * end(bound).cwiseAbs().maxCoeff());
}

TEST(BindLaws, TwoMediaAtOnePlaceEachKeepTheirTemperature) {
  std::vector<std::string> two = kMachine;
  two.emplace_back(
      "{type: coolant, node: head, flow: 10 L/min, passage_conductance: 5 W/K, set_point: 12 degC, from: 20 min}");
  ReducedSystem bound = reduced(kMachine);
  bind_laws(bound, fixtures::balance_of(two));
  EXPECT_LT((end(bound) - end(reduced(two))).cwiseAbs().maxCoeff(), 1e-9 * end(bound).cwiseAbs().maxCoeff());
  bind_laws(bound, fixtures::balance_of(kMachine));  // and a law that is gone leaves no heat
  EXPECT_LT((end(bound) - end(reduced(kMachine))).cwiseAbs().maxCoeff(), 1e-9 * end(bound).cwiseAbs().maxCoeff());
}

TEST(BindLaws, ALawFindsTheBodyThatNothingLookedAt) {
  ReducedSystem bound = reduced(kMachine);
  ASSERT_TRUE(bound.probes.empty());
  HeatBalance balance = fixtures::balance_of(kMachine);
  balance.heats[0].power_W = Law([](const effects::Inputs& u) { return u.probe_K[0]; }, {effects::node("column")});
  bind_laws(bound, balance);
  ASSERT_EQ(bound.probes.size(), 1u);
  EXPECT_EQ(bound.probes[0].body, effects::node("column"));
  // the column's state is its temperature times the root of its capacity
  EXPECT_NEAR(bound.probes[0].weights[1], 1.0 / std::sqrt(40e3), 1e-12);
  EXPECT_EQ(bound.probes[0].weights[0], 0.0);
}

TEST(BindLaws, RefusesAPlaceThatTheSystemHasNot) {
  for (const char* text :
       {"{type: heat_source, node: tail, power: 1 W}", "{type: link, node: head, to: ambient, conductance: 1 W/K}"}) {
    std::vector<std::string> other = kMachine;
    other.emplace_back(text);
    ReducedSystem bound = reduced(kMachine);
    EXPECT_THROW(bind_laws(bound, fixtures::balance_of(other)), std::logic_error) << text;
  }
}

// --- laws of temperature, made linear

const std::vector<std::string> kOiled = {"{type: node, node: bearing, capacity: 0.7 kJ/K}",
                                         "{type: node, node: housing, capacity: 19 kJ/K}",
                                         "{type: bearing_friction, node: bearing, f0: 2, viscosity_40: 25 mm^2/s, "
                                         "viscosity_100: 5.4 mm^2/s, mean_diameter: 90 mm}",
                                         "{type: link, node: bearing, to: housing, conductance: 30 W/K}",
                                         "{type: link, node: housing, to: ambient, conductance: 5 W/K}"};

/// The state with these temperatures of bearing and housing over the reference.
Eigen::VectorXd state_of(const ReducedSystem& system, double bearing_K, double housing_K) {
  const auto source = std::find_if(system.sources.begin(), system.sources.end(),
                                   [](const HeatSource& s) { return s.power_W.looks_at_state(); });
  Eigen::VectorXd state(2);
  const int bearing = std::abs(source->load[0]) > 0.0 ? 0 : 1;
  state[bearing] = std::sqrt(700.0) * bearing_K;
  state[1 - bearing] = std::sqrt(19000.0) * housing_K;
  return state;
}

/// Palmgren's viscous friction [W] of kOiled at f0 = 2 and 90 mm, and its derivative over temperature, by hand:
/// P ~ nu^(2/3), lg lg (nu + 0.8) = A - B lg T, so dnu/dT = -(nu + 0.8) ln(nu + 0.8) B / T.
struct Friction {
  double power_W = 0.0, slope_W_K = 0.0;
};
Friction friction(double speed_rpm, double temperature_K) {
  const auto lglg = [](double nu) { return std::log10(std::log10(nu + 0.8)); };
  const double b = (lglg(25.0) - lglg(5.4)) / (std::log10(373.15) - std::log10(313.15)),
               a = lglg(25.0) + b * std::log10(313.15),
               nu = std::pow(10.0, std::pow(10.0, a - b * std::log10(temperature_K))) - 0.8;
  const double torque_Nm = 1e-3 * 2.0 * 1e-7 * std::pow(nu * speed_rpm, 2.0 / 3.0) * std::pow(90.0, 3),
               power_W = torque_Nm * speed_rpm * std::numbers::pi / 30.0;
  const double dnu_dT = -(nu + 0.8) * std::log(nu + 0.8) * b / temperature_K;
  return {power_W, power_W * 2.0 / 3.0 * dnu_dT / nu};
}

TEST(Linearise, OilThatThinsBecomesItsTangentAtEachSpeed) {
  const ReducedSystem system = reduced(kOiled);
  const effects::Inputs at{.drive = {.speed_rpm = 3000.0}, .ambient_K = 1.0};
  const Eigen::VectorXd state = state_of(system, 20.0, 8.0);
  const double temperature_K = system.reference_K + 20.0;
  const Linearisation linear = linearise(system, std::vector<OperatingRow>{{at, state}});
  EXPECT_FALSE(system.is_linear());
  ASSERT_TRUE(linear.system.is_linear());
  ASSERT_EQ(linear.laws.size(), 1U);
  EXPECT_NEAR(linear.laws[0].at_K, temperature_K, 1e-9);
  ASSERT_EQ(linear.system.exchanges.size(), system.exchanges.size() + 1);
  const auto& slope = linear.system.exchanges.back();
  for (double rpm : {3000.0, 6000.0}) {  // the law goes on to follow the drive
    const Friction by_hand = friction(rpm, temperature_K);
    const effects::Inputs there{.drive = {.speed_rpm = rpm}, .ambient_K = 1.0};
    EXPECT_LT(by_hand.slope_W_K, -0.01 * by_hand.power_W);  // 2.5 % per K: else there is nothing to test
    EXPECT_NEAR(slope.coefficient(there), -by_hand.slope_W_K, 1e-5 * -by_hand.slope_W_K);
    for (double warmer_K : {0.0, 3.0}) {  // heat into the bearing from friction
      const Eigen::VectorXd warmer = state_of(system, 20.0 + warmer_K, 8.0);
      double heat_W = 0.0;
      for (const HeatSource& s : linear.system.sources) heat_W += s.power_W(there);
      heat_W -= slope.coefficient(there) * (slope.flow.dot(warmer) - slope.offset_sum);
      EXPECT_NEAR(heat_W, by_hand.power_W + by_hand.slope_W_K * warmer_K, 1e-5 * by_hand.power_W);
    }
  }
  EXPECT_EQ(slope.coefficient({.drive = {}, .ambient_K = 0.0}), 0.0);  // at rest nothing rubs
  // The whole tangent: K of the linear system against that of the rate of the nonlinear one.
  const TimeSeries ambient{{0.0}, {1.0}};
  LiveRate rate(system, ambient);
  (void)rate.enter({.start_s = 0.0, .end_s = 60.0, .drive = at.drive});
  Eigen::MatrixXd k = linear.system.conduction;
  for (const auto& e : linear.system.exchanges) k += e.coefficient(at) * e.matrix;
  EXPECT_LT((k + rate.tangent(0.0, state)).cwiseAbs().maxCoeff(), 1e-6 * k.cwiseAbs().maxCoeff());
}

// Two states, one standard deviation on either side of the mean: their difference is the slope, their mean the power.
TEST(Linearise, OverARangeOfTemperaturesTheSlopeIsTheSecantOverTwoDeviations) {
  const ReducedSystem system = reduced(kOiled);
  const effects::Inputs at{.drive = {.speed_rpm = 3000.0}};
  std::vector<OperatingRow> rows;
  double sum = 0.0, mean_K = 0.0, variance = 0.0;
  const std::vector<double> temperatures_K = {2.0, 10.0, 18.0, 24.0, 26.0};
  const auto weight = [&](double theta_K) { return std::pow(friction(3000.0, system.reference_K + theta_K).power_W, 2); };
  for (double theta_K : temperatures_K) {
    rows.push_back({at, state_of(system, theta_K, 0.5 * theta_K)});
    sum += weight(theta_K);
    mean_K += weight(theta_K) * theta_K;
  }
  mean_K /= sum;
  rows.push_back({{.drive = {}}, state_of(system, 60.0, 60.0)});  // at rest: it does not count
  for (double theta_K : temperatures_K) variance += weight(theta_K) / sum * std::pow(theta_K - mean_K, 2);
  const double sigma_K = std::sqrt(variance);
  const Linearisation linear = linearise(system, rows);
  const double above_W = friction(3000.0, system.reference_K + mean_K + sigma_K).power_W,
               below_W = friction(3000.0, system.reference_K + mean_K - sigma_K).power_W;
  EXPECT_NEAR(linear.laws[0].at_K, system.reference_K + mean_K, 1e-6);
  EXPECT_NEAR(linear.laws[0].spread_K, sigma_K, 1e-6);
  const auto& slope = linear.system.exchanges.back();
  EXPECT_NEAR(slope.coefficient(at), (below_W - above_W) / (2.0 * sigma_K), 1e-6 * below_W);
  EXPECT_NEAR(slope.offset_sum, mean_K, 1e-6);
  double power_W = 0.0;
  for (const HeatSource& s : linear.system.sources) power_W += s.power_W(at);
  EXPECT_NEAR(power_W, 0.5 * (above_W + below_W), 1e-6 * below_W);
}

// Free convection, c = 2 W/K (difference / K)^(1/4), over differences of 0 to 20 K alike: the coefficient with the least
// error in heat is the mean of c x^2 over that of x^2, 2 * 20^(1/4) * 3 / 3.25; two states give it to a third of a per cent.
TEST(Linearise, FreeConvectionBecomesTheSecantWithTheLeastErrorInHeat) {
  ReducedSystem system = reduced(
      {"{type: node, node: bearing, capacity: 0.7 kJ/K}", "{type: link, node: bearing, to: ambient, conductance: 2 W/K}"});
  auto& film = system.exchanges.front();
  const effects::Law by_difference(
      [](const effects::Inputs& u) { return 2.0 * std::pow(std::abs(u.probe_K.at(0) - u.probe_K.at(1)), 0.25); });
  film.coefficient = BoundLaw(by_difference);
  const int first = static_cast<int>(system.probes.size());
  system.probes.push_back({.weights = film.flow});
  system.probes.push_back({.weights = Eigen::VectorXd::Zero(1), .ambient_share = 1.0});
  film.coefficient.probes = {first, first + 1};
  std::vector<OperatingRow> rows;
  for (int i = 0; i <= 200; ++i) {
    const double ambient_K = 3.0 + 0.01 * i, theta_K = ambient_K + 0.1 * i;
    rows.push_back({{.drive = {}, .ambient_K = ambient_K}, Eigen::VectorXd::Constant(1, std::sqrt(700.0) * theta_K)});
  }
  const Linearisation linear = linearise(system, rows);
  const double c = linear.system.exchanges.front().coefficient({});
  EXPECT_NEAR(c, 2.0 * std::pow(20.0, 0.25) * 3.0 / 3.25, 0.005 * c);
  EXPECT_EQ(linear.system.exchanges.size(), 1U);
  // Zero difference remains zero heat.
  const effects::Inputs at{.drive = {}, .ambient_K = 5.0};
  const Eigen::VectorXd balance = Eigen::VectorXd::Constant(1, std::sqrt(700.0) * 5.0),
                        heat_W = linear.system.load(at) - c * (film.matrix * balance);
  EXPECT_NEAR(heat_W[0], 0.0, 1e-9);
}

TEST(Linearise, RefusesThermostatsAndNoRows) {
  ReducedSystem system = reduced(kOiled);
  EXPECT_THROW((void)linearise(system, {}), std::logic_error);
  system.thermostats.push_back({.name = "chiller"});
  EXPECT_THROW((void)linearise(system, std::vector<OperatingRow>{{{}, state_of(system, 1.0, 1.0)}}), std::logic_error);
}

// Laws come back to a linear system from a file as they were.
TEST(BindLaws, LinearLawsKeepTheirTemperatures) {
  const ReducedSystem system = reduced(kOiled);
  const effects::Inputs at{.drive = {.speed_rpm = 3000.0}};
  const std::vector<OperatingRow> rows = {{at, state_of(system, 10.0, 4.0)}, {at, state_of(system, 30.0, 9.0)}};
  const ReducedSystem linear = linearise(system, rows).system;
  ReducedSystem bound = linear;
  for (auto& s : bound.sources) s.power_W.law = effects::Law([](const effects::Inputs&) { return 1e9; });
  for (auto& e : bound.exchanges) e.coefficient.law = effects::Law([](const effects::Inputs&) { return 1e9; });
  bind_laws(bound, fixtures::balance_of(kOiled));
  EXPECT_EQ(end(bound), end(linear));
  EXPECT_GT((end(linear) - end(linearise(system, std::span(rows).first(1)).system)).norm(), 1e-3 * end(linear).norm());
}

}  // namespace
}  // namespace driftwright::solver::bind_laws_test
