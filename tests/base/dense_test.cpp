#include "base/dense.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace driftwright::dense::dense_test {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

MatrixXd matrix(Eigen::Index rows, Eigen::Index cols, std::initializer_list<double> row_by_row) {
  MatrixXd m(rows, cols);
  Eigen::Index i = 0;
  for (const double v : row_by_row) m(i / cols, i % cols) = v, ++i;
  return m;
}

const MatrixXd kDefinite = matrix(2, 2, {2, 1, 1, 2});  // eigenvalues 1 and 3

TEST(Dense, EigenvaluesOfASymmetricMatrixAscend) {
  const SymmetricEigen eigen(kDefinite);
  EXPECT_NEAR(eigen.eigenvalues()[0], 1.0, 1e-15);
  EXPECT_NEAR(eigen.eigenvalues()[1], 3.0, 1e-15);
  EXPECT_NEAR(std::abs(eigen.eigenvectors()(0, 1)), std::sqrt(0.5), 1e-15);
}

TEST(Dense, GeneralizedEigenvectorsAreOfUnitMass) {
  // 2x = λ 8x and 9x = λ x.
  const MatrixXd a = matrix(2, 2, {2, 0, 0, 9}), b = matrix(2, 2, {8, 0, 0, 1});
  const GeneralizedSymmetricEigen eigen(a, b);
  EXPECT_NEAR(eigen.eigenvalues()[0], 0.25, 1e-15);
  EXPECT_NEAR(eigen.eigenvalues()[1], 9.0, 1e-14);
  EXPECT_LT((eigen.eigenvectors().transpose() * b * eigen.eigenvectors() - MatrixXd::Identity(2, 2)).norm(), 1e-14);
}

TEST(Dense, SingularValuesOfWideAndTallMatrices) {
  const MatrixXd wide = matrix(2, 3, {3, 0, 0, 0, 0, 4});
  const VectorXd alone = SingularValues::alone(wide).sigma;
  EXPECT_NEAR(alone[0], 4.0, 1e-15);
  EXPECT_NEAR(alone[1], 3.0, 1e-15);
  const SingularValues full = SingularValues::with_u_and_full_v(wide);
  EXPECT_EQ(full.u.cols(), 2);
  EXPECT_EQ(full.v.cols(), 3);
  EXPECT_LT((full.u * full.sigma.asDiagonal() * full.v.leftCols(2).transpose() - wide).norm(), 1e-14);
  EXPECT_EQ(SingularValues::with_full_u(wide.transpose()).u.cols(), 3);
  EXPECT_EQ(SingularValues::with_u(wide.transpose()).u.cols(), 2);
}

TEST(Dense, PivotedQrTellsTheRankAndWhatColumnsDoNotGive) {
  const MatrixXd parallel = matrix(3, 2, {1, 2, 0, 0, 0, 0});
  const PivotedQr qr(parallel, 1e-10);
  EXPECT_EQ(qr.rank(), 1);
  EXPECT_EQ(qr.basis().cols(), 1);
  EXPECT_NEAR(qr.length_beside(Eigen::Vector3d(5, 3, 4)), 5.0, 1e-14);
  const MatrixXd upright = matrix(3, 2, {1, 1, 0, 2, 0, 0});
  EXPECT_NEAR(std::abs(PivotedQr(upright, 1e-10).r().determinant()), 2.0, 1e-14);
  EXPECT_NEAR(PivotedQr(upright, 1e-10).solve(Eigen::Vector3d(3, 4, 7))(1, 0), 2.0, 1e-14);
}

TEST(Dense, SolvesByEachDecomposition) {
  const VectorXd b = Eigen::Vector2d(4, 5);  // of x = 1, 2
  for (const MatrixXd& x : {solve_definite(kDefinite, b), solve_symmetric(kDefinite, b), solve_square(kDefinite, b),
                            least_squares(kDefinite, b)}) {
    EXPECT_NEAR(x(0, 0), 1.0, 1e-14);
    EXPECT_NEAR(x(1, 0), 2.0, 1e-14);
  }
  // Two columns that are one: of all answers the shortest shares it between them.
  const MatrixXd shared = shortest_least_squares(matrix(2, 2, {1, 1, 1, 1}), Eigen::Vector2d(2, 2), 1e-10);
  EXPECT_NEAR(shared(0, 0), 1.0, 1e-14);
  EXPECT_NEAR(shared(1, 0), 1.0, 1e-14);
}

TEST(Dense, OrthonormalColumnsSpanWhatTheyAreMadeFrom) {
  const MatrixXd a = matrix(3, 1, {0, 3, 4}), q = orthonormal_from(a);
  EXPECT_EQ(q.cols(), 3);
  EXPECT_LT((q.transpose() * q - MatrixXd::Identity(3, 3)).norm(), 1e-14);
  EXPECT_NEAR(std::abs(q.col(0).dot(a.col(0))), 5.0, 1e-14);
}

}  // namespace
}  // namespace driftwright::dense::dense_test
