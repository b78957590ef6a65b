#include "solver/multigrid.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <random>

#include "solver/conduction_factor.hpp"
#include "solver/conjugate_gradients.hpp"
#include "solver/heat_assembly.hpp"
#include "tests/fixtures.hpp"

namespace driftwright::solver {
namespace {

Eigen::VectorXd random_vector(Eigen::Index n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd v(n);
  for (double& value : v) value = normal(random);
  return v;
}

struct Heat {
  SparseRow mass, stiffness;
};

/// A block of steel with a film on one face, n cells along each edge.
Heat heat_in_block(int n, mesh::CellShape shape = mesh::CellShape::kTet4) {
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.3, 0.2, 0.4}, .n = {n, n, n}, .shape = shape});
  effects::HeatBalance balance;
  balance.films.push_back({"film", "x1", fixtures::constant(10.0), "hall"});
  const FullSystem system = assemble_heat(mesh, {fixtures::steel()}, balance);
  return {system.mass, fixtures::stiffness(system)};
}

struct Solved {
  Eigen::VectorXd x;
  int iterations;
};

Solved solve(const SparseRow& a, const Multigrid& multigrid, const Eigen::VectorXd& b, double tolerance) {
  Solved solved{Eigen::VectorXd(b.size()), 0};
  const CgOutcome outcome = conjugate_gradients(
      static_cast<int>(b.size()), 1, [&](const double* x, double* y) { multiply(a, x, y); },
      [&](const double* r, double* z) { multigrid.precondition(r, z); }, b.data(), solved.x.data(), tolerance, 200);
  EXPECT_TRUE(outcome.converged);
  solved.iterations = outcome.iterations;
  return solved;
}

TEST(MultigridOfHeat, FindsWhatAFactorFinds) {
  for (const mesh::CellShape shape : {mesh::CellShape::kTet4, mesh::CellShape::kTet10, mesh::CellShape::kHex8}) {
    const SparseRow k = heat_in_block(10, shape).stiffness;
    const Eigen::VectorXd b = random_vector(k.rows(), 1), exact = ConductionFactor(k).solve(b);
    const Solved solved = solve(k, Multigrid(k), b, 1e-10);
    // The norm of the error is bounded in the norm of K; its condition here is 1e4.
    EXPECT_LT((solved.x - exact).norm(), 1e-7 * exact.norm());
    EXPECT_LT(solved.iterations, 25);
  }
}

TEST(MultigridOfHeat, NeedsHardlyMoreIterationsOnFinerMeshes) {
  const auto iterations = [](int n) {
    const SparseRow k = heat_in_block(n).stiffness;
    return solve(k, Multigrid(k), random_vector(k.rows(), 2), 1e-8).iterations;
  };
  const int coarse = iterations(8), fine = iterations(24);  // 27 times the nodes
  EXPECT_LE(fine, coarse + 6);
}

}  // namespace
}  // namespace driftwright::solver
