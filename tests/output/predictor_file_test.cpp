// Predictors as files: there and back to the last digit, row by row, and what is refused.

#include "output/predictor_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/errors.hpp"
#include "base/file_bytes.hpp"
#include "base/hashed_json.hpp"
#include "compensation/predictors/formula_predictor.hpp"
#include "compensation/predictors/past_drift.hpp"
#include "tests/shared/deployed_model.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::output::predictor_file_test {
namespace {

using namespace compensation;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using Json = nlohmann::ordered_json;

MachineRun machine(std::uint64_t seed) {
  return {.cyclogram = {.name = "work", .sections = {{9000.0, {.speed_rpm = 2000.0}}, {9e4, {}}}},
          .ambient = {{0.0, 9000.0}, {0.0, 1.5}},
          .readings = fixtures::machine(seed, 60.0)};
}

PredictorFile formula(bool from_start) {
  DeployedModel model = fixtures::deployed(from_start, 60.0 / 7.0);
  PredictorFile file;
  DeployedPredictor& d = file.predictor;
  d.name = "regression with lags";
  d.target = "drift_y";
  d.from_start = from_start;
  d.sensors = {"X1", "X2", "X3", "X4"};
  d.ambient = "X4";
  d.reason = "because";
  d.fail_safe = std::move(model.safe);
  d.predictor = std::make_shared<FormulaPredictor>(std::move(model.model));
  d.interval_um = model.interval_um;
  file.judged = {{"verdict", "safe within limits"}, {"tolerance_um", 10.0}};
  return file;
}

PredictorFile back(const PredictorFile& file) {
  return read_predictor(driftwright::write_file("predictor.json", predictor_json(file, {"1", "a test"}).dump()));
}

/// All of a predictor is in the text.
void expect_same(const PredictorFile& a, const PredictorFile& b) {
  EXPECT_EQ(predictor_json(a, {"1", "a test"}).dump(), predictor_json(b, {"1", "a test"}).dump());
}

TEST(PredictorFile, AFormulaComesBackToTheLastDigit) {
  for (const bool from_start : {false, true}) {
    PredictorFile file = formula(from_start);
    const PredictorFile read = back(file);
    expect_same(file, read);
    const MachineRun run = machine(7);
    EXPECT_EQ(correct(file.predictor, run).correction_um, correct(read.predictor, run).correction_um);
    EXPECT_EQ(read.predictor.interval_um, file.predictor.interval_um);
    EXPECT_EQ(read.judged["verdict"], "safe within limits");
    file.predictor.interval_um.reset();
    EXPECT_FALSE(back(file).predictor.interval_um);
  }
}

TEST(PredictorFile, SaysWhetherTheFileIsMissingOrAFolder) {
  const auto reading = [](const std::string& path) { return [path] { (void)read_predictor(path); }; };
  EXPECT_THAT(reading("no_such.json"), ThrowsMessage<InputError>(HasSubstr("no_such.json: there is no such file")));
  EXPECT_THAT(reading("."), ThrowsMessage<InputError>(HasSubstr(".: this is a folder; it must be a predictor")));
}

TEST(PredictorFile, AMeanComesBackWithItsMembers) {
  PredictorFile file = formula(true);
  const DriftModel mean = *file.predictor.predictor->formula();
  DriftModel member = mean;
  member.terms[2].coefficient *= 3.0;
  file.predictor.predictor = std::make_shared<FormulaPredictor>(mean, std::vector<DriftModel>{mean, member});
  const PredictorFile read = back(file);
  expect_same(file, read);
  const MachineRun run = machine(7);
  const std::vector<double> interval_um = correct(read.predictor, run).interval_um;
  EXPECT_EQ(correct(file.predictor, run).interval_um, interval_um);
  EXPECT_GT(*std::max_element(interval_um.begin(), interval_um.end()), 2.0 * *file.predictor.interval_um);
  member.terms[2].input = "X5";
  file.predictor.predictor = std::make_shared<FormulaPredictor>(mean, std::vector<DriftModel>{mean, member});
  EXPECT_THAT([&] { (void)back(file); }, ThrowsMessage<InputError>(AllOf(HasSubstr("predictor.json"), HasSubstr("'X5'"))));
}

TEST(PredictorFile, WhatProbingsNeedComesBack) {
  PredictorFile file = formula(true);
  EXPECT_FALSE(back(file).predictor.residual);
  file.predictor.residual = {10.0 / 3.0, 7200.0 / 7.0, 0.1};
  file.predictor.probe = {0.3, 20.0};
  const PredictorFile read = back(file);
  expect_same(file, read);
  ASSERT_TRUE(read.predictor.residual);
  EXPECT_EQ(read.predictor.residual->deviation_um, 10.0 / 3.0);
  EXPECT_EQ(read.predictor.residual->time_constant_s, 7200.0 / 7.0);
  EXPECT_EQ(read.predictor.probe.noise_um, 0.3);
  EXPECT_EQ(read.predictor.probe.lag_s, 20.0);
  Json earlier = predictor_json(formula(true), {"1", "a test"});  // a file of a version without the key
  earlier.erase("probing");
  earlier.erase("hash");
  EXPECT_FALSE(read_predictor(driftwright::write_file("earlier.json", with_hash(earlier).dump())).predictor.residual);
}

TEST(PredictorFile, WhatTheMembersOfABlendLeaveComesBack) {
  PredictorFile file;
  file.predictor = fixtures::deployed_blend();
  const PredictorFile read = back(file);
  expect_same(file, read);
  ASSERT_EQ(read.predictor.member_residuals.size(), 2u);
  EXPECT_EQ(read.predictor.member_residuals[0].name, "large");
  EXPECT_EQ(read.predictor.member_residuals[1].process.time_constant_s, 7200.0);
  const Json good = predictor_json(file, {"1", "a test"});
  const auto refused = [&](const std::function<void(Json&)>& change, const char* word) {
    Json j = good;
    change(j);
    const std::string path = driftwright::write_file("members.json", j.dump());
    EXPECT_THAT([&] { (void)read_predictor(path); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("members.json"), HasSubstr(word))))
        << word;
  };
  refused([](Json& j) { j["probing"]["members"].erase(1); }, "key `members` has 1 entries, but the formula has 2 `members`");
  refused([](Json& j) { j["probing"]["members"][0]["deviation_um"] = 0.0; }, "key `deviation_um` is 0; it must be above 0");
  refused([](Json& j) { j["probing"]["members"][1].erase("name"); }, "key `name` is missing");
  refused([](Json& j) { j["probing"]["members"] = 3; }, "key `members` is 3; it must be a list");
  refused([](Json& j) { j["formula"].erase("members"); }, "the formula has 0 `members`");
  Json earlier = good;  // of a version whose weights did not move
  earlier["probing"].erase("members");
  earlier.erase("hash");
  EXPECT_TRUE(
      read_predictor(driftwright::write_file("earlier.json", with_hash(earlier).dump())).predictor.member_residuals.empty());
}

