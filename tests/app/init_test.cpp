// The first hour: a scenario from a drawing, a mesh or nothing, which runs at once; the geometry alone; what there is to
// choose from.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/record.hpp"
#include "tests/shared/command_line.hpp"

namespace driftwright::init_test {
namespace {

using ::testing::AllOf, ::testing::ContainsRegex, ::testing::HasSubstr, ::testing::Not;

/// Runs what `init` has written. The heat would warm a machine that loses it by 10 W/(m^2 K) everywhere by 2 K in the
/// mean; the heated part is warmer, and nothing is colder than the ambient.
void expect_sane_run(const std::filesystem::path& folder, const std::string& name) {
  const std::string scenario = (folder / name / (name + ".yaml")).string();
  EXPECT_EQ(run_program("check " + scenario).exit_code, 0);
  const CommandOutcome run = run_program("run " + scenario + " -o " + (folder / "results").string());
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_TRUE(std::filesystem::exists(folder / "results/fields.pvd"));
  const Record record = read_record_csv((folder / "results/records/warm_up.csv").string());
  double warmest = 0.0;
  for (const Channel& c : record.channels) {
    for (double value : c.values) {
      if (c.unit == "degC") {
        EXPECT_GT(value, 19.99) << c.name;
        warmest = std::max(warmest, value);
      }
    }
  }
  EXPECT_GT(warmest, 20.5);
  EXPECT_LT(warmest, 80.0);
  const double drift_um =
      std::hypot(record.at("drift_x").values.back(), record.at("drift_y").values.back(), record.at("drift_z").values.back());
  EXPECT_GT(drift_um, 1.0);
  EXPECT_LT(drift_um, 500.0);
}

TEST(Init, OfADrawingRunsAtOnce) {
  const auto folder = fresh_folder("init_drawing");
  const std::string target = (folder / "mill").string();
  const CommandOutcome made = run_program("init " + target + " --from scenarios/parts/c_frame.step");
  ASSERT_EQ(made.exit_code, 0) << made.output;
  expect_sane_run(folder, "mill");
  const std::string text = read_text(target + "/mill.yaml");
  EXPECT_THAT(text, HasSubstr("type: contact"));
  EXPECT_THAT(text, HasSubstr("known_to: guess"));
  EXPECT_THAT(read_text(target + "/regions.svg"), AllOf(HasSubstr(">solid_1</text>"), HasSubstr(">solid_5</text>")));
  EXPECT_THAT(text, ContainsRegex("supports:[^\n]*a guess"));
  const CommandOutcome again = run_program("init " + target + " --from scenarios/parts/vertical_mill.step");
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.output, HasSubstr("nothing in it is overwritten"));
  EXPECT_EQ(read_text(target + "/mill.yaml"), text);
}

TEST(Init, OfAMeshKeepsItsRegionsAndJoints) {
  const auto folder = fresh_folder("init_mesh");
  const std::string mesh = (folder / "mesh").string();
  ASSERT_EQ(run_program("mesh scenarios/parts/c_frame.step -o " + mesh).exit_code, 0);
  const CommandOutcome made = run_program("init " + (folder / "frame").string() + " --from " + mesh + "/mesh.vtu");
  ASSERT_EQ(made.exit_code, 0) << made.output;
  const std::string text = read_text((folder / "frame/frame.yaml").string());
  EXPECT_THAT(text, HasSubstr("units: m "));
  EXPECT_THAT(text, HasSubstr("a guess from the size"));
  expect_sane_run(folder, "frame");
}

TEST(Init, OfLumpedNodes) {
  const auto folder = fresh_folder("init_lumped");
  ASSERT_EQ(run_program("init " + (folder / "two").string()).exit_code, 0);
  const std::string scenario = (folder / "two/two.yaml").string();
  const CommandOutcome run = run_program("run " + scenario + " -o " + (folder / "results").string());
  ASSERT_EQ(run.exit_code, 0) << run.output;
  // At 3000 rpm 150 W leave by 5 W/K: the housing ends 30 K over the ambient, the spindle 12.5 K over it. Two nodes, two
  // time constants, as exponentials.
  const double c1 = 5600, c2 = 19000, g = 12, h = 5, p = 150, t = 7200;
  const double a = g / c1, b = g / c1, c = g / c2, d = (g + h) / c2;
  const double mean = 0.5 * (a + d), root = std::sqrt(mean * mean - (a * d - b * c)), l1 = mean - root, l2 = mean + root;
  // Rise over the ambient x(t) = x_end - k1 v1 e^(-l1 t) - k2 v2 e^(-l2 t), v = (b, a - l), x(0) = 0.
  const double e1 = p / h + p / g, e2 = p / h;
  const double k2 = (e2 - (a - l1) / b * e1) / ((a - l2) - (a - l1)), k1 = e1 / b - k2;
  const double spindle = 20 + e1 - k1 * b * std::exp(-l1 * t) - k2 * b * std::exp(-l2 * t);
  const Record record = read_record_csv((folder / "results/records/warm_up.csv").string());
  EXPECT_NEAR(record.at("t_spindle").values.back(), spindle, 0.02);
  EXPECT_NEAR(record.at("drift_z").values.back(), 2.5 * (spindle - 20), 0.05);
}

TEST(Init, RefusesWhatIsNoName) {
  EXPECT_EQ(run_program("init '" + (fresh_folder("init_bad") / "two words").string() + "'").exit_code, 2);
  EXPECT_EQ(run_program("init " + (fresh_folder("init_bad2") / "a").string() + " --from scenarios/c_frame.yaml").exit_code,
            2);
}

TEST(Check, OffersANameWithoutBlanks) {
  const auto folder = fresh_folder("blank_in_name");
  std::string text = read_text("scenarios/first_machine.yaml");
  text.replace(text.find("name: first_machine"), 19, "name: first machine");
  std::ofstream(folder / "scenario.yaml") << text;
  const CommandOutcome outcome = run_program("check " + (folder / "scenario.yaml").string());
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.output, HasSubstr("Did you mean 'first_machine'?"));
}

