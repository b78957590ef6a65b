#include "solver/slope_space.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include "solver/heat_assembly.hpp"
#include "tests/shared/fixtures.hpp"
#include "tests/solver/random_vector.hpp"

namespace driftwright::solver::slope_space_test {
namespace {

constexpr int kHeld = 6;  // slopes that a space keeps

/// Storing and conduction of a block of steel with a film, of one pattern.
struct Matrices {
  SparseRow mass, stiffness;
  explicit Matrices(int n) {
    const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {n, n, n}, .shape = mesh::CellShape::kTet4});
    effects::HeatBalance balance;
    balance.exchanges.push_back(effects::make_film("film", "x1", fixtures::constant(20.0), "ambient"));
    const FullSystem system = assemble_heat(mesh, {fixtures::steel()}, balance);
    mass = system.mass;
    stiffness = fixtures::stiffness(system);
  }
  [[nodiscard]] Eigen::Index size() const { return mass.rows(); }
};

struct Guess {
  Eigen::VectorXd x, residual;
};
Guess guess(SlopeSpace& space, double gamma, const Eigen::VectorXd& b) {
  Guess g{Eigen::VectorXd(b.size()), Eigen::VectorXd(b.size())};
  space.guess(gamma, b.data(), g.x.data(), g.residual.data());
  return g;
}

TEST(SlopeSpace, FindsACombinationOfItsSlopesAtAnyGamma) {
  const Matrices m(5);
  SlopeSpace space(static_cast<int>(m.size()));
  EXPECT_TRUE(space.empty());
  std::vector<Eigen::VectorXd> slopes;
  for (unsigned i = 0; i < 4; ++i) {
    slopes.push_back(fixtures::random_vector(m.size(), i));
    space.add(m.mass, m.stiffness, slopes.back().data());
  }
  const Eigen::VectorXd exact = 2.0 * slopes[0] - 0.3 * slopes[2] + 5.0 * slopes[3];
  for (double gamma : {0.5, 60.0, 4000.0}) {
    const SparseRow a = m.mass + gamma * m.stiffness;
    const Eigen::VectorXd b = a * exact;
    const Guess g = guess(space, gamma, b);
    // Rounding over the share of an eigenvalue that is kept, 1e-9 at worst; random slopes are nearly orthogonal.
    EXPECT_LT((g.x - exact).norm(), 1e-10 * exact.norm()) << gamma;
    EXPECT_LT(g.residual.norm(), 1e-10 * b.norm()) << gamma;
  }
}

TEST(SlopeSpace, GuessIsTheBestOfItsSpanAndItsResidualIsTrue) {
  const Matrices m(5);
  SlopeSpace space(static_cast<int>(m.size()));
  std::vector<Eigen::VectorXd> slopes;
  for (unsigned i = 0; i < 3; ++i) {
    slopes.push_back(fixtures::random_vector(m.size(), i));
    space.add(m.mass, m.stiffness, slopes.back().data());
  }
  const SparseRow a = m.mass + 30.0 * m.stiffness;
  const Eigen::VectorXd b = fixtures::random_vector(m.size(), 7);
  const Guess g = guess(space, 30.0, b);
  EXPECT_LT((b - a * g.x - g.residual).norm(), 1e-13 * b.norm());
  ASSERT_GT(g.residual.norm(), 0.5 * b.norm());  // b is none of them
  // The error is least in the norm of A where the residual is orthogonal to the span.
  for (const Eigen::VectorXd& s : slopes) EXPECT_LT(std::abs(s.dot(g.residual)), 1e-12 * s.norm() * b.norm());
}

TEST(SlopeSpace, DropsTheOldest) {
  const Matrices m(4);
  SlopeSpace space(static_cast<int>(m.size()));
  std::vector<Eigen::VectorXd> slopes;
  for (unsigned i = 0; i < kHeld + 2; ++i) {
    slopes.push_back(fixtures::random_vector(m.size(), i));
    space.add(m.mass, m.stiffness, slopes.back().data());
  }
  const SparseRow a = m.mass + 10.0 * m.stiffness;
  for (int i = 0; i < kHeld + 2; ++i) {
    const Eigen::VectorXd b = a * slopes[i];
    const double left = guess(space, 10.0, b).residual.norm() / b.norm();
    if (i < 2) {
      EXPECT_GT(left, 0.5) << i;
    } else {
      EXPECT_LT(left, 1e-10) << i;
    }
  }
  space.clear();
  EXPECT_TRUE(space.empty());
}

TEST(SlopeSpace, SlopesThatAreNearlyTheSameOrZeroDoNoHarm) {
  const Matrices m(4);
  SlopeSpace space(static_cast<int>(m.size()));
  const Eigen::VectorXd slope = fixtures::random_vector(m.size(), 1), zero = Eigen::VectorXd::Zero(m.size());
  const Eigen::VectorXd nearly = slope + 1e-9 * fixtures::random_vector(m.size(), 2);
  for (const auto* s : {&slope, &nearly, &slope, &zero}) space.add(m.mass, m.stiffness, s->data());
  const SparseRow a = m.mass + 10.0 * m.stiffness;
  const Eigen::VectorXd b = a * (3.0 * slope) + 1e-3 * fixtures::random_vector(m.size(), 3);
  const Guess g = guess(space, 10.0, b);
  EXPECT_LT((g.x - 3.0 * slope).norm(), 1e-3 * slope.norm());
  EXPECT_LT(g.x.cwiseAbs().maxCoeff(), 20.0);
}

TEST(SlopeSpace, GivesTheSameBitsOnAnyNumberOfThreads) {
  const Matrices m(36);  // some 50 000 unknowns: worth threads
  const int before = omp_get_max_threads();
  std::vector<Eigen::VectorXd> found;
  for (int n_threads : {1, 2, 3}) {
    omp_set_num_threads(n_threads);
    SlopeSpace space(static_cast<int>(m.size()));
    for (unsigned i = 0; i < 3; ++i) space.add(m.mass, m.stiffness, fixtures::random_vector(m.size(), i).data());
    found.push_back(guess(space, 30.0, fixtures::random_vector(m.size(), 7)).residual);
  }
  omp_set_num_threads(before);
  EXPECT_EQ(found[0], found[1]);
  EXPECT_EQ(found[0], found[2]);
}

}  // namespace
}  // namespace driftwright::solver::slope_space_test
