// Studies: what they vary, which members that makes, who shares what, and what is refused.

#include "scenarios/reader/sweep_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::scenarios::sweep_plan_test {
namespace {

using ::testing::AllOf, ::testing::ElementsAre, ::testing::HasSubstr, ::testing::ThrowsMessage;

SweepPlan read(const std::string& rest) {
  const std::string scenario = std::filesystem::absolute("scenarios/lumped_spindle.yaml").string();
  return read_sweep_plan(write_file("study.yaml", "name: study\nscenario: " + scenario + "\n" + rest));
}

std::vector<std::string> labels(const SweepPlan& plan, std::size_t member) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < plan.variations.size(); ++i) texts.push_back(plan.value(member, i).label);
  return texts;
}

double parameter(const SweepPlan& plan, std::size_t member, const std::string& effect, const std::string& key) {
  const Scenario scenario = read_scenario(plan.scenario_of(member));
  for (const effects::Effect& e : scenario.machine->effects) {
    if (e.kind->key == effect) return e[key];
  }
  return std::nan("");
}

TEST(SweepPlan, AListTakesValuesSideBySide) {
  const SweepPlan plan = read(R"(design: list
vary:
  - key: effects[bearing_friction@bearing_front].load
    values: [300 N, 0.5 kN]
  - {name: flow, key: "effects[coolant].flow", from: 4 L/min, to: 8 L/min, steps: 2}
collect: [nose_z.end]
cyclograms: [warm_up]
)");
  EXPECT_EQ(plan.n_members, 2u);
  EXPECT_EQ(plan.table_header(),
            "member,effects_bearing_friction_bearing_front_load_N,flow_L_min,warm_up_nose_z_end_um,status");
  EXPECT_THAT(labels(plan, 1), ElementsAre("500", "8"));
  EXPECT_EQ(parameter(plan, 0, "bearing_friction", "load"), 300.0);
  EXPECT_EQ(parameter(plan, 1, "bearing_friction", "load"), 500.0);
  EXPECT_EQ(parameter(plan, 1, "coolant", "flow"), 8.0);
}

TEST(SweepPlan, AGridCombinesEachWithEach) {
  const SweepPlan plan = read(R"(design: grid
vary:
  - key: cyclograms.warm_up
    values: {slow: [[10 min, 2000 rpm]], fast: [[10 min, 9000 rpm]]}
  - {key: "effects[coolant].volume", from: 1 L, to: 100 L, steps: 3, spacing: log}
)");
  ASSERT_EQ(plan.n_members, 6u);
  EXPECT_THAT(labels(plan, 0), ElementsAre("slow", "1"));
  EXPECT_THAT(labels(plan, 1), ElementsAre("slow", "10"));
  EXPECT_THAT(labels(plan, 5), ElementsAre("fast", "100"));
  EXPECT_EQ(read_scenario(plan.scenario_of(5)).cyclogram("warm_up").drive(0).speed_rpm, 9000.0);
  EXPECT_EQ(read_scenario(plan.scenario_of(5)).cyclogram("warm_up").duration_s(), 600.0);
}

const char* const kHypercube = R"(design: latin_hypercube
samples: 40
seed: 3
vary:
  - {name: preload, key: "effects[bearing_friction@bearing_front].load", uniform: [0.2 kN, 400 N]}
  - {name: volume, key: "effects[coolant].volume", log_uniform: [1 L, 100 L]}
  - name: ambient
    key: ["ambient[0][1]", "ambient[1][1]"]
    normal: {mean: 22 degC, sd: 2 K}
  - {name: f1, key: "effects[bearing_friction@bearing_front].f1", values: [0.0004, 0.0006]}
)";

TEST(SweepPlan, AHypercubeFollowsItsDistributions) {
  const SweepPlan plan = read(kHypercube);
  ASSERT_EQ(plan.n_members, 40u);
  int below_10 = 0, below_22 = 0, second = 0;
  for (std::size_t m = 0; m < 40; ++m) {
    const double preload_kN = plan.value(m, 0).number, volume_L = plan.value(m, 1).number, ambient = plan.value(m, 2).number;
    EXPECT_TRUE(preload_kN > 0.2 && preload_kN < 0.4);
    EXPECT_TRUE(volume_L > 1.0 && volume_L < 100.0);
    below_10 += volume_L < 10.0 ? 1 : 0;
    below_22 += ambient < 22.0 ? 1 : 0;
    second += plan.value(m, 3).label == "0.0006" ? 1 : 0;
    const Scenario scenario = read_scenario(plan.scenario_of(m));
    EXPECT_NEAR(scenario.machine->ambient.value[0] + 22.0, ambient, 1e-9);
    EXPECT_NEAR(scenario.machine->ambient.value[1] + 22.0, ambient, 1e-9);
    EXPECT_DOUBLE_EQ(parameter(plan, m, "bearing_friction", "load"), 1e3 * preload_kN);
  }
  // Half the strata each, exactly: that is what a Latin hypercube is for.
  EXPECT_EQ(below_10, 20);
  EXPECT_EQ(below_22, 20);
  EXPECT_EQ(second, 20);
  EXPECT_THAT(plan.table_header(), HasSubstr("member,preload_kN,volume_L,ambient_degC,f1_1,shift_nose_z_peak_um,"));
}

