// Bodies and paths of heat that a network lacks: named, at their place, with their numbers; and none where none is missing.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "tests/shared/column_and_head.hpp"
#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis::missing_paths_test {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr const char* kMachine = R"(name: four_nodes
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: spindle, capacity: 5 kJ/K}
  - {type: node, node: head, capacity: 20 kJ/K}
  - {type: node, node: column, capacity: 50 kJ/K}
  - {type: node, node: motor, capacity: 8 kJ/K}
  - {type: heat_source, node: spindle, power: 150 W, at_speed: 1000 rpm, exponent: 1.3}
  - {type: heat_source, node: motor, power: 90 W, at_speed: 1000 rpm, exponent: 0.8}
  - {type: link, node: spindle, to: head, conductance: 14 W/K}
  - {type: link, node: motor, to: head, conductance: 6 W/K}
  - {type: link, node: head, to: column, conductance: 12 W/K}
  - {type: link, node: column, to: ambient, conductance: 14 W/K}
  - {type: link, node: motor, to: ambient, conductance: 3 W/K}
ambient: [[0 min, 20 degC], [200 min, 22 degC], [400 min, 21 degC]]
sensors:
  - {name: t_spindle, node: spindle}
  - {name: t_head, node: head}
  - {name: t_column, node: column}
  - {name: t_motor, node: motor}
displacements:
  - name: nose
    sensitivities:
      - {node: spindle, sensitivity: 2 um/K}
      - {node: column, sensitivity: 3 um/K}
cyclograms:
  monday: [[60 min, 600 rpm], [60 min, 1900 rpm], [40 min, 0 rpm], [80 min, 1000 rpm], [60 min, 1400 rpm], [90 min, 0 rpm]]
  tuesday: [[50 min, 1800 rpm], [70 min, 300 rpm], [60 min, 1000 rpm], [60 min, 0 rpm], [60 min, 2000 rpm]]
solver: {output_interval: 1 min}
)";

struct Missing {
  const char* name;
  const char* entry;  ///< of the truth
  const char* effect;
  const char* where;
  std::size_t n_numbers;                                    ///< that describe it, in any of its laws
  std::map<std::string, double> values;                     ///< of its numbers, in all of its laws
  double tolerance;                                         ///< relative: some three of their standard deviations
  std::string written = "- {type: " + std::string(effect);  ///< in the scenario that is made
};
class AMissingPath : public testing::TestWithParam<Missing> {};

TEST_P(AMissingPath, IsNamedWithItsNumbersAndWritten) {
  const Missing& missing = GetParam();
  const Found found(kMachine, with_effect(kMachine, missing.entry), std::string(missing.name) + "_", {.seed = 3});
  const Diagnosis& d = found.d;
  EXPECT_EQ(d.verdict, Verdict::kNamed) << d.reason;
  ASSERT_THAT(d.causes, SizeIs(1)) << d.reason;
  EXPECT_EQ(d.causes[0].effect, missing.effect);
  EXPECT_EQ(d.causes[0].where, missing.where);
  EXPECT_THAT(d.causes[0].alternatives, IsEmpty());
  EXPECT_THAT(d.causes[0].parameters, SizeIs(missing.n_numbers)) << d.reason;
  for (const Estimate& e : d.causes[0].parameters) {
    ASSERT_TRUE(missing.values.contains(e.name)) << e.name;
    const double value = missing.values.at(e.name);
    EXPECT_NEAR(e.value, value, missing.tolerance * value) << e.name;
  }
  found.expect_written_is_found_no_more(missing.written);
}

std::string missing_name(const ::testing::TestParamInfo<Missing>& one) {
  return one.param.name;
}
// A path, and bodies with a way out, which have the most numbers. That fewer are taken where they do is checked AtLength.
INSTANTIATE_TEST_SUITE_P(
    OfEachSort, AMissingPath,
    ::testing::Values(
        Missing{"between_nodes",
                "{type: link, node: spindle, to: column, conductance: 5 W/K}",
                "link",
                "spindle,column",
                1,
                {{"conductance", 5.0}},
                0.15},
        Missing{"hidden_body_with_a_way_out",
                "{type: hidden_body, node: spindle, capacity: 12 kJ/K, conductance: 5 W/K, "
                "hall_conductance: 4 W/K}",
                "hidden_body",
                "spindle",
                3,
                {{"conductance", 5.0}, {"capacity", 12e3}, {"hall_conductance", 4.0}},
                0.25},
        Missing{"body_between_two_with_a_way_out",
                "{type: node, node: cover, capacity: 12 kJ/K}\n"
                "  - {type: link, node: head, to: cover, conductance: 8 W/K}\n"
                "  - {type: link, node: column, to: cover, conductance: 8 W/K}\n"
                "  - {type: link, node: cover, to: ambient, conductance: 5 W/K}",
                "hidden_body",
                "head,column",
                4,
                {{"conductance", 8.0}, {"capacity", 12e3}, {"ratio_of_conductances", 1.0}, {"ratio_to_ambient", 0.625}},
                0.35,
                "- {type: node, node: between_head_and_column, capacity: "}),
    missing_name);
