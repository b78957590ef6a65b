// What no machine has or does is said, with the number and the usual range, and refused with --strict; shipped scenarios
// hold nothing of the kind.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/shared/command_line.hpp"
#include "tests/shared/edited_text.hpp"

namespace driftwright::plausibility_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf, ::testing::ContainsRegex, ::testing::HasSubstr, ::testing::Not;

/// A spindle in its housing; one number of it may be another.
std::string scenario(const std::string& name, const std::string& usual = "", const std::string& other = "") {
  std::string text = R"(name: m
reference_temperature: 20 degC
ambient: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: spindle, capacity: 5.6 kJ/K}
  - {type: node, node: housing, capacity: 19 kJ/K}
  - {type: heat_source, node: spindle, power: 150 W, at_speed: 6000 rpm, exponent: 1.5}
  - {type: link, node: spindle, to: housing, conductance: 12 W/K}
  - {type: link, node: housing, to: ambient, conductance: 5 W/K}
sensors: [{name: t_housing, node: housing}]
displacements: [{name: nose_z, sensitivities: [{node: spindle, sensitivity: 2.5 um/K}]}]
cyclograms: {shift: [[120 min, 6000 rpm]]}
)";
  if (!usual.empty()) text = fixtures::replaced(text, usual, other);
  const fs::path folder = fresh_folder("plausibility_" + name);
  std::ofstream(folder / "m.yaml") << text;
  return (folder / "m.yaml").string();
}

struct Unusual {
  const char *name, *usual, *other, *what;
};

class UnusualNumbers : public ::testing::TestWithParam<Unusual> {};

TEST_P(UnusualNumbers, AreWarnedOfAndRefusedWithStrict) {
  const Unusual& u = GetParam();
  const std::string file = scenario(u.name, u.usual, u.other);
  const CommandOutcome warned = run_program("check " + file);
  EXPECT_EQ(warned.exit_code, 0) << warned.output;
  EXPECT_THAT(warned.output, AllOf(HasSubstr("warning: "), HasSubstr(u.what), HasSubstr("not plausible")));
  const CommandOutcome refused = run_program("check --strict " + file);
  EXPECT_EQ(refused.exit_code, 2) << refused.output;
  EXPECT_THAT(refused.output, HasSubstr(u.what));
}

// The values of a run by hand: 150 kW over 12 and 5 W/K leave 30,000 K; 15 W/(0.5 W/K) leave 30 K in the housing.
INSTANTIATE_TEST_SUITE_P(
    All, UnusualNumbers,
    ::testing::Values(Unusual{"power", "power: 150 W", "power: 150 kW",
                              "m.yaml:8: heat_source spindle: the heat of one source or cooler is 150 kW at 6000 rpm"},
                      Unusual{"runaway", "power: 150 W", "power: 29 kW", "cannot be run: cyclogram 'shift': "},
                      Unusual{"link", "conductance: 12 W/K", "conductance: 10 kW/K",
                              "m.yaml:9: link spindle - housing: the conductance between two bodies is 1e+04 W/K"},
                      Unusual{"hot", "power: 150 W", "power: 2 kW", "spindle reaches "},
                      Unusual{"drift", "sensitivity: 2.5 um/K", "sensitivity: 90 um/K", "nose_z reaches "},
                      Unusual{"sensitivity", "sensitivity: 2.5 um/K", "sensitivity: 2.5 mm/K",
                              "sensitivity of nose_z to spindle is 2500 um/K; usual is -100 to 100 um/K"},
                      Unusual{"capacity", "capacity: 19 kJ/K", "capacity: 19 GJ/K",
                              "heat capacity of housing is 1.9e+10 J/K"},
                      Unusual{"ambient", "ambient: 20 degC", "ambient: 70 degC",
                              "the ambient temperature is 70 degC; usual is -30 to 60 degC"}),
    [](const auto& which) { return std::string(which.param.name); });

TEST(Plausibility, AUsualMachineIsFineAndStrictTakesIt) {
  const CommandOutcome fine = run_program("check --strict " + scenario("usual"));
  EXPECT_EQ(fine.exit_code, 0) << fine.output;
  EXPECT_THAT(fine.output, AllOf(HasSubstr(": fine\n"), Not(HasSubstr("warning"))));
}

