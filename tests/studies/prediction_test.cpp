// Which model predicts, and the cyclograms that a user names.

#include "studies/prediction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::studies::prediction_test {
namespace {

scenarios::ModelKind model_of(const std::string& path) {
  return studies::predicting_model(scenarios::read_scenario(path));
}

TEST(PredictingModel, IsTheReducedOneOfAMeshAndTheFullOneOfNodes) {
  EXPECT_EQ(model_of("scenarios/fp3_spindle.yaml"), scenarios::ModelKind::kReduced);
  EXPECT_EQ(model_of("scenarios/c_frame.yaml"), scenarios::ModelKind::kReduced) << "which asks for the full one";
  EXPECT_EQ(model_of("scenarios/lumped_spindle.yaml"), scenarios::ModelKind::kFull);
}

TEST(PredictingModel, IsTheFullOneWhereATemperatureIsPrescribedOverTime) {
  scenarios::Scenario scenario = scenarios::read_scenario("scenarios/c_frame.yaml");
  const auto held = [&](const std::string& temperature) {
    const std::string file =
        write_file("held.yaml", "{type: fixed_temperature, surface: s, temperature: " + temperature + "}");
    scenario.machine->effects.push_back(effects::read_effect(ConfigMap::read_file(file)));
    return studies::predicting_model(scenario);
  };
  EXPECT_EQ(held("20 degC"), scenarios::ModelKind::kReduced);
  EXPECT_EQ(held("[[0 s, 20 degC], [60 s, 30 degC]]"), scenarios::ModelKind::kFull);
}

TEST(NamedCyclogram, IsTheScenariosOrThatOfACsvNamedAsTheFile) {
  const scenarios::Scenario scenario = scenarios::read_scenario("scenarios/lumped_spindle.yaml");
  EXPECT_EQ(studies::named_cyclogram(scenario, "warm_up").sections, scenario.cyclogram("warm_up").sections);
  const std::string csv = write_file("plan.csv", "time_min,speed_rpm\n0,12000\n60,0\n");
  const Cyclogram plan = studies::named_cyclogram(scenario, csv);
  EXPECT_EQ(plan.name, "plan");
  EXPECT_EQ(plan.sections, scenario.cyclogram("warm_up").sections);
  EXPECT_REFUSED(studies::named_cyclogram(scenario, "warmup"), "there are shift, warm_up");
  EXPECT_REFUSED(studies::named_cyclogram(scenario, "nope.ngc"),
                 "nope.ngc: there is no such file, and scenarios/lumped_spindle.yaml has no");
}

}  // namespace
}  // namespace driftwright::studies::prediction_test
