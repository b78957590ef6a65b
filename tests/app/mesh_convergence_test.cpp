// `mesh --convergence`: three meshes of a small machine and what is written of them; machines that cannot be refined.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/record.hpp"
#include "tests/shared/column_and_head.hpp"
#include "tests/shared/command_line.hpp"
#include "tests/shared/small_table.hpp"

namespace driftwright::mesh_convergence_test {
namespace {

using Json = nlohmann::json;
using ::testing::AllOf, ::testing::HasSubstr;

const std::string kTable = fixtures::small_table("400 mm") +
                           R"(  - {type: heat_source, surface: table_low_x, power: 500 W, at_speed: 1 rpm, exponent: 0}
ambient: 20 degC
sensors: [{name: mid, region: table, at: [0 m, 0 m, 0 m]}]
displacements: [{name: bow, along: z, tool: {region: table, at: [900 mm, 0 m, 0 m]}, table: {region: bed, at: [0 m, 0 m, -600 mm]}}]
cyclograms: {heat: [[2 h, 1 rpm]], short: [[1 h, 1 rpm]]}
solver: {model: full, output_interval: 60 min}
)";

TEST(MeshConvergence, OfASmallMachineHasThreeSizesAndTheScenariosOwnResult) {
  const std::filesystem::path folder = fresh_folder("mesh_convergence");
  const std::string scenario = (folder / "table.yaml").string(), out = (folder / "out").string();
  std::ofstream(scenario) << kTable;
  const CommandOutcome done =
      run_program("mesh " + scenario + " --convergence --cyclogram short --most-elements 3000 -o " + out);
  ASSERT_EQ(done.exit_code, 0) << done.output;
  EXPECT_THAT(done.output, AllOf(HasSubstr("[µm]"), HasSubstr("[K]"), HasSubstr("unknowns"), HasSubstr("[s]")));
  const Json found = Json::parse(read_text(out + "/summary.json"));
  ASSERT_EQ(found["meshes"].size(), 3U);
  std::string own;
  for (std::size_t k = 0; k < 3; ++k) {
    const Json& mesh = found["meshes"][k];
    EXPECT_LE(mesh["elements"].get<int>(), 3000);
    if (mesh["is_own"].get<bool>()) own = mesh["mesh"].get<std::string>() + "_um";
    if (k == 0) continue;
    EXPECT_GE(found["meshes"][k - 1]["size_mm"].get<double>() / mesh["size_mm"].get<double>(), 1.299);
  }
  ASSERT_EQ(found["displacements"].size(), 2U);
  ASSERT_EQ(found["thermometers"].size(), 2U);
  EXPECT_THAT(read_text(out + "/report.html"), HasSubstr("mean element size [mm]"));
  EXPECT_TRUE(std::filesystem::exists(out + "/tables/displacements.csv"));
  // The scenario's own mesh gives what `simulate` gives.
  const std::string simulated = (folder / "simulated").string();
  ASSERT_EQ(run_program("simulate " + scenario + " --cyclogram short -o " + simulated).exit_code, 0);
  const Record record = read_record_csv(simulated + "/record.csv");
  EXPECT_NEAR(found["displacements"][0][own].get<double>(), record.at("bow").values.back(), 1e-4);
}

TEST(MeshConvergence, RefusesWhatCannotBeRefined) {
  const std::filesystem::path folder = fresh_folder("not_refined");
  const std::string out = " -o " + (folder / "out").string();
  const CommandOutcome lumped = run_program("mesh scenarios/first_machine.yaml --convergence" + out);
  EXPECT_EQ(lumped.exit_code, 2);
  EXPECT_THAT(lumped.output, AllOf(HasSubstr("lumped bodies"), HasSubstr("nothing to refine")));
  const std::string given = fixtures::write_column_and_head(folder, fixtures::ColumnAndHead{});
  const CommandOutcome nodes = run_program("mesh " + given + " --convergence" + out);
  EXPECT_EQ(nodes.exit_code, 2);
  EXPECT_THAT(nodes.output, AllOf(HasSubstr("file with nodes"), HasSubstr("Bring a finer mesh")));
  const CommandOutcome drawing = run_program("mesh scenarios/parts/c_frame.step --convergence" + out);
  EXPECT_EQ(drawing.exit_code, 2);
  EXPECT_THAT(drawing.output, HasSubstr("needs a scenario"));
  EXPECT_EQ(run_program("mesh scenarios/c_frame.yaml --cyclogram pockets" + out).exit_code, 2) << "only with --convergence";
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(Check, SaysWhereTheMeshSizeComesFrom) {
  EXPECT_THAT(run_program("check scenarios/c_frame.yaml").output,
              HasSubstr("given in the scenario: default 90 mm, head 60 mm, spindle 40 mm"));
  const std::string given = fixtures::write_column_and_head(fresh_folder("size_of_file"), fixtures::ColumnAndHead{});
  EXPECT_THAT(run_program("check " + given).output, HasSubstr("fixed by the mesh file"));
}

}  // namespace
}  // namespace driftwright::mesh_convergence_test
