#include "compensation/pulse_injector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace driftwright::compensation {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;

constexpr QuadratureState k00{false, false}, k10{true, false}, k11{true, true}, k01{false, true};

std::vector<QuadratureState> feed(PulseInjector& injector, const std::vector<QuadratureState>& rows) {
  std::vector<QuadratureState> out;
  for (QuadratureState row : rows) {
    const auto emitted = injector.step(row);
    out.insert(out.end(), emitted.begin(), emitted.end());
  }
  return out;
}

std::int64_t count_from_low(const std::vector<QuadratureState>& rows) {
  QuadratureDecoder decoder(k00);
  for (QuadratureState row : rows) decoder.step(row);
  EXPECT_EQ(decoder.n_illegal(), 0);
  return decoder.count();
}

TEST(PulseInjector, PassesRowsThroughUnchangedWhenNothingIsDue) {
  std::vector<QuadratureState> rows = motion_rows(k00, 23);
  const std::vector<QuadratureState> back = motion_rows(rows.back(), -40);
  rows.insert(rows.end(), back.begin(), back.end());
  PulseInjector injector;
  EXPECT_THAT(feed(injector, rows), ElementsAreArray(rows));
  injector.set_target(3);
  (void)feed(injector, motion_rows(rows.back(), 12 + 3));
  EXPECT_EQ(injector.inserted(), 3);
  EXPECT_THAT(feed(injector, rows), ElementsAreArray(rows));  // the target is reached: bypass again
}

// The order of the rows is the 90 degree law itself: A rises first forward, B rises first backward.
TEST(PulseInjector, InsertsOnePeriodWhileBothAreLow) {
  PulseInjector forward, backward;
  forward.set_target(1);
  backward.set_target(-1);
  EXPECT_THAT(feed(forward, {k01, k00, k10}), ElementsAre(k01, k00, k10, k11, k01, k00, k10));
  EXPECT_THAT(feed(backward, {k01, k00, k10}), ElementsAre(k01, k00, k01, k11, k10, k00, k10));
  EXPECT_EQ(forward.inserted(), 1);
  EXPECT_EQ(backward.inserted(), -1);
}

// Counts by hand: the axis moves n quarters from 00, the injector adds 4 per period, whichever way the axis
// goes.
TEST(PulseInjector, AddsFourQuartersPerPeriodToAMovingAxis) {
  for (int n_quarters : {+40, -40}) {
    for (int target : {+7, -7}) {
      PulseInjector injector;
      injector.set_target(target);
      EXPECT_EQ(count_from_low(feed(injector, motion_rows(k00, n_quarters))), n_quarters + 4 * target);
      EXPECT_EQ(injector.inserted(), target);
    }
  }
}

// 40 quarters pass 00 ten times: of 25 periods wanted only ten find a low window.
TEST(PulseInjector, InsertsNoMoreThanOnePeriodPerLowWindow) {
  PulseInjector injector;
  injector.set_target(25);
  EXPECT_EQ(count_from_low(feed(injector, motion_rows(k00, 40))), 40 + 4 * 10);
  EXPECT_EQ(injector.inserted(), 10);
}

TEST(PulseInjector, GivesARestingAxisOnePeriodAtMost) {
  PulseInjector low, high;
  low.set_target(2);
  high.set_target(2);
  EXPECT_THAT(feed(low, {k00, k00, k00}), ElementsAre(k00, k10, k11, k01, k00, k00, k00));
  EXPECT_THAT(feed(high, {k11, k11, k11}), ElementsAre(k11, k11, k11));
}

// The encoder comes into 00 going forward (01 -> 00) and leaves it backward (00 -> 01): the window is one,
// the period fits between, and the way back counts as it did.
TEST(PulseInjector, SurvivesAReversalInsideTheLowWindow) {
  PulseInjector injector;
  injector.set_target(-2);
  const std::vector<QuadratureState> out = feed(injector, {k01, k00, k00, k01});
  EXPECT_THAT(out, ElementsAre(k01, k00, k01, k11, k10, k00, k00, k01));
  EXPECT_EQ(count_from_low(out), -1 - 4);  // 00 -> 01 is -1, +1 into 00, -4 inserted, -1 out
}

TEST(PulseInjector, TakesPeriodsBackWhenTheTargetFalls) {
  PulseInjector injector;
  injector.set_target(5);
  (void)feed(injector, motion_rows(k00, 40));
  injector.set_target(2);
  EXPECT_EQ(count_from_low(feed(injector, motion_rows(k00, 40))), 40 - 4 * 3);
  EXPECT_EQ(injector.inserted(), 2);
}

// 1e5 random quarter steps, rests and reversals, with a new random target now and then; seed 20130704. The
// inputs are legal, so the output must be, and at every single row downstream = upstream + 4 inserted.
TEST(PulseInjector, KeepsItsInvariantsOnARandomWalk) {
  std::mt19937 random(20130704);
  PulseInjector injector;
  QuadratureDecoder upstream(k00), downstream(k00);
  std::int64_t phase = 0;
  std::int64_t inserted_forward = 0, inserted_backward = 0;
  for (int i = 0; i < 100000; ++i) {
    if (random() % 50 == 0) injector.set_target(static_cast<std::int64_t>(random() % 21) - 10);
    phase += static_cast<std::int64_t>(random() % 3) - 1;
    const QuadratureState row = state_of_phase(phase);
    const std::int64_t before = injector.inserted();
    upstream.step(row);
    for (QuadratureState out : injector.step(row)) downstream.step(out);
    inserted_forward += injector.inserted() > before;
    inserted_backward += injector.inserted() < before;
    ASSERT_EQ(downstream.count(), upstream.count() + 4 * injector.inserted()) << "row " << i;
  }
  EXPECT_EQ(upstream.count(), phase);
  EXPECT_EQ(downstream.n_illegal(), 0);
  EXPECT_GT(inserted_forward, 1000);  // the walk did exercise both ways
  EXPECT_GT(inserted_backward, 1000);
}

}  // namespace
}  // namespace driftwright::compensation