TEST(Plausibility, RunsWarnOfWhatCameOutAndStrictLeavesNoFolder) {
  const std::string file = scenario("simulate", "power: 150 W", "power: 2 kW");
  const fs::path out = fs::path(file).parent_path() / "out";
  const CommandOutcome refused = run_program("simulate --strict " + file + " -o " + out.string());
  EXPECT_EQ(refused.exit_code, 2) << refused.output;
  EXPECT_FALSE(fs::exists(out));
  const CommandOutcome warned = run_program("simulate " + file + " -o " + out.string());
  EXPECT_EQ(warned.exit_code, 0) << warned.output;
  EXPECT_THAT(
      warned.output,
      ContainsRegex("warning: spindle reaches 4[0-9]+(\\.[0-9])? degC in cyclogram 'shift'; usual is -40 to 200 degC"));
  EXPECT_THAT(read_text((out / "summary.json").string()),
              AllOf(HasSubstr("\"plausibility\""), HasSubstr("spindle reaches")));
}

TEST(Plausibility, HeatBySourceAndPathStandsOnTheTerminal) {
  const std::string file = scenario("heat");
  const CommandOutcome outcome = run_program("simulate " + file + " -o " + (fs::path(file).parent_path() / "out").string());
  // 150 W go in; at the end of 120 min, some six time constants of the slower body (24.6 kJ/K over 5 W/K), all but a few
  // W leave by the link.
  EXPECT_THAT(outcome.output, ContainsRegex("heat_source spindle +source +150.0"));
  EXPECT_THAT(outcome.output, ContainsRegex("link housing - ambient +ambient +- +[0-9]"));
}

TEST(Plausibility, NumericsThatGiveUpNameTheCauseTheCyclogramAndTheTime) {
  const std::string file = scenario("gives_up", "power: 150 W", "power: 150 kW");
  const CommandOutcome outcome = run_program("simulate " + file + " -o " + (fs::path(file).parent_path() / "out").string());
  EXPECT_EQ(outcome.exit_code, 3) << outcome.output;
  EXPECT_THAT(outcome.output,
              ContainsRegex(
                  "the numerics gave up: cyclogram 'shift': heat_source spindle is 1.5e\\+05 W at 6000 rpm; a source heats "
                  "more than films, links and joints carry away: [0-9.e+]+ K at t = [0-9.]+ s"));
}

TEST(Plausibility, ABrokenSensorIsNoCause) {
  const fs::path cases = "../shared/cases/record_broken_sensor";
  if (!fs::exists(cases)) GTEST_SKIP() << cases << " is not there";
  for (const auto& [file, words] : {std::pair{"fm_n2.csv", "t_housing_degC reads 888.8 degC in 2 rows"},
                                    std::pair{"fm_n3.csv", "t_housing_degC reads 888.8 degC in 3 rows"},
                                    std::pair{"fm_9999.csv", "t_housing_degC reads -9999 degC in 10 rows"},
                                    std::pair{"indicator_n2.csv", "nose_z_um reads -9999 um in 2 rows"}}) {
    const fs::path out = fresh_folder("plausibility_broken") / "out";
    const CommandOutcome outcome = run_program(
        fmt::format("diagnose scenarios/first_machine.yaml --measured {} -o {}", (cases / file).string(), out.string()));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_THAT(read_text((out / "diagnosis.json").string()),
                AllOf(HasSubstr("\"verdict\": \"consistent\""), HasSubstr(words)))
        << file;
  }
}

// Those of measured records are read without their records.
TEST(Plausibility, ShippedScenariosHoldNothingUnusual) {
  int n = 0;
  for (const char* folder : {"scenarios", "scenarios/measured"}) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() != ".yaml" || entry.path().filename() == "lumped_sweep.yaml") continue;
      const CommandOutcome outcome = run_program("check --strict " + entry.path().string());
      EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
      EXPECT_THAT(outcome.output, AllOf(HasSubstr(": fine\n"), Not(HasSubstr("strict")))) << entry.path();
      ++n;
    }
  }
  EXPECT_GE(n, 23);
}

}  // namespace
}  // namespace driftwright::plausibility_test
