#include "solver/transient.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/errors.hpp"
#include "solver/energy_balance.hpp"
#include "solver/heat_assembly.hpp"
#include "solver/heat_ode.hpp"
#include "solver/integrate.hpp"
#include "tests/shared/effect_list.hpp"
#include "tests/shared/fixtures.hpp"

namespace driftwright::solver::transient_test {
namespace {

using mesh::CellShape;
using ::testing::HasSubstr, ::testing::ThrowsMessage;

const TimeSeries kStillAmbient{{0.0}, {0.0}};

/// Two steel blocks with a joint: heat and a film that grow with speed, a constant film, a pocket of air.
FullSystem machine(int n) {
  const mesh::Mesh mesh = fixtures::two_boxes({{0, 0, 0}, {0.1, 0.1, 0.1}, {n, n, n}, CellShape::kTet10},
                                              {{0.1, 0, 0}, {0.2, 0.1, 0.1}, {n, n, n}, CellShape::kTet10}, "a.x1", "b.x0");
  effects::HeatBalance balance;
  balance.heats.push_back(
      {"bearing", effects::region("a"), [](const effects::Inputs& u) { return 0.1 * u.drive.speed_rpm; }});
  balance.heats.push_back({"pump", effects::region("b"), fixtures::constant(20.0)});
  const auto grows = [](const effects::Inputs& u) { return 5.0 + 0.02 * u.drive.speed_rpm; };
  balance.exchanges.push_back(effects::make_film("nose", "a.x0", grows, "air"));
  balance.exchanges.push_back(effects::make_film("side", "a.y1", grows, "ambient"));
  balance.exchanges.push_back(effects::make_film("back", "b.x1", fixtures::constant(30.0), "ambient"));
  balance.nodes.push_back({"air", 300.0});
  balance.exchanges.push_back(
      effects::make_link("air_node " + std::string("air"), effects::node("air"), fixtures::constant(2.0)));
  balance.exchanges.push_back(effects::make_contact("contact", "a/b", fixtures::constant(1500.0)));
  FullSystem system = assemble_heat(mesh, {fixtures::steel(), fixtures::steel()}, balance);
  fixtures::observe_unknowns(system, {0, mesh.n_nodes() - 1, mesh.n_nodes()});
  return system;
}

const Cyclogram kCycle{.name = "cycle", .sections = {{1800, 2000}, {600, 0}, {1200, 500}, {3600, 3000}, {1800, 0}}};
const TimeSeries kRampingAmbient{{0, 2000, 5000, 8000}, {0.0, 1.5, 1.5, -2.0}};

// --- balance ----------------------------------------------------------------------------------------------------

TEST(EnergyBalance, ClosesToRoundingOnACyclogramWithRampsAtAnyTolerance) {
  const FullSystem system = machine(2);
  for (double tolerance : {1e-2, 5e-4, 1e-5}) {
    const Trajectory run =
        simulate(system, kCycle, kRampingAmbient, {4000, 9000},
                 {.relative_tolerance = tolerance, .absolute_tolerance_K = tolerance}, Eigen::VectorXd::Zero(system.size()));
    // Sums over some thousand unknowns and steps, each to 1e-16, and the last steps' projected residuals.
    EXPECT_LT(run.energy_gap(), 1e-9) << "tolerance " << tolerance;
    RecordProperty("gap_" + std::to_string(tolerance), std::to_string(1e12 * run.energy_gap()) + "e-12");
  }
}

TEST(EnergyBalance, HeatOfASourceIsPowerTimesTime) {
  const FullSystem system = machine(1);
  const Trajectory run = simulate(system, kCycle, kRampingAmbient, {1800, 9000}, {}, Eigen::VectorXd::Zero(system.size()));
  std::vector<std::string> names;
  for (const HeatFlow& f : run.flows) names.push_back(f.name);
  ASSERT_EQ(names, (std::vector<std::string>{"bearing", "pump", "nose", "side", "back", "air_node air", "contact"}));
  ASSERT_EQ(run.flows[1].kind, FlowKind::kSource);
  ASSERT_EQ(run.flows[2].kind, FlowKind::kInternal);
  ASSERT_EQ(run.flows[3].kind, FlowKind::kSurrounding);
  // 0.1 W/rpm: 1800 s * 200 W = 360 kJ, then 1200 s * 50 W + 3600 s * 300 W = 1140 kJ more. Rounding of sums.
  EXPECT_NEAR(run.heat_J(0, 0), 360e3, 1e-6);
  EXPECT_NEAR(run.heat_J(0, 1), 1500e3, 1e-5);
  EXPECT_NEAR(run.heat_J(1, 1), 180e3, 1e-6);
  EXPECT_LT(run.heat_J(3, 1), -1e4);  // and heat leaves through the films
}

TEST(EnergyBalance, GapIsThatOfItsThreeTerms) {
  Trajectory run;
  run.flows = {{"in", FlowKind::kSource}, {"out", FlowKind::kSurrounding}, {"inside", FlowKind::kInternal}};
  run.heat_J.resize(3, 1);
  run.heat_J << 100.0, -30.0, 55.0;
  run.stored_J.resize(1);
  run.stored_J << 69.0;
  EXPECT_DOUBLE_EQ(run.energy_gap(), 1.0 / (0.5 * 199.0));
}

TEST(EnergyBalance, ThatDoesNotCloseEndsARun) {
  Trajectory run;
  run.time_s = {60.0};
  run.flows = {{"in", FlowKind::kSource}};
  run.heat_J = Eigen::MatrixXd::Constant(1, 1, 1000.0);
  run.stored_J = Eigen::VectorXd::Constant(1, 995.0);
  EXPECT_NO_THROW(require_balance(run, 10.0));  // half a per cent
  run.stored_J[0] = 0.0;
  EXPECT_THAT([&] { require_balance(run, 10.0); },
              ThrowsMessage<SolveError>(HasSubstr("1000 J went in and 0 J are stored")));
  EXPECT_NO_THROW(require_balance(run, 1e6));  // of a machine that this warms by a thousandth of a kelvin
  run.heat_J(0, 0) = std::nan("");
  EXPECT_THROW(require_balance(run, 1e6), SolveError);
}

TEST(EnergyBalance, OfASystemWhoseLoadWasLostEndsTheRun) {
  // As a kept machine once was used whose loads had become zeros on the disk.
  FullSystem system = assemble_heat(fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {2, 2, 2}}), {fixtures::steel()},
                                    fixtures::balance_of({"{type: heat_source, region: body, power: 100 W}"}));
  fixtures::observe_unknowns(system, {0});
  const Cyclogram rest{.name = "rest", .sections = {{3600.0, {}}}};
  const Eigen::VectorXd start = Eigen::VectorXd::Zero(system.size());
  const auto run_in_balance = [&] {
    const double capacity_J_K = system.ones.dot(system.mass * system.ones);
    require_balance(simulate(system, rest, {{0.0}, {0.0}}, {3600.0}, {}, start), capacity_J_K);
  };
  EXPECT_NO_THROW(run_in_balance());
  system.sources.front().load.setZero();
  EXPECT_THAT(run_in_balance, ThrowsMessage<SolveError>(HasSubstr("does not balance")));
}

