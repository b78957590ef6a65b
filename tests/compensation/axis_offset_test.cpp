// Counts for a control's external offset: enable, watchdog and slew by closed form.

#include "compensation/control/axis_offset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/random.hpp"

namespace driftwright::axis_offset_test {
namespace {

constexpr double kCycle_s = 0.125;  // sums of it are exact

struct Axis {
  axis_offset_settings settings{
      .most_rate_um_s = 2.0, .sign = -1.0, .um_per_count = 0.25, .unit_um = 1000.0, .most_age_s = 1.0, .most_um = 0.0};
  axis_offset_state state{};
  bool heartbeat = false, beats = true, is_on = true, is_enabled = true;
  double correction_um = 20.0;
  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      if (beats) heartbeat = !heartbeat;
      axis_offset_watch(&settings, &state, heartbeat, kCycle_s);
      axis_offset_step(&settings, &state, is_on, is_enabled, correction_um, kCycle_s);
    }
  }
};

TEST(AxisOffset, GoesToTheCorrectionAndBackAtTheSlewLimit) {
  Axis axis;
  axis.run(1);  // a heartbeat that has not changed yet says nothing
  EXPECT_EQ(axis.state.is_late, 1);
  EXPECT_EQ(axis.state.is_offset_enabled, 0);
  for (int i = 1; i <= 100; ++i) {
    axis.run(1);
    EXPECT_EQ(axis.state.offset_um, -std::min(20.0, 0.25 * i)) << i;
    EXPECT_EQ(axis.state.counts, -std::min(80, i)) << i;
    EXPECT_EQ(axis.state.is_offset_enabled, 1);
  }
  EXPECT_EQ(axis.state.scale, 0.25e-3);
  axis.is_enabled = false;
  for (int i = 1; i <= 100; ++i) {
    axis.run(1);
    EXPECT_EQ(axis.state.counts, -std::max(0, 80 - i)) << i;
    EXPECT_EQ(axis.state.is_offset_enabled, i <= 80) << i;  // until the control has taken back the last count
  }
  EXPECT_EQ(axis.state.offset_um, 0.0);
}

// 1 s without a change is 8 cycles; the ninth is late, and from then on the offset goes back by a count a cycle.
TEST(AxisOffset, GoesBackWhenTheHeartbeatStopsAndForthWhenItIsBack) {
  for (const bool stays : {false, true}) {
    Axis axis;
    axis.run(200);
    if (axis.heartbeat != stays) axis.run(1);
    ASSERT_EQ(axis.state.counts, -80);
    axis.beats = false;
    axis.run(8);
    EXPECT_EQ(axis.state.is_late, 0);
    EXPECT_EQ(axis.state.counts, -80);
    axis.run(30);
    EXPECT_EQ(axis.state.is_late, 1);
    EXPECT_EQ(axis.state.counts, -50);
    axis.beats = true;
    axis.run(10);
    EXPECT_EQ(axis.state.counts, -60);
    axis.beats = false;
    axis.run(8 + 200);
    EXPECT_EQ(axis.state.counts, 0);
  }
}

TEST(AxisOffset, BeginsAtZeroWheneverTheMachineIsSwitchedOn) {
  Axis axis;
  axis.run(41);
  EXPECT_EQ(axis.state.counts, -40);
  axis.is_on = false;
  axis.run(1);
  EXPECT_EQ(axis.state.counts, 0);
  EXPECT_EQ(axis.state.offset_um, 0.0);
  EXPECT_EQ(axis.state.is_offset_enabled, 0);
  axis.run(50);
  EXPECT_EQ(axis.state.counts, 0);
  axis.is_on = true;
  axis.run(10);
  EXPECT_EQ(axis.state.counts, -10);
}

TEST(AxisOffset, GoesNoFurtherThanItsLimit) {
  for (const double sign : {-1.0, 1.0}) {
    Axis axis;
    axis.settings.sign = sign;
    axis.settings.most_um = 7.0;
    axis.run(200);
    EXPECT_EQ(axis.state.offset_um, sign * 7.0);
    EXPECT_EQ(axis.state.is_wrong, 0);
    axis.settings.most_um = 0.0;  // none
    axis.run(200);
    EXPECT_EQ(axis.state.offset_um, sign * 20.0);
  }
}

