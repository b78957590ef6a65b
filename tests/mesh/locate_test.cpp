#include "mesh/locate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "mesh/topology.hpp"
#include "tests/shared/fixtures.hpp"

namespace driftwright::mesh::locate_test {
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

INSTANTIATE_TEST_SUITE_P(Shapes, OutsideABox,
                         ::testing::Values(CellShape::kTet4, CellShape::kTet10, CellShape::kHex8, CellShape::kHex20,
                                           CellShape::kWedge6, CellShape::kWedge15));

/// Nodes of one cell or facet at its reference nodes, bent by a smooth map and shaken a little.
Mesh one_bent(CellShape shape, unsigned seed) {
  Mesh mesh;
  mesh.regions = {"body"};
  mesh.surfaces = {"face"};
  const auto xi = reference_nodes(shape);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shake(-0.04, 0.04);
  mesh.coords.resize(3, static_cast<Eigen::Index>(xi.size()));
  std::vector<int> nodes;
  for (const Eigen::Vector3d& r : xi) {
    const Eigen::Vector3d bent(2.0 * r[0] + 0.2 * r[1] * r[1], 1.2 * r[1] + 0.25 * r[0] * r[2],
                               r[2] + 0.2 * r[0] * r[1] + 0.15 * r[0] * r[0]);
    mesh.coords.col(static_cast<Eigen::Index>(nodes.size())) =
        bent + Eigen::Vector3d(shake(random), shake(random), shake(random));
    nodes.push_back(static_cast<int>(nodes.size()));
  }
  (dimension_of(shape) == 3 ? mesh.cells : mesh.facets).add(shape, nodes, 0);
  return mesh;
}

/// Least distance from p to the cell by sampling its reference cell ever finer around the best 20 samples: no derivative, no
/// assumption of one minimum.
double sampled_distance_m(const Mesh& mesh, const Cells& cells, const Eigen::Vector3d& p) {
  const CellShape shape = cells.shape[0];
  const auto x = cell_coords(mesh, cells.nodes(0));
  const bool simplex = n_corners_of(shape) == dimension_of(shape) + 1, wedge = n_corners_of(shape) == 6;
  const auto clamp = [&](Eigen::Vector3d xi) {
    xi = xi.cwiseMax(0.0).cwiseMin(1.0);
    if (dimension_of(shape) == 2) xi[2] = 0.0;
    if (const double sum = xi[0] + xi[1]; wedge && sum > 1.0) xi.head<2>() /= sum;
    if (const double sum = xi.sum(); simplex && sum > 1.0) xi /= sum;
    return xi;
  };
  std::vector<std::pair<double, Eigen::Vector3d>> best;
  const auto sample = [&](const Eigen::Vector3d& centre, double half, int n) {
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= n; ++j) {
        for (int k = 0; k <= (dimension_of(shape) == 3 ? n : 0); ++k) {
          const Eigen::Vector3d xi = clamp(centre + half * (2.0 / n * Eigen::Vector3d(i, j, k) - Eigen::Vector3d::Ones()));
          const ShapeValues s = shape_values(shape, xi);
          best.emplace_back((x * s.N.head(s.n).transpose() - p).norm(), xi);
        }
      }
    }
  };
  const auto keep_best = [&](std::size_t n) {
    std::sort(best.begin(), best.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    best.resize(std::min(n, best.size()));
  };
  sample({0.5, 0.5, 0.5}, 0.5, 16);
  keep_best(20);
  for (double half = 0.06; half > 1e-7; half *= 0.6) {
    for (const auto& [distance, xi] : std::vector(best)) sample(xi, half, 4);
    keep_best(6);
  }
  return best.front().first;
}

class OneBentCell : public ::testing::TestWithParam<CellShape> {};

TEST_P(OneBentCell, NearestPointIsThatOfBruteForceInsideAndOutside) {
  std::mt19937 random(31);
  std::uniform_real_distribution<double> share(-1.0, 3.0);
  int n_outside = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Mesh mesh = one_bent(GetParam(), seed);
    const Cells& cells = dimension_of(GetParam()) == 3 ? mesh.cells : mesh.facets;
    for (int i = 0; i < 15; ++i) {
      const Eigen::Vector3d p(share(random), 0.7 * share(random), 0.6 * share(random));
      const MeshPoint found = nearest_point(mesh, cells, all(cells), p);
      const double sampled_m = sampled_distance_m(mesh, cells, p);
      // The samples come within 1e-7 of the reference cell, and the distance is flat or linear there.
      EXPECT_NEAR(found.distance_m, sampled_m, 3e-6) << "seed " << seed << ", point " << p.transpose();
      EXPECT_NEAR((found.position_m - p).norm(), found.distance_m, 1e-14);
      n_outside += found.distance_m > 0.1;
    }
  }
  EXPECT_GT(n_outside, 20);
}

TEST_P(OneBentCell, PointsOnItHaveTheDistanceZero) {
  std::mt19937 random(32);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const Mesh mesh = one_bent(GetParam(), 9);
  const Cells& cells = dimension_of(GetParam()) == 3 ? mesh.cells : mesh.facets;
  const auto x = cell_coords(mesh, cells.nodes(0));
  for (int i = 0; i < 100; ++i) {
    Eigen::Vector3d xi(share(random), share(random), dimension_of(GetParam()) == 3 ? share(random) : 0.0);
    if (n_corners_of(GetParam()) == dimension_of(GetParam()) + 1 && xi.sum() > 1.0) xi /= 1.001 * xi.sum();
    if (n_corners_of(GetParam()) == 6 && xi[0] + xi[1] > 1.0) xi.head<2>() /= 1.001 * (xi[0] + xi[1]);
    if (i % 3 == 0) xi[0] = 0.0;  // on an edge or face
    const ShapeValues s = shape_values(GetParam(), xi);
    const MeshPoint found = nearest_point(mesh, cells, all(cells), x * s.N.head(s.n).transpose());
    EXPECT_LT(found.distance_m, 1e-9);  // Newton converges quadratically; its stop is a step of 1e-12
    EXPECT_LT((found.xi - xi).norm(), 1e-8);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, OneBentCell,
                         ::testing::Values(CellShape::kTri3, CellShape::kTri6, CellShape::kQuad4, CellShape::kQuad8,
                                           CellShape::kTet4, CellShape::kTet10, CellShape::kHex8, CellShape::kHex20,
                                           CellShape::kWedge6, CellShape::kWedge15));

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
    const Eigen::Vector3d p = cell_coords(mesh, mesh.cells.nodes(any(random))) * s.N.head(10).transpose();
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
}  // namespace driftwright::mesh::locate_test
