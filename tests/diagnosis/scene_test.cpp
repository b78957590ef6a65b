// What of the records a diagnosis asks effects about: between which speeds a gear may change.

#include "diagnosis/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis::scene_test {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<double> steps_rpm(const std::string& day) {
  std::string text = kTwoNodes;
  const std::size_t from = text.find("cyclograms:"), to = text.find("solver:");
  text.replace(from, to - from, "cyclograms:\n  day: [" + day + "]\n");
  const std::string path = write_file("machine.yaml", text);
  const Beside beside(path, noisy_records(path, "speeds_"));
  return scene_of(*beside.twin, beside.runs).speed_steps_rpm;
}

TEST(SpeedSteps, LieHalfWayBetweenSpeedsThatItTurnsAtForAWhile) {
  // 20 of the 200 min that it turns are slower, a rest does not count.
  EXPECT_THAT(steps_rpm("[20 min, 500 rpm], [180 min, 1500 rpm], [300 min, 0 rpm]"), ElementsAre(DoubleEq(1000.0)));
}

TEST(SpeedSteps, AreNoneBesideASpeedItPassesOrNextToOneThatWasReadTwice) {
  EXPECT_THAT(steps_rpm("[8 min, 500 rpm], [192 min, 1500 rpm]"), IsEmpty()) << "4 % of the time";
  EXPECT_THAT(steps_rpm("[100 min, 1500 rpm], [100 min, 1600 rpm]"), IsEmpty()) << "7 % faster";
  EXPECT_THAT(steps_rpm("[100 min, 1000 rpm]"), IsEmpty());
}

TEST(SpeedSteps, AreTheSixWidestOfMany) {
  // Ratios of 3, 1.20, 1.22, 1.23, 1.24, 1.25 and 2.2: the second is the one too many.
  EXPECT_THAT(
      steps_rpm("[20 min, 100 rpm], [20 min, 300 rpm], [20 min, 360 rpm], [20 min, 440 rpm], [20 min, 540 rpm], [20 min, "
                "670 rpm], "
                "[20 min, 840 rpm], [20 min, 1860 rpm]"),
      ElementsAre(DoubleEq(200.0), DoubleEq(1350.0), DoubleEq(755.0), DoubleEq(605.0), DoubleEq(490.0), DoubleEq(400.0)));
}

}  // namespace
}  // namespace driftwright::diagnosis::scene_test
