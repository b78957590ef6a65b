#include "base/dense.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace driftwright::dense {

using Eigen::MatrixXd;

SymmetricEigen::SymmetricEigen(const MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(a);
  values_ = eigen.eigenvalues();
  vectors_ = eigen.eigenvectors();
}

GeneralizedSymmetricEigen::GeneralizedSymmetricEigen(const MatrixXd& a, const MatrixXd& b) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(a, b);
  values_ = eigen.eigenvalues();
  vectors_ = eigen.eigenvectors();
}

namespace {

SingularValues decomposed(const MatrixXd& a, unsigned what) {
  // The methods of Eigen for large matrices take the compiler ten times longer; the largest here has some hundred rows.
  const Eigen::JacobiSVD<MatrixXd> svd(a, what);
  SingularValues s{svd.singularValues(), {}, {}};
  if (svd.computeU()) s.u = svd.matrixU();
  if (svd.computeV()) s.v = svd.matrixV();
  return s;
}

}  // namespace

SingularValues SingularValues::alone(const MatrixXd& a) {
  return decomposed(a, 0);
}
SingularValues SingularValues::with_u(const MatrixXd& a) {
  return decomposed(a, Eigen::ComputeThinU);
}
SingularValues SingularValues::with_full_u(const MatrixXd& a) {
  return decomposed(a, Eigen::ComputeFullU);
}
SingularValues SingularValues::with_u_and_full_v(const MatrixXd& a) {
  return decomposed(a, Eigen::ComputeThinU | Eigen::ComputeFullV);
}

PivotedQr::PivotedQr(const MatrixXd& a, double threshold) {
  auto qr = std::make_shared<Eigen::ColPivHouseholderQR<MatrixXd>>(a.rows(), a.cols());
  qr->setThreshold(threshold);
  qr->compute(a);
  qr_ = std::move(qr);
}

Eigen::Index PivotedQr::rank() const {
  return qr_->rank();
}

MatrixXd PivotedQr::solve(const MatrixXd& b) const {
  return qr_->solve(b);
}

MatrixXd PivotedQr::basis() const {
  return qr_->householderQ() * MatrixXd::Identity(qr_->rows(), rank());
}

MatrixXd PivotedQr::r() const {
  return qr_->matrixR().topRows(qr_->cols()).triangularView<Eigen::Upper>();
}

double PivotedQr::length_beside(const Eigen::VectorXd& v) const {
  const Eigen::VectorXd rotated = qr_->householderQ().adjoint() * v;
  return rotated.tail(v.size() - rank()).norm();
}

MatrixXd least_squares(const MatrixXd& a, const MatrixXd& b) {
  return a.colPivHouseholderQr().solve(b);
}

MatrixXd shortest_least_squares(const MatrixXd& a, const MatrixXd& b, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> cod(a.rows(), a.cols());
  cod.setThreshold(threshold);
  cod.compute(a);
  return cod.solve(b);
}

MatrixXd solve_definite(const MatrixXd& a, const MatrixXd& b) {
  return a.llt().solve(b);
}

MatrixXd solve_symmetric(const MatrixXd& a, const MatrixXd& b) {
  return a.ldlt().solve(b);
}

MatrixXd solve_square(const MatrixXd& a, const MatrixXd& b) {
  return a.partialPivLu().solve(b);
}

MatrixXd orthonormal_from(const MatrixXd& a) {
  return Eigen::HouseholderQR<MatrixXd>(a).householderQ();
}

}  // namespace driftwright::dense
