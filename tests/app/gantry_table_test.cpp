// scenarios/gantry_table.yaml as a user runs it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/record.hpp"
#include "tests/shared/command_line.hpp"
#include "tests/shared/edited_text.hpp"

namespace driftwright::gantry_table_test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr;

struct Outcome {
  CommandOutcome command;
  std::filesystem::path folder;
};
const Outcome& outcome() {
  static const Outcome done = [] {
    const auto folder = fresh_folder("gantry") / "out";
    return Outcome{run_program("run scenarios/gantry_table.yaml -o " + folder.string()), folder};
  }();
  return done;
}

nlohmann::json summary() {
  return nlohmann::json::parse(read_text(outcome().folder / "summary.json"));
}

nlohmann::json strategy(const std::string& name) {
  const nlohmann::json all = summary();
  for (const auto& s : all["strategies"]) {
    if (s["name"] == name) return s;
  }
  return {};
}

TEST(GantryTable, WritesReportFieldsAndProgramsForTheControl) {
  ASSERT_EQ(outcome().command.exit_code, 0) << outcome().command.output;
  for (const char* name :
       {"report.html", "summary.json", "record.csv", "strategies.csv", "probe.csv", "fields.pvd",
        "control/siemens/THERMFRAME.SPF", "control/siemens/RINGMEAS.SPF", "control/siemens/THERMDATA.SPF",
        "control/linuxcnc/thermframe.ngc", "control/linuxcnc/joint_0.comp", "control/heidenhain/THERMFRAME.H"})
    EXPECT_TRUE(std::filesystem::exists(outcome().folder / name)) << name;
}

/// Mean of the five thermometers of the bed, which stretches the tape.
double tape_degC(const Record& record, std::size_t i) {
  double sum = 0.0;
  for (const char* name : {"bed_1", "bed_2", "bed_3", "bed_4", "bed_5"}) sum += record.at(name).values[i] / 5.0;
  return sum;
}

// Free steel of 9.9 m at 2.5 K would be 285 um; the paper's first day lies between 20 and 120 um. At 8:00 all is as warm
// as the ambient, and what is computed is nothing but (11.5 - 11.0) um/(m K) times 9.9 m times 3 K = 14.85 um: below the
// paper's 20, out of its band. With each expansion known to 3 % it is 15 +- 14 um. The later three lie in the band.
TEST(GantryTable, GrowsByTableLessScaleAsThePapersFirstDayButForItsStart) {
  const Record record = read_record_csv((outcome().folder / "record.csv").string());
  const auto& first = record.at("table_14_x").values;  // middle row of 3 x 13 points
  const auto& last = record.at("table_26_x").values;
  const auto x_um = [&](double h) {
    const auto i = static_cast<std::size_t>(std::lround(6.0 * h));
    return last[i] - first[i] - 11.0 * 9.9 * (tape_degC(record, i) - 20.0);
  };
  EXPECT_NEAR(x_um(0.0), 14.85, 0.05);  // springs of drives and foundation hold back a little
  for (double h : {3.0, 6.0, 9.0}) {
    EXPECT_GT(x_um(h), 20.0) << h;
    EXPECT_LT(x_um(h), 120.0) << h;
  }
}

// 3 x 13 points, two rings, then the head: X is table less scale, both from the head on. The record carries 7 digits.
TEST(GantryTable, JudgesTableLessScale) {
  const Record record = read_record_csv((outcome().folder / "record.csv").string());
  const auto& head = record.at("table_42_x").values;
  double most_um = 0.0;
  for (std::size_t i = 0; i < record.n_samples() && record.time_s[i] <= 86400.0; ++i) {
    for (int p = 0; p < 39; ++p) {
      const double x_m = -4.95 + 9.9 * (p % 13) / 12.0, scale_um = 11.0 * (tape_degC(record, i) - 20.0) * x_m;
      const double error_um = record.at("table_" + std::to_string(p + 1) + "_x").values[i] - head[i] - scale_um;
      most_um = std::max(most_um, std::abs(error_um));
    }
  }
  EXPECT_NEAR(strategy("none")["x_um"].get<double>(), most_um, 1e-3);
}

