#include "compensation/injector/pulse_injector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "base/random.hpp"

namespace driftwright::compensation::pulse_injector_test {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;

constexpr Lines k00 = 0, k10 = kLineA, k11 = kLineA | kLineB, k01 = kLineB;

std::vector<Lines> feed(PulseInjector& injector, const std::vector<Lines>& rows) {
  std::vector<Lines> out(rows.size() * kMostRowsPerRow);
  out.resize(injector.run(rows, out.data()));
  return out;
}

std::vector<Lines> from_low(int n_quarters) {
  std::vector<Lines> rows = motion_rows(k00, n_quarters);
  rows.insert(rows.begin(), k00);
  return rows;
}

std::int64_t count_of(const std::vector<Lines>& rows, Counting counting = Counting::kX4) {
  QuadratureCounter counter(rows.front(), counting);
  for (Lines row : rows) counter.step(row);
  EXPECT_EQ(counter.n_jumps(), 0);
  return counter.count();
}

TEST(PulseInjector, PassesRowsThroughUnchangedWhenNothingIsDue) {
  std::vector<Lines> rows = from_low(24);
  const std::vector<Lines> back = motion_rows(rows.back(), -40);
  rows.insert(rows.end(), back.begin(), back.end());
  for (std::size_t i = 0; i < rows.size(); i += 7) rows[i] |= kLineIndex;
  PulseInjector injector;
  EXPECT_THAT(feed(injector, rows), ElementsAreArray(rows));
  injector.set_target(12);
  (void)feed(injector, motion_rows(rows.back(), 16));
  EXPECT_EQ(injector.inserted(), 12);
  EXPECT_THAT(feed(injector, rows), ElementsAreArray(rows));  // the target is reached: the encoder's own signal again
}

// The order of the rows is the 90 degree law itself: A rises first forward, B rises first backward.
TEST(PulseInjector, InsertsOnePeriodWhileBothAreLow) {
  PulseInjector forward, backward;
  forward.set_target(4);
  backward.set_target(-4);
  EXPECT_THAT(feed(forward, {k01, k00, k10}), ElementsAre(k01, k00, k10, k11, k01, k00, k10));
  EXPECT_THAT(feed(backward, {k01, k00, k10}), ElementsAre(k01, k00, k01, k11, k10, k00, k10));
  EXPECT_EQ(forward.inserted(), 4);
  EXPECT_EQ(backward.inserted(), -4);
}

// Counts by hand: the axis moves n quarters from 00, the injector adds 4 per period, whichever way the axis goes; at x1 one.
TEST(PulseInjector, OneCycleIsFourCountsAtX4AndOneAtX1) {
  for (int n_quarters : {+40, -40}) {
    for (int target : {+28, -28}) {
      PulseInjector injector;
      injector.set_target(target);
      const std::vector<Lines> out = feed(injector, from_low(n_quarters));
      EXPECT_EQ(count_of(out), n_quarters + target);
      EXPECT_EQ(count_of(out, Counting::kX2), (n_quarters + target) / 2);
      EXPECT_EQ(count_of(out, Counting::kX1), (n_quarters + target) / 4);
      EXPECT_EQ(injector.n_insertions(), 7);
    }
  }
}

// 40 quarters pass 00 ten times, and the row before them is the eleventh: of the 25 required periods only eleven find a
// low row.
TEST(PulseInjector, InsertsNoMoreThanOnePeriodPerLowRow) {
  PulseInjector injector;
  injector.set_target(100);
  EXPECT_EQ(count_of(feed(injector, from_low(40))), 40 + 4 * 11);
  EXPECT_EQ(injector.inserted(), 44);
}

TEST(PulseInjector, ARestingAxisGetsOnePeriodPerRowWhereBothAreLowAndNoneElsewhere) {
  PulseInjector low, high;
  low.set_target(8);
  high.set_target(8);
  EXPECT_THAT(feed(low, {k00, k00, k00}), ElementsAre(k00, k10, k11, k01, k00, k00, k10, k11, k01, k00, k00));
  EXPECT_THAT(feed(high, {k11, k11, k11}), ElementsAre(k11, k11, k11));
}

// The encoder comes into 00 going forward (01 -> 00) and leaves it backward (00 -> 01): the way back counts as it did.
TEST(PulseInjector, SurvivesAReversalInsideTheLowWindow) {
  PulseInjector injector;
  injector.set_target(-4);
  EXPECT_THAT(feed(injector, {k01, k00, k01}), ElementsAre(k01, k00, k01, k11, k10, k00, k01));
}

TEST(PulseInjector, TakesPeriodsBackWhenTheTargetFalls) {
  PulseInjector injector;
  injector.set_target(20);
  (void)feed(injector, from_low(40));
  injector.set_target(8);
  std::vector<Lines> out = feed(injector, motion_rows(k00, 40));
  out.insert(out.begin(), k00);
  EXPECT_EQ(count_of(out), 40 - 12);
  EXPECT_EQ(injector.inserted(), 8);
}

// A quarter: after the row at 00 the output makes one legal step, and stays that far ahead.
TEST(PulseInjector, AQuarterShiftsThePhaseForGood) {
  PulseInjector injector({.quarters = 1});
  injector.set_target(1);
  EXPECT_THAT(feed(injector, {k01, k00, k10, k11, k01, k00, k01}), ElementsAre(k01, k00, k10, k11, k01, k00, k10, k00));
  injector.set_target(0);
  EXPECT_THAT(feed(injector, {k00, k10}), ElementsAre(k10, k00, k10));
}

TEST(PulseInjector, ARestBelowOneInsertionWaits) {
  PulseInjector injector;
  injector.set_target(3);
  EXPECT_THAT(feed(injector, {k00, k00}), ElementsAre(k00, k00));
  injector.set_target(7);
  (void)feed(injector, {k00, k00});
  EXPECT_EQ(injector.inserted(), 4);
}

TEST(PulseInjector, TheIndexIsHeldThroughAnInsertion) {
  PulseInjector injector;
  injector.set_target(4);
  const std::vector<Lines> out = feed(injector, {k01, k00 | kLineIndex, k10});
  EXPECT_THAT(
      out, ElementsAre(k01, k00 | kLineIndex, k10 | kLineIndex, k11 | kLineIndex, k01 | kLineIndex, k00 | kLineIndex, k10));
}

// A lost edge: 10 -> 01. The control sees the states between, and nothing is inserted until a whole period has followed.
TEST(PulseInjector, MakesUpForALostEdgeAndHoldsTheCorrection) {
  PulseInjector injector;
  const std::vector<Lines> out = feed(injector, {k00, k10, k01});
  EXPECT_THAT(out, ElementsAre(k00, k10, k10));  // in doubt
  injector.set_target(4);
  EXPECT_THAT(feed(injector, {k00}), ElementsAre(k11, k01, k00));  // three steps forward; both low, but nothing is inserted
  EXPECT_THAT(feed(injector, {k10, k11, k01}), ElementsAre(k10, k11, k01));
  EXPECT_EQ(injector.inserted(), 0);
  EXPECT_THAT(feed(injector, {k00}), ElementsAre(k00, k10, k11, k01, k00));
  EXPECT_EQ(injector.encoder().n_jumps(), 1);
}

TEST(PulseInjector, BypassIsAWireForFaultsToo) {
  Random random(7);
  std::vector<Lines> rows;
  for (int i = 0; i < 10000; ++i) rows.push_back(static_cast<Lines>(random.below(8)));
  PulseInjector injector({.bypass = true});
  injector.set_target(1000);
  EXPECT_EQ(feed(injector, rows), rows);
  EXPECT_EQ(injector.inserted(), 0);
  EXPECT_GT(injector.encoder().n_jumps(), 1000);
}

TEST(PulseInjector, RefusesOtherPartsOfACycle) {
  EXPECT_THROW(PulseInjector({.quarters = 3}), RangeError);
  EXPECT_THROW(PulseInjector({.quarters = 0}), RangeError);
}

/// One random case: an axis that walks, rests and turns, targets that change, any rules. True when every property holds.
void check_walk(std::uint64_t seed) {
  Random random(seed);
  const InsertionRules rules{.quarters = 1 << random.below(3), .anywhere = random.chance(0.3)};
  PulseInjector injector(rules);
  const double p_move = random.uniform(), p_turn = random.uniform(0.0, 0.5);
  std::int64_t phase = random.below(4);
  const std::int64_t start = phase;
  int direction = +1;
  std::array<Lines, kMostRowsPerRow> out;
  QuadratureCounter control(lines_of_phase(start));
  for (int i = 0; i < 60; ++i) {
    if (random.chance(0.1)) injector.set_target(random.below(61) - 30);
    if (i > 0) {
      if (random.chance(p_turn)) direction = -direction;
      if (random.chance(p_move)) phase += direction;
    }
    const Lines row = static_cast<Lines>(lines_of_phase(phase) | (random.chance(0.1) ? kLineIndex : 0));
    const std::int64_t before = injector.inserted();
    const std::size_t n = injector.run({&row, 1}, out.data());
    for (std::size_t r = 0; r < n; ++r) {
      control.step(out[r]);
      ASSERT_EQ(out[r] & kLineIndex, row & kLineIndex);
    }
    const std::int64_t step = injector.inserted() - before;
    ASSERT_EQ(control.n_jumps(), 0) << "seed " << seed;
    ASSERT_EQ(control.count(), phase - start + injector.inserted()) << "seed " << seed << " row " << i;
    ASSERT_TRUE(step == 0 || std::abs(step) == rules.quarters);
    ASSERT_EQ(n, 1u + static_cast<std::size_t>(std::abs(step)));
    if (step != 0 && !rules.anywhere) {
      ASSERT_EQ(row & kLinesAB, 0) << "seed " << seed;
    }
    if (injector.inserted() % 4 == 0) {
      ASSERT_EQ(out[n - 1], row);
    }
  }
}

TEST(PulseInjector, KeepsItsPropertiesOnRandomWalks) {
  for (std::uint64_t seed = 0; seed < 50000 && !::testing::Test::HasFatalFailure(); ++seed) check_walk(seed);
}

}  // namespace
}  // namespace driftwright::compensation::pulse_injector_test
