#include "solver/propagator.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "solver/reduced_model.hpp"
#include "solver/thermal_modes.hpp"
#include "solver/transient.hpp"
#include "tests/shared/two_blocks.hpp"

namespace driftwright::solver::propagator_test {
namespace {

const Cyclogram kCycle{.name = "cycle", .sections = {{1800, 2000}, {600, 0}, {1200, 500}, {3600, 3000}}};
const TimeSeries kRampingAmbient{{0, 2000, 5000, 7200}, {0.0, 1.5, 1.5, -2.0}};

TEST(Orthonormalise, DropsColumnsThatAddNothing) {
  const FullSystem system = fixtures::two_blocks(1);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Random(system.size(), 4);
  columns.col(2) = 3.0 * columns.col(0) - columns.col(1);
  columns.col(3).setZero();
  const Eigen::MatrixXd basis = orthonormalise(system.mass, columns);
  ASSERT_EQ(basis.cols(), 2);
  EXPECT_LT((basis.transpose() * (system.mass * basis) - Eigen::Matrix2d::Identity()).norm(), 1e-12);
}

Trajectory evolved(const ReducedSystem& system, const Cyclogram& cyclogram, const TimeSeries& ambient,
                   const std::vector<double>& output_s, const Eigen::VectorXd& start) {
  return Propagator(system).run(cyclogram, ambient, output_s, start, true);
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

TEST(Propagator, InACompleteBasisIsTheFullModel) {
  const FullSystem system = fixtures::two_blocks(1);
  const Eigen::MatrixXd basis = orthonormalise(system.mass, Eigen::MatrixXd::Identity(system.size(), system.size()));
  ASSERT_EQ(basis.cols(), system.size());
  const ReducedSystem reduced = project(system, basis);
  // Both start from 5 K everywhere.
  const Eigen::VectorXd start = Eigen::VectorXd::Constant(system.size(), 5.0);
  const Trajectory exact = evolved(reduced, kCycle, kRampingAmbient, every(300), 5.0 * reduced.ones);
  const Trajectory full = simulate(system, kCycle, kRampingAmbient, every(300),
                                   {.relative_tolerance = 1e-8, .absolute_tolerance_K = 1e-8}, start);
  EXPECT_GT(full.outputs.maxCoeff(), 30.0);
  RecordProperty("difference_K", std::to_string(1e9 * difference_K(exact, full)) + "e-9");
  EXPECT_LT(difference_K(exact, full), 1e-5);  // 1e-8 of 60 K a step, over some hundred steps
}

TEST(Propagator, ARunThatGoesOnEndsAsTheWhole) {
  // In the middle of a section, on its end, and beside a knot of the ambient; heat counts from where the run goes on.
  const FullSystem system = fixtures::two_blocks(1);
  const ReducedSystem reduced =
      project(system, orthonormalise(system.mass, Eigen::MatrixXd::Identity(system.size(), system.size())));
  const Eigen::VectorXd start = 5.0 * reduced.ones;
  const double end_s = kCycle.duration_s();
  for (const double from_s : {700.0, 1800.0, 2000.0, 7100.0}) {
    Eigen::MatrixXd states;
    const Trajectory whole = Propagator(reduced).run(kCycle, kRampingAmbient, {from_s, end_s}, start, true, &states);
    const Trajectory rest =
        Propagator(reduced).run(kCycle, kRampingAmbient, {from_s, end_s}, states.col(0), true, nullptr, from_s);
    EXPECT_LT(difference_K(whole, rest), 1e-10) << from_s;
    EXPECT_LT((whole.heat_J.col(1) - whole.heat_J.col(0) - rest.heat_J.col(1)).cwiseAbs().maxCoeff(),
              1e-9 * whole.heat_J.cwiseAbs().maxCoeff())
        << from_s;
    EXPECT_EQ(rest.heat_J.col(0).cwiseAbs().maxCoeff(), 0.0);
  }
}

TEST(Transient, ARunThatGoesOnEndsAsTheWhole) {
  const FullSystem system = fixtures::two_blocks(1);
  TransientOptions options{.relative_tolerance = 1e-8, .absolute_tolerance_K = 1e-8};
  const double from_s = 700.0, end_s = kCycle.duration_s();
  Eigen::VectorXd at_from;
  const auto keep = [&](double time_s, const Eigen::VectorXd& state) {
    if (time_s == from_s) at_from = state;
  };
  const Trajectory whole = simulate(system, kCycle, kRampingAmbient, {from_s, end_s}, options,
                                    Eigen::VectorXd::Constant(system.size(), 5.0), keep);
  options.from_s = from_s;
  const Trajectory rest = simulate(system, kCycle, kRampingAmbient, {from_s, end_s}, options, at_from);
  EXPECT_LT(difference_K(whole, rest), 1e-5);  // 1e-8 of 60 K a step, over some hundred steps
  EXPECT_LT(std::abs(whole.stored_J[1] - whole.stored_J[0] - rest.stored_J[1]), 1e-6 * std::abs(whole.stored_J[1]));
}

TEST(Propagator, ModesWithSteadyResponsesBeatModesAlone) {
  // Six modes without and with the steady responses at both ends of the range of speed.
  const FullSystem system = fixtures::two_blocks(2);
  const effects::Inputs slow{.drive = {.speed_rpm = 0.0}, .ambient_K = 0.0},
      fast{.drive = {.speed_rpm = 3000.0}, .ambient_K = 0.0};
  const Eigen::MatrixXd modes = thermal_modes(system, fast, 6).shapes;
  const Eigen::MatrixXd at_rest = steady_responses(system, slow), at_speed = steady_responses(system, fast);
  Eigen::MatrixXd more(system.size(), modes.cols() + at_rest.cols() + at_speed.cols());
  more << modes, at_rest, at_speed;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  const Trajectory full = simulate(system, kCycle, kRampingAmbient, every(300),
                                   {.relative_tolerance = 1e-6, .absolute_tolerance_K = 1e-6}, zero);
  const auto error_K = [&](const Eigen::MatrixXd& columns) {
    const ReducedSystem reduced = project(system, orthonormalise(system.mass, columns));
    return difference_K(evolved(reduced, kCycle, kRampingAmbient, every(300), Eigen::VectorXd::Zero(reduced.size())), full);
  };
  const double alone_K = error_K(modes), together_K = error_K(more);
  RecordProperty("alone_K", std::to_string(alone_K));
  RecordProperty("together_K", std::to_string(together_K));
  EXPECT_LT(together_K, 0.5 * alone_K);

  // In the steady state the responses leave nothing at all: 1e7 s are many time constants.
  const Cyclogram for_ever{.name = "for ever", .sections = {{1e7, 3000}}};
  const ReducedSystem reduced = project(system, orthonormalise(system.mass, more));
  const Trajectory end = evolved(reduced, for_ever, {{0}, {2.0}}, {1e7}, Eigen::VectorXd::Zero(reduced.size()));
  const Eigen::VectorXd exact =
      system.outputs.state.transpose() * fixtures::steady(system, {.drive = {.speed_rpm = 3000}, .ambient_K = 2});
  EXPECT_LT((end.outputs.col(0) - exact).cwiseAbs().maxCoeff(), 1e-8 * exact.maxCoeff());
}

/// C θ' = P(speed) - H (θ - θ_ambient), as a system of the one unknown z = √C θ.
ReducedSystem one_body(double capacity_J_K, double loss_W_K) {
  const double root = std::sqrt(capacity_J_K);
  ReducedSystem s;
  s.mass = Eigen::MatrixXd::Ones(1, 1);
  s.conduction = Eigen::MatrixXd::Zero(1, 1);
  const Eigen::VectorXd scaled = Eigen::VectorXd::Constant(1, 1.0 / root);
  s.sources.push_back({"heat", {}, scaled, [](const effects::Inputs& u) { return 0.1 * u.drive.speed_rpm; }});
  s.exchanges.push_back({.name = "film",
                         .matrix = scaled * scaled.transpose(),
                         .to_ambient = scaled,
                         .ambient_sum = 1.0,
                         .coefficient = fixtures::constant(loss_W_K),
                         .flow = scaled});
  s.outputs = {{"t"}, {"K"}, scaled, Eigen::VectorXd::Zero(1)};
  s.ones = Eigen::VectorXd::Constant(1, root);
  return s;
}

TEST(Propagator, FollowsARampOfTheAmbientExactly) {
  // tau = 4000 s; ambient 2 K/h: θ = s (t - tau + tau e^(-t/tau)).
  const double slope_K_s = 2.0 / 3600;
  const std::vector<double> times_s = {1, 600, 3600, 7200};
  const Trajectory run = evolved(one_body(4000, 1), {.name = "rest", .sections = {{7200, 0}}}, {{0, 7200}, {0, 4.0}},
                                 times_s, Eigen::VectorXd::Zero(1));
  for (std::size_t k = 0; k < times_s.size(); ++k) {
    const double exact_K = slope_K_s * (times_s[k] + 4000.0 * std::expm1(-times_s[k] / 4000.0));
    EXPECT_NEAR(run.outputs(0, static_cast<Eigen::Index>(k)), exact_K,
                1e-12);  // rounding of numbers of some kelvin
  }
}

TEST(Propagator, HeatsInOnePieceOrInMany) {
  // P = 100 W for 2 h: θ = P/H (1 - e^(-t/tau)), whether the cyclogram and the ambient cut it or not.
  const double exact_K = -100.0 * std::expm1(-7200.0 / 4000.0);
  const Cyclogram one{.name = "", .sections = {{7200, 1000}}};
  const Cyclogram many{.name = "", .sections = {{1000, 1000}, {200, 1000}, {0.5, 1000}, {5999.5, 1000}}};
  for (const Cyclogram& cycle : {one, many}) {
    const Trajectory run = evolved(one_body(4000, 1), cycle, {{0, 100, 7000}, {0, 0, 0}}, {7200}, Eigen::VectorXd::Zero(1));
    EXPECT_NEAR(run.outputs(0, 0), exact_K, 1e-11);
  }
}

TEST(Propagator, WithoutLossesItRisesInAStraightLine) {
  const Trajectory run = evolved(one_body(4000, 0), {.name = "", .sections = {{7200, 1000}}}, {{0}, {0}}, {1800, 7200},
                                 Eigen::VectorXd::Constant(1, 2.0 * std::sqrt(4000.0)));
  EXPECT_NEAR(run.outputs(0, 0), 2.0 + 45.0, 1e-12);  // 100 W * 1800 s / 4000 J/K
  EXPECT_NEAR(run.outputs(0, 1), 2.0 + 180.0, 1e-12);
}

TEST(Propagator, ManyOutputsAreThoseAskedOneByOne) {
  // Each minute, while the ambient has knots between minutes; outputs, states, heats. One has no losses: a mode with λ = 0.
  const FullSystem full = fixtures::two_blocks(1);
  const ReducedSystem reduced =
      project(full, orthonormalise(full.mass, Eigen::MatrixXd::Identity(full.size(), full.size())));
  const TimeSeries ambient{{0, 2010, 5000, 7200}, {0.0, 1.5, 1.5, -2.0}};
  for (const ReducedSystem& system : {reduced, one_body(4000, 0)}) {
    const Eigen::VectorXd start = 5.0 * system.ones;
    Eigen::MatrixXd states, state;
    const Trajectory many = Propagator(system).run(kCycle, ambient, every(60), start, true, &states);
    ASSERT_EQ(many.outputs.cols(), 121);
    EXPECT_GT(many.outputs.maxCoeff(), 30.0);
    for (Eigen::Index k = 0; k < 121; k += 7) {
      const Trajectory one = Propagator(system).run(kCycle, ambient, {60.0 * static_cast<double>(k)}, start, true, &state);
      EXPECT_LT((one.outputs - many.outputs.col(k)).cwiseAbs().maxCoeff(), 1e-10) << k;
      EXPECT_LT((state - states.col(k)).cwiseAbs().maxCoeff(), 1e-10 * states.cwiseAbs().maxCoeff()) << k;
      EXPECT_LT((one.heat_J - many.heat_J.col(k)).cwiseAbs().maxCoeff(), 1e-10 * many.heat_J.cwiseAbs().maxCoeff()) << k;
      EXPECT_NEAR(one.stored_J[0], many.stored_J[k], 1e-10 * many.heat_J.cwiseAbs().maxCoeff()) << k;
    }
  }
}

TEST(Propagator, AMachineAtRestBeginsAtExactlyZero) {
  const FullSystem full = fixtures::two_blocks(1);
  const ReducedSystem reduced =
      project(full, orthonormalise(full.mass, Eigen::MatrixXd::Identity(full.size(), full.size())));
  Eigen::MatrixXd states;
  const TimeSeries ambient{{0, 7200}, {0.0, 2.0}};
  const Trajectory run =
      Propagator(reduced).run(kCycle, ambient, every(60), Eigen::VectorXd::Zero(reduced.size()), true, &states);
  EXPECT_TRUE(run.outputs.col(0).isZero(0.0));
  EXPECT_TRUE(states.col(0).isZero(0.0));
  EXPECT_TRUE(run.heat_J.col(0).isZero(0.0));
  EXPECT_EQ(run.stored_J[0], 0.0);
  EXPECT_FALSE(run.outputs.col(1).isZero(1e-6));
}

TEST(Propagator, HeatsAddUpToWhatIsStored) {
  // With the uniform temperature in the basis, 1'(M z' + K z - f) = 0 holds in the small system, too.
  const FullSystem system = fixtures::two_blocks(1);
  Eigen::MatrixXd columns(system.size(), 6);
  columns << system.ones, Eigen::MatrixXd::Random(system.size(), 5);
  const ReducedSystem reduced = project(system, orthonormalise(system.mass, columns));
  const Trajectory run = evolved(reduced, kCycle, kRampingAmbient, every(300), 5.0 * reduced.ones);
  EXPECT_LT(run.energy_gap(), 1e-12);
  EXPECT_EQ(run.heat_J.rows(), 4);  // bearing, two films, the joint
  EXPECT_NEAR(run.heat_J(0, run.heat_J.cols() - 1), 0.1 * (1800 * 2000 + 1200 * 500 + 3600 * 3000.0), 1e-6);
}

TEST(Propagator, FlowsAreThoseOfTheFullModel) {
  const FullSystem system = fixtures::two_blocks(1);
  const Eigen::MatrixXd basis = orthonormalise(system.mass, Eigen::MatrixXd::Identity(system.size(), system.size()));
  const ReducedSystem reduced = project(system, basis);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  const Trajectory exact = evolved(reduced, kCycle, kRampingAmbient, every(300), zero);
  const Trajectory full = simulate(system, kCycle, kRampingAmbient, every(300),
                                   {.relative_tolerance = 1e-7, .absolute_tolerance_K = 1e-7}, zero);
  ASSERT_EQ(exact.flows.size(), full.flows.size());
  for (std::size_t j = 0; j < full.flows.size(); ++j) {
    EXPECT_EQ(exact.flows[j].name, full.flows[j].name);
    EXPECT_EQ(exact.flows[j].kind, full.flows[j].kind);
  }
  EXPECT_LT((exact.heat_J - full.heat_J).cwiseAbs().maxCoeff(), 1e-6 * full.heat_J.cwiseAbs().maxCoeff());
  EXPECT_LT((exact.stored_J - full.stored_J).cwiseAbs().maxCoeff(), 1e-6 * full.heat_J.cwiseAbs().maxCoeff());
}

TEST(Propagator, HeatsWithoutLossesAreThePowerTimesTime) {
  const Trajectory run = evolved(one_body(4000, 0), {.name = "", .sections = {{7200, 1000}}}, {{0}, {0}}, {1800, 7200},
                                 Eigen::VectorXd::Zero(1));
  EXPECT_NEAR(run.stored_J[1], 720e3, 1e-6);
  EXPECT_NEAR(run.heat_J(1, 1), 0.0, 1e-9);
}

TEST(Propagator, DecomposesOncePerSetOfCoefficients) {
  const FullSystem system = fixtures::two_blocks(1);
  const ReducedSystem reduced = project(system, orthonormalise(system.mass, steady_responses(system, {})));
  Propagator propagator(reduced);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(reduced.size());
  const Trajectory first = propagator.run(kCycle, kRampingAmbient, every(300), zero);
  EXPECT_EQ(propagator.n_decompositions(), 4);  // four speeds
  const Trajectory again = propagator.run(kCycle, kRampingAmbient, every(300), zero);
  EXPECT_EQ(propagator.n_decompositions(), 4);
  EXPECT_EQ(first.outputs, again.outputs);
  for (int rpm = 0; rpm < 40; ++rpm) {  // more than are kept
    (void)propagator.run({.name = "", .sections = {{60, {.speed_rpm = 10.0 * rpm}}}}, kRampingAmbient, {60}, zero);
  }
  EXPECT_EQ(propagator.run(kCycle, kRampingAmbient, every(300), zero).outputs, first.outputs);
}

TEST(Propagator, RefusesWhatIsNotLinear) {
  FullSystem system = fixtures::two_blocks(1);
  system.thermostats.push_back({"chiller", 0, 300.0, 299.0});
  const ReducedSystem reduced = project(system, orthonormalise(system.mass, Eigen::MatrixXd::Random(system.size(), 3)));
  EXPECT_THROW(Propagator{reduced}, std::logic_error);
}

TEST(Propagator, RefusesAnOutputAfterTheEnd) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(1);
  const Cyclogram hour{.name = "", .sections = {{3600, 1000}}};
  EXPECT_THROW((void)evolved(one_body(4000, 0), hour, {{0}, {0}}, {1800, 3601}, zero), std::logic_error);
}

}  // namespace
}  // namespace driftwright::solver::propagator_test