INSTANTIATE_TEST_SUITE_P(
    OthersAtLength, AMissingPath,
    ::testing::Values(Missing{"to_the_ambient",
                              "{type: link, node: head, to: ambient, conductance: 5 W/K}",
                              "link",
                              "head,ambient",
                              1,
                              {{"conductance", 5.0}},
                              0.1},
                      Missing{"hidden_body",
                              "{type: hidden_body, node: head, capacity: 25 kJ/K, conductance: 6 W/K}",
                              "hidden_body",
                              "head",
                              2,  // the time constant [min] or the conductance beside the capacity
                              {{"capacity", 25e3}, {"time_constant", 25e3 / 6.0 / 60.0}, {"conductance", 6.0}},
                              0.15},
                      Missing{"body_between_two",
                              "{type: node, node: oil, capacity: 15 kJ/K}\n"
                              "  - {type: link, node: spindle, to: oil, conductance: 6 W/K}\n"
                              "  - {type: link, node: column, to: oil, conductance: 9 W/K}",
                              "hidden_body",
                              "spindle,column",
                              3,
                              {{"conductance", 6.0}, {"capacity", 15e3}, {"ratio_of_conductances", 1.5}},
                              0.25,
                              "- {type: node, node: between_spindle_and_column, capacity: "}),
    missing_name);

TEST(NoMissingPath, IsConsistent) {
  const Found found(kMachine, kMachine, "none_", {.seed = 3});
  EXPECT_EQ(found.d.verdict, Verdict::kConsistent) << found.d.reason;
}

TEST(MissingPaths, AreOfferedOnceWhereNothingJoinsTwoBodies) {
  const std::string plain = write_file("plain.yaml", kMachine);
  const Beside beside(plain, noisy_records(plain, "offered_", {.seed = 3}));
  std::vector<std::string> links, bodies;
  for (const Candidate& c : candidates(*beside.twin, beside.runs, {})) {
    if (c.effect == "link") links.push_back(c.where);
    if (c.effect == "hidden_body") bodies.push_back(c.where);
  }
  EXPECT_THAT(links, testing::UnorderedElementsAre("spindle,column", "spindle,motor", "spindle,ambient", "head,ambient",
                                                   "column,motor", "spindle,head", "head,motor",
                                                   "head,column"));  // these while the spindle turns
  EXPECT_THAT(bodies, testing::UnorderedElementsAre("spindle", "head", "column", "motor", "spindle,head", "head,column",
                                                    "head,motor", "spindle,column", "spindle,motor",
                                                    "column,motor"));  // between two, or a guard around them
}

TEST(AWrittenGradient, ThatIsFarOffIsFound) {
  const auto written = [](const std::string& gradient) {
    fixtures::ColumnAndHead what;
    what.start = "ambient";
    what.effects.push_back("{type: stratification, gradient: " + gradient + ", level: 0.1 m}");
    what.cyclograms = "{cycle: [[100 min, 1000 rpm], [100 min, 0 rpm], [100 min, 600 rpm], [60 min, 1500 rpm]]}";
    return fixtures::write_column_and_head(fresh_folder("gradient_" + gradient.substr(0, 2)), what);
  };
  const Beside beside(written("1 K/m"), noisy_records(written("13 K/m"), "gradient_", {.seed = 3}));
  const Diagnosis d = beside.diagnosed(3);
  EXPECT_EQ(d.verdict, Verdict::kNamed) << d.reason;
  ASSERT_THAT(d.causes, SizeIs(1)) << d.reason;
  EXPECT_EQ(d.causes[0].effect, "stratification");
  EXPECT_EQ(d.causes[0].where, "ambient");
  EXPECT_NEAR(d.causes[0].parameters[0].value, 13.0, 1.5);
}

}  // namespace
}  // namespace driftwright::diagnosis::missing_paths_test