TEST(SweepPlan, ASpreadHasItsMoments) {
  double mean = 0.0, square = 0.0;
  const Spread normal{Spread::Kind::kNormal, 5.0, 2.0};
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const double x = normal.at((i + 0.5) / kSteps);
    mean += x / kSteps;
    square += (x - 5.0) * (x - 5.0) / kSteps;
  }
  EXPECT_NEAR(mean, 5.0, 1e-9);
  EXPECT_NEAR(square, 4.0, 2e-3);  // the outermost steps of the midpoint rule lack some 3e-4 of the variance
  EXPECT_DOUBLE_EQ((Spread{Spread::Kind::kUniform, 2.0, 6.0}).at(0.25), 3.0);
  EXPECT_DOUBLE_EQ((Spread{Spread::Kind::kLogUniform, 1.0, 16.0}).at(0.25), 2.0);
}

TEST(Sharing, FollowsWhatDecidesStructureAndMachine) {
  const SweepPlan plan = read(R"(design: grid
vary:
  - {key: "ambient[0][1]", values: [20 degC, 22 degC]}
  - {key: solver.relative_tolerance, values: [1e-4, 1e-5]}
  - {key: "effects[coolant].flow", values: [4 L/min, 6 L/min]}
  - {key: "displacements[nose_z].sensitivities[shaft].sensitivity", values: [2.9 um/K, 3.1 um/K]}
)");
  ASSERT_EQ(plan.n_members, 16u);
  const auto key = [&](std::size_t member, Shared what) { return sharing_key(plan, member, what); };
  EXPECT_EQ(key(0, Shared::kMachine), key(8, Shared::kMachine)) << "ambient";
  EXPECT_EQ(key(0, Shared::kMachine), key(4, Shared::kMachine)) << "solver";
  EXPECT_NE(key(0, Shared::kMachine), key(2, Shared::kMachine)) << "effects";
  EXPECT_EQ(key(0, Shared::kStructure), key(2, Shared::kStructure)) << "effects";
  EXPECT_NE(key(0, Shared::kStructure), key(1, Shared::kStructure)) << "displacements";
}

TEST(Sharing, AFactorOnExpansionDecidesTheStructure) {
  std::ifstream file("scenarios/lumped_spindle.yaml");
  std::string text((std::istreambuf_iterator<char>(file)), {});
  text.insert(text.find("effects:\n") + 9,
              "  - {type: expansion, region: body, factor: 1}\n"
              "  - {type: conductivity, region: body, factor: 1}\n");
  (void)write_file("expanding.yaml", text);
  const SweepPlan plan = read_sweep_plan(write_file("study.yaml", R"(name: study
scenario: expanding.yaml
design: grid
vary:
  - {key: "effects[expansion].factor", values: [1, 2]}
  - {key: "effects[conductivity].factor", values: [1, 2]}
)"));
  EXPECT_EQ(sharing_key(plan, 0, Shared::kStructure), sharing_key(plan, 1, Shared::kStructure)) << "conductivity";
  EXPECT_NE(sharing_key(plan, 0, Shared::kStructure), sharing_key(plan, 2, Shared::kStructure)) << "expansion";
  EXPECT_NE(sharing_key(plan, 0, Shared::kMachine), sharing_key(plan, 1, Shared::kMachine)) << "conductivity";
}

TEST(Parts, AreDisjointCompleteBalancedAndKeepMachinesTogether) {
  const SweepPlan plan = read(R"(design: grid
vary:
  - {key: "ambient[0][1]", from: 20 degC, to: 22 degC, steps: 5}
  - {key: "effects[coolant].flow", values: [4 L/min, 6 L/min]}
)");
  for (const std::size_t n : {1u, 2u, 3u, 7u, 10u, 13u}) {
    std::multiset<std::size_t> all;
    for (std::size_t part = 0; part < n; ++part) {
      const std::vector<std::size_t> members = members_of_part(plan, part, n);
      EXPECT_GE(members.size(), 10 / n);
      EXPECT_LE(members.size(), (10 + n - 1) / n);
      all.insert(members.begin(), members.end());
    }
    EXPECT_THAT(all, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9)) << n;
  }
  EXPECT_THAT(members_of_part(plan, 0, 2), ElementsAre(0, 2, 4, 6, 8)) << "one flow, one machine";
}

