// Systems whose laws look at temperatures: radiation, free convection, oil that thins, properties over temperature; against
// closed forms, against their own steady state, and whether heat balances.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "effects/bearing_formulas.hpp"
#include "effects/film_formulas.hpp"
#include "solver/heat_rate.hpp"
#include "solver/steady_state.hpp"
#include "solver/transient.hpp"
#include "tests/shared/effect_list.hpp"
#include "tests/shared/fixtures.hpp"

namespace driftwright::solver::nonlinear_test {
namespace {

using fixtures::flow;

const TimeSeries kStillAmbient{{0.0}, {0.0}};
const TransientOptions kFine{.relative_tolerance = 1e-6, .absolute_tolerance_K = 1e-5};
constexpr double kSigma = 5.670374419e-8;

Cyclogram at_speed(double duration_s, double speed_rpm) {
  return {.name = "c", .sections = {{duration_s, {.speed_rpm = speed_rpm}}}};
}

/// A cube of 0.1 m that has nearly one temperature: C = 4000 J/K, a face of 0.01 m^2.
mesh::Mesh cube() {
  return fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {1, 1, 1}});
}

void note(const std::string& key, double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2e", value);
  ::testing::Test::RecordProperty(key, text);
}

// --- radiation --------------------------------------------------------------------------------------------------

TEST(Radiation, LumpCoolsByTheClosedFormOfTheFourthPower) {
  // dT/dt = -k T^4 into an ambient of 1 K (1e-10 of it comes back): T = (T0^-3 + 3 k t)^(-1/3), k = 0.9 sigma 0.01 m^2 /
  // 4000 J/K.
  FullSystem system = assemble_heat(cube(), {fixtures::lump(1e5)},
                                    fixtures::balance_of({"{type: radiation, surface: x1, emissivity: 0.9}"}), 400.0);
  fixtures::observe_unknowns(system, {0});
  const TimeSeries ambient{{0.0}, {-399.0}};
  const std::vector<double> times_s = {1000, 10000, 50000, 200000};
  const Trajectory run =
      simulate(system, at_speed(200000, 0), ambient, times_s, kFine, Eigen::VectorXd::Constant(system.size(), 200.0));
  for (std::size_t k = 0; k < times_s.size(); ++k) {
    const double exact_K = std::pow(std::pow(600.0, -3) + 3.0 * 0.9 * kSigma * 0.01 / 4000.0 * times_s[k], -1.0 / 3.0);
    // The cube's temperatures differ by q L / k = 6600 * 0.1 / 1e5 = 6.6 mK at first; the tolerance adds 0.2 mK a step.
    EXPECT_NEAR(400.0 + run.outputs(0, static_cast<Eigen::Index>(k)), exact_K, 6.6e-3) << times_s[k];
    note("error_K", 400.0 + run.outputs(0, static_cast<Eigen::Index>(k)) - exact_K);
  }
  note("gap", run.energy_gap());
  EXPECT_LT(run.energy_gap(), 1e-9);
}

TEST(Radiation, BetweenAPlateAndAHotNeighbourAsTheClosedForm) {
  // A neighbour held at 500 degC shines on x0, x1 radiates to the ambient of 20 degC, both with 0.8: T^4 is the mean of
  // the two.
  const mesh::Mesh mesh = cube();
  FullSystem system =
      assemble_heat(mesh, {fixtures::lump(1e7)},
                    fixtures::balance_of({"{type: node, node: furnace, capacity: 1 J/K}",
                                          "{type: fixed_temperature, node: furnace, temperature: 500 degC}",
                                          "{type: radiation, surface: x0, emissivity: 0.8, surrounding: furnace}",
                                          "{type: radiation, surface: x1, emissivity: 0.8}"}));
  const Eigen::VectorXd theta = steady_state(system, {}, Eigen::VectorXd::Zero(system.size()));
  const double exact_K = std::pow(0.5 * (std::pow(773.15, 4) + std::pow(293.15, 4)), 0.25);
  EXPECT_NEAR(293.15 + theta[0], exact_K, 2e-4);  // 8.1 kW/m^2 * 0.1 m / 1e7 W/(m K) = 81 uK within the cube
  // 0.8 sigma (T_furnace^4 - T^4) 0.01 m^2 = 79.4 W cross the cube.
  const double through_W = 0.8 * kSigma * 0.01 * (std::pow(773.15, 4) - std::pow(exact_K, 4));
  const Trajectory on = simulate(system, at_speed(100, 0), kStillAmbient, {100}, {}, theta);
  EXPECT_NEAR(on.heat_J(flow(on, "radiation x1"), 0) / 100.0, -through_W, 1e-3);
  EXPECT_NEAR(on.heat_J(flow(on, "radiation x0"), 0) / 100.0, -through_W, 1e-3);  // out of the cube, into the node
  EXPECT_NEAR(on.heat_J(flow(on, "fixed_temperature furnace"), 0) / 100.0, through_W, 1e-3);
  // Radiation's share of the heats is that of Newton's last iterate: linear problems alone close to rounding.
  EXPECT_LT(on.energy_gap(), 1e-7);
}

