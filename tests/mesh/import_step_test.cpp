// Drawings as STEP against closed forms of what is drawn.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gmsh.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/file_bytes.hpp"
#include "mesh/gmsh_parts.hpp"
#include "mesh/step_unit.hpp"
#include "mesh/unnamed_geometry.hpp"
#include "tests/mesh/imported.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::mesh::import_step_test {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

template <class Draw>
std::string write_step(const std::string& name, Draw draw, const std::string& unit = "MM") {
  const GmshSession session;
  gmsh::option::setString("Geometry.OCCTargetUnit", unit);
  draw();
  gmsh::model::occ::synchronize();
  gmsh::write(path_of(name));
  return path_of(name);
}

TEST(StepFile, OfTwoTouchingBoxesHasTheirVolumesAndTheJoint) {
  ImportedMesh r = recipe(write_step("boxes.step",
                                     [] {
                                       gmsh::model::occ::addBox(0, 0, 0, 100, 60, 40);  // mm, Gmsh's unit of STEP files
                                       gmsh::model::occ::addBox(0, 0, 40, 50, 60, 30);
                                     }),
                          0.0);
  r.mesh_size_m = 0.03;
  r.region_points = {{"column", {0.09, 0.03, 0.02}, {}}, {"head", {0.02, 0.03, 0.06}, {}}};
  r.surfaces = {{"foot", "column", PlanePick{{0, 0, 0}, {0, 0, -1}}, {}}, {"rest", "", RemainingPick{}, {}}};
  const Mesh m = import_mesh(r);
  EXPECT_NEAR(volume(m, "column"), 0.1 * 0.06 * 0.04, 1e-12);
  EXPECT_NEAR(volume(m, "head"), 0.05 * 0.06 * 0.03, 1e-12);
  ASSERT_NE(m.joint("column/head"), nullptr);
  EXPECT_NEAR(area(m, m.joint("column/head")->side_a), 0.05 * 0.06, 1e-12);
  EXPECT_NEAR(area(m, "foot"), 0.1 * 0.06, 1e-12);
  const double column_m2 = 2 * (0.1 * 0.06 + 0.1 * 0.04 + 0.06 * 0.04),
               head_m2 = 2 * (0.05 * 0.06 + 0.05 * 0.03 + 0.06 * 0.03);
  EXPECT_NEAR(area(m, "rest"), column_m2 + head_m2 - 2 * 0.05 * 0.06 - 0.1 * 0.06, 1e-12);
  EXPECT_THAT(m.cells.shape, ::testing::Each(CellShape::kTet10));

  r.region_points[1].at_m = {1, 1, 1};
  EXPECT_REFUSED(import_mesh(r), "'head' lies in 0 solids");
  r.region_points.pop_back();
  r.surfaces.clear();
  EXPECT_THAT(import_mesh(r).regions, UnorderedElementsAre("column", HasSubstr("Open CASCADE")));  // as the file calls it
}

