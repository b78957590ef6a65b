// The guide on which a body slides, and bodies moved on it.

#include "mesh/joint_sides.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh/quality.hpp"
#include "tests/shared/fixtures.hpp"

namespace driftwright::joint_sides_test {
namespace {

using mesh::CellShape, mesh::Mesh;

/// A bed of 8 x 4 bricks of 0.1 m x 0.05 m and a table of 2 x 2 on its first corner. Their joint is the area in which they
/// touch, as drawings are meshed.
Mesh slide() {
  Mesh mesh;
  fixtures::add_box(mesh, {{0.0, 0.0, 0.0}, {0.8, 0.2, 0.1}, {8, 4, 1}, CellShape::kHex8}, "bed", "bed.");
  fixtures::add_box(mesh, {{0.0, 0.0, 0.1}, {0.2, 0.1, 0.1}, {2, 2, 1}, CellShape::kHex8}, "table", "table.");
  mesh.joints.push_back({"bed/table", "bed/table@bed", "bed/table@table"});
  for (const auto& [side, of] : {std::pair{"bed/table@bed", "bed.z1"}, std::pair{"bed/table@table", "table.z0"}}) {
    mesh.surfaces.emplace_back(side);
    const int surface = mesh.surface(side);
    for (const int f : mesh.facets_on(mesh.surface(of))) {
      const std::vector<int> nodes(mesh.facets.nodes(f).begin(), mesh.facets.nodes(f).end());
      Eigen::Vector3d centre = Eigen::Vector3d::Zero();
      for (const int n : nodes) centre += mesh.coords.col(n) / static_cast<double>(nodes.size());
      if (centre.x() < 0.2 && centre.y() < 0.1) mesh.facets.add(mesh.facets.shape[f], nodes, surface);
    }
  }
  return mesh;
}

TEST(ContinuedSides, AreTheStripOfTheGuideThatTheBodySlidesOn) {
  Mesh mesh = slide();
  const int bed = mesh.surface("bed/table@bed"), table = mesh.surface("bed/table@table");
  ASSERT_NEAR(mesh::area_m2(mesh, bed), 0.2 * 0.1, 1e-12);
  mesh::continue_sides(mesh, mesh.joints[0], mesh::described_outer_faces(mesh), {.direction = Eigen::Vector3d::UnitX()});
  EXPECT_NEAR(mesh::area_m2(mesh, bed), 0.8 * 0.1, 1e-12);                     // the whole length, no wider than the table
  EXPECT_NEAR(mesh::area_m2(mesh, table), 0.2 * 0.1, 1e-12);                   // all of its underside was in the joint
  EXPECT_NEAR(mesh::area_m2(mesh, mesh.surface("bed.z1")), 0.8 * 0.2, 1e-12);  // the named surface stays
  mesh::continue_sides(mesh, mesh.joints[0], mesh::described_outer_faces(mesh), {.direction = Eigen::Vector3d::UnitY()});
  EXPECT_NEAR(mesh::area_m2(mesh, bed), 0.8 * 0.2, 1e-12);
}

TEST(ContinuedSides, StayWhereTheDirectionCrossesThem) {
  Mesh mesh = slide();
  mesh::continue_sides(mesh, mesh.joints[0], mesh::described_outer_faces(mesh), {.direction = Eigen::Vector3d::UnitZ()});
  EXPECT_NEAR(mesh::area_m2(mesh, mesh.surface("bed/table@bed")), 0.2 * 0.1, 1e-12);
}

/// A base of 8 x 8 bricks of 0.4 m and a table of 4 x 4 of 0.2 m on its middle, the joint where they touch.
Mesh turntable() {
  Mesh mesh;
  fixtures::add_box(mesh, {{-0.2, -0.2, 0.0}, {0.4, 0.4, 0.1}, {8, 8, 1}, CellShape::kHex8}, "base", "base.");
  fixtures::add_box(mesh, {{-0.1, -0.1, 0.1}, {0.2, 0.2, 0.1}, {4, 4, 1}, CellShape::kHex8}, "table", "table.");
  mesh.joints.push_back({"base/table", "base/table@base", "table.z0"});
  mesh.surfaces.emplace_back("base/table@base");
  for (const int f : mesh.facets_on(mesh.surface("base.z1"))) {
    const std::vector<int> nodes(mesh.facets.nodes(f).begin(), mesh.facets.nodes(f).end());
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const int n : nodes) centre += mesh.coords.col(n) / static_cast<double>(nodes.size());
    if (centre.head<2>().cwiseAbs().maxCoeff() < 0.1)
      mesh.facets.add(mesh.facets.shape[f], nodes, mesh.surface("base/table@base"));
  }
  return mesh;
}

TEST(ContinuedSides, AreTheRingThatTheCornersOfATurningBodySweep) {
  // Corners of the table are 0.1414 m from the axis; with a twentieth of the strip of a facet at the corner, 0.0707 m, 0.145
  // m. Centres of the base's facets within that are those at 0.125 m and 0.025 m from the middle lines (0.1275 m); those at
  // 0.125 m and 0.075 m (0.1458 m) are not.
  Mesh mesh = turntable();
  const int base = mesh.surface("base/table@base");
  const std::vector<mesh::DescribedFacet> outer = mesh::described_outer_faces(mesh);
  ASSERT_NEAR(mesh::area_m2(mesh, base), 0.04, 1e-12);
  mesh::continue_sides(mesh, mesh.joints[0], outer, {.direction = Eigen::Vector3d::UnitZ(), .turns = true});
  EXPECT_NEAR(mesh::area_m2(mesh, base), 0.04 + 8 * 0.05 * 0.05, 1e-12);
  EXPECT_NEAR(mesh::area_m2(mesh, mesh.surface("table.z0")), 0.04, 1e-12);  // all of its underside was in the joint
}

TEST(ContinuedSides, OfAShaftAreItsWholeCircumference) {
  // A quarter of a sleeve's inner side was drawn in contact: turning brings all of it there, and none of the end faces.
  Mesh mesh;
  fixtures::add_box(mesh, {{0.05, 0.0, 0.0}, {0.02, 1.0, 0.1}, {1, 32, 2}, CellShape::kHex8}, "sleeve", "s.");
  fixtures::map_nodes(mesh, [](const Eigen::Vector3d& x) {
    const double angle = x[1] * 2.0 * std::numbers::pi;
    return Eigen::Vector3d(0.3 + x[0] * std::cos(angle), x[0] * std::sin(angle), x[2]);
  });
  fixtures::merge_nodes(mesh);
  mesh.joints.push_back({"j", "quarter", "quarter"});
  mesh.surfaces.emplace_back("quarter");
  for (const int f : mesh.facets_on(mesh.surface("s.x0"))) {
    const std::vector<int> nodes(mesh.facets.nodes(f).begin(), mesh.facets.nodes(f).end());
    if (std::all_of(nodes.begin(), nodes.end(),
                    [&](int n) { return mesh.coords(0, n) > 0.3 - 1e-9 && mesh.coords(1, n) > -1e-9; }))
      mesh.facets.add(mesh.facets.shape[f], nodes, mesh.surface("quarter"));
  }
  const double whole_m2 = mesh::area_m2(mesh, mesh.surface("s.x0"));
  ASSERT_NEAR(mesh::area_m2(mesh, mesh.surface("quarter")), whole_m2 / 4, 1e-9);
  mesh.joints[0].side_b = "s.z0";  // crosses nothing that the quarter continues
  const std::vector<mesh::DescribedFacet> outer = mesh::described_outer_faces(mesh);
  mesh::continue_sides(mesh, mesh.joints[0], outer,
                       {.direction = Eigen::Vector3d::UnitZ(), .turns = true, .through_m = {0.3, 0.0, 0.0}});
  EXPECT_NEAR(mesh::area_m2(mesh, mesh.surface("quarter")), whole_m2, 1e-9);
}

TEST(Ways, TurnRightHandedAboutTheirPoint) {
  const mesh::Way way{.direction = Eigen::Vector3d::UnitZ(), .turns = true, .through_m = {1.0, 0.0, 5.0}};
  const mesh::Motion quarter = way.by(0.5 * std::numbers::pi);
  EXPECT_LT((quarter({2.0, 0.0, 7.0}) - Eigen::Vector3d(1.0, 1.0, 7.0)).norm(), 1e-15);
  EXPECT_LT((quarter.before({1.0, 1.0, 7.0}) - Eigen::Vector3d(2.0, 0.0, 7.0)).norm(), 1e-15);
  EXPECT_LT((way.along({1.0, 3.0, 0.0}) - Eigen::Vector3d(-1.0, 0.0, 0.0)).norm(), 1e-15);
  EXPECT_EQ(way.along({1.0, 0.0, 0.0}), Eigen::Vector3d::Zero().eval());
  EXPECT_TRUE(way.by(0.0) == mesh::Motion{});
  // A slide on a body that has turned: first along x, then both by a quarter, which is along y.
  const mesh::Way slide{.direction = Eigen::Vector3d::UnitX()};
  EXPECT_LT((slide.moved(quarter).direction - Eigen::Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_LT((quarter.after(slide.by(0.5))({1.5, 0.0, 0.0}) - Eigen::Vector3d(1.0, 1.0, 0.0)).norm(), 1e-15);
}

TEST(MovedRegions, MoveTheirNodesAlone) {
  Mesh mesh = slide();
  const Eigen::Matrix3Xd before = mesh.coords;
  ASSERT_FALSE(mesh::move_regions(mesh, {mesh::Motion{}, {.shift_m = {0.3, 0.0, 0.0}}}));
  const Eigen::Index n_bed = 9 * 5 * 2;
  EXPECT_EQ(mesh.coords.leftCols(n_bed), before.leftCols(n_bed));
  const Eigen::Matrix3Xd moved = mesh.coords.rightCols(9 * 2) - before.rightCols(9 * 2);
  EXPECT_LT((moved.colwise() - Eigen::Vector3d(0.3, 0.0, 0.0)).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(MovedRegions, AreNotTornWhereTheyShareNodes) {
  Mesh mesh = slide();
  fixtures::add_box(mesh, {{0.0, 0.0, 0.2}, {0.2, 0.1, 0.1}, {2, 2, 1}, CellShape::kHex8}, "work", "work.");
  fixtures::merge_nodes(mesh);
  const Eigen::Matrix3Xd before = mesh.coords;
  EXPECT_TRUE(mesh::move_regions(mesh, {mesh::Motion{}, mesh::Motion{}, {.shift_m = {0.3, 0.0, 0.0}}}));
  EXPECT_EQ(mesh.coords, before);
}

}  // namespace
}  // namespace driftwright::joint_sides_test
