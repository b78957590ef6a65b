// Lumped nodes, links and effects that act for a time, as systems, against closed forms.

#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "solver/steady_state.hpp"
#include "solver/transient.hpp"
#include "tests/shared/effect_list.hpp"
#include "tests/shared/fixtures.hpp"

namespace driftwright::solver::lumped_effects_test {
namespace {

using fixtures::flow;

const TimeSeries kStillAmbient{{0.0}, {0.0}};
const TransientOptions kFine{.relative_tolerance = 1e-7, .absolute_tolerance_K = 1e-7};

Cyclogram rest(double duration_s) {
  return {.name = "rest", .sections = {{duration_s, {}}}};
}

const std::vector<std::string> kTwoBodies = {
    "{type: node, node: motor, capacity: 5 kJ/K}",
    "{type: node, node: housing, capacity: 2 kJ/K}",
    "{type: link, node: motor, to: housing, conductance: 10 W/K}",
    "{type: link, node: motor, to: ambient, conductance: 3 W/K}",
    "{type: link, node: housing, to: ambient, conductance: 5 W/K}",
    "{type: heat_source, node: motor, power: 150 W}",
};

TEST(LumpedNodes, AloneFollowTheClosedFormOfTwoBodies) {
  FullSystem system = fixtures::lumped_system(kTwoBodies);
  ASSERT_EQ(system.size(), 2);
  fixtures::observe_unknowns(system, {0, 1});
  const std::vector<double> times_s = {60, 300, 900, 3600};
  const Trajectory run = simulate(system, rest(3600), kStillAmbient, times_s, kFine, Eigen::Vector2d(4.0, -2.0));
  const fixtures::TwoBodies exact{5000, 2000, 10, 3, 5, 150};
  for (std::size_t k = 0; k < times_s.size(); ++k) {
    const Eigen::Vector2d at = exact.at(times_s[k], {4.0, -2.0});
    // 1e-7 of some 20 K a step, and the steps' errors add up.
    EXPECT_NEAR(run.outputs(0, static_cast<Eigen::Index>(k)), at[0], 2e-5) << times_s[k];
    EXPECT_NEAR(run.outputs(1, static_cast<Eigen::Index>(k)), at[1], 2e-5) << times_s[k];
  }
  EXPECT_LT(run.energy_gap(), 1e-9);
}

TEST(LumpedNodes, AloneHaveTheSteadyStateOfTheirConductances) {
  // Motor: 150 = 3 T1 + 10 (T1 - T2); housing: 10 (T1 - T2) = 5 T2, so T2 = T1 / 1.5 and T1 = 150 / (3 + 10 / 3).
  const FullSystem system = fixtures::lumped_system(kTwoBodies);
  const Eigen::VectorXd theta = steady_state(system, {}, Eigen::VectorXd::Zero(2));
  EXPECT_NEAR(theta[0], 150.0 / (3.0 + 10.0 / 3.0), 1e-9);
  EXPECT_NEAR(theta[1], theta[0] / 1.5, 1e-9);
}

TEST(LumpedNodes, ThreeInARowPassTheirHeatOn) {
  // 60 W run from a through b and c to the ambient: 60 / 20 = 3 K, 60 / 12 = 5 K, 60 / 6 = 10 K.
  const FullSystem system = fixtures::lumped_system(
      {"{type: node, node: a, capacity: 100 J/K}", "{type: node, node: b, capacity: 100 J/K}",
       "{type: node, node: c, capacity: 100 J/K}", "{type: link, node: b, to: a, conductance: 20 W/K}",
       "{type: link, node: b, to: c, conductance: 12 W/K}", "{type: link, node: c, to: ambient, conductance: 6 W/K}",
       "{type: heat_source, node: a, power: 60 W}"});
  const Eigen::VectorXd theta = steady_state(system, {}, Eigen::VectorXd::Zero(3));
  EXPECT_NEAR(theta[2], 10.0, 1e-9);
  EXPECT_NEAR(theta[1], 15.0, 1e-9);
  EXPECT_NEAR(theta[0], 18.0, 1e-9);
}

TEST(LumpedNodes, WithoutAWayOutHaveNoSteadyState) {
  const FullSystem system =
      fixtures::lumped_system({"{type: node, node: a, capacity: 100 J/K}", "{type: heat_source, node: a, power: 60 W}"});
  EXPECT_THROW((void)steady_state(system, {}, Eigen::VectorXd::Zero(1)), SolveError);
}

TEST(Link, SpreadsItsWholeConductanceOverRegionOrSurface) {
  // 50 W in the node leave through the body: node - body by 10 W/K over the region or a surface, body - ambient by 4 W/K.
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.2, 0.3}, .n = {1, 2, 2}});
  for (const char* body : {"region: body", "surface: y0"}) {
    const std::string to_node = std::string("{type: link, ") + body + ", to: rotor, conductance: 10 W/K}";
    const FullSystem system =
        assemble_heat(mesh, {fixtures::lump(1e7)},
                      fixtures::balance_of({"{type: node, node: rotor, capacity: 100 J/K}", to_node,
                                            "{type: link, surface: x1, to: ambient, conductance: 4 W/K}",
                                            "{type: heat_source, node: rotor, power: 50 W}"}));
    const Eigen::VectorXd theta = steady_state(system, {}, Eigen::VectorXd::Zero(system.size()));
    // Within the body 50 W make some 50 * 0.3 / (1e7 * 0.02) = 75 uK.
    EXPECT_NEAR(theta[0], 12.5, 1e-4) << body;
    EXPECT_NEAR(theta[mesh.n_nodes()], 17.5, 1e-4) << body;
  }
}

