// `validate` and `compensate` on parts of records, on records that continue others, and on simulated runs.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/csv_row.hpp"
#include "base/record.hpp"
#include "tests/app/records_of_two_bodies.hpp"

namespace driftwright::continued_records_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

class ContinuedRecords : public RecordsOfTwoBodies {};

// A machine that is its own model, run for ten hours without ever coming back to balance. What follows 6 h goes on from
// what came before, so that the model is exact there, too; had the part begun at 0, or cold, it would be off by the 30 um
// that the machine has gone by then.
TEST_F(ContinuedRecords, APartOfALongRecordGoesOnFromWhatCameBefore) {
  const std::string week = scenario("long_record", [](std::string& t) {
    replace(
        t, "  to_and_fro:",
        "  week: [[2 h, 3000 rpm], [1 h, 0 rpm], [2 h, 1500 rpm], [1 h, 0 rpm], [2 h, 2500 rpm], [30 min, 0 rpm], [90 min, "
        "2000 rpm]]\n  to_and_fro:");
  });
  simulate(week, "week", "week");
  const auto out = fresh_folder("parts") / "out";
  const CommandOutcome run = run_program("validate " + week + " --train " + record("week") + ":0h..6h --test " +
                                         record("week") + ":6h..10h -o " + out.string());
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const Json summary = Json::parse(read_text(out / "summary.json"));
  expect_exact(summary);
  for (const Json& l : summary["validation"]["left_out"])  // of three thermometers no three modes
    EXPECT_THAT(l["name"].get<std::string>(), HasSubstr("common modes"));
  EXPECT_EQ(summary["validation"]["trained_on"].size(), 2u);
  EXPECT_THAT(summary["warnings"].dump(), AllOf(HasSubstr("cut into 2 runs"), HasSubstr("at 3.00 h"),
                                                HasSubstr("the later run continues the earlier one")));
  EXPECT_THAT(run.output, HasSubstr("record.csv:6h..10h"));
  const Json* nothing = strategy(summary, "no correction");
  ASSERT_TRUE(nothing);
  EXPECT_GT((*nothing)["worst_peak_um"].get<double>(), 20.0);

  // rows after the fitted ones may be corrected, as `validate` judged them; a part that holds one of the others may not
  const std::string file = (out / "models/ridge_all_sensors.json").string();
  const auto compensate = [&](const std::string& part) {
    return run_program("compensate " + week + " --model " + file + " --through none --measured " + record("week") + part +
                       " -o " + (out / "corrected").string());
  };
  for (const char* part : {"", ":5h..10h", ":..1h", ":2h..2.5h", ":0h..6h"})
    EXPECT_THAT(compensate(part).output, HasSubstr("it was fitted on")) << part;
  const CommandOutcome corrected = compensate(":6h..10h");
  ASSERT_EQ(corrected.exit_code, 0) << corrected.output;
  const Json left = Json::parse(read_text(out / "corrected/summary.json"));
  EXPECT_EQ(left["peak_left_um"], (*strategy(summary, "ridge, all sensors"))["worst_peak_um"]);
  EXPECT_THAT(left["iso_230_3"]["not_available"].dump(), HasSubstr("goes on from what came before"));
  const Record rows = read_record_csv((out / "corrected/corrected.csv").string());
  EXPECT_EQ(rows.time_s.front(), 0.0);
  EXPECT_NEAR(rows.time_s.back(), 4.0 * 3600.0, 1.0);

  const CommandOutcome selected =
      run_program("select " + week + " --train " + record("week") + " -o " + (out / "selected").string());
  EXPECT_EQ(selected.exit_code, 0) << selected.output;
  EXPECT_THAT(selected.output, AllOf(HasSubstr("cut into"), Not(HasSubstr("not possible"))));
}