TEST(AxisOffset, TakesANewSignOrScaleOnlyAtZero) {
  Axis axis;
  axis.run(200);
  axis.settings.sign = 1.0;
  axis.settings.um_per_count = 0.5;
  axis.settings.unit_um = 25400.0;
  axis.run(79);
  EXPECT_EQ(axis.state.counts, -1);
  EXPECT_EQ(axis.state.scale, 0.25e-3);
  axis.run(1);
  EXPECT_EQ(axis.state.counts, 0);
  axis.run(10);
  EXPECT_EQ(axis.state.offset_um, 2.5);
  EXPECT_EQ(axis.state.counts, 5);
  EXPECT_EQ(axis.state.scale, 0.5 / 25400.0);
}

TEST(AxisOffset, GoesBackToZeroByTheLastSettingsInOrder) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const std::vector<std::pair<double axis_offset_settings::*, std::vector<double>>> wrong = {
      {&axis_offset_settings::most_rate_um_s, {-1.0, nan, inf}},    {&axis_offset_settings::sign, {0.0, 2.0, nan}},
      {&axis_offset_settings::um_per_count, {0.0, -1.0, nan, inf}}, {&axis_offset_settings::unit_um, {0.0, -1.0, nan}},
      {&axis_offset_settings::most_age_s, {0.0, -1.0, nan}},        {&axis_offset_settings::most_um, {-1.0, nan, inf}}};
  for (const auto& [setting, values] : wrong) {
    for (const double value : values) {
      Axis axis;
      axis.run(200);
      axis.settings.*setting = value;
      axis.run(30);
      EXPECT_EQ(axis.state.is_wrong, 1) << value;
      EXPECT_EQ(axis.state.counts, -50) << value;
      axis.run(200);
      EXPECT_EQ(axis.state.counts, 0) << value;
      Axis fresh;
      fresh.settings.*setting = value;
      fresh.run(200);
      EXPECT_EQ(fresh.state.is_wrong, 1) << value;
      EXPECT_EQ(fresh.state.counts, 0) << value;
    }
  }
}

TEST(AxisOffset, OfACorrectionThatIsNoNumberIsNone) {
  Axis axis;
  axis.run(200);
  axis.correction_um = std::numeric_limits<double>::quiet_NaN();
  axis.run(30);
  EXPECT_EQ(axis.state.counts, -50);
}

// Whatever happens while the machine is on, no cycle moves by more than the slew limit, and what LinuxCNC adds up is the
// offset.
TEST(AxisOffset, NeverMovesFasterThanTheSlewLimitAndKeepsWhatTheControlAddsUp) {
  Random random(7, 1);
  Axis axis;
  double before_um = 0.0, added_up = 0.0;
  int counts_before = 0, n_moved = 0;
  for (int i = 0; i < 20000; ++i) {
    if (random.chance(0.01)) axis.beats = !axis.beats;
    if (random.chance(0.01)) axis.is_enabled = !axis.is_enabled;
    if (random.chance(0.02)) axis.correction_um = 60.0 * random.normal();
    if (random.chance(0.002)) axis.settings.sign = -axis.settings.sign;
    if (random.chance(0.002)) axis.settings.um_per_count = random.chance(0.2) ? 0.0 : 0.1 + random.uniform();
    axis.run(1);
    EXPECT_LE(std::abs(axis.state.offset_um - before_um), 0.25 + 1e-12) << i;
    if (axis.state.is_offset_enabled) added_up += axis.state.scale * (axis.state.counts - counts_before);
    EXPECT_NEAR(added_up, axis.state.scale * axis.state.counts, 1e-9) << i;
    EXPECT_LE(std::abs(axis.state.counts * axis.state.um_per_count - axis.state.offset_um),
              0.5 * axis.state.um_per_count + 1e-9);
    n_moved += axis.state.offset_um != before_um;
    before_um = axis.state.offset_um;
    counts_before = axis.state.counts;
  }
  EXPECT_GT(n_moved, 2000);
}

}  // namespace
}  // namespace driftwright::axis_offset_test
