// Counts for the external offset of an axis whose correction depends on its position, by closed form.

#include "compensation/control/axis_travel.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace driftwright::axis_travel_test {
namespace {

constexpr double kCycle_s = 0.125;  // sums of it are exact
constexpr std::array<double, 3> kAt = {0.0, 400.0, 800.0};

struct Axis {
  axis_offset_settings settings{
      .most_rate_um_s = 2.0, .sign = -1.0, .um_per_count = 0.25, .unit_um = 1000.0, .most_age_s = 1.0, .most_um = 0.0};
  axis_travel_state state{};
  std::array<double, 3> corrections_um = {0.0, 10.0, 40.0};
  bool heartbeat = false, is_on = true, is_enabled = true;
  double position = 0.0;
  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      heartbeat = !heartbeat;
      axis_travel_watch(&settings, &state, 3, heartbeat, kCycle_s);
      axis_travel_step(&settings, &state, kAt.data(), 3, is_on, is_enabled, corrections_um.data(), position, kCycle_s);
    }
  }
};

TEST(AxisTravel, IsStraightBetweenPlacesAndHoldsBeyondThem) {
  const std::array<double, 3> um = {1.0, 5.0, -3.0};
  const auto at = [&](double mm) { return axis_travel_value(kAt.data(), um.data(), 3, mm); };
  EXPECT_EQ(at(-50.0), 1.0);
  EXPECT_EQ(at(0.0), 1.0);
  EXPECT_EQ(at(100.0), 2.0);
  EXPECT_EQ(at(400.0), 5.0);
  EXPECT_EQ(at(600.0), 1.0);
  EXPECT_EQ(at(800.0), -3.0);
  EXPECT_EQ(at(900.0), -3.0);
  EXPECT_EQ(at(NAN), 1.0);
  EXPECT_EQ(axis_travel_value(kAt.data(), um.data(), 1, 700.0), 1.0);
}

// Each place grows by 0.25 um a cycle to its own correction. Where the axis is, its offset is the chord: no slew limit of
// that.
TEST(AxisTravel, IsSlewedInTimeAndNotByTheWayOfTheAxis) {
  Axis axis;
  axis.run(1);  // the heartbeat has not changed yet
  EXPECT_EQ(axis.state.is_offset_enabled, 0);
  for (int i = 1; i <= 200; ++i) {
    axis.position = 600.0;
    axis.run(1);
    const double mid_um = std::min(10.0, 0.25 * i), far_um = std::min(40.0, 0.25 * i);
    ASSERT_EQ(axis.state.offset_um, -0.5 * (mid_um + far_um)) << i;
    ASSERT_EQ(axis.state.is_offset_enabled, 1);
  }
  EXPECT_EQ(axis.state.counts, -100);  // 25 um
  EXPECT_EQ(axis.state.scale, 0.25e-3);
  axis.position = 800.0;
  axis.run(1);
  EXPECT_EQ(axis.state.counts, -160);
  axis.position = 0.0;
  axis.run(1);
  EXPECT_EQ(axis.state.counts, 0);
  axis.position = NAN;  // the last one that was a number
  axis.corrections_um[0] = 1.0;
  axis.run(4);
  EXPECT_EQ(axis.state.offset_um, -1.0);
  axis.position = 800.0;
  axis.is_enabled = false;
  for (int i = 1; i <= 200; ++i) {
    axis.run(1);
    ASSERT_EQ(axis.state.offset_um, -std::max(0.0, 40.0 - 0.25 * i)) << i;
    ASSERT_EQ(axis.state.is_offset_enabled, i <= 160) << i;  // until the control has taken back the last count
  }
}

TEST(AxisTravel, IsAtZeroWhileTheMachineIsOff) {
  Axis axis;
  axis.position = 800.0;
  axis.run(200);
  ASSERT_EQ(axis.state.counts, -160);
  axis.is_on = false;
  axis.run(1);
  EXPECT_EQ(axis.state.counts, 0);
  EXPECT_EQ(axis.state.is_offset_enabled, 0);
}

// The control adds up counts times scale: what it has taken is taken back in the same scale, and a wrong setting is said at
// once.
TEST(AxisTravel, ANewCountWaitsUntilTheOldOnesAreTakenBack) {
  Axis axis;
  axis.position = 800.0;
  axis.run(200);
  double taken_mm = axis.state.counts * axis.state.scale;
  axis.settings.um_per_count = 0.5;
  int before = axis.state.counts;
  for (int i = 0; i < 400; ++i) {
    axis.run(1);
    taken_mm += (axis.state.counts - before) * axis.state.scale;
    before = axis.state.counts;
  }
  EXPECT_EQ(axis.state.scale, 0.5e-3);
  EXPECT_EQ(axis.state.counts, -80);
  EXPECT_NEAR(taken_mm, -0.04, 1e-12);
  axis.settings.um_per_count = -1.0;
  axis.run(1);
  EXPECT_EQ(axis.state.is_wrong, 1);
  axis.run(200);
  EXPECT_EQ(axis.state.counts, 0);
}

}  // namespace
}  // namespace driftwright::axis_travel_test
