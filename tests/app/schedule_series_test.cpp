// `driftwright schedule` of several parts in a row, as a user runs it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/record.hpp"
#include "tests/app/scheduled.hpp"

namespace driftwright::schedule_series_test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr;

/// A part of 20 min, and the machine's 50 min between cold and warm.
constexpr const char* kShortPart =
    "G21 G90 G54\nS2000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX190 F20\nG0 Z5\nX0\nG1 Z-2 F100\nX190 F20\nG0 Z5\nM30\n";

/// Time and nose_z [um] of a record.
std::vector<double> drift_of(const std::filesystem::path& folder) {
  return read_record_csv((folder / "record.csv").string()).at("nose_z").values;
}

// The scenario's own cyclogram that repeats the program is the independent account of a series.
TEST(ScheduleSeries, TheDriftOfPartsIsThatOfTheProgramRepeated) {
  std::string repeated = kScheduledHead;
  repeated.replace(repeated.find("cyclograms: {"), 13,
                   "cyclograms: {three: {nc_program: part.ngc, rapid: 10 m/min, repeat: 3}, ");
  const Scheduled s = run_schedule("series_repeat", kShortPart, "--parts 3", repeated);
  ASSERT_EQ(s.outcome.exit_code, 0) << s.outcome.output;
  const auto simulated = s.folder.parent_path() / "simulated";
  ASSERT_EQ(run_program("simulate " + (s.folder.parent_path() / "head.yaml").string() + " --cyclogram three -o " +
                        simulated.string())
                .exit_code,
            0);
  const Record series = read_record_csv((s.folder / "record.csv").string()),
               whole = read_record_csv((simulated / "record.csv").string());
  EXPECT_NEAR(series.time_s.back(), whole.time_s.back(), 1e-6);
  std::size_t n_compared = 0;
  for (std::size_t i = 0; i < series.n_samples(); ++i) {
    for (std::size_t k = 0; k < whole.n_samples(); ++k) {
      if (std::abs(series.time_s[i] - whole.time_s[k]) > 1e-6) continue;
      ++n_compared;
      EXPECT_NEAR(series.at("nose_z").values[i], whole.at("nose_z").values[k], 0.01) << series.time_s[i];  // 1e-4 of 60 um
    }
  }
  EXPECT_GT(n_compared, 10U);
}

TEST(ScheduleSeries, WritesOneProgramForEachPartThatDiffers) {
  const Scheduled one = run_schedule("series_one", kShortPart);
  const Scheduled s = run_schedule("series_warming", kShortPart, "--parts 4 --between '2 min'");
  ASSERT_EQ(s.outcome.exit_code, 0) << s.outcome.output;
  EXPECT_THAT(s.outcome.output,
              AllOf(HasSubstr("4 parts of "), HasSubstr("with 2 min between"), HasSubstr("part 4: part_04.ngc")));
  EXPECT_FALSE(std::filesystem::exists(s.folder / "part.ngc"));
  EXPECT_EQ(read_text(s.folder / "part_01.ngc"), read_text(one.folder / "part.ngc")) << "the first part knows of no series";
  EXPECT_NE(read_text(s.folder / "part_02.ngc"), read_text(s.folder / "part_01.ngc"));
  EXPECT_THAT(read_text(s.folder / "schedule.csv"),
              AllOf(HasSubstr("first_part,last_part,time_s,line"), HasSubstr("\n4,4,0.000,")));
  EXPECT_THAT(read_text(s.folder / "schedule.txt"), HasSubstr("# part 3: part_03.ngc"));
  EXPECT_THAT(read_text(s.folder / "report.html"), HasSubstr("The parts of the series"));
  EXPECT_THAT(read_text(s.folder / "summary.json"), HasSubstr("\"n_parts\": 4"));
}