/// Heat for an hour and rest, on a mesh fine enough that long steps take many iterations with the diagonal.
TEST(Multigrid, OfTheLongStepsGivesWhatTheDiagonalGivesInFewerIterations) {
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {18, 18, 18}, .shape = CellShape::kTet4});
  effects::HeatBalance balance;
  balance.heats.push_back({"motor", effects::surface("x0"), [](const effects::Inputs& u) { return u.drive.speed_rpm; }});
  balance.exchanges.push_back(effects::make_film("film", "x1", fixtures::constant(20.0), "ambient"));
  balance.fixed.push_back({"bed", effects::surface("z0"), {{0.0}, {0.0}}, true});
  FullSystem system = assemble_heat(mesh, {fixtures::steel()}, balance);
  fixtures::observe_unknowns(system, {0, mesh.n_nodes() / 2, mesh.n_nodes() - 1});
  const std::vector<double> minutes = {60, 600, 3600, 5400, 7200};
  constexpr double kTolerance = 2e-3;
  const TransientOptions options{.relative_tolerance = kTolerance, .absolute_tolerance_K = kTolerance};
  const auto run = [&](int worth_multigrid) {
    HeatOde ode(system, kStillAmbient, kTolerance, worth_multigrid);
    const Cyclogram cycle{.name = "cycle", .sections = {{3600, 100}, {3600, 0}}};
    return integrate(ode, linear_stretches(cycle, std::vector<double>{}), kStillAmbient, minutes, options,
                     Eigen::VectorXd::Zero(system.size()), {});
  };
  const Trajectory diagonal = run(mesh.n_nodes()), multigrid = run(1000);
  EXPECT_LT(multigrid.n_iterations, 0.9 * diagonal.n_iterations);  // the last of them are those of short steps
  // Linear solves may err by a fiftieth of the tolerance each, which steps of other lengths take further.
  EXPECT_LT((diagonal.outputs - multigrid.outputs).cwiseAbs().maxCoeff(), kTolerance);
  EXPECT_GT(diagonal.outputs.maxCoeff(), 1.0);
  EXPECT_LT(multigrid.energy_gap(), 1e-9);  // rounding, as with the diagonal
  EXPECT_LT(diagonal.energy_gap(), 1e-9);
}

