// The shipped scenarios beside fp3_spindle and spindle_22, as their headers say they behave.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/record.hpp"
#include "tests/app/csv_table.hpp"
#include "tests/shared/command_line.hpp"

namespace driftwright::shipped_scenarios_test {
namespace {

using ::testing::HasSubstr;

/// Runs `simulate` on one cyclogram of a shipped scenario; returns the folder of results.
std::filesystem::path simulate(const std::string& scenario, const std::string& cyclogram, std::string* output = nullptr) {
  const std::filesystem::path folder = fresh_folder(scenario) / "results";
  const CommandOutcome outcome =
      run_program("simulate scenarios/" + scenario + ".yaml --cyclogram " + cyclogram + " -o " + folder.string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  if (output) *output = outcome.output;
  return folder;
}

TEST(LumpedSpindle, CoolerCyclesBetweenItsSwitchingPoints) {
  const Record record = read_record_csv((simulate("lumped_spindle", "shift") / "record.csv").string());
  const auto& cooler = record.at("t_cooler").values;
  const auto settled = cooler.begin() + 40;                          // after 20 min
  EXPECT_NEAR(*std::min_element(settled, cooler.end()), 24.0, 0.3);  // rows of 30 s cut the saw-tooth's tips of 1.3 K/min
  EXPECT_NEAR(*std::max_element(settled, cooler.end()), 26.0, 0.3);
  EXPECT_LT(*std::max_element(cooler.begin(), cooler.end()), 26.0 + 1e-3);
  EXPECT_NEAR(record.at("nose_z").values[60], 56.0, 1.0);  // after 30 min, as the header says
}

TEST(LumpedSpindle, WhatFlowsInMakesWhatIsStoredInEachRow) {
  const Record heat = read_record_csv((simulate("lumped_spindle", "shift") / "heat_flows.csv").string());
  std::vector<std::string> across;  // those that cross the boundary: sources, and links to the ambient
  for (const Channel& c : heat.channels) {
    const bool within = c.name.starts_with("within_");
    if (c.name != "stored" && !within) across.push_back(c.name);
  }
  ASSERT_EQ(across.size(), 9u);
  for (std::size_t row = 1; row < heat.n_samples(); ++row) {
    double sum_W = 0.0;
    for (const std::string& name : across) sum_W += heat.at(name).values[row];
    EXPECT_NEAR(sum_W, heat.at("stored").values[row], 1e-3) << "row " << row;  // of 1500 W written with 7 digits
  }
}

TEST(BallScrew, GrowsWhereItsNutIsAndReadsLittleByAScale) {
  // Its header's values.
  const Record full = read_record_csv((simulate("ball_screw", "full_strokes") / "record.csv").string());
  EXPECT_NEAR(full.at("x_800").values[30], 115.0, 1.0);
  EXPECT_NEAR(full.at("x_400").values[30], 62.0, 1.0);
  EXPECT_NEAR(full.at("x_0").values[30], 9.0, 0.5);
  EXPECT_NEAR(full.at("x_at_nut").values[30], full.at("x_400").values[30], 1e-3);
  EXPECT_NEAR(full.at("x_800").values[50], 60.0, 1.0);
  const Record brief = read_record_csv((simulate("ball_screw", "short_strokes") / "record.csv").string());
  EXPECT_NEAR(brief.at("x_800").values[30], 57.0, 1.0);
  EXPECT_NEAR(brief.at("x_400").values[30], 6.0, 1.0);
  for (const double um : brief.at("x_by_scale").values) EXPECT_LT(std::abs(um), 1.0);
}

/// The figures of ISO 230-3 of a simulated cyclogram.
nlohmann::json iso230_3(const std::string& scenario, const std::string& cyclogram) {
  const std::filesystem::path folder = simulate(scenario, cyclogram);
  return nlohmann::json::parse(read_text(folder / "summary.json")).at("cyclograms").at(0).at("iso_230_3");
}

// Values by independent integration of the three bodies' balances.
TEST(WorkshopDay, IsTestedAsIso230_3TestsTheAmbientAndASpindle) {
  const auto etve = iso230_3("workshop_day", "etve");
  EXPECT_EQ(etve.at("test"), "environment");
  EXPECT_EQ(etve.at("duration_min"), 1440.0);
  EXPECT_NEAR(etve.at("channels").at(0).at("range_whole_record"), 23.45, 0.02);
  EXPECT_NEAR(etve.at("channels").at(1).at("range_whole_record"), 4.92, 0.02);
  EXPECT_TRUE(etve.at("channels").at(0).at("range_running_period").is_null());
  const auto spindle = iso230_3("workshop_day", "spindle");
  EXPECT_EQ(spindle.at("test"), "rotating_spindle");
  EXPECT_NEAR(spindle.at("channels").at(0).at("range_first_60_min"), 28.53, 0.02);
  EXPECT_NEAR(spindle.at("channels").at(0).at("range_running_period"), 47.62, 0.02);
}

TEST(WorkshopDay, HasNoNegativeZeroForAMotorAtRest) {
  EXPECT_THAT(read_text(simulate("workshop_day", "etve") / "summary.json"),
              ::testing::Not(HasSubstr("\"out_of_machine_W\": -0.0,")));
}

TEST(BallScrew, IsTestedAsIso230_3TestsMovingAxes) {
  const auto axis = iso230_3("ball_screw", "iso_230_3");
  EXPECT_EQ(axis.at("test"), "linear_axes");
  EXPECT_EQ(axis.at("axes"), "x");
  EXPECT_EQ(axis.at("axis_running_period_min"), 240.0);
  EXPECT_EQ(axis.at("channels").at(0).at("name"), "x_0") << "position_x and stroke_x are no errors";
  EXPECT_NEAR(axis.at("channels").at(0).at("range_first_60_min"), 10.9, 0.1);
  EXPECT_NEAR(axis.at("channels").at(2).at("range_first_60_min"), 131.3, 0.2);
  EXPECT_NEAR(axis.at("channels").at(2).at("range_running_period"), 147.4, 0.2);
}

TEST(CFrame, FromADrawingToFieldsWithStresses) {
  std::string output;
  const std::filesystem::path folder = simulate("c_frame", "warm_up", &output);
  EXPECT_THAT(output, HasSubstr("fields.pvd"));
  EXPECT_THAT(read_text(folder / "fields" / "fields_0001.vtu").substr(0, 4000), HasSubstr("von_mises_MPa"));
  EXPECT_THAT(read_text(folder / "fields.pvd"), HasSubstr("timestep=\"600\""));  // fields_at: 10 min
  const Record record = read_record_csv((folder / "record.csv").string());
  // Its header's values, to the digits given there: a change of the model shows here first.
  EXPECT_NEAR(record.at("nose_y").values.back(), -29.0, 0.5);
  EXPECT_NEAR(record.at("nose_z_x0").values.back(), -22.0, 0.5);
  EXPECT_DOUBLE_EQ(record.at("t_head").values.front(), 20.5);  // start: ambient
  const Record heat = read_record_csv((folder / "heat_flows.csv").string());
  EXPECT_GT(heat.at("bearing_friction_spindle").values[1], heat.at("bearing_friction_spindle").values.back())
      << "warm oil is thin";
  const auto& draught = heat.at("convection_column_back").values;  // 10 to 15 min, rows of half a minute
  EXPECT_EQ(draught[20], 0.0);
  EXPECT_NE(draught[25], 0.0);
  EXPECT_EQ(draught[31], 0.0);
}

TEST(MovingMill, TheVolumeHoldsTheErrorsOfTheRecordWhereBothAreAtOnePose) {
  const std::filesystem::path folder = fresh_folder("moving_mill") / "results";
  const CommandOutcome outcome = run_program("run scenarios/moving_mill.yaml -o " + folder.string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const fixtures::Table table = fixtures::read_table(folder / "volume.csv");
  ASSERT_EQ(table.size(), 1u + 2 * 27);
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(table[0].begin(), table[0].end(), name) - table[0].begin());
  };
  const auto is_at = [&](const std::vector<std::string>& row, double x_mm, double y_mm, double z_mm) {
    return std::stod(row[column("time_min")]) == 180.0 && std::stod(row[column("position_x_mm")]) == x_mm &&
           std::stod(row[column("position_y_mm")]) == y_mm && std::stod(row[column("position_z_mm")]) == z_mm;
  };
  // The cyclogram ends at the drawn pose, where the foot of the volume is the point `table` of the displacements.
  const Record record = read_record_csv((folder / "record.csv").string());
  EXPECT_EQ(record.at("position_x").values[5], 150.0);
  int n_met = 0;
  for (std::size_t i = 1; i < table.size(); ++i) {
    if (is_at(table[i], 0.0, 0.0, 0.0)) {
      ++n_met;
      EXPECT_NEAR(std::stod(table[i][column("EY_um")]), record.at("nose_y").values.back(), 1e-3);
      EXPECT_NEAR(std::stod(table[i][column("EZ_um")]), record.at("nose_z").values.back(), 1e-3);
    }
    if (is_at(table[i], 200.0, 50.0, 100.0)) {
      ++n_met;
      EXPECT_NEAR(std::stod(table[i][column("place_x_mm")]), 200.0, 1e-6);  // +X of the tool in the work, as ISO 841
      EXPECT_NEAR(std::stod(table[i][column("place_y_mm")]), -60.0 + 50.0, 1e-6);
      EXPECT_NEAR(std::stod(table[i][column("place_z_mm")]), 740.0, 1e-6);
    }
  }
  EXPECT_EQ(n_met, 2);
  for (const char* name :
       {"report.html", "volume.pvd", "volume/volume_0000.vtu", "volume/volume_0001.vtu", "heat_flows.csv"})
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
}

TEST(MovingMill, EndsWithTwoWhereAnAxisLeavesItsRange) {
  const std::filesystem::path folder = fresh_folder("moving_mill_refused") / "results";
  const CommandOutcome outcome =
      run_program("simulate scenarios/moving_mill.yaml --cyclogram still --pose x=300mm -o " + folder.string());
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.output, HasSubstr("scenarios/moving_mill.yaml:"));
  EXPECT_THAT(outcome.output, HasSubstr("outside the `range` of axis 'x', -200 mm to 200 mm"));
  EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST(RotaryMill, ItsRTestShowsThePlaceOfTheAxisThatTheVolumeHas) {
  const std::filesystem::path folder = fresh_folder("rotary_mill") / "results";
  const CommandOutcome outcome = run_program("run scenarios/rotary_mill.yaml -o " + folder.string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const fixtures::Table volume = fixtures::read_table(folder / "volume.csv");
  ASSERT_EQ(volume.size(), 1u + 2 * 36);
  EXPECT_THAT(volume[0], testing::Contains("position_c_deg"));
  ASSERT_EQ(fixtures::read_table(folder / "r_test.csv").size(), 1u + 2 * 8);
  ASSERT_EQ(fixtures::read_table(folder / "ball_bar.csv").size(), 1u + 2 * 16);
  const auto summary = nlohmann::json::parse(read_text(folder / "summary.json"));
  const auto& fit = summary.at("r_test").at("fit").back();
  const auto axis =
      std::find_if(summary.at("axes").begin(), summary.at("axes").end(), [](const auto& a) { return a.at("axis") == "c"; });
  ASSERT_NE(axis, summary.at("axes").end());
  const auto& location = axis->at("location").back();
  // The tool of the volume is above the axis of C, so both see its place. They differ by what the linear axes do on the
  // circle.
  EXPECT_NEAR(fit.at("YO_um").get<double>(), location.at("YO_um").get<double>(), 3.0);
  EXPECT_NEAR(fit.at("XO_um").get<double>(), location.at("XO_um").get<double>(), 3.0);
  EXPECT_GT(fit.at("YO_um").get<double>(), 15.0);     // the warm column and head bend the tool away from it
  EXPECT_GT(fit.at("radial_um").get<double>(), 0.0);  // the table has grown
  EXPECT_NEAR(summary.at("r_test").at("reach_mm").get<double>(), 0.0, 1e-6);  // x, y and z bring the tool to the ball
  EXPECT_GT(summary.at("ball_bar").at("fit").back().at("G_um").get<double>(), 0.0);
}

TEST(Mesh, OfALumpedMachineIsRefused) {
  const CommandOutcome outcome =
      run_program("mesh scenarios/lumped_spindle.yaml -o " + (fresh_folder("lumped_mesh") / "out").string());
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.output, HasSubstr("a lumped machine has no mesh"));
}

TEST(Mesh, OfUnbearableFinenessIsRefusedBeforeItIsMade) {
  std::string text = read_text("scenarios/c_frame.yaml");
  text.replace(text.find("parts/c_frame.step"), 18, std::filesystem::absolute("scenarios/parts/c_frame.step").string());
  text.replace(text.find("parts/pocket.ngc"), 16, std::filesystem::absolute("scenarios/parts/pocket.ngc").string());
  text.replace(text.find("default: 90 mm"), 14, "default: 0.1 mm");
  const std::string file = (fresh_folder("fine") / "scenario.yaml").string();
  std::ofstream(file) << text;
  const CommandOutcome outcome = run_program("mesh " + file + " -o " + file + ".out");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.output, HasSubstr("take a larger mesh size"));
}

}  // namespace
}  // namespace driftwright::shipped_scenarios_test