TEST(PredictorFile, WrongNumbersForProbingsAreRefusedWithTheirKey) {
  PredictorFile file = formula(true);
  file.predictor.residual = {3.0, 7200.0, 0.1};
  const Json good = predictor_json(file, {"1", "a test"});
  const auto refused = [&](const char* key, const Json& value, const char* word) {
    Json j = good;
    j["probing"][key] = value;
    const std::string path = driftwright::write_file("probing.json", j.dump());
    EXPECT_THAT([&] { (void)read_predictor(path); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("probing.json: key `probing`"), HasSubstr(word))))
        << key << " " << value.dump();
  };
  refused("deviation_um", 0.0, "key `deviation_um` is 0; it must be above 0");
  refused("time_constant_s", -60.0, "key `time_constant_s` is -60; it must be above 0");
  refused("noise_um", -1.0, "key `noise_um` is -1; it must be above 0");
  refused("noise_um", "1 um", "key `noise_um`");
  refused("lag_s", -1.0, "key `lag_s` is -1; it must be 0 or more");
  refused("reading_um", nullptr, "key `reading_um`");
  Json j = good;
  j["probing"].erase("lag_s");
  EXPECT_THROW((void)read_predictor(driftwright::write_file("probing.json", j.dump())), InputError);
  j["probing"] = 3.0;
  EXPECT_REFUSED(read_predictor(driftwright::write_file("probing.json", j.dump())), "must be a map");
}

