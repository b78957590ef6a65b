// Planes and cylinders found in meshes, against bodies whose faces are known; picks as a scenario writes them.

#include "mesh/pickable_faces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "mesh/fit_cylinder.hpp"
#include "mesh/pick_surfaces.hpp"
#include "mesh/quality.hpp"
#include "tests/shared/column_and_head.hpp"
#include "tests/shared/curved_bodies.hpp"

namespace driftwright::mesh::pickable_faces_test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Each outer face is in exactly one, and every pick gives, as a surface of the mesh, the area that was said.
void expect_whole(Mesh m, const std::vector<PickableFace>& faces) {
  std::vector<int> seen(described_outer_faces(m).size(), 0);
  std::vector<SurfacePick> picks;
  std::vector<double> area;
  for (const PickableFace& face : faces) {
    for (int f : face.facets) ++seen[static_cast<std::size_t>(f)];
    if (!face.pick) continue;
    SurfacePick pick{"pick_" + std::to_string(picks.size()), m.regions[static_cast<std::size_t>(face.region)], {}, {}};
    std::visit([&](const auto& kind) { pick.pick = kind; }, *face.pick);
    picks.push_back(pick);
    area.push_back(face.area_m2);
  }
  EXPECT_THAT(seen, ::testing::Each(1));
  pick_surfaces(m, picks);
  for (std::size_t i = 0; i < picks.size(); ++i)
    EXPECT_NEAR(area_m2(m, m.surface(picks[i].name)), area[i], 1e-12) << picks[i].name;
}

const CylinderPick* cylinder_of(const PickableFace& face) {
  return face.pick ? std::get_if<CylinderPick>(&*face.pick) : nullptr;
}

TEST(PickableFaces, OfABoxAreItsSixSides) {
  const Mesh m = fixtures::box_mesh({{0, 0, 0}, {0.1, 0.06, 0.04}, {3, 2, 2}, CellShape::kTet10});
  const auto faces = pickable_faces(m);
  ASSERT_EQ(faces.size(), 6U);
  double sum_m2 = 0.0;
  for (const PickableFace& face : faces) {
    ASSERT_TRUE(face.pick && std::holds_alternative<PlanePick>(*face.pick));
    const auto& plane = std::get<PlanePick>(*face.pick);
    EXPECT_NEAR(plane.normal.cwiseAbs().maxCoeff(), 1.0, 1e-12);
    sum_m2 += face.area_m2;
  }
  EXPECT_NEAR(sum_m2, 2 * (0.1 * 0.06 + 0.1 * 0.04 + 0.06 * 0.04), 1e-12);
  expect_whole(m, faces);
}

TEST(PickableFaces, OfATurnedBoxKeepTheirFacetsInFewDigits) {
  Mesh m = fixtures::box_mesh({{0, 0, 0}, {0.1, 0.06, 0.04}, {3, 2, 2}, CellShape::kHex20});
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  fixtures::map_nodes(m, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return turn * x + Eigen::Vector3d(3, -2, 1); });
  const auto faces = pickable_faces(m);
  ASSERT_EQ(faces.size(), 6U);
  expect_whole(m, faces);
}

TEST(PickableFaces, OfTwoPartsAreOfTheirRegions) {
  const Mesh m = fixtures::column_and_head();
  const auto faces = pickable_faces(m);
  ASSERT_EQ(faces.size(), 12U);
  for (std::size_t i = 0; i < faces.size(); ++i) EXPECT_EQ(faces[i].region, i < 6 ? 0 : 1);
  expect_whole(m, faces);
}

