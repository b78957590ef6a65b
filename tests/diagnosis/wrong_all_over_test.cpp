// Numbers of a scenario that are far from what it says: one or two are causes by their own key; many of them say that the
// model is of another make than the machine.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis::wrong_all_over_test {
namespace {

using ::testing::HasSubstr;

/// Three bodies. @param conductances  of spindle to head, head to column and column to the ambient [W/K]
std::string machine(const std::array<double, 3>& conductances, double head_kJ_K) {
  return fmt::format(R"(name: three_nodes
reference_temperature: 20 degC
machine: {{generator: lumped}}
effects:
  - {{type: node, node: spindle, capacity: 5 kJ/K}}
  - {{type: node, node: head, capacity: {} kJ/K}}
  - {{type: node, node: column, capacity: 50 kJ/K}}
  - {{type: heat_source, node: spindle, power: 150 W, at_speed: 1000 rpm, exponent: 1.3}}
  - {{type: link, node: spindle, to: head, conductance: {} W/K}}
  - {{type: link, node: head, to: column, conductance: {} W/K}}
  - {{type: link, node: column, to: ambient, conductance: {} W/K}}
ambient: [[0 min, 20 degC], [200 min, 22 degC], [400 min, 21 degC]]
sensors:
  - {{name: t_spindle, node: spindle}}
  - {{name: t_head, node: head}}
  - {{name: t_column, node: column}}
cyclograms:
  monday: [[60 min, 600 rpm], [60 min, 1900 rpm], [40 min, 0 rpm], [80 min, 1000 rpm], [60 min, 1400 rpm], [90 min, 0 rpm]]
  tuesday: [[50 min, 1800 rpm], [70 min, 300 rpm], [60 min, 1000 rpm], [60 min, 0 rpm], [60 min, 2000 rpm]]
solver: {{output_interval: 1 min}}
)",
                     head_kJ_K, conductances[0], conductances[1], conductances[2]);
}

TEST(NumbersFarOff, AreCausesWhereTheyAreFew) {
  const Found found(machine({14, 12, 14}, 20), machine({14, 26, 14}, 20), "one_", {.seed = 3});
  const Diagnosis& d = found.d;
  EXPECT_EQ(d.verdict, Verdict::kNamed) << d.reason;
  EXPECT_THAT(d.reason, HasSubstr("link at head,column, line 10"));
}

TEST(NumbersFarOff, AreCausesWhereTheyAreTwo) {
  const Found found(machine({14, 12, 14}, 20), machine({14, 26, 14}, 9), "two_", {.seed = 3});
  const Diagnosis& d = found.d;
  EXPECT_EQ(d.verdict, Verdict::kNamed) << d.reason;
  EXPECT_THAT(d.reason, testing::AllOf(HasSubstr("link at head,column, line 10"), HasSubstr("node at head, line 6")));
}

TEST(NumbersFarOff, SayThatTheModelIsWrongAllOverWhereTheyAreMany) {
  const Found found(machine({14, 12, 14}, 20), machine({30, 5, 32}, 8), "many_", {.seed = 3});
  const Diagnosis& d = found.d;
  EXPECT_EQ(d.verdict, Verdict::kSuspected) << d.reason;
  for (const Cause& c : d.causes) EXPECT_EQ(c.standing, Standing::kSuspected) << c.effect << " at " << c.where;
  EXPECT_THAT(d.reason, HasSubstr("uncertain numbers had to go beyond 3.5 sigmas"));
  EXPECT_TRUE(d.written.keeps_numbers);
  EXPECT_LT(d.misses.extended, 0.2 * d.misses.as_written);
}

}  // namespace
}  // namespace driftwright::diagnosis::wrong_all_over_test
