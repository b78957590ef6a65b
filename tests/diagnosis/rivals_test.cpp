// What is named where several claims would do: the kind whose odds are sure, though its place be open; and nothing where
// kinds share the odds.

#include "diagnosis/rivals.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace driftwright::diagnosis::rivals_test {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(Odds, AreSharedByEvidenceOverKindsAndOverPlacesOfAKind) {
  // 4 : 2 : 1 : 1
  const double ln2 = std::log(2.0);
  const std::vector<Rival> rivals = {{"link", "head,ambient", 50.0},
                                     {"contact", "head,bed", 50.0 - ln2},
                                     {"link", "bed,ambient", 50.0 - 2 * ln2},
                                     {"ambient", "ambient", 50.0 - 2 * ln2}};
  EXPECT_THAT(shares_of(rivals), ElementsAre(DoubleNear(0.5, 1e-12), DoubleNear(0.25, 1e-12), DoubleNear(0.125, 1e-12),
                                             DoubleNear(0.125, 1e-12)));
  EXPECT_NEAR(odds_of(rivals).kind, 0.625, 1e-12);
  EXPECT_NEAR(odds_of(rivals).place, 0.8, 1e-12);
  EXPECT_THAT(open_rivals(rivals), ElementsAre(1, 2, 3));  // 0.5 + 0.25 + 0.125 is not yet nine tenths
}

TEST(Odds, OfAnotherKindBelowOneToNineLeaveNothingOpen) {
  // 1 / (1 + e^-2.1) = 0.891, 1 / (1 + e^-2.3) = 0.909
  EXPECT_THAT(open_rivals({{"link", "a,b", 20.0}, {"contact", "b,c", 17.9}}), ElementsAre(1));
  EXPECT_THAT(open_rivals({{"link", "a,b", 20.0}, {"contact", "b,c", 17.7}}), IsEmpty());
  // five of them together count as much as one likely one: 1 / (1 + 5 e^-3) = 0.80
  std::vector<Rival> many(6, {"contact", "b,c", 17.0});
  many[0] = {"link", "a,b", 20.0};
  EXPECT_NEAR(odds_of(many).kind, 1.0 / (1.0 + 5.0 * std::exp(-3.0)), 1e-12);
  EXPECT_THAT(open_rivals(many), ElementsAre(1, 2, 3));
}

TEST(Odds, OfOneKindAtTwoPlacesLeaveThePlaceOpenAlone) {
  const std::vector<Rival> rivals = {
      {"recorded_drive", "platen", 53.6}, {"recorded_drive", "cavity", 53.4}, {"ambient", "ambient", 50.0}};
  EXPECT_GT(odds_of(rivals).kind, kSure);
  EXPECT_NEAR(odds_of(rivals).place, 1.0 / (1.0 + std::exp(-0.2)), 1e-12);
  EXPECT_THAT(open_rivals(rivals), ElementsAre(1));
}

TEST(Odds, OfWhatSaysTheSameInOtherWordsTakeNothingAway) {
  const std::vector<Rival> rivals = {{"heat_source", "chamber", 30.0}, {"heat_window", "chamber", 29.9, true}};
  EXPECT_EQ(odds_of(rivals).kind, 1.0);
  EXPECT_EQ(odds_of(rivals).place, 1.0);
  EXPECT_THAT(open_rivals(rivals), IsEmpty());
}

}  // namespace
}  // namespace driftwright::diagnosis::rivals_test