/// A quarter of a pipe: two cylinders and four planes.
void expect_quarter_ring(CellShape shape, double area_tolerance) {
  Mesh m;
  fixtures::add_quarter_ring(m, 0.03, 0.05, 0.1, 2, 8, 3, shape, "pipe", "p.");
  const Eigen::Vector3d shift(0.2, 0.1, 0.0);
  fixtures::map_nodes(m, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return x + shift; });
  const auto faces = pickable_faces(m);
  int n_planes = 0;
  std::vector<double> diameters_m;
  for (const PickableFace& face : faces) {
    ASSERT_TRUE(face.pick);
    const CylinderPick* cylinder = cylinder_of(face);
    if (!cylinder) {
      ++n_planes;
      continue;
    }
    diameters_m.push_back(cylinder->diameter_m);
    EXPECT_LT((cylinder->axis - Eigen::Vector3d::UnitZ()).norm(), 1e-6);
    EXPECT_LT((cylinder->through_m - shift).head<2>().norm(), 1e-7);
    const double exact_m2 = 0.25 * kPi * cylinder->diameter_m * 0.1;
    EXPECT_NEAR(face.area_m2, exact_m2, area_tolerance * exact_m2);
  }
  EXPECT_EQ(n_planes, 4);
  EXPECT_THAT(diameters_m,
              ::testing::UnorderedElementsAre(::testing::DoubleNear(0.06, 1e-7), ::testing::DoubleNear(0.1, 1e-7)));
  expect_whole(m, faces);
}

TEST(PickableFaces, OfAPipeAreCylindersWithCurvedEdges) {
  expect_quarter_ring(CellShape::kHex20, 1e-4);
  expect_quarter_ring(CellShape::kTet10, 1e-3);
}

// Straight edges: chords of 11.25 degrees, whose length is sin(x)/x of the arc with x = 5.6 degrees, 0.2 % less.
TEST(PickableFaces, OfAPipeAreCylindersWithStraightEdges) {
  expect_quarter_ring(CellShape::kHex8, 2e-3);
}

TEST(PickableFaces, OfABallHaveNoPickWhereItIsRound) {
  Mesh m;
  fixtures::add_eighth_of_ball(m, 0.05, 3, CellShape::kHex20, "ball", "b.");
  double round_m2 = 0.0;
  const auto faces = pickable_faces(m);
  for (const PickableFace& face : faces) {
    EXPECT_EQ(cylinder_of(face), nullptr);
    if (!face.pick &&
        (m.coords.col(described_outer_faces(m)[static_cast<std::size_t>(face.facets.front())].nodes[0]).norm() > 0.049))
      round_m2 += face.area_m2;
  }
  EXPECT_NEAR(round_m2, 4 * kPi * 0.05 * 0.05 / 8, 2e-3 * 4 * kPi * 0.05 * 0.05 / 8);
  expect_whole(m, faces);
}

TEST(PickableFaces, OfNothingAreNone) {
  EXPECT_TRUE(pickable_faces(Mesh{}).empty());
}

TEST(FitCylinder, FindsATiltedOneToRounding) {
  const Eigen::Vector3d axis = Eigen::Vector3d(0.3, -0.2, 0.9).normalized(), u = axis.unitOrthogonal(), v = axis.cross(u),
                        through_m(0.4, 0.1, -0.2);
  Eigen::Matrix3Xd points_m(3, 30), normals(3, 30);
  for (int i = 0; i < 30; ++i) {  // a sector of 100 degrees, on a helix
    const double angle = 1.75 * i / 29.0;
    normals.col(i) = std::cos(angle) * u + std::sin(angle) * v;
    points_m.col(i) = through_m + 0.025 * normals.col(i) + 0.01 * (i % 4) * axis;
  }
  const auto fitted = fit_cylinder(points_m, normals);
  ASSERT_TRUE(fitted);
  EXPECT_NEAR(fitted->radius_m, 0.025, 1e-10);
  EXPECT_LT((fitted->axis - axis).norm(), 1e-8);
  const Eigen::Vector3d off_m = fitted->through_m - through_m;
  EXPECT_LT((off_m - axis * axis.dot(off_m)).norm(), 1e-9);
  EXPECT_LT(fitted->largest_error_m, 1e-10);
}

TEST(FitCylinder, NeedsSixPoints) {
  EXPECT_FALSE(fit_cylinder(Eigen::Matrix3Xd::Random(3, 5), Eigen::Matrix3Xd::Random(3, 5)));
  EXPECT_FALSE(fit_cylinder(Eigen::Matrix3Xd::Zero(3, 8), Eigen::Matrix3Xd::Random(3, 8)));
}

}  // namespace
}  // namespace driftwright::mesh::pickable_faces_test