TEST(ContentKey, ChangesWithStudyScenarioVersionAndTheFilesTheyName) {
  write_file("plan.csv", "time_s,speed_rpm\n0,1000\n60,0\n");
  std::ifstream in("scenarios/lumped_spindle.yaml");
  std::string scenario(std::istreambuf_iterator<char>(in), {});
  scenario.replace(scenario.find("  warm_up: "), 10, "  plan: {csv: plan.csv}\n  warm_up:");
  write_file("spindle.yaml", scenario);
  const std::string study =
      "name: s\nscenario: spindle.yaml\ndesign: list\nvary: [{key: \"ambient[0][1]\", values: [20 degC]}]\n";
  const auto key = [&](const std::string& text, const std::string& version) {
    return content_key(read_sweep_plan(write_file("s.yaml", text)), version);
  };
  const std::string first = key(study, "1");
  EXPECT_EQ(first, key(study, "1"));
  EXPECT_NE(first, key(study, "2"));
  EXPECT_NE(first, key(study + "collect: [nose_z]\n", "1"));
  write_file("plan.csv", "time_s,speed_rpm\n0,1001\n60,0\n");
  EXPECT_NE(first, key(study, "1"));
  write_file("plan.csv", "time_s,speed_rpm\n0,1000\n60,0\n");
  EXPECT_EQ(first, key(study, "1"));
  write_file("spindle.yaml", scenario + "# more\n");
  EXPECT_NE(first, key(study, "1"));
}

struct Bad {
  const char* name;
  const char* rest;
  std::vector<const char*> message;
};
class BadStudy : public ::testing::TestWithParam<Bad> {};

TEST_P(BadStudy, IsRefusedWithPlaceAndRemedy) {
  EXPECT_REFUSED(read(GetParam().rest), "study.yaml:");
  for (const char* part : GetParam().message) EXPECT_REFUSED(read(GetParam().rest), part);
}

