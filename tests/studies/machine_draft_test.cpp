// Facts about a machine from its geometry: touching parts, its feet, surfaces in the air.

#include "studies/machine_draft.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/mesh_step.hpp"
#include "mesh/outer_planes.hpp"
#include "studies/machine_draft_text.hpp"
#include "tests/shared/fixtures.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::machine_draft_test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::IsEmpty, ::testing::UnorderedElementsAre;

/// Two boxes as an input file of Abaqus, in mm, of one hexahedron each: a plate of 200 x 100 x 20 mm on the ground, a
/// block of 100 x 100 x 50 mm on one half of it, with separate nodes; and a third box 300 mm away.
constexpr const char* kBoxes = R"(*NODE
1, 0, 0, 0
2, 200, 0, 0
3, 200, 100, 0
4, 0, 100, 0
5, 0, 0, 20
6, 200, 0, 20
7, 200, 100, 20
8, 0, 100, 20
11, 0, 0, 20
12, 100, 0, 20
13, 100, 100, 20
14, 0, 100, 20
15, 0, 0, 70
16, 100, 0, 70
17, 100, 100, 70
18, 0, 100, 70
)";
constexpr const char* kThird = R"(21, 500, 0, 0
22, 600, 0, 0
23, 600, 100, 0
24, 500, 100, 0
25, 500, 0, 50
26, 600, 0, 50
27, 600, 100, 50
28, 500, 100, 50
)";
constexpr const char* kElements = R"(*ELEMENT, TYPE=C3D8, ELSET=plate
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D8, ELSET=spindle
2, 11, 12, 13, 14, 15, 16, 17, 18
)";

mesh::UnnamedGeometry boxes(bool third) {
  const std::string text = std::string(kBoxes) + (third ? kThird : "") + kElements +
                           (third ? "*ELEMENT, TYPE=C3D8, ELSET=third\n3, 21, 22, 23, 24, 25, 26, 27, 28\n" : "");
  return mesh::read_unnamed_geometry(write_file("boxes.inp", text), "");
}

TEST(OuterPlanes, AreTheSidesOfABox) {
  const mesh::Mesh m = boxes(false).mesh;
  const auto facets = mesh::outer_facets(m);
  const auto planes = mesh::outer_planes(m, facets);
  EXPECT_EQ(planes.size(), 12u);
  double area_m2 = 0.0;
  for (const auto& plane : planes) area_m2 += plane.area_m2;
  EXPECT_NEAR(area_m2, 2 * (0.02 + 0.004 + 0.002) + 2 * (0.01 + 0.005 + 0.005), 1e-12);
  const auto contacts = mesh::plane_contacts(m, facets, planes);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(planes[static_cast<std::size_t>(contacts[0].a)].through_m[2], 0.02, 1e-12);
}

TEST(MachineDraft, FindsTheJointAndWhatItStandsOn) {
  const mesh::UnnamedGeometry geometry = boxes(false);
  EXPECT_EQ(geometry.unit, "mm");  // 200 m would be no machine
  const studies::MachineDraft draft = studies::draft_of(geometry);
  ASSERT_EQ(draft.joints.size(), 1u);
  EXPECT_EQ(draft.joints[0].name, "plate/spindle");
  ASSERT_EQ(draft.feet.size(), 1u);
  EXPECT_EQ(draft.feet[0].surface, "feet");
  EXPECT_THAT(draft.remarks, IsEmpty());
  EXPECT_THAT(draft.films, UnorderedElementsAre("plate_rest", "spindle_rest"));
  EXPECT_EQ(draft.spindle, "spindle");
  EXPECT_GT(draft.tool.at_m[2], 0.021);  // on the block, not in the joint
  // 10 W/(m^2 K) x 2 K on all outer faces.
  EXPECT_NEAR(draft.heat_W, 20.0 * (0.052 + 0.04), 1e-9);
}

TEST(MachineDraft, HoldsBodiesThatTouchNothing) {
  const studies::MachineDraft draft = studies::draft_of(boxes(true));
  EXPECT_EQ(draft.feet.size(), 2u);
  ASSERT_EQ(draft.remarks.size(), 1u);  // 300 mm apart: no gap
  EXPECT_THAT(draft.remarks[0], AllOf(HasSubstr("2 bodies that do not touch"), HasSubstr("plate + spindle; third")));
}

TEST(MachineDraft, TellsTheGapThatKeepsPartsApart) {
  std::string text = std::string(kBoxes) + kElements;
  for (int node : {11, 12, 13, 14}) {
    const std::size_t line = text.find(fmt::format("\n{}, ", node)), end = text.find("20\n", line);
    text.replace(end, 2, "21.5");  // mm: the block hangs over the plate
  }
  const studies::MachineDraft draft = studies::draft_of(mesh::read_unnamed_geometry(write_file("apart.inp", text), ""));
  EXPECT_THAT(draft.joints, IsEmpty());
  ASSERT_EQ(draft.remarks.size(), 2u);
  EXPECT_THAT(draft.remarks[1], HasSubstr("'plate' and 'spindle' face each other across a gap of 1.5 mm"));
}

TEST(MachineDraft, MeshSizesFollowThickness) {
  // A cube of 0.3 m and a plate of 0.3 x 0.3 x 0.03 m: half of the edge (V/A = a/6), and a little over the thickness (V/A
  // = 0.0125 m).
  const std::vector<double> sizes_m = mesh::suggested_mesh_sizes_m({{0.027, 0.54}, {0.0027, 0.216}});
  EXPECT_NEAR(sizes_m[0], 0.15, 1e-12);
  EXPECT_NEAR(sizes_m[1], 0.0375, 1e-12);
  // 1000 such plates would be too many cells: all are coarser by one factor, and the count is the bound.
  const std::vector<mesh::PartExtent> many(1000, {0.0027, 0.216});
  const double coarse_m = mesh::suggested_mesh_sizes_m(many).front();
  EXPECT_NEAR(1000 * 8.5 * 0.0027 / (coarse_m * coarse_m * coarse_m), 15000, 1);
}

TEST(MachineDraft, WritesNamesThatYamlTakes) {
  mesh::UnnamedGeometry geometry = boxes(false);
  geometry.mesh.regions = {"Plate \"A\": 20 mm", "Spindle #2"};
  const std::string text = studies::scenario_text(studies::draft_of(geometry), geometry, "odd", "boxes.inp");
  EXPECT_THAT(text, HasSubstr("\"Plate \\\"A\\\": 20 mm\": cast_iron_gjl250"));
  EXPECT_THAT(text, HasSubstr("t_Spindle__2"));
}

}  // namespace
}  // namespace driftwright::machine_draft_test
