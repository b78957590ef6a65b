// The same commands on measured records. The records are not part of the project; without them the test says so and is skipped.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/command_line.hpp"

namespace driftwright {
namespace {

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
  const auto& coefficients = summary["regression"]["coefficients"];
  EXPECT_NEAR(summary["regression"]["intercept"].get<double>(), 0.767083, 2e-6);
  EXPECT_NEAR(coefficients["rise_00"].get<double>(), 7.910716, 1e-5);
  EXPECT_NEAR(coefficients["rise_13"].get<double>(), -0.438819, 1e-6);
  EXPECT_NEAR(coefficients["rise_12"].get<double>(), -0.251247, 1e-6);
  EXPECT_NEAR(coefficients["rise_14"].get<double>(), -6.019788, 1e-5);
  EXPECT_NEAR(summary["judged"][0]["rmse"].get<double>(), 2.260104, 1e-5);
  EXPECT_NEAR(summary["judged"][1]["rmse"].get<double>(), 3.316652, 1e-5);
  EXPECT_NEAR(summary["judged"][2]["rmse"].get<double>(), 1.233022, 1e-5);

  ASSERT_EQ(run_program("select scenarios/spindle_22.yaml" + train + " -o " + folder.string()).exit_code, 0);
  const auto ranking = nlohmann::json::parse(read_text(folder / "summary.json"));
  EXPECT_EQ(ranking["channels"][0]["name"], "rise_00");
  EXPECT_NEAR(ranking["channels"][0]["grade"].get<double>(), 0.746902, 1e-6);
  EXPECT_NEAR(ranking["channels"][4]["grade"].get<double>(), 0.706740, 1e-6);
}

TEST(MeasuredScenarios, AreReadByTheProgramWithoutTheirRecords) {
  int n = 0;
  for (const auto& file : std::filesystem::directory_iterator("scenarios/measured")) {
    const CommandOutcome outcome = run_program("check " + file.path().string());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    ++n;
  }
  EXPECT_EQ(n, 8);
}

}  // namespace
}  // namespace driftwright
