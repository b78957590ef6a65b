#include "diagnosis/projection.hpp"

namespace driftwright::diagnosis {

Projection::Projection(Eigen::MatrixXd j, const Eigen::VectorXd& sd, const Eigen::VectorXd& y) : slopes(std::move(j)) {
  Eigen::MatrixXd hessian = slopes.transpose() * slopes;
  hessian.diagonal() += sd.cwiseProduct(sd).cwiseInverse();
  factor.compute(hessian);
  rest = without(y);
}

Eigen::MatrixXd Projection::without(const Eigen::MatrixXd& columns) const {
  return columns - slopes * factor.solve(slopes.transpose() * columns);
}

double Projection::square(const Eigen::VectorXd& s) const {
  const Eigen::VectorXd js = slopes.transpose() * s;
  return s.squaredNorm() - js.dot(factor.solve(js));
}

}  // namespace driftwright::diagnosis
