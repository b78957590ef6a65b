// Which rows of a stream are taken, and their times: rows that are late, doubled, swapped, missing, and clocks that are set.

#include "follow/row_guard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace driftwright::follow::row_guard_test {
namespace {

using ::testing::ElementsAre, ::testing::IsEmpty;

const std::vector<Channel> kChannels = {{"t01", "degC", {}}, {"speed", "rpm", {}}};

StreamRow row(double time_s, double t01 = 20.0, double speed = 1000.0) {
  return {.time_s = time_s, .values = {t01, speed}};
}

/// Times in the run of the rows that are taken.
std::vector<double> taken(RowGuard& guard, const std::vector<double>& times_s) {
  std::vector<double> run_s;
  for (double t_s : times_s) {
    StreamRow r = row(t_s);
    if (const JudgedRow judged = guard.judge(r, kChannels); judged.is_taken) run_s.push_back(judged.run_s);
  }
  return run_s;
}

std::int64_t n(const RowGuard& guard, Fault fault) {
  return guard.state().counts[static_cast<std::size_t>(fault)];
}

TEST(RowGuard, TimeCountsFromTheFirstRow) {
  RowGuard guard;
  EXPECT_THAT(taken(guard, {1000.0, 1060.0, 1120.0}), ElementsAre(0.0, 60.0, 120.0));
  EXPECT_EQ(guard.usual_step_s(), 60.0);
  EXPECT_THAT(guard.state().counts, ::testing::Each(0));
}

TEST(RowGuard, DoubledLateAndSwappedRowsArePassedOver) {
  RowGuard guard;
  EXPECT_THAT(taken(guard, {0, 60, 60, 120, 240, 180, 300}), ElementsAre(0, 60, 120, 240, 300));
  EXPECT_EQ(n(guard, Fault::kDoubled), 1);
  EXPECT_EQ(n(guard, Fault::kLate), 1);
}

TEST(RowGuard, MissingRowsAreCountedAndTimeGoesOn) {
  RowGuard guard;
  EXPECT_THAT(taken(guard, {0, 60, 120, 420, 480}), ElementsAre(0, 60, 120, 420, 480));
  EXPECT_EQ(n(guard, Fault::kMissingRows), 1);
  EXPECT_EQ(guard.usual_step_s(), 60.0);  // of a gap no step is learned
}

TEST(RowGuard, AClockThatIsSetBackGoesOnByOneStepWhereItIsConfirmed) {
  RowGuard guard;
  EXPECT_THAT(taken(guard, {10000, 10060, 10120, 6580, 6640, 6700}), ElementsAre(0, 60, 120, 180, 240));
  EXPECT_EQ(n(guard, Fault::kClockSet), 1);
  EXPECT_EQ(n(guard, Fault::kUnconfirmed), 1);
}

TEST(RowGuard, AClockThatIsSetForwardByYearsDoesNotPass) {
  RowGuard guard;
  EXPECT_THAT(taken(guard, {0, 60, 1.7e9, 1.7e9 + 60, 1.7e9 + 120}), ElementsAre(0, 60, 120, 180));
  EXPECT_EQ(n(guard, Fault::kClockSet), 1);
}

TEST(RowGuard, AnAbsenceOfHoursHasPassed) {
  RowGuard guard;
  EXPECT_THAT(taken(guard, {0, 60, 7260, 7320, 7380}), ElementsAre(0, 60, 7320, 7380));
  EXPECT_EQ(n(guard, Fault::kGap), 1);
}

TEST(RowGuard, ASingleStrayTimeIsPassedOver) {
  for (const double stray_s : {5e5, -5e5, 1e12}) {
    RowGuard guard;
    EXPECT_THAT(taken(guard, {0, 60, 120, stray_s, 180, 240}), ElementsAre(0, 60, 120, 180, 240)) << stray_s;
    EXPECT_EQ(n(guard, Fault::kUnconfirmed), 1);
    EXPECT_EQ(n(guard, Fault::kClockSet) + n(guard, Fault::kGap), 0);
  }
}

TEST(RowGuard, AFirstTimeThatIsYearsOffIsNoYears) {
  RowGuard guard;
  EXPECT_THAT(taken(guard, {0.0, 1.7e9, 1.7e9 + 60, 1.7e9 + 120}), ElementsAre(0.0, 1.0, 61.0));
}

TEST(RowGuard, ValuesThatNoMachineHasAreMissing) {
  RowGuard guard;
  StreamRow r = row(0.0, 4000.0, -5.0);
  EXPECT_THAT(guard.judge(r, kChannels).faults, ElementsAre(Fault::kOutOfRange));
  EXPECT_TRUE(std::isnan(r.values[0]) && std::isnan(r.values[1]));
  r = row(60.0, NAN, 0.0);
  EXPECT_THAT(guard.judge(r, kChannels).faults, IsEmpty());  // missing is no fault of its own here
  r = {.time_s = 120.0, .values = {NAN, 0.0}, .n_unreadable = 1};
  EXPECT_THAT(guard.judge(r, kChannels).faults, ElementsAre(Fault::kUnreadableValue));
  r = row(NAN);
  EXPECT_FALSE(guard.judge(r, kChannels).is_taken);
}

}  // namespace
}  // namespace driftwright::follow::row_guard_test