// --- laws of mean temperatures ----------------------------------------------------------------------------------

/// Two blocks: a bearing whose oil thins and whose preload grows, free convection on all sides, radiation, a pocket of air.
FullSystem spindle() {
  const mesh::Mesh mesh =
      fixtures::two_boxes({{0, 0, 0}, {0.2, 0.1, 0.1}, {2, 1, 1}, mesh::CellShape::kTet10},
                          {{0.2, 0, 0}, {0.3, 0.2, 0.2}, {2, 1, 1}, mesh::CellShape::kTet10}, "a.x1", "b.x0");
  FullSystem system =
      assemble_heat(mesh, {fixtures::steel(), fixtures::steel()},
                    fixtures::balance_of(
                        {"{type: bearing_friction, region: a, f0: 2, viscosity_40: 32 mm^2/s, viscosity_100: 5.4 mm^2/s, "
                         "mean_diameter: 90 mm, "
                         "f1: 0.001, load: 300 N, preload_growth: 15 N/K, inner: a, outer: b, count: 2}",
                         "{type: contact, joint: a/b, conductance: 3000 W/(m^2 K)}",
                         "{type: natural_convection, surface: a.y1, orientation: vertical, length: 0.1 m, surrounding: air}",
                         "{type: natural_convection, surface: a.z1, orientation: up, length: 33 mm, surrounding: air}",
                         "{type: natural_convection, surface: b.z1, orientation: up, length: 60 mm}",
                         "{type: natural_convection, surface: b.z0, orientation: down, length: 60 mm}",
                         "{type: natural_convection, surface: b.y1, orientation: horizontal_cylinder, length: 0.2 m}",
                         "{type: radiation, surface: b.x1, emissivity: 0.9}",
                         "{type: radiation, surface: a.y0, emissivity: 0.9, surrounding: air}",
                         "{type: air_node, node: air, capacity: 1.2 kJ/K, exchange: 2 W/K}"}));
  fixtures::observe_unknowns(system, {0, mesh.n_nodes() - 1, mesh.n_nodes()});
  return system;
}

TEST(Nonlinear, TransientEndsInTheSteadyStateOfItsLaws) {
  const FullSystem system = spindle();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  const Eigen::VectorXd theta = steady_state(system, {.drive = {.speed_rpm = 3000}}, zero);
  const Trajectory fine = simulate(system, at_speed(6e5, 3000), kStillAmbient, {6e5},
                                   {.relative_tolerance = 1e-6, .absolute_tolerance_K = 1e-5}, zero);
  const Eigen::VectorXd expected = system.observe(theta, 0.0);
  EXPECT_GT(expected[0], 10.0);
  // The slowest lag is some 2e4 s: e^-30. Left are 1e-6 of some 50 K a step.
  EXPECT_LT((fine.outputs.col(0) - expected).cwiseAbs().maxCoeff(), 2e-3);
  note("difference_K", (fine.outputs.col(0) - expected).cwiseAbs().maxCoeff());
}

TEST(Nonlinear, HeatBalancesToRoundingAtAnyTolerance) {
  const FullSystem system = spindle();
  const Cyclogram cycle{
      .name = "cycle",
      .sections = {{1800, {.speed_rpm = 2000}}, {600, {}}, {1200, {.speed_rpm = 500}}, {3600, {.speed_rpm = 3000}}}};
  const TimeSeries ambient{{0, 2000, 5000}, {0.0, 1.5, -1.0}};
  for (double tolerance : {1e-2, 5e-4, 1e-5}) {
    const Trajectory run =
        simulate(system, cycle, ambient, {7200}, {.relative_tolerance = tolerance, .absolute_tolerance_K = tolerance},
                 Eigen::VectorXd::Zero(system.size()));
    EXPECT_LT(run.energy_gap(), 1e-9) << tolerance;  // Runge-Kutta weights serve temperatures and heats alike
    note("gap_at_" + std::to_string(tolerance), run.energy_gap());
  }
  const Trajectory standard = simulate(system, cycle, ambient, {7200}, {}, Eigen::VectorXd::Zero(system.size()));
  note("gap_at_default", standard.energy_gap());
  note("steps_at_default", standard.n_steps);
}

