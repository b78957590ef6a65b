// Prescribed temperatures against closed forms of a slab, and the heat that holds them.

#include <gtest/gtest.h>

#include <cmath>

#include "solver/steady_state.hpp"
#include "solver/transient.hpp"
#include "tests/shared/effect_list.hpp"
#include "tests/shared/fixtures.hpp"

namespace driftwright::solver::prescribed_test {
namespace {

using fixtures::flow;

const TimeSeries kStillAmbient{{0.0}, {0.0}};

Cyclogram rest(double duration_s) {
  return {.name = "rest", .sections = {{duration_s, {}}}};
}

/// Slab of steel along x, 0.1 m thick and 0.01 m^2 wide: k A / L = 4 W/K, C = 4000 J/K, k / (rho c) = 1e-5 m^2/s.
mesh::Mesh slab() {
  return fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {6, 1, 1}});
}

TEST(FixedTemperature, SlabBetweenTwoTemperatures) {
  // 50 degC and 20 degC at its faces: linear between, 4 W/K * 30 K = 120 W through it.
  const mesh::Mesh mesh = slab();
  FullSystem system = assemble_heat(mesh, {fixtures::steel()},
                                    fixtures::balance_of({"{type: fixed_temperature, surface: x0, temperature: 50 degC}",
                                                          "{type: fixed_temperature, surface: x1, temperature: 20 degC}"}));
  const Eigen::VectorXd theta = steady_state(system, {}, Eigen::VectorXd::Zero(system.size()));
  const auto exact = fixtures::at_nodes(mesh, [](const Eigen::Vector3d& x) { return 30.0 * (1.0 - x[0] / 0.1); });
  EXPECT_LT((theta - exact).cwiseAbs().maxCoeff(), 1e-9);  // a linear field is exact; the solver's tolerance
  fixtures::observe_unknowns(system, {0});
  const Trajectory run =
      simulate(system, rest(20000), kStillAmbient, {10000, 20000}, {}, Eigen::VectorXd::Zero(system.size()));
  const Eigen::Index hot = flow(run, "fixed_temperature x0"), cold = flow(run, "fixed_temperature x1");
  // After 10 000 s exp(-pi^2 a t / L^2) = 5e-5 of the start is left in rates; 0.1 %.
  EXPECT_NEAR((run.heat_J(hot, 1) - run.heat_J(hot, 0)) / 10000.0, 120.0, 0.12);
  EXPECT_NEAR((run.heat_J(cold, 1) - run.heat_J(cold, 0)) / 10000.0, -120.0, 0.12);
  EXPECT_LT(run.energy_gap(), 1e-9);
}

TEST(FixedTemperature, RampIsFollowedWithTheLagOfTheClosedForm) {
  // Face at r t, the other insulated. Once the start has died away: T = r t - (r / a) (L x - x^2 / 2), and the face takes up
  // C r. r = 36 K/h = 0.01 K/s: the far face lags by 0.01 / 1e-5 * 0.005 = 5 K; 40 W.
  const mesh::Mesh mesh = slab();
  FullSystem system = assemble_heat(
      mesh, {fixtures::steel()},
      fixtures::balance_of({"{type: fixed_temperature, surface: x0, temperature: [[0 h, 20 degC], [4 h, 164 degC]]}"}));
  const int far = fixtures::node_at(mesh, {0.1, 0, 0}), middle = fixtures::node_at(mesh, {0.05, 0, 0}),
            face = fixtures::node_at(mesh, {0, 0, 0});
  fixtures::observe_unknowns(system, {face, middle, far});
  const TransientOptions fine{.relative_tolerance = 1e-7, .absolute_tolerance_K = 1e-7};
  const Trajectory run =
      simulate(system, rest(14400), kStillAmbient, {10800, 14400}, fine, Eigen::VectorXd::Zero(system.size()));
  // exp(-pi^2 a t / (4 L^2)) at 3 h = 2.7e-12: nothing is left of the start. A parabola is exact in quadratic cells.
  EXPECT_NEAR(run.outputs(0, 1), 144.0, 1e-9);         // rounding
  EXPECT_NEAR(run.outputs(1, 1), 144.0 - 3.75, 2e-4);  // tolerance 1e-7 of 144 K a step
  EXPECT_NEAR(run.outputs(2, 1), 144.0 - 5.0, 2e-4);
  const Eigen::Index held = flow(run, "fixed_temperature x0");
  EXPECT_NEAR((run.heat_J(held, 1) - run.heat_J(held, 0)) / 3600.0, 40.0, 1e-3);
  EXPECT_LT(run.energy_gap(), 1e-9);
  RecordProperty("gap", std::to_string(1e12 * run.energy_gap()) + "e-12");
}

