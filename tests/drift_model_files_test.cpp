// Models as files: JSON there and back, what is refused; the text.

#include "output/drift_model_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "base/errors.hpp"
#include "tests/deployed_model.hpp"
#include "tests/temporary_file.hpp"

namespace driftwright::output {
namespace {

using compensation::DriftModel;
using compensation::FailSafe;
using fixtures::deployed;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

void expect_same(const DeployedModel& a, const DeployedModel& b) {
  EXPECT_EQ(model_json(a).dump(), model_json(b).dump());
  ASSERT_EQ(a.model.terms.size(), b.model.terms.size());
  for (std::size_t i = 0; i < a.model.terms.size(); ++i) {
    EXPECT_EQ(a.model.terms[i].input, b.model.terms[i].input);
    EXPECT_EQ(a.model.terms[i].coefficient, b.model.terms[i].coefficient);
    EXPECT_EQ(a.model.terms[i].power, b.model.terms[i].power);
    EXPECT_EQ(a.model.terms[i].lag_s, b.model.terms[i].lag_s);
    EXPECT_EQ(a.model.terms[i].is_running, b.model.terms[i].is_running);
  }
  EXPECT_EQ(a.model.intercept, b.model.intercept);
  EXPECT_EQ(a.model.from_start, b.model.from_start);
  ASSERT_EQ(a.safe.guards.size(), b.safe.guards.size());
  for (std::size_t i = 0; i < a.safe.guards.size(); ++i) {
    EXPECT_EQ(a.safe.guards[i].low, b.safe.guards[i].low);
    EXPECT_EQ(a.safe.guards[i].high, b.safe.guards[i].high);
    EXPECT_EQ(a.safe.guards[i].most_jump, b.safe.guards[i].most_jump);  // infinite for a speed
    EXPECT_EQ(a.safe.guards[i].others_intercept, b.safe.guards[i].others_intercept);
    EXPECT_EQ(a.safe.guards[i].others_coefficient, b.safe.guards[i].others_coefficient);
    EXPECT_EQ(a.safe.guards[i].most_apart, b.safe.guards[i].most_apart);
  }
  EXPECT_EQ(a.safe.most_rate_um_s, b.safe.most_rate_um_s);
  EXPECT_EQ(a.safe.lowest_um, b.safe.lowest_um);
  EXPECT_EQ(a.safe.highest_um, b.safe.highest_um);
  EXPECT_EQ(a.safe.period_s, b.safe.period_s);
  EXPECT_EQ(a.safe.fade_s, b.safe.fade_s);
  EXPECT_EQ(a.safe.stale_s, b.safe.stale_s);
}

TEST(ModelJson, IsReadBackToTheLastDigit) {
  for (const bool from_start : {false, true}) {
    DeployedModel d = deployed(from_start, 60.0 / 7.0);
    const DeployedModel back = read_model(write_file("model.json", model_json(d).dump(2)));
    expect_same(d, back);
    EXPECT_EQ(back.interval_um, d.interval_um);
    // files from before there were terms that count running
    nlohmann::ordered_json old = model_json(d);
    old["terms"].erase(9);
    old["terms"].erase(8);
    for (const auto& t : old["terms"]) EXPECT_FALSE(t.contains("is_running"));
    for (const DriftModel::Term& t : read_model(write_file("old.json", old.dump())).model.terms) EXPECT_FALSE(t.is_running);
    d.interval_um = NAN;
    EXPECT_TRUE(std::isnan(read_model(write_file("model.json", model_json(d).dump())).interval_um));
  }
}

TEST(ModelJson, OfAnotherKindIsRefusedWithItsKey) {
  using Json = nlohmann::ordered_json;
  const Json good = model_json(deployed(false, 60.0));
  struct Broken {
    const char* what;
    std::function<void(Json&)> by;
    const char* key;
  };
  const std::vector<Broken> all = {
      {"format", [](Json& j) { j["format"] = "something else"; }, "format"},
      {"no kind", [](Json& j) { j.erase("kind"); }, "`kind`"},
      {"number as kind", [](Json& j) { j["kind"] = 3; }, "`kind`"},
      {"text as intercept", [](Json& j) { j["intercept"] = "1.0"; }, "`intercept`"},
      {"null as coefficient", [](Json& j) { j["terms"][1]["coefficient"] = nullptr; }, "`coefficient`"},
      {"no lag", [](Json& j) { j["terms"][0].erase("lag_s"); }, "`lag_s`"},
      {"negative lag", [](Json& j) { j["terms"][0]["lag_s"] = -1.0; }, "`lag_s` -1"},
      {"power 0", [](Json& j) { j["terms"][0]["power"] = 0; }, "`power` 0"},
      {"running squared", [](Json& j) { j["terms"][6]["is_running"] = true; }, "`is_running` and `power` 2"},
      {"running by a number", [](Json& j) { j["terms"][7]["is_running"] = 1; }, "`is_running`"},
      {"terms as text", [](Json& j) { j["terms"] = "none"; }, "`terms`"},
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
      {"starts differ", [](Json& j) { j["fail_safe"]["from_start"] = true; }, "`from_start`"},
  };
  for (const Broken& b : all) {
    Json j = good;
    b.by(j);
    const std::string path = write_file("broken.json", j.dump());
    EXPECT_THAT([&] { (void)read_model(path); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("broken.json"), HasSubstr(b.key))))
        << b.what;
  }
  EXPECT_THROW((void)read_model(write_file("cut.json", good.dump().substr(0, 300))), InputError);
  EXPECT_THROW((void)read_model(write_file("list.json", "[1, 2]")), InputError);
  EXPECT_THROW((void)read_model("nowhere.json"), InputError);
}

TEST(FormulaText, SaysUnitsRangesAndLimits) {
  DeployedModel d = deployed(true, 60.0);
  const std::string text = formula_text(d);
  for (const char* part : {"drift_y [um] =", "um/degC", "um/rpm^2", "LAG(13 min, (X1 - X1 at start))",
                           "+ 3 um * LAG(9 min, ON(spindle))", "+ 0.4 um * ON(spindle)\n", "ON(x): 1 while x is not 0",
                           "<= X1 - start <=", "<= spindle <=", "um/min", "95 % of the drift"})
    EXPECT_THAT(text, HasSubstr(part));
  d.interval_um = NAN;
  EXPECT_EQ(formula_text(d).find("95 %"), std::string::npos);
  std::erase_if(d.model.terms, [](const DriftModel::Term& t) { return t.is_running; });
  EXPECT_EQ(formula_text(d).find("ON("), std::string::npos);
}

}  // namespace
}  // namespace driftwright::output