TEST(Nonlinear, SteadyStateSolvesTheLawsOfASmallModel) {
  // One lump by hand: P(T) of the bearing = h(T) A (T - T_ambient), solved by bisection on the same formulas, outside the
  // solver.
  const mesh::Mesh mesh = cube();
  const FullSystem system =
      assemble_heat(mesh, {fixtures::lump(1e7)},
                    fixtures::balance_of({"{type: bearing_friction, region: body, f0: 0.5, viscosity_40: 32 mm^2/s, "
                                          "viscosity_100: 5.4 mm^2/s, mean_diameter: 60 mm}",
                                          "{type: natural_convection, surface: y1, orientation: vertical, length: 0.1 m}"}));
  double low_K = 293.15, high_K = 450.0;
  for (int i = 0; i < 200; ++i) {
    const double t_K = 0.5 * (low_K + high_K);
    const double in_W = effects::friction_power_W(
        effects::palmgren_viscous_torque_Nmm(0.5, effects::walther_viscosity_mm2_s(32, 5.4, t_K), 500, 60), 500);
    const double out_W =
        effects::natural_convection_htc_W_m2K(effects::Orientation::kVertical, 0.1, t_K, 293.15) * 0.01 * (t_K - 293.15);
    (in_W > out_W ? low_K : high_K) = t_K;
  }
  const Eigen::VectorXd theta = steady_state(system, {.drive = {.speed_rpm = 500}}, Eigen::VectorXd::Zero(system.size()));
  EXPECT_GT(theta[0], 3.0);
  EXPECT_NEAR(theta.mean(), low_K - 293.15, 1e-5);  // 0.7 W * 0.1 m / (1e7 W/(m K) 0.01 m^2) = 1 uK within the cube
}

TEST(Nonlinear, SteadyStateTakesShorterStepsWhereALawIsSteep) {
  // θ = 100 exp(-θ / 5): whole steps without the law's slope (-2.2 at the solution) would swing between 0.2 K and 96 K.
  effects::HeatBalance balance = fixtures::balance_of(
      {"{type: node, node: a, capacity: 1 J/K}", "{type: link, node: a, to: ambient, conductance: 1 W/K}"});
  balance.heats.push_back(
      {"steep", effects::node("a"),
       effects::Law([](const effects::Inputs& u) { return 100.0 * std::exp(-(u.probe_K.at(0) - 293.15) / 5.0); },
                    {effects::node("a")})});
  const Eigen::VectorXd theta = steady_state(assemble_heat({}, {}, balance), {}, Eigen::VectorXd::Zero(1));
  EXPECT_GT(theta[0], 10.0);
  EXPECT_NEAR(theta[0], 100.0 * std::exp(-theta[0] / 5.0), 1e-8);  // 1e-10 of 50 K, the largest seen on the way
}

TEST(Nonlinear, ALawThatIsLeftForGoodIsNamedWhenTheRunGivesUp) {
  // 20 kW into 4 kJ/K: after a minute or two the film is warmer than the 500 K up to which air is known.
  const mesh::Mesh mesh = cube();
  const FullSystem system =
      assemble_heat(mesh, {fixtures::steel()},
                    fixtures::balance_of({"{type: heat_source, region: body, power: 20 kW}",
                                          "{type: natural_convection, surface: x1, orientation: vertical, length: 0.1 m}"}));
  EXPECT_THAT(
      [&] { (void)simulate(system, at_speed(7200, 0), kStillAmbient, {7200}, {}, Eigen::VectorXd::Zero(system.size())); },
      ::testing::ThrowsMessage<SolveError>(::testing::HasSubstr("air temperature [K]")));
}

// --- properties over temperature --------------------------------------------------------------------------------