TEST(FixedTemperature, OfANodeAndOfAFaceThatFollowTheAmbient) {
  const mesh::Mesh mesh = slab();
  FullSystem system =
      assemble_heat(mesh, {fixtures::steel()},
                    fixtures::balance_of({"{type: fixed_temperature, surface: x0, follows: ambient}",
                                          "{type: node, node: bath, capacity: 100 J/K}",
                                          "{type: fixed_temperature, node: bath, temperature: 60 degC}",
                                          "{type: convection, surface: x1, film: 400 W/(m^2 K), surrounding: bath}"}));
  // 4 W/K of the film and 4 W/K of the slab in a row: half of the difference falls off in each.
  const Eigen::VectorXd theta = steady_state(system, {.drive = {}, .ambient_K = 4.0}, Eigen::VectorXd::Zero(system.size()));
  EXPECT_NEAR(theta[fixtures::node_at(mesh, {0.1, 0, 0})], 22.0, 1e-9);
  EXPECT_NEAR(theta[mesh.n_nodes()], 40.0, 1e-12);
  fixtures::observe_unknowns(system, {fixtures::node_at(mesh, {0, 0, 0}), mesh.n_nodes()});
  const TimeSeries ambient{{0, 1000, 3000}, {0.0, 2.0, -1.0}};
  const Trajectory run = simulate(system, rest(4000), ambient, {500, 2000, 4000}, {}, Eigen::VectorXd::Zero(system.size()));
  for (Eigen::Index k = 0; k < 3; ++k) {
    EXPECT_NEAR(run.outputs(0, k), ambient.at(run.time_s[k]), 1e-9);
    EXPECT_NEAR(run.outputs(1, k), 40.0, 1e-9);
  }
  EXPECT_LT(run.energy_gap(), 1e-9);
}

TEST(FixedTemperature, OfTwoFacesThatMeetAtAnEdgeCountsTheEdgeOnce) {
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {2, 2, 2}});
  FullSystem system = assemble_heat(
      mesh, {fixtures::steel()},
      fixtures::balance_of({"{type: fixed_temperature, surface: x0, temperature: [[0 s, 20 degC], [2000 s, 50 degC]]}",
                            "{type: fixed_temperature, surface: y0, temperature: 30 degC}",
                            "{type: heat_source, region: body, power: 100 W}"}));
  fixtures::observe_unknowns(system, {fixtures::node_at(mesh, {0, 0, 0})});
  const Trajectory run = simulate(system, rest(3000), kStillAmbient, {1000, 3000}, {}, Eigen::VectorXd::Zero(system.size()));
  EXPECT_LT(run.energy_gap(), 1e-9);
  EXPECT_NEAR(run.outputs(0, 0), 15.0, 1e-9);  // the first of the two rules where they meet
}

TEST(FixedTemperature, SteadyStateTakesItAtTheTimeAskedFor) {
  const FullSystem system =
      fixtures::lumped_system({"{type: node, node: bath, capacity: 1 kJ/K}",
                               "{type: fixed_temperature, node: bath, temperature: [[0 s, 20 degC], [100 s, 40 degC]]}"});
  EXPECT_NEAR(steady_state(system, {.drive = {}, .time_s = 75.0}, Eigen::VectorXd::Zero(1))[0], 15.0, 1e-12);
}

TEST(FixedTemperature, TheJumpAtTheStartBringsItsHeatOnAnyMesh) {
  // 30 K for 4000 J/K: 120 kJ, of which one cell of 0.1 m takes up half in the jump of its nodes.
  for (int n : {1, 6}) {
    const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {n, 1, 1}});
    FullSystem system = assemble_heat(
        mesh, {fixtures::steel()}, fixtures::balance_of({"{type: fixed_temperature, surface: x0, temperature: 50 degC}"}));
    fixtures::observe_unknowns(system, {0});
    const Trajectory run =
        simulate(system, rest(40000), kStillAmbient, {0, 40000}, {}, Eigen::VectorXd::Zero(system.size()));
    EXPECT_EQ(run.stored_J[0], 0.0);
    EXPECT_NEAR(run.stored_J[1], 120e3, 1.0);  // exp(-pi^2 a t / (4 L^2)) = 5e-5 of a part of it
    EXPECT_NEAR(run.heat_J(flow(run, "fixed_temperature x0"), 1), run.stored_J[1], 1e-4);
    EXPECT_LT(run.energy_gap(), 1e-9);
  }
}

TEST(FixedTemperature, RampOfABodyWhoseHeatCapacityIsNotThatOfTheReference) {
  // As above with 1000 J/(kg K) from 0.1 K on, twice that at the reference temperature: a = 5e-6 m^2/s, the far face lags by
  // 0.01 / 5e-6 * 0.005 = 10 K and the held one takes up 80 W.
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {2, 1, 1}});
  Material steel = fixtures::steel();
  steel.heat_capacity_curve = {{293.15, 293.25}, {500.0, 1000.0}};
  FullSystem system = assemble_heat(
      mesh, {steel},
      fixtures::balance_of({"{type: fixed_temperature, surface: x0, temperature: [[0 h, 20 degC], [8 h, 308 degC]]}"}));
  fixtures::observe_unknowns(system, {fixtures::node_at(mesh, {0.1, 0, 0})});
  const TransientOptions fine{.relative_tolerance = 1e-6, .absolute_tolerance_K = 1e-5};
  const Trajectory run =
      simulate(system, rest(28800), kStillAmbient, {25200, 28800}, fine, Eigen::VectorXd::Zero(system.size()));
  EXPECT_NEAR(run.outputs(0, 1), 288.0 - 10.0, 2e-3);  // exp(-pi^2 a t / (4 L^2)) of the start is left: 4e-16; tolerance
  const Eigen::Index held = flow(run, "fixed_temperature x0");
  EXPECT_NEAR((run.heat_J(held, 1) - run.heat_J(held, 0)) / 3600.0, 80.0, 1e-2);
  EXPECT_NEAR(run.heat_J(held, 1), 8.0 * (1000.0 * (288.0 - 20.0 / 3.0) - 25.0), 5.0);  // mean lag 20/3 K; 1e-6 of it
  EXPECT_LT(run.energy_gap(), 1e-6);
}

}  // namespace
}  // namespace driftwright::solver::prescribed_test
