#include "solver/krylov_reduction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "solver/propagator.hpp"
#include "solver/reduced_model.hpp"
#include "tests/shared/two_blocks.hpp"

namespace driftwright::solver::krylov_reduction_test {
namespace {

const Cyclogram kCycle{.name = "cycle", .sections = {{1800, 2000}, {600, 0}, {1200, 500}, {3600, 3000}}};
const TimeSeries kRampingAmbient{{0, 2000, 5000, 7200}, {0.0, 1.5, 1.5, -2.0}};

std::vector<double> every_minute() {
  std::vector<double> times_s;
  for (double t_s = 0.0; t_s <= kCycle.duration_s(); t_s += 60.0) times_s.push_back(t_s);
  return times_s;
}

ReductionDemand demand() {
  return reduction_demand(fixtures::two_blocks_balance(), {&kCycle}, kRampingAmbient, 293.15);
}

Trajectory run_in(const FullSystem& system, const Eigen::MatrixXd& basis, const Eigen::VectorXd& start,
                  const Cyclogram& cycle = kCycle) {
  const ReducedSystem reduced = project(system, basis);
  return Propagator(reduced).run(cycle, kRampingAmbient, every_minute(), basis.transpose() * (system.mass * start), true);
}

/// The exact answer: in a basis of all unknowns.
Trajectory complete(const FullSystem& system, const Eigen::VectorXd& start, const Cyclogram& cycle = kCycle) {
  return run_in(system, orthonormalise(system.mass, Eigen::MatrixXd::Identity(system.size(), system.size())), start, cycle);
}

TEST(ReductionDemand, LooksAtALawOfTwoTemperaturesWhereOneOfTheBodiesIsWarmer) {
  const effects::Body a = effects::node("a"), b = effects::node("b");
  effects::HeatBalance balance;
  const effects::Law tightens([](const effects::Inputs& u) { return 10.0 * (1.0 + 0.02 * (u.probe_K[0] - u.probe_K[1])); },
                              {a, b});
  balance.exchanges.push_back(effects::make_link("fit", a, tightens, "b"));
  const ReductionDemand demand = reduction_demand(balance, {}, {{0.0}, {0.0}}, 293.15);
  EXPECT_LE(demand.low[0], 2.0);    // b is 40 K warmer
  EXPECT_GE(demand.high[0], 18.0);  // a is
}

TEST(KrylovReduction, MeetsItsToleranceAndItsEstimateBoundsTheError) {
  const FullSystem system = fixtures::two_blocks(2);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  const Trajectory exact = complete(system, zero);
  EXPECT_GT(exact.outputs.maxCoeff(), 30.0);
  Eigen::Index last_size = 0;
  for (double tolerance_K : {0.5, 0.05, 5e-3}) {
    const Reduction reduction = reduce(system, demand(), zero, {.temperature_K = tolerance_K});
    const double error_K = (run_in(system, reduction.basis, zero).outputs - exact.outputs).cwiseAbs().maxCoeff();
    RecordProperty("of_" + std::to_string(tolerance_K), std::to_string(reduction.basis.cols()) + " vectors, estimate " +
                                                            std::to_string(reduction.error.temperature_K) + " K, error " +
                                                            std::to_string(error_K) + " K");
    EXPECT_LE(reduction.error.temperature_K, tolerance_K);
    EXPECT_LE(error_K, reduction.error.temperature_K);
    EXPECT_GT(error_K, 1e-3 * reduction.error.temperature_K);  // an estimate that says nothing would also bound it
    EXPECT_GE(reduction.basis.cols(), last_size);
    last_size = reduction.basis.cols();
  }
  EXPECT_LT(last_size, 50);  // of 450 unknowns
}

TEST(KrylovReduction, HoldsAtEverySpeedInBetween) {
  const FullSystem system = fixtures::two_blocks(2);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  const Reduction reduction = reduce(system, demand(), zero, {.temperature_K = 5e-3});
  for (double rpm : {100.0, 900.0, 2700.0}) {
    const Cyclogram other{.name = "other", .sections = {{3000, rpm}, {900, 0.5 * rpm}, {3300, 0}}};
    EXPECT_LT(
        (run_in(system, reduction.basis, zero, other).outputs - complete(system, zero, other).outputs).cwiseAbs().maxCoeff(),
        5e-3)
        << rpm;
  }
}

TEST(KrylovReduction, KeepsTheStartAndTheHeatBalance) {
  const FullSystem system = fixtures::two_blocks(2);
  Eigen::VectorXd start(system.size());
  for (Eigen::Index i = 0; i < start.size(); ++i) start[i] = 10.0 * std::sin(0.01 * static_cast<double>(i));
  const Reduction reduction = reduce(system, demand(), start, {.temperature_K = 5e-3});
  const Trajectory run = run_in(system, reduction.basis, start);
  EXPECT_NEAR(run.outputs(0, 0), system.observe(start, 0.0)[0], 1e-9);  // rounding: the start itself is in the basis
  EXPECT_LT((run.outputs - complete(system, start).outputs).cwiseAbs().maxCoeff(), 5e-3);
  EXPECT_LT(run.energy_gap(), 1e-10);
}

TEST(KrylovReduction, BasisIsOrthonormalInMass) {
  const FullSystem system = fixtures::two_blocks(1);
  const Eigen::MatrixXd basis = reduce(system, demand(), Eigen::VectorXd::Zero(system.size())).basis;
  const Eigen::MatrixXd gram = basis.transpose() * (system.mass * basis);
  EXPECT_LT((gram - Eigen::MatrixXd::Identity(basis.cols(), basis.cols())).cwiseAbs().maxCoeff(), 1e-10);
}

// A circuit that runs while the spindle turns: at rest its exchange is zero, and with it all that its medium drives.
TEST(KrylovReduction, HoldsWhereAnExchangeWithAMediumIsSwitchedOff) {
  effects::HeatBalance balance = fixtures::two_blocks_balance();
  balance.exchanges.push_back(effects::make_link(
      "coolant", effects::region("b"), [](const effects::Inputs& u) { return u.drive.speed_rpm > 0.0 ? 8.0 : 0.0; }));
  balance.exchanges.back().medium_K = 280.0;
  const FullSystem system = fixtures::two_blocks(2, balance);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  const Reduction reduction =
      reduce(system, reduction_demand(balance, {&kCycle}, kRampingAmbient, 293.15), zero, {.temperature_K = 5e-3});
  const Eigen::MatrixXd exact = complete(system, zero).outputs;
  EXPECT_LT((run_in(system, reduction.basis, zero).outputs - exact).cwiseAbs().maxCoeff(), 5e-3);
}

TEST(ReductionDemand, SpansDrivesAndTemperaturesRoundedOutwards) {
  effects::HeatBalance balance = fixtures::two_blocks_balance();
  // A link that grows with the temperature of block a over the ambient: 1 W/K per K.
  balance.exchanges.push_back(
      effects::make_link("growing", effects::region("a"),
                         effects::Law([](const effects::Inputs& u) { return u.probe_K[0] - u.probe_K[1]; },
                                      {effects::region("a"), effects::node("ambient")})));
  const ReductionDemand demand = reduction_demand(balance, {&kCycle}, {{0}, {0}}, 293.15);
  EXPECT_DOUBLE_EQ(demand.power_W[0], 512.0);  // 300 W
  EXPECT_DOUBLE_EQ(demand.duration_s, 8192.0);
  EXPECT_DOUBLE_EQ(demand.low[0], 4.0);     // the film at rest: 5
  EXPECT_DOUBLE_EQ(demand.high[0], 128.0);  // and at 3000 rpm: 65
  EXPECT_DOUBLE_EQ(demand.low[1], 30.0);    // never moves: not rounded
  EXPECT_DOUBLE_EQ(demand.high[1], 30.0);
  EXPECT_DOUBLE_EQ(demand.low[2], 1500.0);
  EXPECT_DOUBLE_EQ(demand.low[3], 2.0);
  EXPECT_DOUBLE_EQ(demand.high[3], 64.0);
  EXPECT_EQ(demand.points().size(), 3u);
  EXPECT_DOUBLE_EQ(demand.points()[0][0], 66.0);
}

TEST(ReductionDemand, IsTheSameForCyclogramsThatAskNearlyTheSame) {
  const effects::HeatBalance balance = fixtures::two_blocks_balance();
  const Cyclogram other{.name = "other", .sections = {{7000, 3100}}};
  const ReductionDemand a = reduction_demand(balance, {&kCycle}, {{0}, {0}}, 293.15),
                        b = reduction_demand(balance, {&other}, {{0}, {0.5}}, 293.15);
  EXPECT_EQ(a.low, b.low);
  EXPECT_EQ(a.high, b.high);
  EXPECT_EQ(a.power_W, b.power_W);
  EXPECT_EQ(a.duration_s, b.duration_s);
  EXPECT_EQ(a.ambient_K, b.ambient_K);
}

TEST(ReductionDemand, LooksAtBothSidesOfEachChangeAndOfEachThermostat) {
  effects::HeatBalance balance;
  balance.change_times_s = {600.0, 1200.0};
  balance.exchanges.push_back(effects::make_film(
      "draught", "a", [](const effects::Inputs& u) { return u.time_s > 600.0 && u.time_s < 1200.0 ? 16.0 : 4.0; }));
  balance.exchanges.push_back(
      effects::make_film("chiller", "a", effects::Law([](const effects::Inputs&) { return 32.0; }, {}, "t")));
  const ReductionDemand demand = reduction_demand(balance, {}, {{0}, {0}}, 293.15);
  EXPECT_DOUBLE_EQ(demand.low[0], 4.0);
  EXPECT_DOUBLE_EQ(demand.high[0], 16.0);
  EXPECT_DOUBLE_EQ(demand.low[1], 0.0);
  EXPECT_DOUBLE_EQ(demand.high[1], 32.0);
}

TEST(ReductionDemand, IncludesOthersInAnyOrderAndWidensOnlyWhatDiffers) {
  const auto of = [](double power_W, double low, double high, double ambient_K, double duration_s) {
    ReductionDemand d;
    d.power_W = Eigen::VectorXd::Constant(1, power_W);
    d.low = Eigen::Vector2d(low, 30.0);  // the second never moves
    d.high = Eigen::Vector2d(high, 30.0);
    d.ambient_K = ambient_K;
    d.duration_s = duration_s;
    return d;
  };
  const std::vector<ReductionDemand> demands = {of(64, 9, 9, 1, 4096), of(32, 9, 9, 4, 3600), of(128, 13, 13, 2, 8192),
                                                of(16, 0, 2, 1, 3600)};
  ReductionDemand same = demands[0];
  same.include(demands[1]);
  EXPECT_EQ(same.low, demands[0].low);  // constants that agree are kept as they are
  EXPECT_EQ(same.high, demands[0].high);
  EXPECT_EQ(same.points().size(), 1u);
  EXPECT_DOUBLE_EQ(same.power_W[0], 64.0);
  EXPECT_DOUBLE_EQ(same.ambient_K, 4.0);
  EXPECT_DOUBLE_EQ(same.duration_s, 4096.0);
  same.include(demands[2]);
  EXPECT_DOUBLE_EQ(same.low[0], 8.0);  // 9 and 13, outwards to powers of two
  EXPECT_DOUBLE_EQ(same.high[0], 16.0);
  EXPECT_DOUBLE_EQ(same.low[1], 30.0);
  EXPECT_DOUBLE_EQ(same.high[1], 30.0);
  EXPECT_EQ(same.points().size(), 3u);
  std::vector<std::size_t> order = {0, 1, 2, 3};
  do {
    ReductionDemand all = demands[order[0]];
    for (std::size_t i : {1u, 2u, 3u}) all.include(demands[order[i]]);
    all.include(all);
    EXPECT_EQ(all.low, Eigen::Vector2d(0.0, 30.0));
    EXPECT_EQ(all.high, Eigen::Vector2d(16.0, 30.0));
    EXPECT_DOUBLE_EQ(all.power_W[0], 128.0);
    EXPECT_DOUBLE_EQ(all.ambient_K, 4.0);
    EXPECT_DOUBLE_EQ(all.duration_s, 8192.0);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(KrylovReduction, SaysWhenHeatHasNoWayOutOrTheToleranceIsOutOfReach) {
  FullSystem system = fixtures::two_blocks(1);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  EXPECT_THROW((void)reduce(system, demand(), zero, {.temperature_K = 1e-6, .most_rounds = 4}), SolveError);
  for (std::size_t e = 0; e < 2; ++e) system.exchanges[e].matrix *= 0.0;  // both films
  EXPECT_THROW((void)reduce(system, demand(), zero), SolveError);
}

}  // namespace
}  // namespace driftwright::solver::krylov_reduction_test