TEST(VariableConductivity, SlabFollowsTheKirchhoffTransform) {
  // k = 40 W/(m K) at 0 K of rise, falling by 0.05 W/(m K) a kelvin; faces at 220 degC and 20 degC. F(θ) = 40 θ - 0.025 θ^2
  // is linear in x: θ = 800 - sqrt(640000 - 40 F), F = 7000 (1 - x / L); flux F(200) / L = 70 kW/m^2, 700 W.
  Material m = fixtures::steel();
  m.conductivity_curve = {{293.15, 493.15}, {40.0, 30.0}};
  std::vector<double> h, error;
  for (int n : {2, 4, 8}) {
    const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {n, n, n}});
    FullSystem system =
        assemble_heat(mesh, {m},
                      fixtures::balance_of({"{type: fixed_temperature, surface: x0, temperature: 220 degC}",
                                            "{type: fixed_temperature, surface: x1, temperature: 20 degC}"}));
    const Eigen::VectorXd theta = steady_state(system, {}, Eigen::VectorXd::Zero(system.size()));
    h.push_back(1.0 / n);
    error.push_back(fixtures::l2_error(mesh, theta, [](const Eigen::Vector3d& x) {
      return 800.0 - std::sqrt(640000.0 - 40.0 * 7000.0 * (1.0 - x[0] / 0.1));
    }));
    if (n < 8) continue;
    fixtures::observe_unknowns(system, {0});
    const Trajectory run = simulate(system, at_speed(1000, 0), kStillAmbient, {1000}, kFine, theta);
    EXPECT_NEAR(run.heat_J(flow(run, "fixed_temperature x0"), 0) / 1000.0, 700.0, 1e-3);  // the tolerance of steps
    EXPECT_LT(run.energy_gap(), 1e-9);
    note("gap", run.energy_gap());
    note("flux_error_W", run.heat_J(flow(run, "fixed_temperature x0"), 0) / 1000.0 - 700.0);
  }
  note("order", fixtures::observed_order(h, error));
  note("l2_error_finest", error.back());
  EXPECT_NEAR(fixtures::observed_order(h, error), 3.0, 0.1);  // quadratic elements
  EXPECT_LT(error.back(), 1e-5 * 6.0);                        // of the field's own norm, 6 K m^1.5
}

TEST(VariableCapacity, LumpTakesUpTheIntegralOfItsHeatCapacity) {
  // 8 kg, c = 500 J/(kg K) at 20 degC rising by 1 J/(kg K^2): 500 θ + θ^2 / 2 = P t / m. 400 W for 2 h: 360 kJ/kg.
  Material m = fixtures::lump(1e6);
  m.heat_capacity_curve = {{293.15, 1293.15}, {500.0, 1500.0}};
  FullSystem system = assemble_heat(cube(), {m}, fixtures::balance_of({"{type: heat_source, region: body, power: 400 W}"}));
  fixtures::observe_unknowns(system, {0});
  const std::vector<double> times_s = {600, 3600, 7200};
  const Trajectory run =
      simulate(system, at_speed(7200, 0), kStillAmbient, times_s, kFine, Eigen::VectorXd::Zero(system.size()));
  for (std::size_t k = 0; k < times_s.size(); ++k) {
    const double heat_J_kg = 400.0 * times_s[k] / 8.0;
    EXPECT_NEAR(run.outputs(0, static_cast<Eigen::Index>(k)), -500.0 + std::sqrt(250000.0 + 2.0 * heat_J_kg), 2e-3)
        << times_s[k];  // 1e-6 of 485 K a step
  }
  // Where heat capacity varies the heat stored is no linear function of the temperatures; it balances as exactly as they are
  // integrated: 1e-4 of the temperature a step by default, and with the tolerance.
  const Trajectory standard =
      simulate(system, at_speed(7200, 0), kStillAmbient, {7200}, {}, Eigen::VectorXd::Zero(system.size()));
  note("gap_at_1e-6", run.energy_gap());
  note("gap_at_default", standard.energy_gap());
  EXPECT_LT(standard.energy_gap(), 1e-4);
  EXPECT_LT(run.energy_gap(), 1e-6);
}

// --- the linear model -------------------------------------------------------------------------------------------

