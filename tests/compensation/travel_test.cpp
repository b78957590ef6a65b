// What corrections leave along a travel: a screw whose error is the square of the position, in closed form.

#include "compensation/judging/travel.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shared/travel_matrices.hpp"

namespace driftwright::compensation::travel_test {
namespace {

using ::testing::DoubleNear, ::testing::ElementsAre;

auto near(double um) {
  return DoubleNear(um, 1e-9);
}

Travel travel() {
  return judge_travel(fixtures::travel_matrices(), fixtures::kTravelPlaces_m, fixtures::travel_judged());
}

// At 10 K the error is 0, 2.5, 10, 22.5, 40 um.
TEST(Travel, OneCorrectionForTheWholeTravelLeavesItsDifferenceToTheError) {
  const Travel t = travel();
  EXPECT_THAT(t.uncorrected.peak_um, ElementsAre(near(0.0), near(2.5), near(10.0), near(22.5), near(40.0)));
  EXPECT_EQ(t.uncorrected.place, 4u);
  EXPECT_EQ(t.uncorrected.run, 1u);
  const TravelStrategy& exact = t.strategies[1];
  ASSERT_EQ(exact.name, "exact");
  ASSERT_EQ(exact.alone.size(), 3u);
  EXPECT_THAT(exact.alone[0].peak_um, ElementsAre(near(0.0), near(2.5), near(10.0), near(22.5), near(40.0)));
  EXPECT_THAT(exact.alone[1].peak_um, ElementsAre(near(10.0), near(7.5), near(0.0), near(12.5), near(30.0)));
  EXPECT_THAT(exact.alone[2].peak_um, ElementsAre(near(40.0), near(37.5), near(30.0), near(17.5), near(0.0)));
  EXPECT_THAT(exact.alone[1].worst_um, near(30.0));
  EXPECT_EQ(exact.alone[2].place, 0u);
}

// Half-way between two places a parabola lies an eighth of its second difference, 20 um, under the chord.
TEST(Travel, CorrectionsForThreePlacesLeaveWhatTheChordLeaves) {
  const TravelStrategy exact = travel().strategies[1];
  EXPECT_THAT(exact.along.peak_um, ElementsAre(near(0.0), near(2.5), near(0.0), near(2.5), near(0.0)));
  EXPECT_THAT(exact.along.worst_um, near(2.5));
  EXPECT_EQ(exact.along.run, 1u);
}

TEST(Travel, TheChoiceIsByLeftOutPartsOfAllPlacesAndOfStrategiesThatAllPlacesHave) {
  const Travel t = travel();
  ASSERT_EQ(t.strategies.size(), 2u);  // neither the baseline nor what one place lacks
  ASSERT_TRUE(t.chosen && t.chosen_formula);
  EXPECT_EQ(t.strategies[*t.chosen].name, "constant");
  EXPECT_EQ(t.strategies[*t.chosen_formula].name, "exact");
  EXPECT_THAT(t.why_chosen, ::testing::HasSubstr("it leaves 1 µm"));
  EXPECT_FALSE(t.strategies[0].is_formula);
  EXPECT_THAT(t.strategies[0].along.worst_um, near(39.0));
}

TEST(Travel, WithoutPartsLeftOutNothingIsChosen) {
  std::vector<StrategyMatrix> matrices = fixtures::travel_matrices();
  for (JudgedStrategy& s : matrices[1].strategies) s.fitted.fold_errors.clear();
  const Travel t = judge_travel(matrices, fixtures::kTravelPlaces_m, fixtures::travel_judged());
  EXPECT_FALSE(t.chosen || t.chosen_formula);
}

}  // namespace
}  // namespace driftwright::compensation::travel_test
