// Heat of an axis that the scenario lacks: by a power of its feed, or while it holds a weight at rest. The other axis
// moves otherwise.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis::heat_of_feeds_test {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr const char* kMachine = R"(name: two_axes
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: spindle, capacity: 5 kJ/K}
  - {type: node, node: column, capacity: 20 kJ/K}
  - {type: node, node: table, capacity: 12 kJ/K}
  - {type: heat_source, node: spindle, power: 90 W, at_speed: 1000 rpm, exponent: 1.3}
  - {type: servo_loss, node: column, power: 30 W, at_feed: 10 m/min, exponent: 1, axis: z}
  - {type: link, node: spindle, to: column, conductance: 8 W/K}
  - {type: link, node: column, to: table, conductance: 3 W/K}
  - {type: link, node: column, to: ambient, conductance: 9 W/K}
  - {type: link, node: table, to: ambient, conductance: 6 W/K}
ambient: [[0 min, 20 degC], [200 min, 22 degC], [400 min, 21 degC]]
sensors:
  - {name: t_spindle, node: spindle}
  - {name: t_column, node: column}
  - {name: t_table, node: table}
displacements:
  - name: nose
    sensitivities:
      - {node: column, sensitivity: 3 um/K}
cyclograms:
  monday:
    columns: [duration, speed, feed_x, feed_z]
    rows: [[60 min, 600 rpm, 4 m/min, 0 m/min], [60 min, 1900 rpm, 20 m/min, 5 m/min], [40 min, 0 rpm, 0 m/min, 0 m/min], [80 min, 1000 rpm, 9 m/min, 10 m/min], [60 min, 1400 rpm, 0 m/min, 3 m/min]]
  tuesday:
    columns: [duration, speed, feed_x, feed_z]
    rows: [[50 min, 1800 rpm, 12 m/min, 0 m/min], [70 min, 300 rpm, 16 m/min, 8 m/min], [60 min, 1000 rpm, 6 m/min, 2 m/min], [60 min, 0 rpm, 0 m/min, 0 m/min], [60 min, 1200 rpm, 20 m/min, 0 m/min]]
solver: {output_interval: 1 min}
)";

struct Cause {
  const char* name;
  const char* entry;
  const char* where;
  const char* law;
  std::vector<std::pair<double, double>> numbers;  ///< and what they may be off by
};
class HeatOfAnAxis : public testing::TestWithParam<Cause> {};

TEST_P(HeatOfAnAxis, IsNamedWithItsAxisAndWritten) {
  const Cause& cause = GetParam();
  const Found found(kMachine, with_effect(kMachine, cause.entry), std::string(cause.name) + "_");
  const Diagnosis& d = found.d;
  EXPECT_EQ(d.verdict, Verdict::kNamed) << d.reason;
  ASSERT_THAT(d.causes, SizeIs(1)) << d.reason;
  EXPECT_EQ(d.causes[0].effect, "heat_source");
  EXPECT_EQ(d.causes[0].where, cause.where);
  EXPECT_THAT(d.causes[0].law, HasSubstr(cause.law));
  ASSERT_GE(d.causes[0].parameters.size(), cause.numbers.size());
  for (std::size_t i = 0; i < cause.numbers.size(); ++i)
    EXPECT_NEAR(d.causes[0].parameters[i].value, cause.numbers[i].first, cause.numbers[i].second);
  found.expect_written_is_found_no_more();
}

INSTANTIATE_TEST_SUITE_P(
    All, HeatOfAnAxis,
    ::testing::Values(Cause{"a_screw",
                            "{type: servo_loss, node: table, power: 60 W, at_feed: 20 m/min, exponent: 1.8, axis: x}",
                            "table",
                            "power law of the feed of x, at 20 m/min",
                            {{60.0, 4.0}, {1.8, 0.3}}},
                      Cause{"a_motor_that_holds",
                            "{type: servo_loss, node: column, power: 0 W, at_feed: 10 m/min, holding: 30 W, axis: z}",
                            "column",
                            "while the axis z is at rest",
                            {{30.0, 4.0}}}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace driftwright::diagnosis::heat_of_feeds_test