// After ten hours at the program's speed the machine is in balance. All parts drift alike, so one program makes them all,
// and it begins with the whole drift.
TEST(ScheduleSeries, OfAWarmMachineIsOneProgram) {
  const std::string start = write_file("ten_hours.csv", "time_s,speed_rpm\n0,2000\n36000,0\n");
  const Scheduled s = run_schedule("series_warm", kShortPart, "--parts 5 --start " + start);
  ASSERT_EQ(s.outcome.exit_code, 0) << s.outcome.output;
  EXPECT_THAT(s.outcome.output, AllOf(HasSubstr("parts 1 to 5: part.ngc"), HasSubstr("after " + start + " (600 min")));
  EXPECT_TRUE(std::filesystem::exists(s.folder / "part.ngc"));
  EXPECT_FALSE(std::filesystem::exists(s.folder / "part_01.ngc"));
  EXPECT_NEAR(drift_of(s.folder).front(), 60.0, 0.05);  // 300 W on 20 W/K, 4 um/K
}

// Parts 2 and 3 of a series are a series of two after the record of the first and the pause.
TEST(ScheduleSeries, StartsWarmBehindARecordOfTheFirstPart) {
  const Scheduled three = run_schedule("series_three", kShortPart, "--parts 3 --between '2 min'");
  const Scheduled first = run_schedule("series_first", kShortPart);
  const Scheduled rest =
      run_schedule("series_rest", kShortPart,
                   "--parts 2 --between '2 min' --after-pause '2 min' --start " + (first.folder / "record.csv").string());
  ASSERT_EQ(rest.outcome.exit_code, 0) << rest.outcome.output;
  const std::vector<double> all = drift_of(three.folder), later = drift_of(rest.folder);
  ASSERT_GT(all.size(), later.size());
  for (std::size_t i = 0; i < later.size(); ++i)
    EXPECT_NEAR(later[later.size() - 1 - i], all[all.size() - 1 - i], 0.2)
        << i;  // rows of the record blur when the speed changed
}

// Where the work offset is probed before each part, each counts its drift from its own start; else all count from the
// reference.
TEST(ScheduleSeries, CountsFromTheStartOfEachPartWhereTheOffsetIsProbed) {
  for (const bool is_probed : {true, false}) {
    const Scheduled s = run_schedule(is_probed ? "series_probed" : "series_unprobed", kShortPart, "--parts 3",
                                     std::string(kScheduledHead) + (is_probed ? "  drift_from: start\n" : ""));
    ASSERT_EQ(s.outcome.exit_code, 0) << s.outcome.output;
    const Record record = read_record_csv((s.folder / "record.csv").string());
    const std::vector<double>& drift_um = record.at("nose_z").values;
    const nlohmann::json summary = nlohmann::json::parse(read_text(s.folder / "summary.json"));
    ASSERT_EQ(summary["corrected"].size(), 3U);
    const double part_s = record.time_s.back() / 3.0;
    for (int part = 0; part < 3; ++part) {
      std::vector<double> own_um;
      for (std::size_t i = 0; i < record.n_samples(); ++i) {
        if (record.time_s[i] > part * part_s - 1e-3 && record.time_s[i] < (part + 1) * part_s + 1e-3)
          own_um.push_back(drift_um[i]);
      }
      const double zero_um = is_probed ? own_um.front() : 0.0;
      const double expected_um = *std::max_element(own_um.begin(), own_um.end()) - zero_um;  // it rises
      EXPECT_NEAR(summary["corrected"][part]["axes"][1]["peak_before_um"], expected_um, 1e-3) << "part " << part + 1;
    }
  }
}

TEST(ScheduleSeries, RefusesSeriesThatAreNone) {
  EXPECT_EQ(run_schedule("series_zero", kShortPart, "--parts 0").outcome.exit_code, 2);
  EXPECT_EQ(run_schedule("series_between", kShortPart, "--between '2 min'").outcome.exit_code, 2);
  const CommandOutcome wrong = run_schedule("series_unit", kShortPart, "--parts 2 --between '2 mm'").outcome;
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.output, AllOf(HasSubstr("--between"), HasSubstr("2 mm")));
}

}  // namespace
}  // namespace driftwright::schedule_series_test