TEST(Mesh, OfAGeometryAlone) {
  const auto folder = fresh_folder("geometry_alone");
  std::ofstream(folder / "geometry.yaml")
      << "name: geometry\nmachine:\n  mesh: " << std::filesystem::absolute("scenarios/parts/c_frame.step").string()
      << "\n  mesh_size: {default: 120 mm}\n  regions:\n    base: [200 mm, -200 mm, 100 mm]\n"
         "    table: [200 mm, -200 mm, 300 mm]\n    column: [0 mm, 500 mm, 700 mm]\n"
         "    head: [100 mm, 200 mm, 750 mm]\n    spindle: [0 mm, -60 mm, 800 mm]\n";
  const CommandOutcome outcome =
      run_program("mesh " + (folder / "geometry.yaml").string() + " -o " + (folder / "out").string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("head/spindle"));
  EXPECT_THAT(read_text((folder / "out/report.html").string()), HasSubstr("<svg"));
  EXPECT_TRUE(std::filesystem::exists(folder / "out/mesh.vtu"));
}

TEST(Check, RefusesAMachineThatCanStillTurn) {
  std::string text = read_text("scenarios/c_frame.yaml");
  const std::string held = "springs: [200 N/um, 200 N/um, 600 N/um]";
  ASSERT_NE(text.find(held), std::string::npos);
  text.replace(text.find(held), held.size(), "fixed: [z]");
  text.replace(text.find("parts/c_frame.step"), 18, std::filesystem::absolute("scenarios/parts/c_frame.step").string());
  text.replace(text.find("parts/pocket.ngc"), 16, std::filesystem::absolute("scenarios/parts/pocket.ngc").string());
  const auto folder = fresh_folder("can_turn");
  std::ofstream(folder / "scenario.yaml") << text;
  const CommandOutcome outcome = run_program("check " + (folder / "scenario.yaml").string());
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.output,
              AllOf(HasSubstr("as a rigid body it can still"), HasSubstr("rotate about z"), HasSubstr("supports")));
}

TEST(List, WhatThereIsToChooseFrom) {
  const CommandOutcome joints = run_program("list joints scenarios/c_frame.yaml");
  EXPECT_EQ(joints.exit_code, 0);
  EXPECT_THAT(joints.output, AllOf(HasSubstr("base/column"), HasSubstr("head/spindle"), Not(HasSubstr("table_top"))));
  EXPECT_THAT(run_program("list cyclograms scenarios/first_machine.yaml").output, ContainsRegex("shift +240"));
  EXPECT_THAT(run_program("list scenarios").output, ContainsRegex("scenarios/first_machine.yaml +The smallest scenario"));
  EXPECT_EQ(run_program("list joints").exit_code, 2);
  EXPECT_EQ(run_program("list materials scenarios").exit_code, 2);
}

}  // namespace
}  // namespace driftwright::init_test