TEST(StepFile, OfACylinderInASleeveHasTheCurvedJointAndBore) {
  using std::numbers::pi;
  ImportedMesh r = recipe(write_step("sleeve.stp",
                                     [] {
                                       namespace occ = gmsh::model::occ;
                                       occ::addCylinder(0, 0, -10, 0, 0, 120, 20);
                                       gmsh::vectorpair out;
                                       std::vector<gmsh::vectorpair> map;
                                       occ::cut({{3, occ::addCylinder(0, 0, 0, 0, 0, 100, 40)}},
                                                {{3, occ::addCylinder(0, 0, 0, 0, 0, 100, 20)}}, out, map);
                                     }),
                          0.0);
  r.mesh_size_m = 0.015;
  r.mesh_size_of_region_m = {{"shaft", 0.01}};
  r.region_points = {{"shaft", {0, 0, 0.05}, {}}, {"sleeve", {0.03, 0, 0.05}, {}}};
  r.surfaces = {{"outside", "sleeve", CylinderPick{{0, 0, 0}, {0, 0, 1}, 0.08}, {}},
                {"end", "shaft", PlanePick{{0, 0, 0.11}, {0, 0, 1}}, {}}};
  const Mesh m = import_mesh(r);
  // Quadratic edges of 0.01 m on a radius of 0.02 m: sagitta of the parabola's error (l/r)^4/... below 2e-3 in all.
  EXPECT_NEAR(volume(m, "shaft"), pi * 0.02 * 0.02 * 0.12, 2e-3 * pi * 0.02 * 0.02 * 0.12);
  EXPECT_NEAR(volume(m, "sleeve"), pi * (0.0016 - 0.0004) * 0.1, 2e-3 * pi * 0.0012 * 0.1);
  ASSERT_NE(m.joint("shaft/sleeve"), nullptr);
  EXPECT_NEAR(area(m, m.joint("shaft/sleeve")->side_a), pi * 0.04 * 0.1, 2e-3 * pi * 0.004);
  EXPECT_NEAR(area(m, m.joint("shaft/sleeve")->side_b), pi * 0.04 * 0.1, 2e-3 * pi * 0.004);
  EXPECT_NEAR(area(m, "outside"), pi * 0.08 * 0.1, 2e-3 * pi * 0.008);
  EXPECT_NEAR(area(m, "end"), pi * 0.0004, 2e-3 * pi * 0.0004);
}

TEST(StepFile, SaysItsUnitUnlessTheScenarioKnowsBetter) {
  const auto box = [] { gmsh::model::occ::addBox(0, 0, 0, 0.1, 0.06, 0.04); };
  // Gmsh writes millimetres; the same numbers under other units.
  const std::string in_mm = read_bytes(write_step("box_MM.step", box)), milli = "SI_UNIT(.MILLI.,.METRE.)";
  for (const auto& [unit, word, metres] : {std::tuple{"MM", ".MILLI.", 1e-3}, {"CM", ".CENTI.", 1e-2}, {"M", "$", 1.0}}) {
    std::string text = in_mm;
    for (std::size_t at = 0; (at = text.find(milli, at)) != std::string::npos; ++at)
      text.replace(at, milli.size(), fmt::format("SI_UNIT({},.METRE.)", word));
    ImportedMesh r = recipe(write_file(fmt::format("box_{}.step", unit), text), 0.0);
    r.mesh_size_m = 0.04 * metres;
    r.region_points = {{"box", {0.05 * metres, 0.03 * metres, 0.02 * metres}, {}}};
    EXPECT_NEAR(unit_of_step_m(r.path), metres, 1e-15) << unit;
    EXPECT_NEAR(volume(import_mesh(r), "box"), 0.1 * 0.06 * 0.04 * std::pow(metres, 3), 1e-9 * std::pow(metres, 3)) << unit;
    r.unit_m = 1.0;
    r.mesh_size_m = 0.04;
    r.region_points = {{"box", {0.05, 0.03, 0.02}, {}}};
    EXPECT_NEAR(volume(import_mesh(r), "box"), 0.1 * 0.06 * 0.04, 1e-9) << unit;
  }
  const UnnamedGeometry drawn_in_m = read_unnamed_geometry(path_of("box_MM.step"), "");
  EXPECT_EQ(drawn_in_m.unit, "m");
  EXPECT_TRUE(drawn_in_m.unit_is_a_guess);
  EXPECT_NEAR(drawn_in_m.mesh.coords.row(0).maxCoeff(), 0.1, 1e-12);
  EXPECT_NEAR(read_unnamed_geometry(path_of("box_MM.step"), "mm").mesh.coords.row(0).maxCoeff(), 1e-4, 1e-12);
  EXPECT_EQ(read_unnamed_geometry(path_of("box_M.step"), "").unit, "");
}

TEST(StepFile, ThatIsNoneIsRefused) {
  ImportedMesh r = recipe(write_file("no.step", "this is no drawing\n"), 0.0);
  r.mesh_size_m = 0.01;
  EXPECT_REFUSED(import_mesh(r), "no.step");
}

}  // namespace
}  // namespace driftwright::mesh::import_step_test