// --- changes ----------------------------------------------------------------------------------------------------

TEST(Outputs, AfterTheEndAreRefused) {
  const FullSystem system = machine(1);
  const Eigen::VectorXd start = Eigen::VectorXd::Zero(system.size());
  const double end_s = kCycle.duration_s();
  EXPECT_THROW((void)simulate(system, kCycle, kStillAmbient, {0.0, end_s, end_s + 1.0}, {}, start), std::logic_error);
}

TEST(Changes, AShortPulseWithinHoursOfRestIsNotSteppedOver) {
  // 30 s at 1000 rpm (100 W) between twice four hours at rest, nothing leaves: 3000 J stay.
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {2, 2, 2}});
  effects::HeatBalance balance;
  balance.heats.push_back(
      {"pulse", effects::region("body"), [](const effects::Inputs& u) { return 0.1 * u.drive.speed_rpm; }});
  FullSystem system = assemble_heat(mesh, {fixtures::steel()}, balance);
  fixtures::observe_unknowns(system, {0});
  const Cyclogram pulse{.name = "pulse", .sections = {{14400, 0}, {30, 1000}, {14400, 0}}};
  const Trajectory run = simulate(system, pulse, kStillAmbient, {14400, 14415, 14430, 28830}, {.max_step_s = 7200.0},
                                  Eigen::VectorXd::Zero(system.size()));
  // The program's arithmetic conserves heat to rounding; 1e-9 of 3000 J.
  EXPECT_NEAR(run.stored_J[0], 0.0, 3e-6);
  EXPECT_NEAR(run.stored_J[1], 1500.0, 3e-6);
  EXPECT_NEAR(run.stored_J[2], 3000.0, 3e-6);
  EXPECT_NEAR(run.stored_J[3], 3000.0, 3e-6);
  EXPECT_NEAR(run.outputs(0, 3), 3000.0 / 4000.0,
              1e-3);  // evened out to 0.75 K, within two of the tolerances
}

TEST(Changes, AShortKnickOfTheAmbientIsNotSteppedOver) {
  // The ambient rises by 30 K for 60 s within 8 h: a triangle of 900 K s. A lump with C = 4000 J/K and h A = 1 W/K takes up
  // hA * integral = 900 J = 0.225 K less 1 % by the loss on the way; then it cools with tau = 4000 s.
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {1, 1, 1}});
  effects::HeatBalance balance;
  balance.exchanges.push_back(effects::make_film("film", "x1", fixtures::constant(100.0), "ambient"));
  FullSystem system = assemble_heat(mesh, {fixtures::lump()}, balance);
  fixtures::observe_unknowns(system, {0});
  const TimeSeries ambient{{0, 14400, 14430, 14460, 28800}, {0, 0, 30, 0, 0}};
  const Trajectory run = simulate(system, {.name = "rest", .sections = {{28800, 0}}}, ambient, {14400, 14460},
                                  {.max_step_s = 7200.0}, Eigen::VectorXd::Zero(system.size()));
  // Exact for C T' = h A (T_ambient - T): the response to a triangle, from that to a ramp of slope s,
  // r(t) = s (t - tau + tau e^(-t/tau)): T(60) = r(60) - 2 r(30).
  const auto ramp = [](double t) { return t + 4000.0 * std::expm1(-t / 4000.0); };
  EXPECT_NEAR(run.outputs(0, 0), 0.0, 1e-9);
  EXPECT_NEAR(run.outputs(0, 1), ramp(60) - 2 * ramp(30), 1e-3);  // twice the tolerance
}

// --- accuracy ---------------------------------------------------------------------------------------------------

/// Largest error of a run from a start of two eigenmodes, 10 K and 5 K, against their exponentials.
double error_K(double tolerance) {
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.2, 0.1, 0.1}, .n = {3, 1, 1}});
  effects::HeatBalance balance;
  balance.exchanges.push_back(effects::make_film("film", "x1", fixtures::constant(200.0), "ambient"));
  FullSystem system = assemble_heat(mesh, {fixtures::steel()}, balance);
  std::vector<int> all(system.size());
  for (int i = 0; i < system.size(); ++i) all[i] = i;
  fixtures::observe_unknowns(system, all);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Eigen::MatrixXd(fixtures::stiffness(system)),
                                                                        Eigen::MatrixXd(system.mass));
  const Eigen::VectorXd slow = 10.0 * eigen.eigenvectors().col(0) / eigen.eigenvectors().col(0).cwiseAbs().maxCoeff();
  const Eigen::VectorXd fast = 5.0 * eigen.eigenvectors().col(1) / eigen.eigenvectors().col(1).cwiseAbs().maxCoeff();
  const std::vector<double> times_s = {10, 100, 137, 1000, 3000, 9999, 20000};
  const Trajectory run =
      simulate(system, {.name = "rest", .sections = {{20000, 0}}}, kStillAmbient, times_s,
               {.relative_tolerance = tolerance, .absolute_tolerance_K = tolerance, .max_step_s = 1e4}, slow + fast);
  double worst = 0.0;
  for (std::size_t k = 0; k < times_s.size(); ++k) {
    const Eigen::VectorXd exact =
        std::exp(-eigen.eigenvalues()[0] * times_s[k]) * slow + std::exp(-eigen.eigenvalues()[1] * times_s[k]) * fast;
    worst = std::max(worst, (run.outputs.col(static_cast<Eigen::Index>(k)) - exact).cwiseAbs().maxCoeff());
  }
  return worst;
}