INSTANTIATE_TEST_SUITE_P(
    Each, BadStudy,
    ::testing::Values(
        Bad{"unknown_key",
            "design: list\nvary: [{key: \"effects[coolant].flwo\", values: [1 L/min]}]\n",
            {":4:14: ", "has no key 'flwo'", "Did you mean 'flow'?", "[vary[0].key]"}},
        Bad{"unknown_effect",
            "design: list\nvary: [{key: \"effects[coolnt].flow\", values: [1 L/min]}]\n",
            {"no entry of 'effects' is named 'coolnt'", "Did you mean 'coolant'?"}},
        Bad{"unknown_design", "design: random\nvary: [{key: start, values: [ambient]}]\n", {"'random' is not known here"}},
        Bad{"nothing_varies", "design: list\n", {"key 'vary' is missing"}},
        Bad{"name_varies", "design: list\nvary: [{key: name, values: [a]}]\n", {"changes nothing that is simulated"}},
        Bad{"no_values", "design: list\nvary: [{key: \"ambient[0][1]\"}]\n", {"one of values, from, uniform"}},
        Bad{"empty_values", "design: list\nvary: [{key: \"ambient[0][1]\", values: []}]\n", {"at least one"}},
        Bad{"two_kinds",
            "design: list\nvary: [{key: \"ambient[0][1]\", values: [20 degC], from: 1 K}]\n",
            {"one of values, from, uniform", "beside the key"}},
        Bad{"spread_in_grid",
            "design: grid\nvary: [{key: \"ambient[0][1]\", uniform: [20 degC, 22 degC]}]\n",
            {"a distribution requires `design: latin_hypercube`"}},
        Bad{"unequal_list",
            "design: list\nvary: [{name: a, key: \"ambient[0][1]\", values: [20 degC]}, {name: b, key: \"ambient[1][1]\", "
            "values: "
            "[20 "
            "degC, 21 degC]}]\n",
            {"'a' has 1, 'b' has 2"}},
        Bad{"units_differ",
            "design: grid\nvary: [{key: \"ambient[0][1]\", from: 20 degC, to: 30 N, steps: 3}]\n",
            {":4:50: ", "wrong unit 'N'", "[vary[0].to]"}},
        Bad{"one_step",
            "design: grid\nvary: [{key: \"ambient[0][1]\", from: 20 degC, to: 30 degC, steps: 1}]\n",
            {"must be a whole number from 2"}},
        Bad{"log_of_degC",
            "design: grid\nvary: [{key: \"ambient[0][1]\", from: 20 degC, to: 30 degC, steps: 3, spacing: log}]\n",
            {"and no degC"}},
        Bad{"reversed",
            "design: latin_hypercube\nsamples: 3\nvary: [{key: \"effects[coolant].flow\", uniform: [2 L/min, 1 L/min]}]\n",
            {"the first number must be below the second"}},
        Bad{"log_of_zero",
            "design: latin_hypercube\nsamples: 3\nvary: [{key: \"effects[coolant].flow\", log_uniform: [0 L/min, 1 "
            "L/min]}]\n",
            {"requires numbers above 0"}},
        Bad{"sd_of_zero",
            "design: latin_hypercube\nsamples: 3\nvary: [{key: \"ambient[0][1]\", normal: {mean: 20 degC, sd: 0 K}}]\n",
            {"must be above 0"}},
        Bad{"sd_in_degC",
            "design: latin_hypercube\nsamples: 3\nvary: [{key: \"ambient[0][1]\", normal: {mean: 20 degC, sd: 2 degC}}]\n",
            {"this must be a temperature difference in K"}},
        Bad{"no_samples",
            "design: latin_hypercube\nvary: [{key: \"ambient[0][1]\", uniform: [20 degC, 22 degC]}]\n",
            {"key 'samples' is missing"}},
        Bad{"samples_of_grid",
            "design: grid\nsamples: 3\nvary: [{key: \"ambient[0][1]\", values: [20 degC]}]\n",
            {"unknown key 'samples'"}},
        Bad{"twice",
            "design: grid\nvary: [{key: \"ambient[0][1]\", values: [20 degC]}, {name: b, key: ambient, values: {x: [[0 s, "
            "20 "
            "degC]]}}]\n",
            {"vary[0] changes the same value, or one within it"}},
        Bad{"same_column",
            "design: grid\nvary: [{name: a, key: \"ambient[0][1]\", values: [20 degC]}, {name: a, key: \"ambient[1][1]\", "
            "values: "
            "[20 "
            "degC]}]\n",
            {"there is a column 'a_degC' already"}},
        Bad{"unknown_channel",
            "design: list\nvary: [{key: \"ambient[0][1]\", values: [20 degC]}]\ncollect: [nose_y]\n",
            {"no channel 'nose_y'", "Did you mean 'nose_z'?"}},
        Bad{"unknown_scalar",
            "design: list\nvary: [{key: \"ambient[0][1]\", values: [20 degC]}]\ncollect: [nose_z.top]\n",
            {"one of peak, time_of_peak, end, min, max is required"}},
        Bad{"collected_twice",
            "design: list\nvary: [{key: \"ambient[0][1]\", values: [20 degC]}]\ncollect: [nose_z, nose_z.end]\n",
            {"is collected twice"}},
        Bad{"unknown_cyclogram",
            "design: list\nvary: [{key: \"ambient[0][1]\", values: [20 degC]}]\ncyclograms: [warmup]\n",
            {"no cyclogram 'warmup'", "Did you mean 'warm_up'?"}},
        Bad{"too_many",
            "design: grid\nvary: [{key: \"ambient[0][1]\", from: 1 degC, to: 9 degC, steps: 1000000}, {key: "
            "\"ambient[1][1]\", from: 1 degC, to: 9 degC, steps: 2}]\n",
            {"more than 1000000 members"}}),
    [](const auto& of) { return std::string(of.param.name); });

TEST(BadStudyFile, ScenarioMustBeThereAndHaveAMachine) {
  const std::string rest = "design: list\nvary: [{key: study.tolerance, values: [1 um]}]\n";
  EXPECT_THAT(
      [&] { (void)read_sweep_plan(write_file("s.yaml", "name: s\nscenario: nowhere.yaml\n" + rest)); },
      ThrowsMessage<InputError>(AllOf(HasSubstr("s.yaml:2:11: there is no file"), HasSubstr("relative to the study"))));
  const std::string records = std::filesystem::absolute("scenarios/spindle_22.yaml").string();
  EXPECT_REFUSED(read_sweep_plan(write_file("s.yaml", "name: s\nscenario: " + records +
                                                          "\ndesign: list\nvary: [{key: reference, values: [1 um]}]\n")),
                 "s.yaml:");
}

}  // namespace
}  // namespace driftwright::scenarios::sweep_plan_test
