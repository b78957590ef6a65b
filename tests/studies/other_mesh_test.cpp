// A second mesh of every machine that has a mesh size, and the twin that it gives `diagnose`.

#include "studies/other_mesh.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gmsh.h>

#include <cmath>

#include "mesh/gmsh_parts.hpp"
#include "studies/measured_twin.hpp"
#include "tests/shared/column_and_head.hpp"
#include "tests/shared/small_table.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::studies::other_mesh_test {
namespace {

[[maybe_unused]] const bool kOwnStore =
    ::setenv("XDG_CACHE_HOME", temporary_folder().c_str(), 1) == 0;  // none kept from an earlier run

using scenarios::MeshRecipe;
using ::testing::HasSubstr;

/// Nodes of a recipe's own mesh over those of the other, whose cells are `size` times as large.
double n_nodes_ratio(const MeshRecipe& recipe, double size) {
  const studies::OtherMesh other = studies::other_mesh(recipe, size);
  EXPECT_EQ(other.why_none, "");
  return static_cast<double>(scenarios::build_mesh(recipe).n_nodes()) /
         scenarios::build_mesh(other.recipe.value()).n_nodes();
}

MeshRecipe shipped(const std::string& scenario) {
  return scenarios::read_scenario("scenarios/" + scenario).machine->mesh;
}

std::string two_boxes_drawn() {
  const std::string path = (temporary_folder() / "boxes.step").string();
  const mesh::GmshSession session;
  gmsh::model::occ::addBox(0, 0, 0, 100, 60, 40);
  gmsh::model::occ::addBox(0, 0, 40, 50, 60, 30);
  gmsh::model::occ::synchronize();
  gmsh::write(path);
  return path;
}

// size^3 where cells fill the volume; thin walls and small parts keep their nodes whatever the size.
TEST(OtherMesh, OfEveryRecipeWithASizeHasAnotherNumberOfNodes) {
  const MeshRecipe mill = studies::other_mesh(shipped("fp3_spindle.yaml"), 2.0).recipe.value();  // quick to mesh
  mesh::ImportedMesh drawing;
  drawing.path = two_boxes_drawn();
  drawing.mesh_size_m = 0.012;
  drawing.mesh_size_of_region_m = {{"head", 0.008}};
  drawing.region_points = {{"column", {0.09, 0.03, 0.02}, {}}, {"head", {0.02, 0.03, 0.06}, {}}};
  const MeshRecipe table = shipped("gantry_table.yaml");
  for (const auto& [name, recipe] : {std::pair{"mill", mill}, {"table", table}, {"drawing", MeshRecipe{drawing}}}) {
    const double ratio = n_nodes_ratio(recipe, 1.4);
    RecordProperty(name, fmt::format("{:.3f}", ratio));
    EXPECT_GT(ratio, 1.2) << name;
    EXPECT_LT(ratio, 1.4 * 1.4 * 1.4) << name;
    EXPECT_LT(n_nodes_ratio(recipe, 0.85), 0.9) << name;
  }
}

TEST(OtherMesh, KeepsAllElse) {
  mesh::GantryTable table = std::get<mesh::GantryTable>(shipped("gantry_table.yaml"));
  const auto other = std::get<mesh::GantryTable>(studies::other_mesh(table, 1.25).recipe.value());
  EXPECT_DOUBLE_EQ(other.mesh_size_m, 0.5);  // 400 mm as written
  EXPECT_EQ(other.table.length_m, table.table.length_m);
  EXPECT_EQ(other.element_order, table.element_order);
  mesh::ImportedMesh drawing;
  drawing.path = "a.step";
  drawing.mesh_size_m = 0.02;
  drawing.mesh_size_of_region_m = {{"shaft", 0.01}};
  const auto redrawn = std::get<mesh::ImportedMesh>(studies::other_mesh(drawing, 1.25).recipe.value());
  EXPECT_DOUBLE_EQ(redrawn.mesh_size_m, 0.025);
  EXPECT_DOUBLE_EQ(redrawn.mesh_size_of_region_m.at("shaft"), 0.0125);
}

TEST(OtherMesh, IsNoneWhereThereIsNoSizeAndTheReasonIsSaid) {
  const studies::OtherMesh lumped = studies::other_mesh(scenarios::LumpedMachine{}, 1.4);
  EXPECT_FALSE(lumped.recipe);
  EXPECT_THAT(lumped.why_none, HasSubstr("lumped"));
  for (const char* file : {"a.msh", "a.inp", "a.vtu"}) {
    mesh::ImportedMesh given;
    given.path = file;
    const studies::OtherMesh other = studies::other_mesh(given, 1.4);
    EXPECT_FALSE(other.recipe) << file;
    EXPECT_THAT(other.why_none, HasSubstr("node by node")) << file;
  }
}

const std::string kTable =
    fixtures::small_table("300 mm") + R"(  - {type: heat_source, region: table, power: 50 W, at_speed: 1 rpm, exponent: 0}
ambient: [[0 min, 20 degC]]
sensors:
  - {name: mid, region: table, at: [0 m, 0 m, 0 m]}
  - {name: low, region: bed, at: [-1 m, 0 m, -400 mm]}
cyclograms: {rest: [[6 h, 0 rpm]]}
solver: {model: reduced}
)";

std::string record() {
  std::string text = "time_min,speed_rpm,ambient_degC,mid_degC,low_degC\n";
  for (int i = 0; i <= 72; ++i) {
    const double noise_K = 0.01 * std::sin(37.0 * i * i);
    text += fmt::format("{},0,20,{:.4f},{:.4f}\n", 5 * i, 20.0 + 0.004 * i + noise_K, 20.0 + 0.001 * i - noise_K);
  }
  return write_file("measured.csv", text);
}

TEST(MeasuredTwin, OfAGantryTableHasASecondMesh) {
  const auto scenario = scenarios::read_scenario(write_file("table.yaml", kTable));
  const studies::MeasuredTwin m = studies::open_measured_twin(scenario, "diagnose", {record()}, {});
  ASSERT_TRUE(m.on_other_mesh);
  EXPECT_EQ(studies::one_mesh_text(m), "");
  EXPECT_NEAR(m.how.mesh_error_share, 1.0 / (1.4 * 1.4 - 1.0), 1e-12);
  EXPECT_NE(m.other->machine.n_unknowns, m.fine->machine.n_unknowns);
  RecordProperty("n_unknowns", fmt::format("{} {}", m.fine->machine.n_unknowns, m.other->machine.n_unknowns));
}

TEST(MeasuredTwin, OfAMeshFromAFileSaysThatThereIsNoSecondOne) {
  fixtures::ColumnAndHead machine;
  const auto scenario = scenarios::read_scenario(fixtures::write_column_and_head(fresh_folder("given"), machine));
  studies::MeasuredTwin m;
  m.mesh = scenarios::build_mesh(scenario.machine->mesh);
  m.why_one_mesh = studies::other_mesh(scenario.machine->mesh, 1.4).why_none;
  EXPECT_THAT(studies::one_mesh_text(m), HasSubstr("node by node"));
  EXPECT_THAT(studies::one_mesh_text(m), HasSubstr("can pass for a cause"));
}

}  // namespace
}  // namespace driftwright::studies::other_mesh_test
