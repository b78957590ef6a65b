// The small system in time where laws look at temperatures and thermostats switch, against the full system in a complete
// basis.

#include "solver/reduced_transient.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/integrate.hpp"
#include "solver/propagator.hpp"
#include "solver/reduced_model.hpp"
#include "solver/reduced_ode.hpp"
#include "solver/steady_state.hpp"
#include "tests/shared/effect_list.hpp"
#include "tests/shared/heat_runs.hpp"
#include "tests/shared/two_blocks.hpp"

namespace driftwright::solver::reduced_transient_test {
namespace {

const Cyclogram kCycle{.name = "cycle", .sections = {{1800, 2000}, {600, 0}, {1200, 500}, {1800, 3000}}};
const TimeSeries kRampingAmbient{{0, 2000, 4000, 5400}, {0.0, 1.5, 1.5, -2.0}};

std::vector<double> every(double interval_s) {
  std::vector<double> times_s;
  for (int i = 0; i * interval_s <= kCycle.duration_s(); ++i) times_s.push_back(i * interval_s);
  return times_s;
}

TransientOptions tolerance(double relative) {
  return {.relative_tolerance = relative, .absolute_tolerance_K = relative};
}

/// Two blocks of 100 unknowns under these effects; outputs: a corner of each, then lumped nodes.
FullSystem blocks(const std::vector<std::string>& effects) {
  const mesh::Mesh mesh =
      fixtures::two_boxes({{0, 0, 0}, {0.05, 0.1, 0.1}, {1, 1, 1}, mesh::CellShape::kTet10},
                          {{0.05, 0, 0}, {0.3, 0.1, 0.1}, {3, 1, 1}, mesh::CellShape::kTet10}, "a.x1", "b.x0");
  const effects::HeatBalance balance = fixtures::balance_of(effects);
  FullSystem system = assemble_heat(mesh, {fixtures::steel(), fixtures::steel()}, balance);
  std::vector<int> seen = {fixtures::node_at(mesh, {0, 0, 0}), fixtures::node_at(mesh, {0.35, 0.1, 0.1})};
  for (int n = mesh.n_nodes(); n < system.size(); ++n) seen.push_back(n);
  fixtures::observe_unknowns(system, seen);
  return system;
}

constexpr const char* kHeat = "{type: heat_source, region: a, power: 300 W, at_speed: 3000 rpm, exponent: 1}";
constexpr const char* kFilm = "{type: convection, surface: b.x1, film: 30 W/(m^2 K)}";
constexpr const char* kJoint = "{type: contact, joint: a/b, conductance: 1500 W/(m^2 K)}";
constexpr const char* kOil =
    "{type: bearing_friction, region: a, f0: 4, viscosity_40: 25 mm^2/s, viscosity_100: 5 mm^2/s, mean_diameter: 90 mm, f1: "
    "0.0006, load: 300 N}";
constexpr const char* kUpwards = "{type: natural_convection, surface: a.y1, orientation: vertical, length: 100 mm}";
constexpr const char* kDraught = "{type: convection, surface: a.y0, film: 60 W/(m^2 K), from: 20 min, until: 50 min}";
constexpr const char* kChiller =
    "{type: coolant, region: a, tank: cooler, flow: 4 L/min, passage_conductance: 60 W/K, volume: 2 L, tank_exchange: 3 "
    "W/K, "
    "pump_power: 40 W, cooling_power: 900 W, set_point: 25 degC, hysteresis: 2 K, runs: always}";
constexpr const char* kLayers = "{type: stratification, gradient: 2 K/m, level: 0 m}";

struct Case {
  const char* name;
  std::vector<std::string> effects;
  bool is_live;  ///< some law depends on temperatures, or a thermostat switches
};

class InACompleteBasis : public ::testing::TestWithParam<Case> {};

TEST_P(InACompleteBasis, TheSmallSystemIsTheFullOne) {
  const FullSystem system = blocks(GetParam().effects);
  const Eigen::MatrixXd basis = orthonormalise(system.mass, Eigen::MatrixXd::Identity(system.size(), system.size()));
  ASSERT_EQ(basis.cols(), system.size());
  const ReducedSystem reduced = project(system, basis);
  EXPECT_EQ(!reduced.is_linear(), GetParam().is_live);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  const Trajectory full = simulate(system, kCycle, kRampingAmbient, every(60), tolerance(1e-7), zero);
  std::vector<double> called_s;
  double worst_K = 0.0;
  const auto look = [&](double time_s, const Eigen::VectorXd& state) {
    ASSERT_EQ(state.size(), reduced.size());
    called_s.push_back(time_s);
    const auto k = static_cast<Eigen::Index>(called_s.size()) - 1;
    worst_K = std::max(worst_K, (reduced.outputs.state.transpose() * state - full.outputs.col(k)).cwiseAbs().maxCoeff());
  };
  const Trajectory small = simulate(reduced, kCycle, kRampingAmbient, every(60), tolerance(1e-7), zero, look);
  EXPECT_EQ(called_s, every(60));
  // 1e-7 of some 40 K a step, both ways, over a thousand steps.
  EXPECT_GT(full.outputs.maxCoeff(), 10.0);
  const double difference_K = (small.outputs - full.outputs).cwiseAbs().maxCoeff();
  RecordProperty("difference_K", fixtures::text(difference_K));
  EXPECT_LT(difference_K, 4e-5);
  EXPECT_LT(worst_K, 4e-5) << "states that callbacks are given";
  ASSERT_EQ(small.flows.size(), full.flows.size());
  const double most_J = full.heat_J.cwiseAbs().maxCoeff();
  for (std::size_t j = 0; j < full.flows.size(); ++j) {
    const auto row = static_cast<Eigen::Index>(j);
    EXPECT_EQ(small.flows[j].name, full.flows[j].name);
    EXPECT_EQ(small.flows[j].kind, full.flows[j].kind);
    EXPECT_LT((small.heat_J.row(row) - full.heat_J.row(row)).cwiseAbs().maxCoeff(), 1e-5 * most_J) << full.flows[j].name;
  }
  EXPECT_LT((small.stored_J - full.stored_J).cwiseAbs().maxCoeff(), 1e-5 * most_J);
  RecordProperty("energy_gap", fixtures::text(small.energy_gap()));
  EXPECT_LT(small.energy_gap(), 1e-11);  // rounding: Newton's last step is taken in all flows alike
}

INSTANTIATE_TEST_SUITE_P(
    Laws, InACompleteBasis,
    ::testing::Values(Case{"FrictionFallsAsOilWarms", {kOil, kFilm, kJoint}, true},
                      Case{"NaturalConvectionFromZeroDifference", {kHeat, kFilm, kJoint, kUpwards}, true},
                      Case{"DraughtByTheClock", {kHeat, kFilm, kJoint, kDraught}, false},
                      Case{"DraughtBesideFriction", {kOil, kFilm, kJoint, kDraught}, true},
                      Case{"StratifiedAmbient", {kHeat, kFilm, kJoint, kUpwards, kLayers}, true},
                      Case{"Chiller", {kHeat, kFilm, kJoint, kChiller}, true},
                      Case{"AllAtOnce", {kOil, kHeat, kFilm, kJoint, kUpwards, kDraught, kChiller, kLayers}, true}),
    [](const auto& one) { return std::string(one.param.name); });

/// Times at which an output turns from falling to rising, to the interval of the outputs.
std::vector<double> troughs_s(const Trajectory& run, Eigen::Index output) {
  std::vector<double> found_s;
  for (Eigen::Index k = 1; k + 1 < run.outputs.cols(); ++k) {
    const double before = run.outputs(output, k - 1), now = run.outputs(output, k), after = run.outputs(output, k + 1);
    if (now < before && now <= after) found_s.push_back(run.time_s[static_cast<std::size_t>(k)]);
  }
  return found_s;
}

TEST(ReducedTransient, SwitchesAsOftenAndWhenTheFullModelDoes) {
  const FullSystem system = blocks({kHeat, kFilm, kJoint, kChiller});
  const ReducedSystem reduced =
      project(system, orthonormalise(system.mass, Eigen::MatrixXd::Identity(system.size(), system.size())));
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  const Trajectory full = simulate(system, kCycle, kRampingAmbient, every(2), tolerance(1e-6), zero),
                   small = simulate(reduced, kCycle, kRampingAmbient, every(2), tolerance(1e-6), zero);
  EXPECT_GE(troughs_s(full, 2).size(), 5u);  // of the tank
  EXPECT_EQ(troughs_s(small, 2), troughs_s(full, 2));
}

TEST(ReducedTransient, ErrorsFollowTheTolerance) {
  const FullSystem system = blocks({kOil, kFilm, kJoint, kUpwards});
  const ReducedSystem reduced =
      project(system, orthonormalise(system.mass, Eigen::MatrixXd::Identity(system.size(), system.size())));
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  const Trajectory exact = simulate(reduced, kCycle, kRampingAmbient, every(60), tolerance(1e-9), zero);
  double last_K = 1.0;
  for (double relative : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    const Trajectory run = simulate(reduced, kCycle, kRampingAmbient, every(60), tolerance(relative), zero);
    const double error_K = (run.outputs - exact.outputs).cwiseAbs().maxCoeff();
    RecordProperty("at_" + fixtures::text(relative), fixtures::text(error_K));
    EXPECT_LT(error_K, 100.0 * relative);  // some ten steps' errors of a temperature of 40 K
    EXPECT_LT(error_K, 0.4 * last_K);      // a tenth with each, but for luck
    last_K = error_K;
  }
}

TEST(ReducedTransient, StepsOfALinearSystemFindItsExponentials) {
  const FullSystem system = blocks({kHeat, kFilm, kJoint, kDraught, kLayers});
  const Eigen::MatrixXd basis = orthonormalise(system.mass, Eigen::MatrixXd::Random(system.size(), 12));
  const ReducedSystem reduced = project(system, basis);
  const Eigen::VectorXd start = Eigen::VectorXd::Constant(reduced.size(), 20.0);
  const Trajectory exact = simulate(reduced, kCycle, kRampingAmbient, every(60), {}, start);
  std::vector<double> knots_s = kRampingAmbient.time_s;
  knots_s.insert(knots_s.end(), {1200.0, 3000.0});
  ReducedOde ode(reduced, kRampingAmbient);
  const Trajectory stepped =
      integrate(ode, linear_stretches(kCycle, knots_s), kRampingAmbient, every(60), tolerance(1e-8), start, {});
  EXPECT_EQ(exact.n_steps, 0);
  EXPECT_GT(stepped.n_steps, 100);
  EXPECT_LT((stepped.outputs - exact.outputs).cwiseAbs().maxCoeff(), 1e-5);
  const double most_J = exact.heat_J.cwiseAbs().maxCoeff();
  EXPECT_LT((stepped.heat_J - exact.heat_J).cwiseAbs().maxCoeff(), 1e-6 * most_J);
  EXPECT_LT((stepped.stored_J - exact.stored_J).cwiseAbs().maxCoeff(), 1e-6 * most_J);
}

TEST(ReducedTransient, HeatBalancesInABasisOfAFewVectorsAtAnyTolerance) {
  const FullSystem system = blocks({kOil, kHeat, kFilm, kJoint, kUpwards, kDraught, kChiller, kLayers});
  Eigen::MatrixXd columns(system.size(), 9);
  columns << system.ones, Eigen::MatrixXd::Random(system.size(), 8);
  const ReducedSystem reduced = project(system, orthonormalise(system.mass, columns));
  for (double relative : {1e-3, 1e-6}) {
    const Trajectory run =
        simulate(reduced, kCycle, kRampingAmbient, every(60), tolerance(relative), Eigen::VectorXd::Zero(reduced.size()));
    RecordProperty("gap_at_" + fixtures::text(relative), fixtures::text(run.energy_gap()));
    EXPECT_LT(run.energy_gap(), 1e-9) << relative;
  }
}

/// b.x1 is held, from the start on at the temperature it is held at.
void expect_held_alike(const std::string& held, double start_K) {
  const FullSystem system = blocks({kOil, kJoint, kUpwards, held});
  FullSystem free = system;
  hold_by_exchanges(free);
  ASSERT_TRUE(free.fixed.empty());
  const Eigen::MatrixXd basis = orthonormalise(free.mass, Eigen::MatrixXd::Identity(free.size(), free.size()));
  const ReducedSystem reduced = project(free, basis);
  const Eigen::VectorXd start = Eigen::VectorXd::Constant(system.size(), start_K);
  const Trajectory full = simulate(system, kCycle, kRampingAmbient, every(60), tolerance(1e-7), start);
  const Trajectory small =
      simulate(reduced, kCycle, kRampingAmbient, every(60), tolerance(1e-7), basis.transpose() * (free.mass * start));
  // The exchanges are a million times stiffer than conduction: what is held gives way by a millionth of 40 K.
  EXPECT_LT((small.outputs - full.outputs).cwiseAbs().maxCoeff(), 4e-4);
  const double most_J = full.heat_J.cwiseAbs().maxCoeff();
  const auto prescribed = fixtures::flow(full, full.flows.back().name);
  ASSERT_EQ(full.flows.back().kind, FlowKind::kPrescribed);
  ASSERT_EQ(small.flows.back().kind, FlowKind::kPrescribed);
  EXPECT_GT(std::abs(full.heat_J(prescribed, full.heat_J.cols() - 1)), 0.05 * most_J);
  EXPECT_LT((small.heat_J - full.heat_J).cwiseAbs().maxCoeff(), 1e-4 * most_J);
  ::testing::Test::RecordProperty("energy_gap", fixtures::text(small.energy_gap()));
  EXPECT_LT(small.energy_gap(), 1e-6);  // rounding of a flow that is a million times a small difference
}

TEST(ReducedTransient, HoldsATemperature) {
  expect_held_alike("{type: fixed_temperature, surface: b.x1, temperature: 30 degC}", 10.0);
}
TEST(ReducedTransient, FollowsTheAmbient) {
  expect_held_alike("{type: fixed_temperature, surface: b.x1, follows: ambient}", 0.0);
}

TEST(ReducedTransient, RunsOfOneSystemDoNotDisturbEachOther) {
  const FullSystem system = blocks({kOil, kFilm, kJoint, kChiller});
  const ReducedSystem reduced = project(system, orthonormalise(system.mass, Eigen::MatrixXd::Identity(system.size(), 30)));
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(reduced.size());
  const Trajectory first = simulate(reduced, kCycle, kRampingAmbient, every(60), {}, zero);
  (void)simulate(reduced, {.name = "", .sections = {{3600, 3000}}}, kRampingAmbient, {3600}, {}, zero);
  const Trajectory again = simulate(reduced, kCycle, kRampingAmbient, every(60), {}, zero);
  EXPECT_EQ(first.outputs, again.outputs);
  EXPECT_EQ(first.heat_J, again.heat_J);
}

TEST(ReducedTransient, StopsAtTemperaturesThatNoMachineHas) {
  const FullSystem system =
      blocks({"{type: heat_source, region: a, power: 1 MW, at_speed: 3000 rpm, exponent: 1}", kFilm, kJoint, kUpwards});
  const ReducedSystem reduced =
      project(system, orthonormalise(system.mass, Eigen::MatrixXd::Identity(system.size(), system.size())));
  EXPECT_THROW((void)simulate(reduced, kCycle, kRampingAmbient, {5400}, {}, Eigen::VectorXd::Zero(reduced.size())),
               SolveError);
}

}  // namespace
}  // namespace driftwright::solver::reduced_transient_test
