#include "solver/reduced_model.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "solver/heat_assembly.hpp"
#include "solver/transient.hpp"
#include "tests/fixtures.hpp"

namespace driftwright::solver {
namespace {

using mesh::CellShape;

const Cyclogram kCycle{.name = "cycle", .sections = {{1800, 2000}, {600, 0}, {1200, 500}, {3600, 3000}}};
const TimeSeries kRampingHall{{0, 2000, 5000, 7200}, {0.0, 1.5, 1.5, -2.0}};

/// Two blocks; a is heated and has a film, both growing with speed.
FullSystem machine(int n) {
  const mesh::Mesh mesh =
      fixtures::two_boxes({{0, 0, 0}, {0.05, 0.1, 0.1}, {n, n, n}, CellShape::kTet10},
                          {{0.05, 0, 0}, {0.3, 0.1, 0.1}, {3 * n, n, n}, CellShape::kTet10}, "a.x1", "b.x0");
  effects::HeatBalance balance;
  balance.heats.push_back(
      {"bearing", effects::region("a"), [](const effects::Inputs& u) { return 0.1 * u.drive.speed_rpm; }});
  balance.films.push_back({"side", "a.y1", [](const effects::Inputs& u) { return 5.0 + 0.02 * u.drive.speed_rpm; }, "hall"});
  balance.films.push_back({"back", "b.x1", fixtures::constant(30.0), "hall"});
  balance.contacts.push_back({"contact", "a/b", fixtures::constant(1500.0)});
  FullSystem system = assemble_heat(mesh, {fixtures::steel(), fixtures::steel()}, balance);
  fixtures::observe_unknowns(system, {fixtures::node_at(mesh, {0, 0, 0}), fixtures::node_at(mesh, {0.35, 0.1, 0.1})});
  return system;
}

TEST(ThermalModes, OfASlabHaveTheTimeConstantsOfTheTranscendentalRoots) {
  // tau_i = rho c L^2 / (k z_i^2), z_i tan z_i = Bi; L = 0.4 m, k = 40, h = 150: Bi = 1.5. 40 quadratic cells along the
  // slab resolve mode i to (z_i / 40)^4 / 720: 1e-9 to 3e-6 for the first five.
  const double length_m = 0.4, htc = 150.0;
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {length_m, 0.01, 0.01}, .n = {40, 1, 1}});
  effects::HeatBalance balance;
  balance.films.push_back({"film", "x1", fixtures::constant(htc), "hall"});
  const FullSystem system = assemble_heat(mesh, {fixtures::steel()}, balance);
  const ThermalModes modes = thermal_modes(system, {}, 5);
  ASSERT_EQ(modes.time_constant_s.size(), 5u);
  for (int i = 0; i < 5; ++i) {
    const double z = fixtures::slab_root(htc * length_m / 40.0, i);
    const double tau_s = 8000.0 * 500.0 * length_m * length_m / (40.0 * z * z);
    EXPECT_NEAR(modes.time_constant_s[i] / tau_s, 1.0, 1e-5) << "mode " << i;
    RecordProperty("tau_" + std::to_string(i), std::to_string(modes.time_constant_s[i]) + " exact " + std::to_string(tau_s));
    // Shape cos(z x / L), of length one in M: amplitude from ∫ rho c A cos^2 dx = rho c A L (1/2 + sin 2z / 4z).
    const double amplitude = 1.0 / std::sqrt(4e6 * 1e-4 * length_m * (0.5 + std::sin(2 * z) / (4 * z)));
    const Eigen::VectorXd exact =
        fixtures::at_nodes(mesh, [&](const Eigen::Vector3d& x) { return amplitude * std::cos(z * x[0] / length_m); });
    const double sign = modes.shapes(fixtures::node_at(mesh, {0, 0, 0}), i) > 0 ? 1.0 : -1.0;
    EXPECT_LT((sign * modes.shapes.col(i) - exact).cwiseAbs().maxCoeff(), 1e-3 * amplitude) << "mode " << i;
  }
}

TEST(ThermalModes, AreOrthonormalInMass) {
  const FullSystem system = machine(1);
  const ThermalModes modes = thermal_modes(system, {.drive = {.speed_rpm = 1000.0}, .hall_K = 0.0}, 12);
  const Eigen::MatrixXd gram = modes.shapes.transpose() * (system.mass * modes.shapes);
  EXPECT_LT((gram - Eigen::MatrixXd::Identity(12, 12)).cwiseAbs().maxCoeff(),
            1e-9);  // the eigensolver's 1e-10
  EXPECT_TRUE(std::is_sorted(modes.time_constant_s.rbegin(), modes.time_constant_s.rend()));
}

