// In which stretches of a run a law may be another one than in the stretch before.

#include "solver/stretches.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace driftwright::solver::stretches_test {
namespace {

using ::testing::ElementsAre;

TEST(LawChanges, AreAtTheFirstStretchAtChangesOfTheDriveAndBehindTimesAtWhichLawsJump) {
  const Cyclogram cyclogram{"day", {{120.0, {.speed_rpm = 1000.0}}, {180.0, {}}}};
  const std::vector<double> jumps_s = {60.0, 150.0, 150.5, 400.0};
  std::vector<double> knots_s = {30.0, 90.0, 180.0, 240.0};  // of the ambient
  knots_s.insert(knots_s.end(), jumps_s.begin(), jumps_s.end());
  LawChanges changes(jumps_s);
  std::vector<double> at_s;
  for (const LinearStretch& stretch : linear_stretches(cyclogram, knots_s)) {
    if (changes.at(stretch)) at_s.push_back(stretch.start_s);
  }
  EXPECT_THAT(at_s, ElementsAre(0.0, 60.0, 120.0, 150.0, 150.5));
}

TEST(LawChanges, SeeAJumpThatLiesInTheFirstStretchesOfARunTakenUpLater) {
  const Cyclogram cyclogram{"day", {{300.0, {.speed_rpm = 1000.0}}}};
  const std::vector<double> jumps_s = {50.0, 200.0};
  LawChanges changes(jumps_s);
  std::vector<bool> changed;
  for (const LinearStretch& stretch : behind(100.0, linear_stretches(cyclogram, {50.0, 150.0, 200.0, 250.0})))
    changed.push_back(changes.at(stretch));
  EXPECT_THAT(changed, ElementsAre(true, false, true, false));
}

}  // namespace
}  // namespace driftwright::solver::stretches_test