// --- windows ----------------------------------------------------------------------------------------------------

TEST(Window, HeatOfASourceIsPowerTimesWindow) {
  // 200 W from 1000 s until 1090 s within four hours, steps of two hours allowed: 18 kJ, no more and no less.
  FullSystem system = fixtures::lumped_system({"{type: node, node: a, capacity: 900 J/K}",
                                               "{type: heat_source, node: a, power: 200 W, from: 1000 s, until: 1090 s}"});
  fixtures::observe_unknowns(system, {0});
  const Trajectory run =
      simulate(system, rest(14400), kStillAmbient, {999, 1045, 1091, 14400}, {.max_step_s = 7200}, Eigen::VectorXd::Zero(1));
  EXPECT_EQ(run.heat_J(0, 0), 0.0);
  EXPECT_NEAR(run.heat_J(0, 1), 9000.0, 1e-6);  // rounding of sums
  EXPECT_NEAR(run.heat_J(0, 2), 18000.0, 1e-6);
  EXPECT_NEAR(run.heat_J(0, 3), 18000.0, 1e-6);
  EXPECT_NEAR(run.outputs(0, 3), 20.0, 1e-9);
}

TEST(Window, ADraughtCoolsWhileItBlows) {
  // C = 4000 J/K, h A = 0.5 W/K all the time and 2 W/K more from 1800 s until 3000 s. From 10 K:
  // T = 10 exp(-(0.5 t + 2 * blown) / 4000).
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {1, 1, 1}});
  FullSystem system = assemble_heat(
      mesh, {fixtures::lump(1e6)},
      fixtures::balance_of({"{type: convection, surface: x1, film: 50 W/(m^2 K)}",
                            "{type: convection, surface: y0, film: 200 W/(m^2 K), from: 30 min, until: 50 min}"}));
  fixtures::observe_unknowns(system, {0});
  const Trajectory run = simulate(system, rest(7200), kStillAmbient, {1800, 2400, 3000, 7200}, kFine,
                                  Eigen::VectorXd::Constant(system.size(), 10.0));
  const auto exact = [](double t_s, double blown_s) { return 10.0 * std::exp(-(0.5 * t_s + 2.0 * blown_s) / 4000.0); };
  // The body's temperatures differ by 2000 W/m^2 * 0.1 m / 1e6 W/(m K) = 0.2 mK.
  EXPECT_NEAR(run.outputs(0, 0), exact(1800, 0), 3e-4);
  EXPECT_NEAR(run.outputs(0, 1), exact(2400, 600), 3e-4);
  EXPECT_NEAR(run.outputs(0, 2), exact(3000, 1200), 3e-4);
  EXPECT_NEAR(run.outputs(0, 3), exact(7200, 1200), 3e-4);
  EXPECT_LT(run.energy_gap(), 1e-9);
}

// --- stratification ---------------------------------------------------------------------------------------------

TEST(Stratification, ABodyTakesTheMeanOfTheAirAlongItsHeight) {
  // A body from z = 0 to 2 m that conducts well, film on a side: air at mid height, 1.5 K/m (1 m - 0.4 m) = 0.9 K above the
  // ambient; by radiation a little more, see below.
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 2.0}, .n = {1, 1, 4}});
  for (const char* exchange :
       {"{type: convection, surface: x1, film: 10 W/(m^2 K)}", "{type: link, surface: x1, to: ambient, conductance: 2 W/K}",
        "{type: radiation, surface: x1, emissivity: 0.9}"}) {
    const FullSystem system =
        assemble_heat(mesh, {fixtures::lump(1e7)},
                      fixtures::balance_of({exchange, "{type: stratification, gradient: 1.5 K/m, level: 0.4 m}"}));
    const Eigen::VectorXd theta =
        steady_state(system, {.drive = {}, .ambient_K = 3.0}, Eigen::VectorXd::Zero(system.size()));
    // T^4 curves by 6 T^2 <d^2> against its slope 4 T^3: 1.5 <d^2> / T = 1.5 * 0.75 / 296 = 3.8 mK.
    const bool radiates = std::string(exchange).find("radiation") != std::string::npos;
    const double curvature_K = radiates ? 1.5 * (1.5 * 1.5 * 4.0 / 12.0) / (293.15 + 3.9) : 0.0;
    EXPECT_NEAR(theta.mean(), 3.9 + curvature_K, 5e-5) << exchange;
  }
}

}  // namespace
}  // namespace driftwright::solver::lumped_effects_test