TEST(ThermalModes, WithoutAWayOutForHeatAreRefused) {
  for (int n = 1; n <= 6; ++n) {
    const mesh::Mesh mesh = fixtures::box_mesh({.n = {n, 2, 2}});
    const FullSystem system = assemble_heat(mesh, {fixtures::steel()}, {});
    EXPECT_THROW((void)thermal_modes(system, {}, 3), SolveError);
    EXPECT_THROW((void)steady_responses(system, {}), SolveError);
  }
}

TEST(ThermalModes, WithOneInsulatedPartAreRefused) {
  const mesh::Mesh mesh = fixtures::two_boxes({}, {.low = {1, 0, 0}}, "a.x1", "b.x0");
  effects::HeatBalance balance;
  balance.films.push_back({"film", "a.x0", fixtures::constant(10.0), "hall"});
  balance.contacts.push_back({"contact", "a/b", fixtures::constant(0.0)});
  const RegionMaterials materials = {fixtures::steel(), fixtures::steel()};
  EXPECT_THROW((void)steady_responses(assemble_heat(mesh, materials, balance), {}), SolveError);
  balance.contacts[0].conductance_W_m2K = fixtures::constant(1.0);
  EXPECT_NO_THROW((void)steady_responses(assemble_heat(mesh, materials, balance), {}));
}

TEST(ThermalModes, MoreThanThereAreUnknownsAreRefused) {
  const FullSystem system = machine(1);
  EXPECT_THROW((void)thermal_modes(system, {}, system.size()), InputError);
  EXPECT_THROW((void)thermal_modes(system, {}, 0), InputError);
}

