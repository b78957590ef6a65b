// Strategies on the shipped mill, as a user judges them; and predictors through every actuator.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "base/csv_row.hpp"
#include "tests/shared/command_line.hpp"

namespace driftwright::validation_study_test {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

struct CsvRow {
  std::string strategy, family, season, failed;
  double before_um = 0.0, left_um = 0.0, rms_before_um = 0.0, rms_left_um = 0.0, covered_percent = NAN;
};

std::vector<CsvRow> read_rows(const std::string& csv) {
  std::vector<CsvRow> rows;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);  // who made it
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = csv_cells(line);
    // strategy, family, season, run, failed, peak before, rms before, peak left, ..., covered, rows
    rows.push_back({cells[0], cells[1], cells[2], cells[4], std::stod(cells[5]), std::stod(cells[7]), std::stod(cells[6]),
                    std::stod(cells[8]), cells[15].empty() ? NAN : std::stod(cells[15])});
  }
  return rows;
}

class ValidationStudy : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fresh_folder("validation") / "out";
    outcome_ = run_program("validate scenarios/cnc_mill_13.yaml -o " + folder_.string());
    ASSERT_EQ(outcome_.exit_code, 0) << outcome_.output;
    validation_ = Json::parse(read_text(folder_ / "summary.json"))["validation"];
    rows_ = read_rows(read_text(folder_ / "strategies.csv"));
  }
  static const Json& strategy(const std::string& name) {
    for (const Json& s : validation_["strategies"]) {
      if (s["name"] == name) return s;
    }
    throw std::runtime_error("no strategy " + name);
  }
  /// Largest peak left [um].
  static double worst(const std::string& name, const std::function<bool(const CsvRow&)>& counts) {
    double largest = -1.0;
    for (const CsvRow& r : rows_) {
      if (r.strategy == name && counts(r)) largest = std::max(largest, r.left_um);
    }
    return largest;
  }
  static inline std::filesystem::path folder_;
  static inline CommandOutcome outcome_;
  static inline Json validation_;
  static inline std::vector<CsvRow> rows_;
};

bool is_intact(const CsvRow& r) {
  return r.failed.empty();
}

// The goal for the best strategy: a tenth of the peak with sensors intact, three tenths with one failed, in its worst
// run. An exchange of two of its thermometers (0.57, docs/how-to/validation.md) and an ambient thermometer that drifts
// (0.51) are beyond it: both look like a model that is wrong, and a wrong model's correction fades. So it is safe within
// limits.
TEST_F(ValidationStudy, TheObserverLeavesATenthAndThreeTenthsWithAFailedSensor) {
  double intact = 0.0, failed = 0.0, exchanged = 0.0, drifting_ambient = 0.0;
  for (const CsvRow& r : rows_) {
    if (r.strategy != "observer") continue;
    double& worst = is_intact(r)                                      ? intact
                    : r.failed.find("exchanged") != std::string::npos ? exchanged
                    : r.failed.starts_with("X1 drifting")             ? drifting_ambient
                                                                      : failed;
    worst = std::max(worst, r.left_um / r.before_um);
  }
  EXPECT_GT(intact, 0.0);
  EXPECT_LE(intact, 0.10);
  EXPECT_GT(failed, 0.0);
  EXPECT_LE(failed, 0.30);
  EXPECT_GT(exchanged, 0.0);
  EXPECT_LE(exchanged, 0.60);
  EXPECT_LE(drifting_ambient, 0.55);
  EXPECT_EQ(validation_["chosen"], "observer");
  EXPECT_EQ(strategy("observer")["verdict"], "safe within limits");
  EXPECT_EQ(strategy("observer")["worse_than_nothing"], false);
}

// Polyakov, Marusich & Nikitina: a regression on temperatures that was fitted to continuous running does not predict the
// drift of another cyclogram.
TEST_F(ValidationStudy, TemperaturesAloneFailWhereTheyWereNotTrained) {
  const auto chaotic_as_trained = [](const CsvRow& r) {
    return is_intact(r) && r.family == "chaotic" && r.season == "as trained";
  };
  EXPECT_GT(worst("regression, grey grade", chaotic_as_trained), 10.0);
  EXPECT_LT(worst("observer", chaotic_as_trained), 1.0);
  EXPECT_EQ(strategy("regression, grey grade")["verdict"], "unsafe");
}

