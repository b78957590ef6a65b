#include "solver/cell_elasticity.hpp"

#include <Eigen/LU>

namespace driftwright::solver {

Eigen::Matrix<double, 6, 6> elasticity_tensor_Pa(const Material& m) {
  const double lame = m.youngs_modulus_Pa * m.poisson_ratio / ((1 + m.poisson_ratio) * (1 - 2 * m.poisson_ratio));
  const double shear = m.youngs_modulus_Pa / (2 * (1 + m.poisson_ratio));
  Eigen::Matrix<double, 6, 6> d = Eigen::Matrix<double, 6, 6>::Zero();
  d.topLeftCorner<3, 3>().setConstant(lame);
  d.diagonal() << lame + 2 * shear, lame + 2 * shear, lame + 2 * shear, shear, shear, shear;
  return d;
}

Eigen::Matrix<double, 6, 1> thermal_strain_1_K(const Material& m) {
  Eigen::Matrix<double, 6, 1> strain = Eigen::Matrix<double, 6, 1>::Zero();
  strain.head<3>() << m.expansion_1_K.x, m.expansion_1_K.y, m.expansion_1_K.z;
  return strain;
}

CellPoint cell_point(mesh::CellShape shape, const Eigen::Ref<const Eigen::Matrix3Xd>& coords, const Eigen::Vector3d& xi) {
  CellPoint point{mesh::shape_values(shape, xi), {}, 0.0};
  const mesh::Jacobian j = mesh::jacobian(point.shape, coords, shape);
  const auto gradient = (j.dx_dxi.inverse().transpose() * point.shape.dN.leftCols(point.shape.n)).eval();
  point.det_m3 = j.det;
  point.strain = StrainMatrix::Zero(6, 3 * point.shape.n);
  for (int i = 0; i < point.shape.n; ++i) {
    const double dx = gradient(0, i), dy = gradient(1, i), dz = gradient(2, i);
    point.strain.block<6, 3>(0, 3 * i) << dx, 0, 0, 0, dy, 0, 0, 0, dz, dy, dx, 0, 0, dz, dy, dz, 0, dx;
  }
  return point;
}

}  // namespace driftwright::solver