TEST(SteadyResponses, AreTheSteadyTemperaturesPerWattAndPerKelvin) {
  const FullSystem system = machine(1);
  const effects::Inputs at{.drive = {.speed_rpm = 2000.0}, .hall_K = 3.0};
  const Eigen::MatrixXd r = steady_responses(system, at);
  ASSERT_EQ(r.cols(), 2);
  EXPECT_LT((r.col(1).array() - 1.0).abs().maxCoeff(), 1e-9);  // a warmer hall warms all alike
  EXPECT_LT((200.0 * r.col(0) + 3.0 * r.col(1) - fixtures::steady(system, at)).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(Orthonormalise, DropsColumnsThatAddNothing) {
  const FullSystem system = machine(1);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Random(system.size(), 4);
  columns.col(2) = 3.0 * columns.col(0) - columns.col(1);
  columns.col(3).setZero();
  const Eigen::MatrixXd basis = orthonormalise(system.mass, columns);
  ASSERT_EQ(basis.cols(), 2);
  EXPECT_LT((basis.transpose() * (system.mass * basis) - Eigen::Matrix2d::Identity()).norm(), 1e-12);
}

/// Largest difference of two runs over all outputs and times [K].
double difference_K(const Trajectory& a, const Trajectory& b) {
  return (a.outputs - b.outputs).cwiseAbs().maxCoeff();
}

std::vector<double> every(double interval_s) {
  std::vector<double> times_s;
  for (int i = 0; i * interval_s <= kCycle.duration_s(); ++i) times_s.push_back(i * interval_s);
  return times_s;
}

TEST(Evolve, InACompleteBasisIsTheFullModel) {
  const FullSystem system = machine(1);
  const Eigen::MatrixXd basis = orthonormalise(system.mass, Eigen::MatrixXd::Identity(system.size(), system.size()));
  ASSERT_EQ(basis.cols(), system.size());
  const ReducedSystem reduced = project(system, basis);
  // Both start from 5 K everywhere.
  const Eigen::VectorXd start = Eigen::VectorXd::Constant(system.size(), 5.0);
  const Trajectory exact = evolve(reduced, kCycle, kRampingHall, every(300), 5.0 * reduced.ones);
  const Trajectory full =
      simulate(system, kCycle, kRampingHall, every(300), {.relative_tolerance = 1e-8, .absolute_tolerance_K = 1e-8}, start);
  EXPECT_GT(full.outputs.maxCoeff(), 30.0);
  RecordProperty("difference_K", std::to_string(1e9 * difference_K(exact, full)) + "e-9");
  EXPECT_LT(difference_K(exact, full), 1e-5);  // 1e-8 of 60 K a step, over some hundred steps
}

TEST(Evolve, ModesWithSteadyResponsesBeatModesAlone) {
  // Six modes without and with the steady responses at both ends of the range of speed.
  const FullSystem system = machine(2);
  const effects::Inputs slow{.drive = {.speed_rpm = 0.0}, .hall_K = 0.0},
      fast{.drive = {.speed_rpm = 3000.0}, .hall_K = 0.0};
  const Eigen::MatrixXd modes = thermal_modes(system, fast, 6).shapes;
  const Eigen::MatrixXd at_rest = steady_responses(system, slow), at_speed = steady_responses(system, fast);
  Eigen::MatrixXd more(system.size(), modes.cols() + at_rest.cols() + at_speed.cols());
  more << modes, at_rest, at_speed;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  const Trajectory full =
      simulate(system, kCycle, kRampingHall, every(300), {.relative_tolerance = 1e-6, .absolute_tolerance_K = 1e-6}, zero);
  const auto error_K = [&](const Eigen::MatrixXd& columns) {
    const ReducedSystem reduced = project(system, orthonormalise(system.mass, columns));
    return difference_K(evolve(reduced, kCycle, kRampingHall, every(300), Eigen::VectorXd::Zero(reduced.size())), full);
  };
  const double alone_K = error_K(modes), together_K = error_K(more);
  RecordProperty("alone_K", std::to_string(alone_K));
  RecordProperty("together_K", std::to_string(together_K));
  EXPECT_LT(together_K, 0.5 * alone_K);

  // In the steady state the responses leave nothing at all: 1e7 s are many time constants.
  const Cyclogram for_ever{.name = "for ever", .sections = {{1e7, 3000}}};
  const ReducedSystem reduced = project(system, orthonormalise(system.mass, more));
  const Trajectory end = evolve(reduced, for_ever, {{0}, {2.0}}, {1e7}, Eigen::VectorXd::Zero(reduced.size()));
  const Eigen::VectorXd exact =
      system.outputs.state.transpose() * fixtures::steady(system, {.drive = {.speed_rpm = 3000}, .hall_K = 2});
  EXPECT_LT((end.outputs.col(0) - exact).cwiseAbs().maxCoeff(), 1e-8 * exact.maxCoeff());
}

/// C θ' = P(speed) - H (θ - θ_hall), as a system of one unknown.
ReducedSystem one_body(double capacity_J_K, double loss_W_K) {
  ReducedSystem s;
  s.mass = Eigen::MatrixXd::Constant(1, 1, capacity_J_K);
  s.conduction = Eigen::MatrixXd::Zero(1, 1);
  const auto one = Eigen::VectorXd::Ones(1);
  s.sources.push_back({"heat", one, [](const effects::Inputs& u) { return 0.1 * u.drive.speed_rpm; }});
  s.exchanges.push_back({"film", Eigen::MatrixXd::Ones(1, 1), one, 1.0, fixtures::constant(loss_W_K)});
  s.outputs = {{"t"}, {"K"}, Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Zero(1)};
  s.ones = one;
  return s;
}

TEST(Evolve, FollowsARampOfTheHallExactly) {
  // tau = 4000 s; hall 2 K/h: θ = s (t - tau + tau e^(-t/tau)).
  const double slope_K_s = 2.0 / 3600;
  const std::vector<double> times_s = {1, 600, 3600, 7200};
  const Trajectory run = evolve(one_body(4000, 1), {.name = "rest", .sections = {{7200, 0}}}, {{0, 7200}, {0, 4.0}}, times_s,
                                Eigen::VectorXd::Zero(1));
  for (std::size_t k = 0; k < times_s.size(); ++k) {
    const double exact_K = slope_K_s * (times_s[k] + 4000.0 * std::expm1(-times_s[k] / 4000.0));
    EXPECT_NEAR(run.outputs(0, static_cast<Eigen::Index>(k)), exact_K,
                1e-12);  // rounding of numbers of some kelvin
  }
}

TEST(Evolve, HeatsInOnePieceOrInMany) {
  // P = 100 W for 2 h: θ = P/H (1 - e^(-t/tau)), whether the cyclogram and the hall cut it or not.
  const double exact_K = -100.0 * std::expm1(-7200.0 / 4000.0);
  const Cyclogram one{.name = "", .sections = {{7200, 1000}}};
  const Cyclogram many{.name = "", .sections = {{1000, 1000}, {200, 1000}, {0.5, 1000}, {5999.5, 1000}}};
  for (const Cyclogram& cycle : {one, many}) {
    const Trajectory run = evolve(one_body(4000, 1), cycle, {{0, 100, 7000}, {0, 0, 0}}, {7200}, Eigen::VectorXd::Zero(1));
    EXPECT_NEAR(run.outputs(0, 0), exact_K, 1e-11);
  }
}

TEST(Evolve, WithoutLossesItRisesInAStraightLine) {
  const Trajectory run = evolve(one_body(4000, 0), {.name = "", .sections = {{7200, 1000}}}, {{0}, {0}}, {1800, 7200},
                                Eigen::VectorXd::Constant(1, 2.0));
  EXPECT_NEAR(run.outputs(0, 0), 2.0 + 45.0, 1e-12);  // 100 W * 1800 s / 4000 J/K
  EXPECT_NEAR(run.outputs(0, 1), 2.0 + 180.0, 1e-12);
}

}  // namespace
}  // namespace driftwright::solver
