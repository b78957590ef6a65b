// The judgement in the file of a predictor: the numbers of the report, by a matrix made by hand.

#include "compensation/judging/judgement_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "compensation/judging/strategy_verdict.hpp"
#include "compensation/predictors/past_drift.hpp"
#include "findings/strategy_section.hpp"
#include "output/document_json.hpp"

namespace driftwright::compensation::judgement_json_test {
namespace {

using Json = nlohmann::ordered_json;

Case case_of(std::size_t run, double before_um, double after_um, const std::string& failed = "") {
  Case c;
  c.run = run;
  c.failed = failed;
  c.before = {.rmse = before_um / 2.0, .peak_abs = before_um, .n = 100};
  c.after = {.rmse = after_um / 2.0, .peak_abs = after_um, .n = 100};
  c.covered = 0.9;
  return c;
}

/// Two runs, a baseline, and a strategy that keeps the tolerance on one of them.
StrategyMatrix matrix(const std::string& file) {
  StrategyMatrix m;
  StrategySettings& how = m.settings.strategies;
  how.target = "nose";
  how.reading_K = 0.1;
  how.drift_um = 0.3;
  how.count_from_start = true;
  how.physics = Physics{};
  how.physics->linearised =
      LinearisedModel{.laws = {{.name = "film head", .at_K = 303.15, .spread_K = 4.0}}, .error_um = 0.25, .drift_um = 30.0};
  m.settings.tolerance_um = 10.0;
  m.settings.fails_at = 0.5;
  const Record readings{
      .source = "monday", .time_s = {0.0, 60.0}, .channels = {{"nose", "um", {0.0, 9.0}}, {"tilt", "urad", {0.0, 1.0}}}};
  m.training.push_back({.cyclogram = {}, .ambient = {}, .readings = readings, .rows = {file, 0.0, 60.0}});
  for (const char* name : {"noon", "night"}) {
    m.runs.push_back({.family = name, .season = "summer", .name = name, .run = m.training.front()});
    m.runs.back().run.n_before = 1;
  }
  m.strategies.resize(2);
  JudgedStrategy &nothing = m.strategies[0], &formula = m.strategies[1];
  nothing.fitted.name = kNoCorrection;
  nothing.fitted.is_baseline = true;
  nothing.fitted.predictor = std::make_shared<ConstantPredictor>(0.0);
  nothing.cases = {case_of(0, 30.0, 30.0), case_of(1, 20.0, 20.0)};
  formula.fitted.name = "ridge, all sensors";
  formula.fitted.predictor = std::make_shared<ConstantPredictor>(0.0);
  formula.fitted.sensors = {"t1", "t2"};
  formula.fitted.reason = "lambda 3";
  formula.fitted.model = "linearised at 30 °C";
  formula.fitted.interval_um = 2.5;
  formula.fitted.fold_errors = {{.kind = "run", .name = "run a", .rms_um = 1.5, .within_um = 2.5}};
  formula.cases = {case_of(0, 30.0, 12.0), case_of(1, 20.0, 4.0), case_of(0, 30.0, 14.0, "t1 stuck")};
  formula.beaten_by = "mean of the training runs";
  for (JudgedStrategy& s : m.strategies) give_verdict(m, s);
  return m;
}

TEST(JudgementJson, HasTheKeysAndValuesOfTheReport) {
  for (const char* file : {"", "/records/monday.csv"}) {
    const StrategyMatrix m = matrix(file);
    const Json report = output::document_json({.body = findings::strategy_section(m, {}, {"1", "a test"})});
    for (std::size_t i = 0; i < m.strategies.size(); ++i) {
      const Json row = report.at("strategies").at(i);
      Json judged = judgement_json(m, m.strategies[i]);
      for (const auto& [key, value] : row.items()) EXPECT_EQ(judged.at(key).dump(), value.dump()) << key;
      EXPECT_EQ(judged["with_failed_sensors"], true);
      EXPECT_EQ(judged["judged_on"].dump(),
                R"([{"run":"noon","family":"noon","season":"summer"},{"run":"night","family":"night","season":"summer"}])");
      judged.erase("with_failed_sensors");
      judged.erase("judged_on");
      for (const auto& [key, value] : judged.items()) {
        if (row.contains(key)) continue;
        EXPECT_EQ(value.dump(), report.at(key).dump()) << key;
      }
    }
  }
}

TEST(JudgementJson, HasTheNumbersOfTheCases) {
  const StrategyMatrix m = matrix("");
  const Json judged = judgement_json(m, m.strategies[1]);
  EXPECT_EQ(judged["worst_peak_um"], 12.0);
  EXPECT_EQ(judged["worst_left_percent"], 40.0);
  EXPECT_EQ(judged["failed_sensor_worst_peak_um"], 14.0);
  EXPECT_DOUBLE_EQ(judged["overall_rms_um"].get<double>(), std::sqrt((6.0 * 6.0 + 2.0 * 2.0) / 2.0));
  EXPECT_EQ(judged["verdict"], "safe within limits");
  EXPECT_EQ(judged["cells_kept"], 1);
  EXPECT_EQ(judged["cells"], 3);
  EXPECT_EQ(judged["linearised_laws"][0].dump(), R"({"law":"film head","at_degC":30.0,"spread_K":4.0})");
  EXPECT_EQ(judged["trained_on"].dump(), R"(["monday"])");
  EXPECT_EQ(judged["not_judged"].dump(), R"(["tilt"])");
  const Json baseline = judgement_json(m, m.strategies[0]);
  EXPECT_EQ(baseline["verdict"], "baseline");
  for (const char* key : {"why", "worse_than_nothing", "keeps_tolerance_in", "interval_95_um", "left_out_um"})
    EXPECT_TRUE(baseline.at(key).is_null()) << key;
}

}  // namespace
}  // namespace driftwright::compensation::judgement_json_test