// docs/how-to/table.md: 78 um without, 26.7 um with rings every three hours, 15.6 um with thermometers between them, 14.5
// um with a model; no frame leaves less than 9.2 um (the best by least squares 13.4). The goals were 75 % less, which rings
// alone miss, and 90 %, which no frame reaches.
TEST(GantryTable, WhatStandsBetweenMeasurementsBeatsRingsAlone) {
  const double none = strategy("none")["position_um"], rings = strategy("rings")["position_um"],
               warmth = strategy("rings, thermometers between")["position_um"],
               both = strategy("rings and model")["position_um"],
               exact = strategy("exact rings at all times")["position_um"],
               whole = strategy("rings and model of the whole table")["position_um"],
               best = strategy("best frame (minimax) at all times")["position_um"];
  // Both sides: what is left in either direction is seen. Seeds are written, the rest is rounding and the reduction's 20
  // mK: 0.01.
  EXPECT_NEAR(none, 77.6, 0.5);
  EXPECT_NEAR(rings / none, 0.344, 0.01);
  EXPECT_NEAR(warmth / none, 0.201, 0.01);
  EXPECT_NEAR(whole / none, 0.186, 0.01);
  EXPECT_NEAR(best / none, 0.119, 0.005);
  // A model of the rings alone was expected to remove 30 % of the error with rings every three hours. It removes 20 %;
  // rings known exactly at all times, which is what it is after, 22.5 %: the rest lies beside the rings, where the whole
  // table's model takes 46 %.
  EXPECT_NEAR(both / rings, 0.797, 0.02);
  EXPECT_NEAR(exact / rings, 0.775, 0.02);
  EXPECT_LT(exact, both);
  EXPECT_NEAR(whole / rings, 0.542, 0.02);
  EXPECT_NEAR(strategy("rings and model of the whole table")["x_um"].get<double>() / strategy("none")["x_um"].get<double>(),
              0.125, 0.01);
}

// The same rings, the same wrong expansions and median as in `run`; the modes are a reduction of the same wrong model, to
// 0.1 um.
TEST(GantryTable, ThroughFrameJudgesAsRunDoes) {
  const auto folder = fresh_folder("gantry_modes") / "out";
  const CommandOutcome done =
      run_program("compensate scenarios/gantry_table.yaml --model modes --through frame -o " + folder.string());
  ASSERT_EQ(done.exit_code, 0) << done.output;
  const nlohmann::json rows = nlohmann::json::parse(read_text(folder / "summary.json"))["corrections"];
  EXPECT_NEAR(rows[1]["position_um"].get<double>(), strategy("rings")["position_um"].get<double>(), 1e-3);
  EXPECT_NEAR(rows[2]["position_um"].get<double>(), strategy("model alone")["position_um"].get<double>(), 0.1);
  EXPECT_NEAR(rows[2]["x_um"].get<double>(), strategy("model alone")["x_um"].get<double>(), 0.1);
  EXPECT_NEAR(rows[3]["position_um"].get<double>(), strategy("rings and model")["position_um"].get<double>(), 0.1);
}

TEST(GantryTable, ProbeKeepsThePapersBound) {
  const nlohmann::json all = summary();
  ASSERT_EQ(all["probe"]["rows"].size(), 60u);  // 3 axes, 5 feeds, 4 motions
  for (const auto& row : all["probe"]["rows"]) EXPECT_LE(row["corrected_um"].get<double>(), 10.6) << row.dump();
}

TEST(GantryTable, EightReadingsLeaveTheLineAtItsPublishedFit) {
  EXPECT_NEAR(summary()["readings"]["models"][0]["r_squared"].get<double>(), 0.44, 0.005);
}

/// The scenario with each first word of a pair replaced, as a file.
std::string edited_file(const std::vector<std::pair<std::string, std::string>>& edits) {
  std::string text = read_text("scenarios/gantry_table.yaml");
  for (const auto& [what, with] : edits) text = fixtures::replaced(text, what, with);
  const std::string data = std::filesystem::absolute("scenarios/measured/gantry_table_days.csv").string();
  for (std::size_t from = text.find("measured/gan"); from != std::string::npos;
       from = text.find("measured/gan", from + data.size()))
    text.replace(from, std::string("measured/gantry_table_days.csv").size(), data);
  const std::string file = (fresh_folder("edited") / "scenario.yaml").string();
  std::ofstream(file) << text;
  return file;
}

CommandOutcome edited(const std::string& what, const std::string& with) {
  return run_program("check " + edited_file({{what, with}}));
}

