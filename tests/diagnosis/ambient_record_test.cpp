// An ambient whose record is late, by its clock or its thermometer, and air that follows the machine: each is named from
// records made with it, with its number, and written so that it is found no more.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis::ambient_record_test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// A hall whose heating comes and goes.
constexpr const char* kMachine = R"(name: in_a_hall
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: head, capacity: 5 kJ/K}
  - {type: node, node: column, capacity: 20 kJ/K}
  - {type: heat_source, node: head, power: 90 W, at_speed: 1000 rpm, exponent: 1.3}
  - {type: link, node: head, to: column, conductance: 8 W/K}
  - {type: link, node: column, to: ambient, conductance: 14 W/K}
  - {type: link, node: head, to: ambient, conductance: 9 W/K}
ambient: [[0 min, 20 degC], [30 min, 23 degC], [60 min, 19 degC], [100 min, 22 degC], [130 min, 18.5 degC], [170 min, 22.5 degC], [200 min, 20 degC], [240 min, 23 degC], [280 min, 19 degC]]
sensors:
  - {name: t_head, node: head}
  - {name: t_column, node: column}
displacements:
  - name: nose
    sensitivities:
      - {node: head, sensitivity: 3 um/K}
cyclograms:
  monday: [[60 min, 600 rpm], [60 min, 1900 rpm], [40 min, 0 rpm], [80 min, 1000 rpm], [40 min, 1400 rpm]]
  tuesday: [[50 min, 1800 rpm], [70 min, 300 rpm], [60 min, 1000 rpm], [40 min, 0 rpm], [60 min, 2000 rpm]]
solver: {output_interval: 1 min}
)";

struct Cause {
  const char* name;
  const char* entry;
  const char* law;  ///< part of it
  double size, tolerance;
};
class AnAmbient : public testing::TestWithParam<Cause> {};

TEST_P(AnAmbient, ThatIsRecordedWronglyIsNamedAndWritten) {
  const Cause& cause = GetParam();
  const Found found(kMachine, with_effect(kMachine, cause.entry), std::string(cause.name) + "_");
  const Diagnosis& d = found.d;
  EXPECT_EQ(d.verdict, Verdict::kNamed) << d.reason;
  ASSERT_THAT(d.causes, SizeIs(1)) << d.reason;
  EXPECT_EQ(d.causes[0].effect, "ambient");
  EXPECT_THAT(d.causes[0].law, HasSubstr(cause.law));
  EXPECT_THAT(d.causes[0].alternatives, IsEmpty());
  EXPECT_NEAR(d.causes[0].parameters[0].value, cause.size, cause.tolerance);
  found.expect_written_is_found_no_more();
}

INSTANTIATE_TEST_SUITE_P(
    All, AnAmbient,
    ::testing::Values(Cause{"a_late_clock", "{type: ambient, late: 6 min}", "recorded late or early", 6.0, 0.6},
                      Cause{"an_early_clock", "{type: ambient, late: -60 min}", "recorded late or early", -60.0, 1.0},
                      Cause{"a_slow_thermometer", "{type: ambient, lag: 9 min}", "slow thermometer", 9.0, 1.0},
                      Cause{"air_that_the_machine_warms",
                            "{type: ambient, with_speed: 2.5 K, at_speed: 1800 rpm, behind: 10 min}",
                            "with the speed, with one lag, at 1000 rpm", 2.5 / 1.8, 0.2}),
    [](const auto& one) { return std::string(one.param.name); });

TEST(AnAmbientOfARightRecord, IsNotBlamed) {
  const Found found(kMachine, kMachine, "right_");
  EXPECT_EQ(found.d.verdict, Verdict::kConsistent) << found.d.reason;
}

}  // namespace
}  // namespace driftwright::diagnosis::ambient_record_test