TEST_F(ValidationStudy, AVerdictIsWhatItsCasesSay) {
  for (const Json& s : validation_["strategies"]) {
    if (s["baseline"] == true) continue;
    bool keeps = true, harms = false, is_worse_than_nothing = false;
    for (const CsvRow& r : rows_) {
      if (r.strategy != s["name"]) continue;
      keeps = keeps && r.left_um <= 10.0;
      const bool is_worse = r.left_um > r.before_um || r.rms_left_um > r.rms_before_um;
      is_worse_than_nothing = is_worse_than_nothing || is_worse;
      harms = harms || (is_worse && r.left_um > 10.0);
    }
    EXPECT_EQ(s["verdict"] == "safe to deploy", keeps) << s["name"];
    EXPECT_TRUE(!harms || s["verdict"] == "unsafe") << s["name"];
    const bool says_so = s["why"].get<std::string>().find("more is left than without any correction") != std::string::npos;
    EXPECT_EQ(says_so, is_worse_than_nothing) << s["name"] << s["why"];
  }
}

TEST_F(ValidationStudy, EverySensorOfAStrategyFailsInEveryWay) {
  const auto n_sensors = strategy("regression, forward")["sensors"].size();
  std::set<std::string> failed;
  for (const CsvRow& r : rows_) {
    if (r.strategy == "regression, forward" && !r.failed.empty()) failed.insert(r.failed);
  }
  // stuck, open, fallen off, drifting up and down, exchanged; the room's own thermometer cannot fall off to read the room
  EXPECT_GE(failed.size(), 6 * n_sensors - 1);
}

TEST_F(ValidationStudy, WritesFormulasAsTextJsonAndC) {
  const std::string text = read_text(folder_ / "models" / "regression_forward.txt");
  EXPECT_THAT(text, HasSubstr("drift_z [um] ="));
  EXPECT_THAT(text, HasSubstr("um/degC"));
  EXPECT_THAT(text, HasSubstr("Valid for"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "models" / "regression_forward.c"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "models" / "regression_forward_axis.comp"));
  for (const char* file : {"drift_correction.h", "drift_correction.c", "axis_offset.h", "axis_offset.c", "probe_feedback.h",
                           "probe_feedback.c", "probe_members.h", "probe_members.c"}) {
    EXPECT_GT(read_text(folder_ / "models" / file).size(), 500u) << file;
    EXPECT_EQ(read_text(folder_ / "models" / file), read_text(std::filesystem::path("compensation/control") / file)) << file;
  }
  const Json probing = Json::parse(read_text(folder_ / "models" / "regression_with_lags.json"))["probing"];
  EXPECT_GT(probing["deviation_um"], 0.0);  // without --probe, too
  EXPECT_GT(probing["time_constant_s"], 0.0);
  EXPECT_EQ(probing["noise_um"], 1.0);
}

TEST_F(ValidationStudy, GivesTheSameBytesOnOneThread) {
  const auto other = fresh_folder("validation_one_thread") / "out";
  setenv("OMP_NUM_THREADS", "1", 1);
  const CommandOutcome outcome = run_program("validate scenarios/cnc_mill_13.yaml -o " + other.string());
  unsetenv("OMP_NUM_THREADS");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  for (const char* file : {"summary.json", "strategies.csv", "models/regression_with_lags.c"})
    EXPECT_EQ(read_text(other / file), read_text(folder_ / file)) << file;
  std::string page = read_text(other / "report.html");  // its commands name the folder
  for (std::size_t at = 0; (at = page.find(other.string(), at)) != std::string::npos; at += folder_.string().size())
    page.replace(at, other.string().size(), folder_.string());
  EXPECT_EQ(page, read_text(folder_ / "report.html"));
}

TEST_F(ValidationStudy, SaysOfWhichAxisItsVerdictsAreAndHowFarAllAxesDrift) {
  EXPECT_THAT(outcome_.output, HasSubstr("Verdicts are of drift_z alone: no strategy here corrects or judges structure_z."));
  EXPECT_EQ(validation_["not_judged"], Json({"structure_z"}));
  std::set<std::string> runs;
  std::map<std::string, int> n_channels;
  for (const Json& run : validation_["iso_230_3"]) {
    runs.insert(run["run"]);
    if (run["not_available"] != "") continue;
    ++n_channels[run["run"]];
    EXPECT_LE(run["range_first_60_min"].get<double>(), run["range_running_period"].get<double>()) << run["run"];
  }
  EXPECT_FALSE(n_channels.empty());
  for (const auto& [run, n] : n_channels) EXPECT_EQ(n, 2) << run;
  std::set<std::pair<std::string, std::string>> judged;  // by strategies.csv
  std::istringstream csv(read_text(folder_ / "strategies.csv"));
  std::string line;
  std::getline(csv, line);  // who made it
  std::getline(csv, line);
  while (std::getline(csv, line)) {
    const std::vector<std::string> cells = csv_cells(line);
    judged.insert({cells[3], cells[2]});
  }
  EXPECT_EQ(runs.size(), judged.size());
  for (const auto& [name, season] : judged) EXPECT_TRUE(runs.contains(name + ", " + season)) << name;
  EXPECT_THAT(read_text(folder_ / "report.html"), HasSubstr("d(X),60: first 60 min"));
}

