// The same commands on measured records. The records are not part of the project; without them the test says so and is
// skipped.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/csv_row.hpp"
#include "base/record.hpp"
#include "tests/shared/command_line.hpp"

namespace driftwright::measured_records_test {
namespace {

/// A number of strategies.csv: the row of that strategy, the column of that name.
double cell(const std::string& csv, const std::string& strategy, const std::string& column) {
  std::istringstream lines(csv);
  std::string line;
  while (std::getline(lines, line) && line.starts_with("#")) continue;
  const std::vector<std::string> header = csv_cells(line);
  const auto n = static_cast<std::size_t>(std::find(header.begin(), header.end(), column) - header.begin());
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = csv_cells(line);
    if (cells.front() == strategy) return std::stod(cells.at(n));
  }
  return std::nan("");
}

TEST(Spindle22, RankingAndRegressionAgreeWithAnIndependentCalculation) {
  const std::filesystem::path data = "../shared/data/spindle_22";
  if (!std::filesystem::exists(data / "run3.csv")) GTEST_SKIP() << "no measured records in " << data;
  const auto folder = fresh_folder("spindle_22") / "out";
  const std::string train = " --train " + (data / "run1.csv").string() + " --train " + (data / "run2.csv").string();
  ASSERT_EQ(run_program("validate scenarios/spindle_22.yaml" + train + " --test " + (data / "run3.csv").string() + " -o " +
                        folder.string())
                .exit_code,
            0);
  const auto summary = nlohmann::json::parse(read_text(folder / "summary.json"));

  // Reference: grey relational grades (range image), regression by normal equations in exact rational arithmetic and both
  // baselines, written independently in Python. Six digits, as the summary has.
  const auto model = nlohmann::json::parse(read_text(folder / "models" / "regression_grey_grade.json"));
  std::map<std::string, double> coefficients;
  for (const auto& term : model["formula"]["terms"]) coefficients[term["input"]] = term["coefficient"];
  EXPECT_NEAR(model["formula"]["intercept"].get<double>(), 0.767083, 2e-6);
  EXPECT_NEAR(coefficients["rise_00"], 7.910716, 1e-5);
  EXPECT_NEAR(coefficients["rise_13"], -0.438819, 1e-6);
  EXPECT_NEAR(coefficients["rise_12"], -0.251247, 1e-6);
  EXPECT_NEAR(coefficients["rise_14"], -6.019788, 1e-5);
  const std::string csv = read_text(folder / "strategies.csv");
  EXPECT_NEAR(cell(csv, "regression, grey grade", "rms_without_fail_safe_um"), 2.260104, 1e-5);
  EXPECT_NEAR(cell(csv, "mean of the training runs", "rms_without_fail_safe_um"), 3.316652, 1e-5);
  EXPECT_NEAR(cell(csv, "training runs at the same time", "rms_without_fail_safe_um"), 1.233022, 1e-5);
  // It keeps 10 um, but a baseline does better: that has to be said.
  for (const auto& strategy : summary["validation"]["strategies"]) {
    if (strategy["name"] == "regression, grey grade") {
      EXPECT_EQ(strategy["beaten_by"], "training runs at the same time");
    }
  }

  ASSERT_EQ(run_program("select scenarios/spindle_22.yaml" + train + " -o " + folder.string()).exit_code, 0);
  const auto ranking = nlohmann::json::parse(read_text(folder / "summary.json"));
  EXPECT_EQ(ranking["channels"][0]["name"], "rise_00");
  EXPECT_NEAR(ranking["channels"][0]["grade"].get<double>(), 0.746902, 1e-6);
  EXPECT_NEAR(ranking["channels"][4]["grade"].get<double>(), 0.706740, 1e-6);
}

// One record of 28 h: fitted to its first 20 h, judged by the other 8.
TEST(FlThermal, ALongRecordIsCutIntoRunsAndJudgedByItsOtherPart) {
  const std::filesystem::path file = "../shared/data/fl_thermal/first_28h.csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no measured record " << file;
  const auto folder = fresh_folder("fl_thermal") / "out";
  const CommandOutcome run = run_program("validate scenarios/measured/fl_thermal.yaml --train " + file.string() +
                                         ":0h..20h --test " + file.string() + ":20h..28h -o " + folder.string());
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const auto summary = nlohmann::json::parse(read_text(folder / "summary.json"));
  // every strategy that needs no machine
  const auto& left_out = summary["validation"]["left_out"];
  ASSERT_EQ(left_out.size(), 1u) << left_out;
  EXPECT_EQ(left_out[0]["why"], "the scenario has no machine");
  EXPECT_EQ(summary["validation"]["trained_on"].size(), 3u) << summary["validation"]["trained_on"];
  // Reference: means over the rows of 0 h to 20 h and 20 h to 28 h of the drift since the first row of the file, written
  // independently in Python.
  const std::string csv = read_text(folder / "strategies.csv");
  EXPECT_NEAR(cell(csv, "no correction", "rms_without_fail_safe_um"), 41.240482, 1e-5);
  EXPECT_NEAR(cell(csv, "mean of the training runs", "rms_without_fail_safe_um"), 37.605422, 1e-5);
  EXPECT_NEAR(cell(csv, "last value of the training runs", "rms_without_fail_safe_um"), 20.788826, 1e-5);
  EXPECT_NEAR(cell(csv, "no correction", "peak_before_um"), 69.131, 1e-3);
}

// The network of docs/start/fl_thermal.md, in the recorded ambient: what it leaves of the hours that it was not fitted to.
TEST(FlThermalNetwork, LeavesOfTheHoursKeptOutWhatItsTutorialSays) {
  const std::filesystem::path file = std::filesystem::absolute("../shared/data/fl_thermal/first_28h.csv");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no measured record " << file;
  const auto folder = fresh_folder("fl_thermal_network");
  std::string scenario = read_text("scenarios/measured/fl_thermal_network.yaml");
  const std::size_t ambient = scenario.find("\nambient: ") + 1;
  scenario.replace(ambient, scenario.find('\n', ambient) - ambient, "ambient: {csv: " + file.string() + ", channel: t16}");
  std::ofstream(folder / "here.yaml") << scenario;
  const CommandOutcome run = run_program("simulate " + (folder / "here.yaml").string() + " --cyclogram " + file.string() +
                                         " -o " + (folder / "out").string());
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const Record simulated = read_record_csv((folder / "out" / "record.csv").string());
  const Record measured =
      read_record_csv(file.string());  // four rows to one of the simulation, whose last row is the end itself
  // Reference: the same network integrated in Python by matrix exponentials, bench/measured/fit_fl_thermal.py (2.18,
  // 1.83, 2.02, 2.56, 3.84 of means of five minutes); single rows have a little more.
  const std::map<std::string, double> left_um = {{"ch1", 2.26}, {"ch2", 1.90}, {"ch3", 2.05}, {"ch4", 2.57}, {"ch5", 3.68}};
  for (const auto& [channel, expected_um] : left_um) {
    double sum = 0.0;
    int n = 0;
    for (std::size_t row = 20 * 60; row + 1 < simulated.n_samples(); ++row, ++n) {
      ASSERT_EQ(simulated.time_s[row], measured.time_s[4 * row]);
      sum += std::pow(simulated.at(channel).values[row] - measured.at(channel).values[4 * row], 2);
    }
    EXPECT_NEAR(std::sqrt(sum / n), expected_um, 0.05) << channel;
  }
}

}  // namespace
}  // namespace driftwright::measured_records_test