// Tests at one speed, or at rest, leave a drive no width.
TEST(PredictorFile, AFailSafeLearntAtOneSpeedComesBack) {
  for (const double speed_rpm : {3000.0, -3000.0, 0.0}) {
    std::vector<Record> training = {fixtures::machine(1, 60.0), fixtures::machine(2, 60.0)};
    PredictorFile file = formula(false);
    std::vector<std::vector<double>> predicted;
    for (Record& r : training) {
      std::fill(r.channels.back().values.begin(), r.channels.back().values.end(), speed_rpm);
      predicted.push_back(file.predictor.predictor->formula()->predict(r));
    }
    file.predictor.fail_safe = learn_fail_safe(training, {"X1", "X2", "X3", "X4", "spindle"}, predicted, false);
    const PredictorFile read = back(file);
    expect_same(file, read);
    MachineRun run = machine(7);
    std::fill(run.readings.channels.back().values.begin(), run.readings.channels.back().values.end(), speed_rpm);
    const GuardedCorrection as_fitted = correct(file.predictor, run);
    EXPECT_EQ(as_fitted.correction_um, correct(read.predictor, run).correction_um);
    for (double& v : run.readings.channels.back().values) v *= 1.01;  // as an encoder reads it
    EXPECT_EQ(correct(read.predictor, run).trust, as_fitted.trust) << speed_rpm;
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
  EXPECT_NEAR(before[0], 1.0 - 0.9 * 100.0 / 7000.0, 1e-12);  // at 100 s, where the first run has no value
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_TRUE(before[i] == after[i] || (std::isnan(before[i]) && std::isnan(after[i])));
  EXPECT_TRUE(std::isnan(before.back()));  // after both
}

TEST(PredictorFile, EarlierRunsThatAreNoneAreRefused) {
  PredictorFile file;
  const std::vector<Record> runs = {{"a", {0.0, 100.0, 300.0}, {{"z", "um", {0.0, 1.0, 30.0}}}}};
  file.predictor = {.name = "same time",
                    .target = "z",
                    .is_baseline = true,
                    .predictor = std::make_shared<EarlierRunsPredictor>(runs, "z")};
  const Json good = predictor_json(file, {"1", "a test"});
  const auto refused = [&](const char* key, const Json& value, const char* word) {
    Json j = good;
    (key == std::string("runs") ? j["earlier_runs"]["runs"] : j["earlier_runs"]["runs"][0][key]) = value;
    const std::string path = driftwright::write_file("broken_runs.json", j.dump());
    EXPECT_REFUSED(read_predictor(path), word) << value.dump();
  };
  refused("runs", Json::array(), "`runs` is empty");
  refused("time_s", {0.0, 100.0, 100.0}, "which rise");
  refused("time_s", {0.0, 100.0}, "as many `drift_um`");
  refused("time_s", "never", "`time_s`");
  Json none = good;
  none["earlier_runs"]["runs"][0]["time_s"] = Json::array();
  none["earlier_runs"]["runs"][0]["drift_um"] = Json::array();
  const std::string path = driftwright::write_file("no_rows.json", none.dump());
  EXPECT_THROW((void)read_predictor(path), InputError);
}

TEST(PredictorFile, WhatIsNoneIsRefusedWithItsKey) {
  const Json good = predictor_json(formula(false), {"1", "a test"});
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
      {"running squared", [](Json& j) { j["formula"]["terms"][6]["is_running"] = true; }, "`is_running` and `power` 2"},
      {"running by a number", [](Json& j) { j["formula"]["terms"][7]["is_running"] = 1; }, "`is_running`"},
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

TEST(PredictorFile, WhatIsNotWhatWasJudgedIsRefused) {
  Json j = predictor_json(formula(false), {"1", "a test"});
  const auto read = [](const Json& file) { return read_predictor(driftwright::write_file("changed.json", file.dump(1))); };
  EXPECT_NO_THROW((void)read(j));  // the layout does not matter
  const auto refused = [&](const std::function<void(Json&)>& change, const char* word) {
    Json other = j;
    change(other);
    EXPECT_THAT([&] { (void)read(other); }, ThrowsMessage<InputError>(AllOf(HasSubstr("changed.json"), HasSubstr(word))));
  };
  refused(
      [](Json& o) {
        o["formula"]["terms"][1]["coefficient"] = o["formula"]["terms"][1]["coefficient"].get<double>() * 10.0;
      },
      "not what was judged");
  refused([](Json& o) { o["fail_safe"]["highest_um"] = 1e3; }, "not what was judged");
  refused([](Json& o) { o["judged"]["verdict"] = "safe to deploy"; }, "not what was judged");
  refused([](Json& o) { o.erase("hash"); }, "`hash`");
}

TEST(PredictorFile, AnObserverOfASizeThatNoneHasIsRefused) {  // with assertions a negative one ended the program
  Json j = Json::parse(read_bytes("tests/fuzz/corpus/predictors/observer.json"));
  for (const std::int64_t size : {std::int64_t(-1), std::int64_t(0), std::int64_t(1) << 40}) {
    j["observer"]["system"]["size"] = size;
    EXPECT_THAT([&] { (void)read_predictor(driftwright::write_file("sized.json", j.dump())); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("sized.json"), HasSubstr("array 'conduction'"))));
  }
}

TEST(PredictorFile, NamesOfAnyBytesComeBack) {
  PredictorFile file = formula(false);
  file.predictor.reason = "t_Geh\xE4use";  // Latin-1, as a caller of the library may hand it in
  EXPECT_EQ(back(file).predictor.reason, "t_Geh\xEF\xBF\xBDuse");
}

}  // namespace
}  // namespace driftwright::output::predictor_file_test
