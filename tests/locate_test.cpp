#include "mesh/locate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "tests/fixtures.hpp"

namespace driftwright::mesh {
namespace {

std::vector<int> all(const Cells& cells) {
  std::vector<int> list(cells.size());
  std::iota(list.begin(), list.end(), 0);
  return list;
}

TEST(NearestPoint, InsideABoxIsThePointItself) {
  const Mesh mesh = fixtures::box_mesh({.size_m = {2, 1, 1}, .n = {3, 2, 2}, .shape = CellShape::kTet4});
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d p(2 * share(random), share(random), share(random));
    const MeshPoint found = nearest_point(mesh, mesh.cells, all(mesh.cells), p);
    const ShapeValues s = shape_values(CellShape::kTet4, found.xi);
    const Eigen::Vector3d back = cell_coords(mesh, mesh.cells.nodes(found.cell)) * s.N.head(4).transpose();
    EXPECT_NEAR((back - p).norm(), 0.0, 1e-12);  // rounding of a 3 x 3 solve
    EXPECT_NEAR(found.distance_m, 0.0, 1e-12);
    EXPECT_GE(found.xi.minCoeff(), -1e-11);
    EXPECT_LE(found.xi.sum(), 1.0 + 1e-11);
  }
}

class OutsideABox : public ::testing::TestWithParam<CellShape> {};

TEST_P(OutsideABox, NearestPointIsTheClampedPoint) {
  const Eigen::Vector3d size(2, 1, 0.5);
  const Mesh mesh = fixtures::box_mesh({.size_m = size, .n = {3, 2, 2}, .shape = GetParam()});
  std::mt19937 random(12);
  std::uniform_real_distribution<double> share(-1.5, 2.5);
  int n_outside = 0;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d p(share(random), share(random), share(random));
    const Eigen::Vector3d nearest = p.cwiseMax(0.0).cwiseMin(size);  // of an axis-parallel box
    const MeshPoint found = nearest_point(mesh, mesh.cells, all(mesh.cells), p);
    EXPECT_NEAR((found.position_m - nearest).norm(), 0.0, 1e-12);
    EXPECT_NEAR(found.distance_m, (p - nearest).norm(), 1e-12);
    n_outside += found.distance_m > 0.1;
  }
  EXPECT_GT(n_outside, 50);
}

INSTANTIATE_TEST_SUITE_P(Orders, OutsideABox, ::testing::Values(CellShape::kTet4, CellShape::kTet10));

/// A quarter turn of a thick ring, radius 1 to 2, height 1: each edge along the circle becomes a parabola.
Mesh quarter_ring(int n_along) {
  Mesh mesh = fixtures::box_mesh({.n = {1, n_along, 1}});
  for (auto x : mesh.coords.colwise()) {
    const double radius = 1.0 + x[0], angle = x[1] * std::acos(0.0);
    x = Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), x[2]);
  }
  return mesh;
}

TEST(NearestPoint, InsideCurvedCellsInvertsTheMap) {
  const Mesh mesh = quarter_ring(3);
  std::mt19937 random(13);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::uniform_int_distribution<int> any(0, mesh.cells.size() - 1);
  for (int i = 0; i < 100; ++i) {
    Eigen::Vector3d xi(share(random), share(random), share(random));
    if (xi.sum() > 1.0) xi /= 1.001 * xi.sum();
    const ShapeValues s = shape_values(CellShape::kTet10, xi);
    const Eigen::Vector3d p = cell_coords(mesh, mesh.cells.nodes(any(random))) * s.N.transpose();
    const MeshPoint found = nearest_point(mesh, mesh.cells, all(mesh.cells), p);
    EXPECT_LT(found.distance_m, 1e-9);  // Newton converges quadratically; its stop is a step of 1e-12
  }
}

TEST(NearestPoint, OutsideCurvedFacetsIsAlongTheRadius) {
  // On the outer face of the ring. With 8 pieces of 11.25 degrees a parabola through three points of the circle
  // leaves it by less than r (angle/2)^4 / 16 = 1.2e-5 m.
  const Mesh mesh = quarter_ring(8);
  const std::vector<int> face = mesh.facets_on(mesh.surface("x1"));
  for (double angle : {0.1, 0.5, 0.7854, 1.2, 1.5}) {
    const Eigen::Vector3d p(2.5 * std::cos(angle), 2.5 * std::sin(angle), 0.3);
    const MeshPoint found = nearest_point(mesh, mesh.facets, face, p);
    EXPECT_NEAR(found.distance_m, 0.5, 2e-5);
    // Along the face the foot is where the parabola's normal points: error of its slope, some 1e-3 of the radius.
    EXPECT_NEAR((found.position_m - p * 2.0 / 2.5).head<2>().norm(), 0.0, 1e-3);
    EXPECT_NEAR(found.position_m[2], 0.3, 1e-4);
  }
}

TEST(NearestPoint, LooksAtTheCandidatesAlone) {
  const Mesh mesh = fixtures::two_boxes({}, {.low = {1, 0, 0}}, "a.x1", "b.x0");
  const MeshPoint found = nearest_point(mesh, mesh.cells, mesh.cells_in(mesh.region("b")), {0.25, 0.5, 0.5});
  EXPECT_EQ(mesh.cells.group[found.cell], mesh.region("b"));
  EXPECT_NEAR(found.distance_m, 0.75, 1e-12);
  EXPECT_EQ(nearest_point(mesh, mesh.cells, {}, {0, 0, 0}).cell, -1);
}

}  // namespace
}  // namespace driftwright::mesh