TEST(Accuracy, ErrorAgainstExponentialsStaysNearTheToleranceAndShrinksWithIt) {
  double last = 1e300;
  for (double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    const double error = error_K(tolerance);
    RecordProperty("error_at_" + std::to_string(tolerance), std::to_string(1e6 * error) + "e-6");
    // Allowed per step: tolerance (1 K + |theta|), 16 K at the start. What adds up over the run stays below it.
    EXPECT_LT(error, 16.0 * tolerance) << "tolerance " << tolerance;
    EXPECT_LT(error, 0.5 * last) << "tolerance " << tolerance;  // a third where an output falls badly between steps
    last = error;
  }
}

TEST(Accuracy, OutputsBetweenStepsAreAsGoodAsThoseOnThem) {
  // One output at the end, and many on the way: the same run.
  const FullSystem system = machine(1);
  std::vector<double> many;
  for (int i = 0; i <= 900; ++i) many.push_back(10.0 * i);
  const Eigen::VectorXd start = Eigen::VectorXd::Zero(system.size());
  const TransientOptions fine{.relative_tolerance = 1e-7, .absolute_tolerance_K = 1e-7};
  const Trajectory loose = simulate(system, kCycle, kRampingAmbient, many, {}, start);
  const Trajectory tight = simulate(system, kCycle, kRampingAmbient, many, fine, start);
  // Temperatures reach 60 K: the tolerance is 1e-4 of it + 5e-4 K = 6.5 mK a step.
  EXPECT_GT(tight.outputs.row(0).maxCoeff(), 30.0);
  EXPECT_LT((loose.outputs - tight.outputs).cwiseAbs().maxCoeff(), 10e-3);
  const Trajectory end = simulate(system, kCycle, kRampingAmbient, {9000}, {}, start);
  EXPECT_EQ(end.outputs.col(0), loose.outputs.rightCols<1>());
}

TEST(Threads, GiveTheSameBits) {
  const FullSystem system =
      machine(11);  // 24 335 unknowns: enough for every loop to share its work, six blocks of the dot product
  const Cyclogram cycle{.name = "c", .sections = {{5, 2000}}};
  const auto run = [&](int n_threads) {
    omp_set_num_threads(n_threads);
    return simulate(system, cycle, kRampingAmbient, {2, 5}, {.relative_tolerance = 0.1, .absolute_tolerance_K = 0.1},
                    Eigen::VectorXd::Zero(system.size()));
  };
  const int n_before = omp_get_max_threads();
  const Trajectory one = run(1), two = run(2);
  omp_set_num_threads(n_before);
  EXPECT_EQ(one.outputs, two.outputs);
  EXPECT_EQ(one.heat_J, two.heat_J);
  EXPECT_EQ(one.stored_J, two.stored_J);
}

// --- callbacks and failures -------------------------------------------------------------------------------------

TEST(Simulate, CallsBackAtEachOutputAndStopsWhenTheCallbackThrows) {
  const FullSystem system = machine(1);
  std::vector<double> called_s;
  const auto note = [&](double t_s, const Eigen::VectorXd& state) {
    EXPECT_EQ(state.size(), system.size());
    called_s.push_back(t_s);
    if (t_s > 500.0) throw std::runtime_error("enough");
  };
  EXPECT_THAT(
      [&] {
        (void)simulate(system, kCycle, kStillAmbient, {0, 100, 700, 800}, {}, Eigen::VectorXd::Zero(system.size()), note);
      },
      ::testing::ThrowsMessage<std::runtime_error>("enough"));
  EXPECT_EQ(called_s, (std::vector<double>{0, 100, 700}));
}

TEST(Simulate, NotANumberIsASolveError) {
  FullSystem system = machine(1);
  system.sources[0].power_W = fixtures::constant(std::nan(""));
  EXPECT_THROW((void)simulate(system, kCycle, kStillAmbient, {100}, {}, Eigen::VectorXd::Zero(system.size())), SolveError);
}

}  // namespace
}  // namespace driftwright::solver::transient_test