// Three files of one recording: lags of the third begin with what the second holds, in `validate` and in `compensate
// --after`.
TEST_F(ContinuedRecords, ARecordThatContinuesAnotherIsCorrectedAsJudged) {
  const std::string shifts = scenario("shifts", [](std::string& t) {
    replace(t, "  to_and_fro:",
            "  day: [[1 h, 3000 rpm], [1 h, 0 rpm], [1 h, 1500 rpm], [30 min, 2500 rpm], [90 min, 0 rpm], [1 h, 2000 "
            "rpm]]\n  to_and_fro:");
  });
  simulate(shifts, "day", "day");
  const std::string scenario =
      write_file("continued.yaml", "name: continued\nstudy: {target: tip_z, sensors_to_choose: 2, tolerance: 3 um}\n");
  for (int part = 0; part < 3; ++part) {
    edited("day", fmt::format("day_{}", part), [&](std::vector<std::string>& cells, const std::vector<std::string>&) {
      return std::min(2, static_cast<int>(std::stod(cells[0]) / 7200.0)) == part;
    });
  }
  const auto out = fresh_folder("continued") / "out";
  const CommandOutcome judged = run_program("validate " + scenario + " --train " + record("day_0") + " --train " +
                                            record("day_1") + " --test " + record("day_2") + " -o " + out.string());
  ASSERT_EQ(judged.exit_code, 0) << judged.output;
  const Json summary = Json::parse(read_text(out / "summary.json"));
  const auto compensate = [&](const std::string& file, const std::string& further) {
    return run_program("compensate " + scenario + " --model " + file + " --through none" + further + " -o " +
                       (out / "corrected").string());
  };
  const std::string measured = " --measured " + record("day_2");
  bool differs = false;  // of one with a memory
  for (const auto& file : std::filesystem::directory_iterator(out / "models")) {
    if (file.path().extension() != ".json") continue;
    const std::string path = file.path().string();
    const auto peak_um = [&](const std::string& further) {
      const CommandOutcome run = compensate(path, further);
      EXPECT_EQ(run.exit_code, 0) << run.output;
      return Json::parse(read_text(out / "corrected/summary.json"))["peak_left_um"];
    };
    const Json* s = strategy(summary, Json::parse(read_text(file.path()))["name"]);
    ASSERT_TRUE(s) << path;
    EXPECT_EQ(peak_um(measured + " --after " + record("day_1")), (*s)["worst_peak_um"]) << path;
    differs = differs || peak_um(measured) != (*s)["worst_peak_um"];
  }
  EXPECT_TRUE(differs);
  const std::string file = (out / "models/ridge_all_sensors.json").string();
  EXPECT_THAT(compensate(file, measured + " --after " + record("day_0")).output, HasSubstr("does not continue"));
  EXPECT_THAT(compensate(file, measured + ":0h..1h --after " + record("day_1")).output, HasSubstr("whole records"));
  EXPECT_THAT(compensate(file, " --after " + record("day_1")).output, HasSubstr("--after requires --measured"));
}