// docs/how-to/table.md: 0.1 K in steps of 0.1 K without a mean leave 27.0 um between rings (15.6 um with the scenario's
// instrument), 48.6 um by the table's thermometer alone (30.9), 59.7 um by the control's own (47.9). All of them read the
// same instrument.
TEST(GantryTable, ThermometersHelpNoMoreThanTheirInstrumentLetsThem) {
  const std::string file = edited_file({{"sensor_noise: 0.02 K", "sensor_noise: 0.1 K"},
                                        {"sensor_resolution: 0.01 K", "sensor_resolution: 0.1 K"},
                                        {"sensor_mean: 30 min", "sensor_mean: 0 min"}});
  const auto folder = fresh_folder("gantry_ordinary") / "out";
  ASSERT_EQ(run_program("run " + file + " -o " + folder.string()).exit_code, 0);
  const nlohmann::json all = nlohmann::json::parse(read_text(folder / "summary.json"));
  for (const char* name : {"rings, thermometers between", "table thermometer", "control's own (SD43900/43910)"}) {
    const auto found = std::find_if(all["strategies"].begin(), all["strategies"].end(),
                                    [&](const nlohmann::json& s) { return s["name"] == name; });
    EXPECT_GT((*found)["position_um"].get<double>(), 1.15 * strategy(name)["position_um"].get<double>()) << name;
  }
}

TEST(GantryTable, SaysWhatIsWrongWithALine) {
  const auto refuses = [](const std::string& what, const std::string& with, const std::string& reason) {
    const CommandOutcome outcome = edited(what, with);
    EXPECT_EQ(outcome.exit_code, 2) << what;
    EXPECT_THAT(outcome.output, AllOf(HasSubstr("scenario.yaml:"), HasSubstr(reason))) << what;
  };
  EXPECT_EQ(edited("points_x: 13", "points_x: 5").exit_code, 0);
  refuses("{name: low, at: [-4.8 m", "{name: low, at: [4.75 m", "identical");
  refuses("{name: low, at: [-4.8 m, 0 m, 0 m]}", "{name: low, at: [4.9 m, 0 m, 0 m]}", "swapped");
  refuses("{name: low, at: [-4.8 m", "{name: low, at: [-5.8 m", "outside");
  refuses("    - {name: low, at: [-4.8 m, 0 m, 0 m]}\n", "", "at least 2 are required");
  refuses("    - {name: high, at", "    - {name: middle, at: [-4.8 m, 0 m, 0 m]}\n    - {name: high, at",
          "identical with ring 'low'");
  refuses("    - {name: high, at", "    - {name: low, at: [0 m, 0 m, 0 m]}\n    - {name: high, at",
          "another ring has this name");
  refuses("low: [-4.95 m, -1.45 m, 0 m]", "low: [-4.95 m, -1.45 m, -7 m]", "differ in z");
  refuses("judge_until: 24 h", "judge_until: 0 h", "judge_until");
  refuses("jitter: 20 us", "jitter: 1 s", "jitter");
  refuses("sensor_noise: 0.02 K", "sensor_noise: -0.02 K", "sensor_noise");
  refuses("sensor_resolution: 0.01 K", "sensor_resolution: 1 m", "sensor_resolution");
  refuses("sensor_mean: 30 min", "sensor_mean: 30 h", "sensor_mean");
  refuses("bed_4, bed_5]", "bed_4, bed_6]", "'bed_6' is no sensor");
  refuses("scale_x: {sensors:", "scale_x: {sensor: beam, sensors:", "one of `sensor` and `sensors`");
  refuses("reference_feed: 10 mm/min", "reference_feed: 40 mm/min", "reference_feed");
  refuses("train_from: 24 h", "train_from: 12 h", "not fitted on");
  refuses("train_from: 24 h", "train_from: 28 h", "three measurements");
  refuses("lag: [8.3 ms, 9.4 ms, 7.7 ms]", "lag: [8.3 ms, 90 ms, 7.7 ms]", "40 cycles");
  refuses("jitter: 20 us", "jiter: 20 us", "Did you mean 'jitter'");
  refuses("sensor: table_mid, update", "sensor: nowhere, update", "nowhere");
  refuses("at: [2.4 m, 0.4 m, 0 m]", "at: [4.4 m, 0.4 m, 0 m]", "does not lie on the table");
  EXPECT_THAT(edited("judge_until: 24 h", "judge_until: 0 h").output, HasSubstr("scenario.yaml:93"));
  refuses("gauge: 1.8 m", "gauge: 2.8 m", "reach beyond");
}

}  // namespace
}  // namespace driftwright::gantry_table_test
