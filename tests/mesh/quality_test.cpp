#include "mesh/quality.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "mesh/topology.hpp"
#include "tests/shared/fixtures.hpp"

namespace driftwright::mesh::quality_test {
namespace {

Mesh one_tet(const Eigen::Matrix<double, 3, 4>& corners, const std::array<int, 4>& order) {
  Mesh mesh;
  mesh.coords = corners;
  mesh.regions = {"body"};
  mesh.cells.add(CellShape::kTet4, order, 0);
  return mesh;
}

Eigen::Matrix<double, 3, 4> regular() {  // every second corner of a cube of edge 2: edges of 2 sqrt 2
  Eigen::Matrix<double, 3, 4> x;
  x << 1, -1, -1, 1, 1, -1, 1, -1, 1, 1, -1, -1;
  return x;
}

TEST(ScaledJacobian, OfTheRegularTetrahedronIsOne) {
  const Mesh mesh = one_tet(regular(), {0, 1, 2, 3});
  // det = edge^3 / sqrt 2 = 16 for an edge of sqrt 8.
  EXPECT_NEAR(std::abs(worst_quality(mesh).min_det_m3), 16.0, 1e-13);  // rounding
  EXPECT_NEAR(std::abs(scaled_jacobians(mesh)[0]), 1.0, 1e-14);
}

TEST(ScaledJacobian, ChangesSignWithTheOrientation) {
  const double one = scaled_jacobians(one_tet(regular(), {0, 1, 2, 3}))[0];
  const double other = scaled_jacobians(one_tet(regular(), {0, 2, 1, 3}))[0];
  EXPECT_NEAR(one + other, 0.0, 1e-14);
  EXPECT_NEAR(std::min(one, other), -1.0, 1e-14);
}

TEST(ScaledJacobian, OfTheCornerOfACubeIsOneOverRootTwo) {
  // Corner at right angles with unit edges: det = 1; the corners at the tips have edges 1, sqrt 2, sqrt 2: product 2.
  Eigen::Matrix<double, 3, 4> x;
  x << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  EXPECT_NEAR(scaled_jacobians(one_tet(x, {0, 1, 2, 3}))[0], std::sqrt(2.0) / 2.0, 1e-14);
}

TEST(ScaledJacobian, OfAFlatCellIsZero) {
  Eigen::Matrix<double, 3, 4> x;
  x << 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0;
  EXPECT_NEAR(scaled_jacobians(one_tet(x, {0, 1, 2, 3}))[0], 0.0, 1e-15);
}

TEST(ScaledJacobian, SeesAMidSideNodeThatFoldsACurvedCell) {
  // Straight, det is 1 everywhere. The mid-side node of the edge along x pulled to x = 0.1, past the quarter point at
  // 0.25: dx/dxi at the corner = -3 x0 + 4 x_mid - x1 = 4 * 0.1 - 1 = -0.6, and det with it.
  Mesh mesh = fixtures::box_mesh({});
  const auto nodes = mesh.cells.nodes(0);
  const Eigen::Vector3d a = mesh.coords.col(nodes[0]), b = mesh.coords.col(nodes[1]);
  EXPECT_NEAR(worst_quality(mesh).min_det_m3, 1.0, 1e-14);
  mesh.coords.col(nodes[4]) = a + 0.1 * (b - a);
  const Quality q = worst_quality(mesh);
  EXPECT_NEAR(q.min_det_m3, -0.6, 1e-13);
  EXPECT_LT(q.min_scaled, 0.0);
}

/// One cell with its nodes at the reference nodes, then moved by map.
Mesh one_cell(CellShape shape, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& map) {
  Mesh mesh;
  mesh.regions = {"body"};
  const auto xi = reference_nodes(shape);
  mesh.coords.resize(3, static_cast<Eigen::Index>(xi.size()));
  std::vector<int> nodes;
  for (const Eigen::Vector3d& x : xi) {
    mesh.coords.col(static_cast<Eigen::Index>(nodes.size())) = map(x);
    nodes.push_back(static_cast<int>(nodes.size()));
  }
  mesh.cells.add(shape, nodes, 0);
  return mesh;
}

class HexahedraAndWedges : public ::testing::TestWithParam<CellShape> {
 protected:
  /// Brick of 2 x 3 x 4, or right prism of height 4 on a regular triangle of side 2.
  [[nodiscard]] Eigen::Vector3d ideal(const Eigen::Vector3d& x) const {
    if (n_corners_of(GetParam()) == 8) return {2 * x[0], 3 * x[1], 4 * x[2]};
    return {2 * x[0] + x[1], std::sqrt(3.0) * x[1], 4 * x[2]};
  }
};

TEST_P(HexahedraAndWedges, HaveScaledJacobianOneWhereAllAnglesAreIdeal) {
  const Mesh mesh = one_cell(GetParam(), [&](const Eigen::Vector3d& x) { return ideal(x); });
  EXPECT_NEAR(scaled_jacobians(mesh)[0], 1.0, 1e-14);
  const bool hex = n_corners_of(GetParam()) == 8;
  EXPECT_NEAR(worst_quality(mesh).min_det_m3, hex ? 24.0 : 8.0 * std::sqrt(3.0), 1e-13);
  EXPECT_NEAR(volume_m3(mesh, 0), hex ? 24.0 : 4.0 * std::sqrt(3.0), 1e-13);
}

TEST_P(HexahedraAndWedges, ShearedByAnAngleHaveItsCosine) {
  // The axis tilted by 60 degrees: the volume of three unit vectors falls to cos 60 deg.
  const Mesh mesh = one_cell(GetParam(), [&](const Eigen::Vector3d& x) {
    Eigen::Vector3d y = ideal(x);
    y[1] += std::sqrt(3.0) * y[2];
    return y;
  });
  EXPECT_NEAR(scaled_jacobians(mesh)[0], 0.5, 1e-13);
}

TEST_P(HexahedraAndWedges, TurnedInsideOutAreNegative) {
  const Mesh mesh = one_cell(GetParam(), [&](const Eigen::Vector3d& x) {
    Eigen::Vector3d y = ideal(x);
    y[2] = -y[2];
    return y;
  });
  EXPECT_NEAR(scaled_jacobians(mesh)[0], -1.0, 1e-14);
  EXPECT_LT(worst_quality(mesh).min_det_m3, 0.0);
}

TEST_P(HexahedraAndWedges, WithACornerPushedInwardsAreNegativeAndNanIsTheWorst) {
  Mesh mesh = one_cell(GetParam(), [&](const Eigen::Vector3d& x) { return ideal(x); });
  EXPECT_EQ(worst_quality(mesh).worst_cell, 0);
  mesh.coords.col(0) = mesh.coords.rowwise().mean() + Eigen::Vector3d(0.3, 0.3, 0.3);
  EXPECT_LT(scaled_jacobians(mesh)[0], 0.0);
  mesh.coords(1, 0) = std::nan("");
  EXPECT_FALSE(worst_quality(mesh).min_det_m3 > 0.0);
  EXPECT_FALSE(worst_quality(mesh).min_scaled > 0.0);
}

INSTANTIATE_TEST_SUITE_P(Shapes, HexahedraAndWedges,
                         ::testing::Values(CellShape::kHex8, CellShape::kHex20, CellShape::kWedge6, CellShape::kWedge15));

class BoxSizes : public ::testing::TestWithParam<CellShape> {};

TEST_P(BoxSizes, VolumesAndAreasAreThoseOfTheBox) {
  const fixtures::Box box{.low = {-1, 2, 3}, .size_m = {2, 3, 0.5}, .n = {3, 2, 4}, .shape = GetParam()};
  const Mesh mesh = fixtures::box_mesh(box);
  constexpr double kRounding = 1e-13;
  const int n_corners = n_corners_of(GetParam());
  EXPECT_EQ(mesh.cells.size(), (n_corners == 4 ? 6 : n_corners == 6 ? 2 : 1) * 3 * 2 * 4);
  EXPECT_NEAR(volume_m3(mesh, mesh.region("body")), 3.0, kRounding);
  EXPECT_NEAR(area_m2(mesh, mesh.surface("x0")), 1.5, kRounding);
  EXPECT_NEAR(area_m2(mesh, mesh.surface("x1")), 1.5, kRounding);
  EXPECT_NEAR(area_m2(mesh, mesh.surface("y0")), 1.0, kRounding);
  EXPECT_NEAR(area_m2(mesh, mesh.surface("z1")), 6.0, kRounding);
  EXPECT_GT(worst_quality(mesh).min_scaled, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Shapes, BoxSizes,
                         ::testing::Values(CellShape::kTet4, CellShape::kTet10, CellShape::kHex8, CellShape::kHex20,
                                           CellShape::kWedge6, CellShape::kWedge15));

TEST(Areas, OfACurvedFaceFollowItsMidSideNodes) {
  // The face z = 1 bent to the parabolic arch z = 1 + x (1 - x), which quadratic facets represent exactly.
  // Area = ∫ sqrt(1 + (1 - 2x)^2) dx = (sqrt 2 + asinh 1) / 2 = 1.147794; the rule of degree 5 on 8 strips: 1e-6.
  Mesh mesh = fixtures::box_mesh({.n = {8, 1, 1}});
  for (auto x : mesh.coords.colwise()) x[2] *= 1.0 + x[0] * (1.0 - x[0]);
  EXPECT_NEAR(area_m2(mesh, mesh.surface("z1")), 0.5 * (std::sqrt(2.0) + std::asinh(1.0)), 1e-6);
  EXPECT_NEAR(volume_m3(mesh, 0), 7.0 / 6.0,
              1e-4);  // z is bent linearly in height: cubic, not quite representable
}

TEST(Areas, OfACylinderOfQuadraticHexahedraConverge) {
  // Quarter of a ring, radius 1 to 2, height 1: bore π/2, volume 3π/4. Parabolas through three points of the circle.
  const auto error = [](int n) {
    Mesh mesh = fixtures::box_mesh({.n = {2, n, 1}, .shape = CellShape::kHex20});
    fixtures::map_nodes(mesh, [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
      const double angle = x[1] * std::acos(0.0);
      return {(1 + x[0]) * std::cos(angle), (1 + x[0]) * std::sin(angle), x[2]};
    });
    EXPECT_GT(worst_quality(mesh).min_scaled, 0.0);
    return std::pair{std::abs(area_m2(mesh, mesh.surface("x0")) - std::acos(0.0)),
                     std::abs(volume_m3(mesh, 0) - 1.5 * std::acos(0.0))};
  };
  const auto coarse = error(3), fine = error(6);
  EXPECT_NEAR(std::log2(coarse.first / fine.first), 4.0, 0.1);  // arc length of an interpolating parabola: h^4
  EXPECT_NEAR(std::log2(coarse.second / fine.second), 4.0, 0.1);
  EXPECT_LT(fine.first, 3e-5);
}

}  // namespace
}  // namespace driftwright::mesh::quality_test