// A simulated run is corrected by the readings that it was judged by: noise and steps of `validation`, drawn as there.
TEST_F(ContinuedRecords, ASimulatedRunIsCorrectedAsItWasJudged) {
  const auto out = fresh_folder("simulated") / "out";
  const std::string noisy = scenario("noisy", [](std::string& t) {
    replace(t, "  to_and_fro:", "  third: [[90 min, 2000 rpm], [60 min, 0 rpm]]\n  to_and_fro:");
    t += "solver: {model: reduced}\nvalidation:\n  train: [warm_up, steps, third]\n  families: {other: [to_and_fro]}\n  "
         "sensor_noise: 0.1 K\n"
         "  sensor_resolution: 0.1 K\n";
  });
  const CommandOutcome judged = run_program("validate " + noisy + " -o " + out.string());
  ASSERT_EQ(judged.exit_code, 0) << judged.output;
  const Json summary = Json::parse(read_text(out / "summary.json"));
  const auto compensate = [&](const std::string& scenario, const std::string& name, const std::string& further) {
    return run_program("compensate " + scenario + " --model " + (out / "models" / name).string() + " " + further + " -o " +
                       (out / "corrected").string());
  };
  for (const char* name : {"ridge_all_sensors.json", "observer.json"}) {
    const CommandOutcome run = compensate(noisy, name, "--through none");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("with noise and steps"));
    const double left_um = Json::parse(read_text(out / "corrected/summary.json"))["rms_left_um"];
    const Json file = Json::parse(read_text(out / "models" / name));
    EXPECT_NEAR(left_um, (*strategy(summary, file["name"]))["overall_rms_um"].get<double>(), 1e-6 * left_um) << name;
  }
  const CommandOutcome exact = compensate(machine_, "ridge_all_sensors.json", "--through none");
  EXPECT_THAT(exact.output, HasSubstr("thermometers read exactly"));
  EXPECT_LT(Json::parse(read_text(out / "corrected/summary.json"))["rms_left_um"].get<double>(),
            (*strategy(summary, "ridge, all sensors"))["overall_rms_um"].get<double>());
  EXPECT_THAT(compensate(noisy, "ridge_all_sensors.json", "--through none --cyclogram steps").output,
              HasSubstr("it was fitted on"));

  // no plan was among the strategies that were judged
  const CommandOutcome planned = compensate(noisy, "ridge_all_sensors.json", "--through schedule");
  EXPECT_EQ(planned.exit_code, 0) << planned.output;
  EXPECT_THAT(planned.output, AllOf(HasSubstr("follows readings live"), HasSubstr("margin of")));
  const Json plan = Json::parse(read_text(out / "corrected/summary.json"));
  EXPECT_EQ(plan["judged_as"], "live");
  EXPECT_LE(plan["margin_um"].get<double>(), 1.5);

  const std::string other = scenario("other_names", [](std::string& t) { replace(t, "name: t_column", "name: t_back"); });
  const CommandOutcome unknown = compensate(other, "ridge_all_sensors.json", "--through none");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.output, AllOf(HasSubstr("'t_column'"), HasSubstr("no sensor of"), Not(HasSubstr("simulating"))));
}

// Each cyclogram of a family, named or drawn, in each season: as it is driven, and what the observer leaves of it.
TEST_F(ContinuedRecords, EachFamilyIsJudgedInEachSeason) {
  const auto out = fresh_folder("seasons") / "out";
  const std::string seasons = scenario("seasons", [](std::string& t) {
    t += "solver: {model: reduced}\nvalidation:\n  train: [warm_up, steps]\n  families:\n    other: [to_and_fro]\n"
         "    drawn: {count: 2, sections: 3, duration: 2 h, speeds: [500 rpm, 1500 rpm, 3000 rpm]}\n"
         "  seasons: {summer: {offset: 8 K, swing: 3 K}}\n";
  });
  const CommandOutcome judged = run_program("validate " + seasons + " -o " + out.string());
  ASSERT_EQ(judged.exit_code, 0) << judged.output;
  std::istringstream lines(read_text(out / "strategies.csv"));
  std::map<std::string, double> uncorrected_um;  // family, season and run
  int n_observed = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> cells = csv_cells(line);  // strategy, family, season, run, failed, peak before, .., left
    if (cells.size() < 8 || !cells[4].empty()) continue;
    if (cells[0] == "no correction") uncorrected_um[cells[1] + " " + cells[2] + " " + cells[3]] = std::stod(cells[7]);
    if (cells[0] != "observer") continue;
    ++n_observed;
    EXPECT_LT(std::stod(cells[7]), 0.01 * std::stod(cells[5])) << line;
  }
  ASSERT_EQ(uncorrected_um.size(), 6U);
  EXPECT_EQ(n_observed, 6);
  const Record run = read_record_csv(record("to_and_fro"));
  double peak_um = 0.0;
  for (double um : run.at("tip_z").values) peak_um = std::max(peak_um, std::abs(um - run.at("tip_z").values.front()));
  EXPECT_NEAR(uncorrected_um.at("other as trained to_and_fro"), peak_um, 1e-4 * peak_um);  // the solver's relative tolerance
  for (const char* cyclogram : {"other {} to_and_fro", "drawn {} drawn_random_01", "drawn {} drawn_random_02"}) {
    const auto in = [&](const char* season) { return uncorrected_um.at(fmt::format(fmt::runtime(cyclogram), season)); };
    EXPECT_GT(in("summer"), 1.01 * in("as trained")) << cyclogram;
  }
}

}  // namespace
}  // namespace driftwright::continued_records_test
