#include "mesh/fit_cylinder.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/dense.hpp"

namespace driftwright::mesh {
namespace {

constexpr int kMostFitSteps = 40;

struct Across {
  Eigen::Vector3d u, v;  // unit length, across the axis and each other
};
Across across(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d u = axis.unitOrthogonal();
  return {u, axis.cross(u)};
}

Eigen::Vector3d radial_of(const FittedCylinder& c, const Eigen::Vector3d& x_m) {
  const Eigen::Vector3d d = x_m - c.through_m;
  return d - c.axis * c.axis.dot(d);
}

/// Distances of the points from the cylinder [m], positive outside.
Eigen::VectorXd distances_m(const FittedCylinder& c, const Eigen::Matrix3Xd& points_m) {
  Eigen::VectorXd r(points_m.cols());
  for (Eigen::Index i = 0; i < points_m.cols(); ++i) r[i] = radial_of(c, points_m.col(i)).norm() - c.radius_m;
  return r;
}

/// The circle through the points across a given axis: |x|² = 2 c·x + (R² - |c|²) in the plane, by least squares.
FittedCylinder kasa_circle(const Eigen::Matrix3Xd& points_m, const Eigen::Vector3d& mean_m, const Eigen::Vector3d& axis) {
  const auto [u, v] = across(axis);
  Eigen::MatrixXd a(points_m.cols(), 3);
  Eigen::VectorXd b(points_m.cols());
  for (Eigen::Index i = 0; i < points_m.cols(); ++i) {
    const Eigen::Vector3d d = points_m.col(i) - mean_m;
    const double x = u.dot(d), y = v.dot(d);
    a.row(i) << 2.0 * x, 2.0 * y, 1.0;
    b[i] = x * x + y * y;
  }
  const Eigen::Vector3d s = dense::least_squares(a, b);
  return {mean_m + s[0] * u + s[1] * v, axis, std::sqrt(std::max(0.0, s[2] + s[0] * s[0] + s[1] * s[1])), 0.0};
}

FittedCylinder moved(const FittedCylinder& c, const Across& at, const Eigen::VectorXd& step) {
  return {c.through_m + step[0] * at.u + step[1] * at.v, (c.axis + step[2] * at.u + step[3] * at.v).normalized(),
          c.radius_m + step[4], 0.0};
}

FittedCylinder improved(FittedCylinder c, const Eigen::Matrix3Xd& points_m, double scale_m) {
  double damping = 1e-6;
  Eigen::VectorXd r = distances_m(c, points_m);
  for (int step = 0; step < kMostFitSteps && damping < 1e6; ++step) {
    const Across at = across(c.axis);
    Eigen::MatrixXd jacobian(points_m.cols(), 5);
    for (Eigen::Index i = 0; i < points_m.cols(); ++i) {
      const Eigen::Vector3d d = points_m.col(i) - c.through_m, e = radial_of(c, points_m.col(i)).normalized();
      const double along_m = c.axis.dot(d), eu = e.dot(at.u), ev = e.dot(at.v);
      jacobian.row(i) << -eu, -ev, -along_m * eu / scale_m, -along_m * ev / scale_m, -1.0;
    }
    Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
    normal.diagonal().array() += damping * normal.diagonal().maxCoeff();
    Eigen::VectorXd by = dense::solve_symmetric(normal, -jacobian.transpose() * r);
    by[2] /= scale_m;
    by[3] /= scale_m;
    const FittedCylinder next = moved(c, at, by);
    const Eigen::VectorXd left = distances_m(next, points_m);
    if (!(left.squaredNorm() < r.squaredNorm())) {
      damping = std::max(10.0 * damping, 1e-6);
      continue;
    }
    const bool is_settled = left.squaredNorm() > 0.999999 * r.squaredNorm() || left.norm() < 1e-14 * scale_m;
    c = next;
    r = left;
    damping = std::max(0.1 * damping, 1e-12);
    if (is_settled) break;
  }
  c.largest_error_m = r.cwiseAbs().maxCoeff();
  return c;
}

}  // namespace

std::optional<FittedCylinder> fit_cylinder(const Eigen::Matrix3Xd& points_m, const Eigen::Matrix3Xd& normals) {
  if (points_m.cols() < 6) return std::nullopt;
  const Eigen::Vector3d mean_m = points_m.rowwise().mean();
  const double scale_m = (points_m.colwise() - mean_m).colwise().norm().maxCoeff();
  if (!(scale_m > 0.0)) return std::nullopt;
  const dense::SymmetricEigen spread(normals * normals.transpose());
  std::optional<FittedCylinder> best;
  for (int k : {0, 1}) {  // where the normals turn little, two directions have few of them
    const FittedCylinder start = kasa_circle(points_m, mean_m, spread.eigenvectors().col(k));
    if (!std::isfinite(start.radius_m) || !(start.radius_m > 0.0)) continue;
    const FittedCylinder fitted = improved(start, points_m, scale_m);
    if (std::isfinite(fitted.largest_error_m) && (!best || fitted.largest_error_m < best->largest_error_m)) best = fitted;
  }
  if (!best || !(best->radius_m > 0.0)) return std::nullopt;
  Eigen::Index largest = 0;
  best->axis.cwiseAbs().maxCoeff(&largest);
  if (best->axis[largest] < 0.0) best->axis = -best->axis;
  best->through_m += best->axis * best->axis.dot(mean_m - best->through_m);
  return best;
}

}  // namespace driftwright::mesh