TEST(Linearised, FollowsASmallPerturbationOfRadiationAndPrescribedTemperature) {
  // Around a steady state by radiation and a held face, 0.2 K of the ambient: both models move alike to second order.
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {2, 1, 1}});
  const FullSystem system =
      assemble_heat(mesh, {fixtures::steel()},
                    fixtures::balance_of({"{type: fixed_temperature, surface: x0, temperature: 60 degC}",
                                          "{type: radiation, surface: x1, emissivity: 0.9}",
                                          "{type: convection, surface: y1, film: 10 W/(m^2 K)}"}));
  const effects::Inputs at{.drive = {}, .ambient_K = 1.0};
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  const Eigen::VectorXd theta = steady_state(system, at, zero);
  const FullSystem linear = linearised(system, at, theta);
  ASSERT_TRUE(linear.is_linear());
  EXPECT_LT((fixtures::steady(linear, at) - theta).cwiseAbs().maxCoeff(), 1e-4);  // stiff rows: 1e-6 of the flux's rise
  effects::Inputs moved = at;
  moved.ambient_K += 0.2;
  const Eigen::VectorXd full_step = steady_state(system, moved, theta) - theta;
  const Eigen::VectorXd linear_step = fixtures::steady(linear, moved) - fixtures::steady(linear, at);
  EXPECT_GT(full_step.maxCoeff(), 5e-3);
  note("largest_step_K", full_step.maxCoeff());
  note("difference_K", (full_step - linear_step).cwiseAbs().maxCoeff());
  // Curvature of T^4 over 0.2 K of 294 K: 1.5 * 0.2 / 294 = 1e-3 of the step.
  EXPECT_LT((full_step - linear_step).cwiseAbs().maxCoeff(), 1e-3 * full_step.maxCoeff());
}

TEST(Nonlinear, FreeConvectionInStratifiedAirGrowsWithTheDifferenceToTheAirBeforeItsSurface) {
  // A face of 0.01 m^2 with its middle 10.05 m over the thermometer: 20.1 K warmer air, the film of that difference.
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {2, 2, 2}});
  const FullSystem system =
      assemble_heat(mesh, {fixtures::steel()},
                    fixtures::balance_of({"{type: natural_convection, surface: x0, orientation: vertical, length: 100 mm}",
                                          "{type: stratification, gradient: 2 K/m, level: -10 m}"}));
  HeatRate rate(system);
  rate.set({}, 0.0);
  const Eigen::VectorXd theta = Eigen::VectorXd::Zero(system.size());
  Eigen::VectorXd heat_W(system.size());
  rate.evaluate(theta.data(), 0.0, heat_W.data());
  double flow_W = 0.0;
  rate.flows_W(theta.data(), 0.0, &flow_W);
  const double htc = effects::natural_convection_htc_W_m2K(effects::Orientation::kVertical, 0.1, 293.15, 293.15 + 20.1);
  EXPECT_NEAR(flow_W, htc * 0.01 * 20.1, 1e-9);
  EXPECT_NEAR(heat_W.sum(), flow_W, 1e-9);
}

TEST(Nonlinear, TemperaturesThatNoMachineHasEndTheRun) {
  // 3 kW out of a node that 2 W/K keep warm tends to -1480 degC; 1 MW into it to 500 000 degC.
  for (const char* power : {"-3 kW", "1 MW"}) {
    const FullSystem system = fixtures::lumped_system({"{type: node, node: b, capacity: 10 kJ/K}",
                                                       "{type: link, node: b, to: ambient, conductance: 2 W/K}",
                                                       std::string("{type: heat_source, node: b, power: ") + power + "}"});
    EXPECT_THROW((void)simulate(system, at_speed(36000, 0), kStillAmbient, {36000}, {}, Eigen::VectorXd::Zero(1)),
                 SolveError);
  }
}

TEST(Nonlinear, ASteadyStateBeyondALawNamesTheLaw) {
  // 300 W through one face of 0.01 m^2 would require thousands of kelvins; properties of air are known up to 500 K.
  const FullSystem system =
      assemble_heat(cube(), {fixtures::steel()},
                    fixtures::balance_of({"{type: natural_convection, surface: x0, orientation: vertical, length: 100 mm}",
                                          "{type: heat_source, region: body, power: 300 W}"}));
  try {
    (void)steady_state(system, {}, Eigen::VectorXd::Zero(system.size()));
    FAIL() << "no error";
  } catch (const SolveError& e) {
    EXPECT_NE(std::string(e.what()).find("air temperature"), std::string::npos) << e.what();
  }
}

TEST(Linearised, KeepsTheHeatCapacityOfItsTemperature) {
  // c rises by 1 J/(kg K^2) from 500 J/(kg K): at +300 K a lump of 8 kg has 6400 J/K.
  Material m = fixtures::lump(1e6);
  m.heat_capacity_curve = {{293.15, 1293.15}, {500.0, 1500.0}};
  const FullSystem system = assemble_heat(cube(), {m}, {});
  const FullSystem linear = linearised(system, {}, Eigen::VectorXd::Constant(system.size(), 300.0));
  EXPECT_NEAR(linear.ones.dot(linear.mass * linear.ones), 6400.0, 1e-6);
}

}  // namespace
}  // namespace driftwright::solver::nonlinear_test
