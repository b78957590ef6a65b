// Thermometers that are wrong together, by one number, and one that sits on another body than its label says: found in
// records made so, and written.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis::instruments_in_common_test {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

/// Three spindles on a beam, alike to a third or so.
constexpr const char* kMachine = R"(name: spindles
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: left, capacity: 2 kJ/K}
  - {type: node, node: middle, capacity: 3 kJ/K}
  - {type: node, node: right, capacity: 2.8 kJ/K}
  - {type: node, node: beam, capacity: 40 kJ/K}
  - {type: heat_source, node: left, power: 60 W, at_speed: 1000 rpm, exponent: 1.2}
  - {type: heat_source, node: middle, power: 75 W, at_speed: 1000 rpm, exponent: 1.7}
  - {type: heat_source, node: right, power: 72 W, at_speed: 1000 rpm, exponent: 1.5}
  - {type: link, node: left, to: beam, conductance: 9 W/K}
  - {type: link, node: middle, to: beam, conductance: 11 W/K}
  - {type: link, node: right, to: beam, conductance: 10 W/K}
  - {type: link, node: beam, to: ambient, conductance: 15 W/K}
ambient: [[0 min, 20 degC], [200 min, 22 degC], [400 min, 21 degC]]
sensors:
  - {name: card1_ch1, node: left}
  - {name: card1_ch2, node: right}
  - {name: card2_ch1, node: beam}
displacements:
  - {name: bow, sensitivities: [{node: left, sensitivity: 2 um/K}, {node: beam, sensitivity: -5 um/K}]}
  - {name: rise, sensitivities: [{node: right, sensitivity: 3 um/K}]}
cyclograms:
  monday: [[60 min, 600 rpm], [60 min, 1900 rpm], [40 min, 0 rpm], [80 min, 1000 rpm], [60 min, 1400 rpm]]
  tuesday: [[50 min, 1800 rpm], [70 min, 300 rpm], [60 min, 1000 rpm], [60 min, 0 rpm], [60 min, 2000 rpm]]
solver: {output_interval: 1 min}
)";

/// What is said of records of a truth.
struct Said : Found {
  Said(const std::string& truth, const std::string& name) : Found(kMachine, truth, name + "_", {.seed = 3}) {}
};

std::string with(std::initializer_list<std::string> entries) {
  std::string truth = kMachine;
  for (const std::string& e : entries) truth = with_effect(truth, e);
  return truth;
}

TEST(InstrumentsInCommon, AThermometerOnAnotherBodyIsSaidToSitThere) {
  const Said said(with({"{type: sensor_place, sensor: card1_ch2, body: middle, share: 1}"}), "mislabelled");
  ASSERT_THAT(said.d.causes, SizeIs(1)) << said.d.reason;
  EXPECT_EQ(said.d.verdict, Verdict::kNamed) << said.d.reason;
  EXPECT_EQ(said.d.causes[0].effect, "sensor_place");
  EXPECT_EQ(said.d.causes[0].where, "card1_ch2");
  EXPECT_THAT(said.d.causes[0].law, HasSubstr("sits on middle, not at its place"));
  EXPECT_THAT(said.written(), HasSubstr("{type: sensor_place, sensor: card1_ch2, share: 1, body: middle}"));
}

TEST(InstrumentsInCommon, ACardThatIsOffIsOneCause) {
  const Said said(
      with({"{type: sensor_bias, sensor: card1_ch1, bias: 0.3 K}", "{type: sensor_bias, sensor: card1_ch2, bias: 0.3 K}"}),
      "card");
  ASSERT_THAT(said.d.causes, SizeIs(1)) << said.d.reason;
  EXPECT_EQ(said.d.verdict, Verdict::kNamed) << said.d.reason;
  EXPECT_EQ(said.d.causes[0].effect, "sensor_bias");
  EXPECT_EQ(said.d.causes[0].where, "card1_ch1,card1_ch2");
  EXPECT_NEAR(said.d.causes[0].parameters[0].value, 0.3, 0.05);
  EXPECT_THAT(said.written(), HasSubstr("{type: sensor_bias, sensor: card1_ch2"));
}

TEST(InstrumentsInCommon, ThermometersThatAllReadAShareOfTheAirAreOneCause) {
  const Said said(with({"{type: sensor_place, sensor: card1_ch1, body: ambient, share: 0.06}",
                        "{type: sensor_place, sensor: card1_ch2, body: ambient, share: 0.06}",
                        "{type: sensor_place, sensor: card2_ch1, body: ambient, share: 0.06}"}),
                  "air");
  ASSERT_THAT(said.d.causes, SizeIs(1)) << said.d.reason;
  EXPECT_EQ(said.d.verdict, Verdict::kNamed) << said.d.reason;
  EXPECT_EQ(said.d.causes[0].effect, "sensor_place");
  EXPECT_EQ(said.d.causes[0].where, "card1_ch1,card1_ch2,card2_ch1");
  EXPECT_NEAR(said.d.causes[0].parameters[0].value, 0.06, 0.02);
}

TEST(InstrumentsInCommon, AnIndicatorThatStandsAskewReadsAShareOfAnother) {
  const Said said(with({"{type: displacement_path, displacement: rise, of: bow, share: 0.08}"}), "askew");
  ASSERT_THAT(said.d.causes, SizeIs(1)) << said.d.reason;
  EXPECT_EQ(said.d.causes[0].effect, "displacement_path");
  EXPECT_EQ(said.d.causes[0].where, "rise");
  EXPECT_THAT(said.d.causes[0].law, HasSubstr("reads a share of bow"));
  EXPECT_NEAR(said.d.causes[0].parameters[0].value, 0.08, 0.01);
  EXPECT_THAT(said.written(), HasSubstr("of: bow"));
}

TEST(InstrumentsInCommon, AreNoCauseWhereNothingIsWrong) {
  const Said said(kMachine, "nothing");
  EXPECT_EQ(said.d.verdict, Verdict::kConsistent) << said.d.reason;
}

}  // namespace
}  // namespace driftwright::diagnosis::instruments_in_common_test
