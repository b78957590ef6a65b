// Predictors as files: there and back to the last digit, row by row, and what is refused.

#include "output/predictor_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/errors.hpp"
#include "compensation/formula_predictor.hpp"
#include "compensation/past_drift.hpp"
#include "tests/sensor_records.hpp"
#include "tests/temporary_file.hpp"

namespace driftwright::output {
namespace {

using namespace compensation;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using Json = nlohmann::ordered_json;

/// Four thermometers, the third between the first two and the fourth beside the first, and a speed.
ObservedRun machine(std::uint64_t seed) {
  ObservedRun run{.cyclogram = {.name = "work", .sections = {{9000.0, {.speed_rpm = 2000.0}}, {9e4, {}}}},
                  .hall = {{0.0, 9000.0}, {0.0, 1.5}},
                  .readings = fixtures::sensor_record(seed, 300, 4, 0.02, 0.1)};
  Record& r = run.readings;
  for (std::size_t i = 0; i < r.n_samples(); ++i) {
    r.channels[2].values[i] =
        0.5 * (r.channels[0].values[i] + r.channels[1].values[i]) + 0.01 * std::sin(5.0 * static_cast<double>(i));
    r.channels[3].values[i] = r.channels[0].values[i] + 0.01 * std::cos(7.0 * static_cast<double>(i));
    r.time_s[i] = 60.0 * static_cast<double>(i);
  }
  r.channels.push_back({"spindle", "rpm", {}});
  for (std::size_t i = 0; i < r.n_samples(); ++i) r.channels.back().values.push_back(i / 40 % 2 == 0 ? 1500.0 : 0.0);
  return run;
}

PredictorFile formula(bool from_start) {
  PredictorFile file;
  DeployedPredictor& d = file.predictor;
  d.name = "regression with lags";
  d.target = "drift_y";
  d.from_start = from_start;
  d.sensors = {"X1", "X2", "X3", "X4"};
  d.hall = "X4";
  d.reason = "because";
  DriftModel model{.kind = "regression with lags",
                   .target = "drift_y",
                   .target_unit = "um",
                   .intercept = 1.0 / 3.0,
                   .terms = {{.input = "X3", .unit = "degC", .coefficient = -0.7},
                             {.input = "X1", .unit = "degC", .coefficient = 2.3, .lag_s = 780.0},
                             {.input = "X2", .unit = "degC", .coefficient = 0.02, .power = 2},
                             {.input = "X4", .unit = "degC", .coefficient = 0.9},
                             {.input = "spindle", .unit = "rpm", .coefficient = 1e-6, .power = 2, .lag_s = 1200.0}},
                   .from_start = from_start};
  std::vector<Record> training;
  std::vector<std::vector<double>> predicted;
  for (const std::uint64_t seed : {1, 2}) {
    training.push_back(machine(seed).readings);
    predicted.push_back(model.predict(training.back()));
  }
  d.fail_safe = learn_fail_safe(training, {"X1", "X2", "X3", "X4", "spindle"}, predicted, from_start);
  d.predictor = std::make_shared<FormulaPredictor>(std::move(model));
  d.interval_um = 2.0 / 7.0;
  file.judged = {{"verdict", "safe within limits"}, {"tolerance_um", 10.0}};
  return file;
}

PredictorFile back(const PredictorFile& file, const std::vector<effects::Effect>& effects = {}) {
  return read_predictor(driftwright::write_file("predictor.json", predictor_json(file, effects, {"1", "a test"}).dump()));
}

/// Everything but a model's laws is in the text.
void expect_same(const PredictorFile& a, const PredictorFile& b, const std::vector<effects::Effect>& effects = {}) {
  EXPECT_EQ(predictor_json(a, effects, {"1", "a test"}).dump(), predictor_json(b, effects, {"1", "a test"}).dump());
}

TEST(PredictorFile, AFormulaComesBackToTheLastDigit) {
  for (const bool from_start : {false, true}) {
    PredictorFile file = formula(from_start);
    const PredictorFile read = back(file);
    expect_same(file, read);
    const ObservedRun run = machine(7);
    EXPECT_EQ(correct(file.predictor, run).correction_um, correct(read.predictor, run).correction_um);
    EXPECT_EQ(read.predictor.interval_um, file.predictor.interval_um);
    EXPECT_EQ(read.judged["verdict"], "safe within limits");
    file.predictor.interval_um.reset();
    EXPECT_FALSE(back(file).predictor.interval_um);
  }
}

TEST(PredictorFile, WhatWasMeasuredBeforeComesBack) {
  PredictorFile file;
  file.predictor = {
      .name = "mean", .target = "um", .is_baseline = true, .predictor = std::make_shared<ConstantPredictor>(-1.0 / 3.0)};
  expect_same(file, back(file));
  EXPECT_EQ(live(*back(file).predictor.predictor, machine(1)), std::vector<double>(300, -1.0 / 3.0));
  std::vector<Record> runs = {{"a", {0.0, 100.0, 300.0}, {{"z", "um", {0.0, NAN, 30.0}}}},
                              {"b", {0.0, 7000.0}, {{"z", "um", {1.0, 0.1}}}}};
  file.predictor.target = "z";
  file.predictor.predictor = std::make_shared<EarlierRunsPredictor>(runs, "z");
  expect_same(file, back(file));
  const std::vector<double> before = live(*file.predictor.predictor, machine(1)),
                            after = live(*back(file).predictor.predictor, machine(1));
  ASSERT_EQ(before.size(), after.size());
  EXPECT_EQ(before[0], 0.5);  // mean of both at the start
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_TRUE(before[i] == after[i] || (std::isnan(before[i]) && std::isnan(after[i])));
  EXPECT_TRUE(std::isnan(before.back()));  // behind both
}

TEST(PredictorFile, WhatIsNoneIsRefusedWithItsKey) {
  const Json good = predictor_json(formula(false), {}, {"1", "a test"});
  struct Broken {
    const char* what;
    std::function<void(Json&)> by;
    const char* key;
  };
  const std::vector<Broken> all = {
      {"format", [](Json& j) { j["format"] = "something else"; }, "format"},
      {"no kind", [](Json& j) { j["formula"].erase("kind"); }, "`kind`"},
      {"number as kind", [](Json& j) { j["formula"]["kind"] = 3; }, "`kind`"},
      {"text as intercept", [](Json& j) { j["formula"]["intercept"] = "1.0"; }, "`intercept`"},
      {"null as coefficient", [](Json& j) { j["formula"]["terms"][1]["coefficient"] = nullptr; }, "`coefficient`"},
      {"no lag", [](Json& j) { j["formula"]["terms"][0].erase("lag_s"); }, "`lag_s`"},
      {"negative lag", [](Json& j) { j["formula"]["terms"][0]["lag_s"] = -1.0; }, "`lag_s` -1"},
      {"power 0", [](Json& j) { j["formula"]["terms"][0]["power"] = 0; }, "`power` 0"},
      {"terms as text", [](Json& j) { j["formula"]["terms"] = "none"; }, "`terms`"},
      {"no fail-safe", [](Json& j) { j.erase("fail_safe"); }, "`fail_safe`"},
      {"no fade", [](Json& j) { j["fail_safe"].erase("fade_s"); }, "`fade_s`"},
      {"fade 0", [](Json& j) { j["fail_safe"]["fade_s"] = 0.0; }, "`fade_s`"},
      {"period 0", [](Json& j) { j["fail_safe"]["period_s"] = 0.0; }, "`period_s`"},
      {"clamp upside down", [](Json& j) { j["fail_safe"]["lowest_um"] = 1e6; }, "`lowest_um`"},
      {"slew below 0", [](Json& j) { j["fail_safe"]["most_rate_um_s"] = -1.0; }, "`most_rate_um_s`"},
      {"range upside down", [](Json& j) { j["fail_safe"]["guards"][0]["low"] = 1e6; }, "`low`"},
      {"others too short", [](Json& j) { j["fail_safe"]["guards"][0]["others_coefficient"] = {1.0}; },
       "`others_coefficient`"},
      {"others of text", [](Json& j) { j["fail_safe"]["guards"][0]["others_coefficient"] = "X"; }, "`others_coefficient`"},
      {"apart 0", [](Json& j) { j["fail_safe"]["guards"][0]["most_apart"] = 0.0; }, "`most_apart`"},
      {"no guard",
       [](Json& j) {
         j["fail_safe"]["guards"].erase(4);
         j["fail_safe"]["guards"].erase(3);
         for (auto& g : j["fail_safe"]["guards"]) g["others_coefficient"] = Json::array();
       },
       "'X4'"},
      {"unknown predictor", [](Json& j) { j["predictor"] = "oracle"; }, "'oracle'"},
      {"no formula", [](Json& j) { j.erase("formula"); }, "`formula`"},
      {"drift in mm", [](Json& j) { j["target_unit"] = "mm"; }, "`target_unit`"},
      {"sensors as number", [](Json& j) { j["sensors"] = 4; }, "`sensors`"},
      {"starts differ", [](Json& j) { j["fail_safe"]["from_start"] = true; }, "`from_start`"},
  };
  for (const Broken& b : all) {
    Json j = good;
    b.by(j);
    const std::string path = driftwright::write_file("broken.json", j.dump());
    EXPECT_THAT([&] { (void)read_predictor(path); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("broken.json"), HasSubstr(b.key))))
        << b.what;
  }
  EXPECT_THROW((void)read_predictor(driftwright::write_file("cut.json", good.dump().substr(0, 300))), InputError);
  EXPECT_THROW((void)read_predictor(driftwright::write_file("list.json", "[1, 2]")), InputError);
  EXPECT_THROW((void)read_predictor("nowhere.json"), InputError);
}

}  // namespace
}  // namespace driftwright::output