TEST_F(ValidationStudy, AModelGoesThroughInjectorAndSchedule) {
  const auto out = fresh_folder("compensate") / "out";
  const auto compensate = [&](const std::string& scenario, const std::string& model, const std::string& through) {
    const CommandOutcome outcome = run_program("compensate scenarios/" + scenario + " --model " + model + " --through " +
                                               through + " -o " + out.string());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    return Json::parse(read_text(out / "summary.json"));
  };
  const std::string formula = (folder_ / "models" / "ridge_all_sensors.json").string();
  EXPECT_LT(compensate("cnc_mill_13.yaml", formula, "schedule")["peak_left_um"].get<double>(), 20.0);
  const Json injected = compensate("fp3_spindle.yaml", "modes", "injector");
  EXPECT_EQ(injected["channel"], "drift_y");
  EXPECT_GT(injected["peak_before_um"].get<double>(), 25.0);
  EXPECT_LT(injected["peak_left_um"].get<double>(), 4.0);  // 1 um of resolution, lag and the axis beside the model
  for (const char* model : {"modes", "observer", "regression"}) {
    const Json done = compensate("gantry_table.yaml", model, "frame");
    ASSERT_EQ(done["corrections"].size(), 4u);
    EXPECT_EQ(done["corrections"][0]["removed_percent"], 0.0);
    if (std::string(model) == "regression") continue;
    EXPECT_LT(done["corrections"][2]["x_um"].get<double>(), 0.4 * done["corrections"][0]["x_um"].get<double>()) << model;
  }
}

// With a probing every half hour each correction leaves less, and the last probing alone much less than nothing.
TEST(ValidationByDefault, SaysWhatProbingsLeave) {
  const auto out = temporary_folder() / "probed";
  const CommandOutcome run =
      run_program("validate scenarios/lumped_spindle.yaml --probe '30 min' -o " + out.string() + " --force");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_THAT(run.output, HasSubstr("With a probing every 30 min, noise 1 µm"));
  const Json rows = Json::parse(read_text(out / "summary.json"))["validation"]["probing"];
  ASSERT_GT(rows.size(), 10u);
  for (const Json& row : rows) {
    if (row["name"] == "weights by probings") {  // no strategy of its own: nothing is without probings
      EXPECT_TRUE(row["overall_rms_um"].is_null());
      continue;
    }
    const double without = row["overall_rms_um"], with = row["probed_rms_um"];
    EXPECT_LT(with, std::max(1.02 * without, 1.0)) << row;
    if (row["name"] == "no correction") {
      EXPECT_LT(with, 0.75 * without) << row;
    }
  }
  const CommandOutcome wrong =
      run_program("validate scenarios/lumped_spindle.yaml --probe 0min -o " + out.string() + " --force");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.output, HasSubstr("must be above 0"));
}

TEST_F(ValidationStudy, WhatCannotBeCorrectedIsRefused) {
  const auto outcome = [](const std::string& arguments) {
    return run_program("compensate " + arguments + " -o " + (fresh_folder("refused") / "o").string());
  };
  const auto expect = [&](const std::string& arguments, const std::string& words) {
    const CommandOutcome o = outcome(arguments);
    EXPECT_EQ(o.exit_code, 2) << arguments << o.output;
    EXPECT_THAT(o.output, HasSubstr(words)) << arguments;
  };
  expect("scenarios/cnc_mill_13.yaml --model observer --through schedule", "models/observer.json");
  expect("scenarios/cnc_mill_13.yaml --model modes --through none --measured a.csv", "--measured is allowed only with");
  expect("scenarios/cnc_mill_13.yaml --model modes --through injector", "axis_loop");
  expect("scenarios/cnc_mill_13.yaml --model modes --through frame", "table");
  expect("scenarios/cnc_mill_13.yaml --model no_such.json --through schedule", "no_such.json");
  expect("scenarios/gantry_table.yaml --model no_such.json --through frame", "modes, observer, regression");
  expect("scenarios/cnc_mill_13.yaml --model modes --through belt", "belt");
}

}  // namespace
}  // namespace driftwright::validation_study_test
