#include "solver/pcg.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "solver/heat_assembly.hpp"
#include "solver/multigrid.hpp"
#include "tests/shared/fixtures.hpp"
#include "tests/solver/random_vector.hpp"

namespace driftwright::solver::pcg_test {
namespace {

/// M + 60 s K of a 0.1 m cube of steel with a film: what a step of the integrator solves.
SparseRow shifted() {
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {2, 2, 2}});
  effects::HeatBalance balance;
  balance.exchanges.push_back(effects::make_film("film", "x1", fixtures::constant(20.0), "ambient"));
  const FullSystem system = assemble_heat(mesh, {fixtures::steel()}, balance);
  return system.mass + 60.0 * fixtures::stiffness(system);
}

TEST(Pcg, FindsTheSolutionOfADenseSolve) {
  const SparseRow a = shifted();
  const Eigen::VectorXd exact = fixtures::random_vector(a.rows(), 3), b = a * exact;
  const Eigen::VectorXd dense = Eigen::MatrixXd(a).ldlt().solve(b);
  Pcg pcg(a);
  pcg.refresh(Eigen::VectorXd::Ones(a.rows()));
  Eigen::VectorXd x = Eigen::VectorXd::Zero(a.rows());
  const PcgOutcome outcome = pcg.solve(b.data(), x.data(), 1e-12, 1000);
  EXPECT_TRUE(outcome.converged);
  EXPECT_LE(outcome.residual, 1e-12);
  // Error <= condition of the scaled matrix (below 1e3 here) times the residual.
  EXPECT_LT((x - dense).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((dense - exact).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Pcg, StopsWhereTheScaledResidualMeetsTheTolerance) {
  const SparseRow a = shifted();
  const Eigen::VectorXd b = a * fixtures::random_vector(a.rows(), 4);
  Pcg pcg(a);
  pcg.refresh(Eigen::VectorXd::Ones(a.rows()));
  Eigen::VectorXd x = Eigen::VectorXd::Zero(a.rows());
  const PcgOutcome outcome = pcg.solve(b.data(), x.data(), 1e-4, 1000);
  ASSERT_TRUE(outcome.converged);
  // The last projection adds at most the share of the residual's sum: still of the size of the tolerance.
  const Eigen::VectorXd scaled = (b - a * x).cwiseQuotient(a.diagonal());
  EXPECT_LT(scaled.cwiseAbs().maxCoeff(), 2e-4);
}

TEST(Pcg, LooseSolvesStillConserveHeat) {
  const SparseRow a = shifted();
  const Eigen::VectorXd b = a * fixtures::random_vector(a.rows(), 5);
  Pcg pcg(a);
  pcg.refresh(Eigen::VectorXd::Ones(a.rows()));
  for (int iterations : {0, 1, 3}) {
    Eigen::VectorXd x = fixtures::random_vector(a.rows(), 6);
    const PcgOutcome outcome = pcg.solve(b.data(), x.data(), 1e-14, iterations);
    EXPECT_EQ(outcome.iterations, iterations);
    const Eigen::VectorXd r = b - a * x;
    EXPECT_GT(r.norm(), 1e-6 * b.norm());                      // loose it is
    EXPECT_LT(std::abs(r.sum()), 1e-13 * b.cwiseAbs().sum());  // rounding of a sum of 125 terms
  }
}

TEST(Pcg, SaysWhenItDidNotConverge) {
  const SparseRow a = shifted();
  const Eigen::VectorXd b = a * fixtures::random_vector(a.rows(), 5);
  Pcg pcg(a);
  pcg.refresh(Eigen::VectorXd::Ones(a.rows()));
  Eigen::VectorXd x = Eigen::VectorXd::Zero(a.rows());
  const PcgOutcome outcome = pcg.solve(b.data(), x.data(), 1e-12, 2);
  EXPECT_FALSE(outcome.converged);
  EXPECT_EQ(outcome.iterations, 2);
  EXPECT_GT(outcome.residual, 1e-12);
}

TEST(Pcg, NotANumberIsNoConvergence) {
  const SparseRow a = shifted();
  Eigen::VectorXd b = fixtures::random_vector(a.rows(), 5), x = Eigen::VectorXd::Zero(a.rows());
  b[7] = NAN;
  Pcg pcg(a);
  pcg.refresh(Eigen::VectorXd::Ones(a.rows()));
  EXPECT_FALSE(pcg.solve(b.data(), x.data(), 1e-3, 100).converged);
}

TEST(Pcg, StartsFromWhatItIsGiven) {
  const SparseRow a = shifted();
  Eigen::VectorXd x = fixtures::random_vector(a.rows(), 8);
  const Eigen::VectorXd b = a * x;
  Pcg pcg(a);
  pcg.refresh(Eigen::VectorXd::Ones(a.rows()));
  EXPECT_EQ(pcg.solve(b.data(), x.data(), 1e-9, 100).iterations, 0);
}

TEST(Pcg, ConserveTakesHeatBackThatACarriedResidualHasLost) {
  const SparseRow a = shifted();
  Pcg pcg(a);
  pcg.refresh(Eigen::VectorXd::Ones(a.rows()));
  const Eigen::VectorXd b = fixtures::random_vector(a.rows(), 9), before = fixtures::random_vector(a.rows(), 10);
  ASSERT_GT(std::abs((b - a * before).sum()), 1e-3 * b.cwiseAbs().sum());
  Eigen::VectorXd x = before;
  pcg.conserve(b.data(), x.data());
  const Eigen::VectorXd change = x - before;
  EXPECT_LT(std::abs((b - a * x).sum()), 1e-13 * b.cwiseAbs().sum());                     // rounding of a sum of 125 terms
  EXPECT_LT((change.array() - change[0]).abs().maxCoeff(), 1e-13 * std::abs(change[0]));  // by a constant
}

TEST(Pcg, ConserveLeavesPrescribedUnknownsAlone) {
  SparseRow a = shifted();
  Eigen::VectorXd ones = Eigen::VectorXd::Ones(a.rows());
  ones[3] = 0.0;
  Pcg pcg(a);
  pcg.refresh(ones);
  const Eigen::VectorXd b = fixtures::random_vector(a.rows(), 11), before = fixtures::random_vector(a.rows(), 12);
  Eigen::VectorXd x = before;
  pcg.conserve(b.data(), x.data());
  EXPECT_EQ(x[3], before[3]);
  EXPECT_NE(x[4], before[4]);
  EXPECT_LT(std::abs(ones.dot(b - a * x)), 1e-13 * b.cwiseAbs().sum());
  pcg.refresh(Eigen::VectorXd::Zero(a.rows()));  // nothing is free
  x = before;
  pcg.conserve(b.data(), x.data());
  EXPECT_EQ(x, before);
}

TEST(Pcg, WithMultigridFindsTheSameInFewerIterationsAndConservesHeat) {
  const mesh::Mesh mesh =
      fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {14, 14, 14}, .shape = mesh::CellShape::kTet4});
  effects::HeatBalance balance;
  balance.exchanges.push_back(effects::make_film("film", "x1", fixtures::constant(20.0), "ambient"));
  const FullSystem system = assemble_heat(mesh, {fixtures::steel()}, balance);
  const SparseRow a = system.mass + 600.0 * fixtures::stiffness(system);
  const Eigen::VectorXd exact = fixtures::random_vector(a.rows(), 13), b = a * exact;
  const Multigrid multigrid(a);
  Pcg pcg(a);
  pcg.refresh(Eigen::VectorXd::Ones(a.rows()));
  const auto solve = [&](const Multigrid* by) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(a.rows()), r = b;
    const PcgOutcome outcome = pcg.improve(r.data(), x.data(), 1e-9, 1000, by);
    EXPECT_TRUE(outcome.converged);
    EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-6);  // the condition of the scaled matrix, 1e3, times the tolerance
    EXPECT_LT((b - a * x - r).cwiseAbs().maxCoeff(), 1e-12 * b.cwiseAbs().maxCoeff()) << "r is the residual of x";
    EXPECT_LT(std::abs(r.sum()), 1e-12 * b.cwiseAbs().sum());
    return outcome.iterations;
  };
  EXPECT_LT(2 * solve(&multigrid), solve(nullptr));
}

}  // namespace
}  // namespace driftwright::solver::pcg_test
