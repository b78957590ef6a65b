// The guide on which a body slides, and bodies moved on it.

#include "mesh/joint_sides.hpp"

#include <gtest/gtest.h>

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
  mesh::continue_sides(mesh, mesh.joints[0], mesh::described_outer_faces(mesh), Eigen::Vector3d::UnitX());
  EXPECT_NEAR(mesh::area_m2(mesh, bed), 0.8 * 0.1, 1e-12);                     // the whole length, no wider than the table
  EXPECT_NEAR(mesh::area_m2(mesh, table), 0.2 * 0.1, 1e-12);                   // all of its underside was in the joint
  EXPECT_NEAR(mesh::area_m2(mesh, mesh.surface("bed.z1")), 0.8 * 0.2, 1e-12);  // the named surface stays
  mesh::continue_sides(mesh, mesh.joints[0], mesh::described_outer_faces(mesh), Eigen::Vector3d::UnitY());
  EXPECT_NEAR(mesh::area_m2(mesh, bed), 0.8 * 0.2, 1e-12);
}

TEST(ContinuedSides, StayWhereTheDirectionCrossesThem) {
  Mesh mesh = slide();
  mesh::continue_sides(mesh, mesh.joints[0], mesh::described_outer_faces(mesh), Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(mesh::area_m2(mesh, mesh.surface("bed/table@bed")), 0.2 * 0.1, 1e-12);
}

TEST(MovedRegions, MoveTheirNodesAlone) {
  Mesh mesh = slide();
  const Eigen::Matrix3Xd before = mesh.coords;
  ASSERT_FALSE(mesh::move_regions(mesh, {Eigen::Vector3d::Zero(), {0.3, 0.0, 0.0}}));
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
  const Eigen::Vector3d still = Eigen::Vector3d::Zero();
  EXPECT_TRUE(mesh::move_regions(mesh, {still, still, {0.3, 0.0, 0.0}}));
  EXPECT_EQ(mesh.coords, before);
}

}  // namespace
}  // namespace driftwright::joint_sides_test
