// Ticks: round, between the ends, enough and not too many, whatever the range; labels say what the ticks are.

#include "output/axis_ticks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "output/plot_axis.hpp"
#include "tests/output/svg_reading.hpp"

namespace driftwright::output::axis_ticks_test {
namespace {

using ::testing::ElementsAre;

struct Axis {
  double low = 0.0, high = 0.0, preferred = 0.0;
};

/// Ranges from a seed: around zero, far from it on either side, and tiny on a large offset, from 1e-250 to 1e290.
std::vector<Axis> drawn_axes(int n) {
  std::mt19937 random(20261129);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<Axis> axes;
  for (int i = 0; i < n; ++i) {
    const bool is_usual = i % 3 != 0;
    const double span = std::pow(10.0, is_usual ? -4.0 + 10.0 * share(random) : -250.0 + 530.0 * share(random));
    const double offset = i % 4 == 0   ? -share(random) * span                        // zero is inside
                          : i % 4 == 1 ? span * std::pow(10.0, 11.0 * share(random))  // up to 1e11 spans away
                          : i % 4 == 2 ? -span * std::pow(10.0, 11.0 * share(random))
                                       : std::round(10.0 * share(random)) * span;  // ends that are nearly ticks
    axes.push_back({offset, offset + span, 3.0 + 6.0 * share(random)});
  }
  return axes;
}

/// How far a number is from a multiple of a step, in steps.
double off_multiple(double value, double step) {
  return std::abs(value / step - std::round(value / step));
}

TEST(AxisTicks, AreFourToNineRoundNumbersThatReachBothEnds) {
  for (const Axis& axis : drawn_axes(30000)) {
    const AxisTicks ticks = axis_ticks(axis.low, axis.high, axis.preferred);
    SCOPED_TRACE(::testing::Message() << axis.low << " to " << axis.high << ", step " << ticks.step);
    ASSERT_GE(ticks.values.size(), 4u);
    ASSERT_LE(ticks.values.size(), 9u);
    const double mantissa = ticks.step / std::pow(10.0, std::floor(std::log10(ticks.step) + 1e-9));
    ASSERT_LT(std::min({std::abs(mantissa - 1), std::abs(mantissa - 2), std::abs(mantissa - 2.5), std::abs(mantissa - 5)}),
              1e-9);
    // Round-off of the ends alone: 1e-16 of a number that is up to 1e12 steps large.
    constexpr double kRoundOff = 1e-3;
    for (std::size_t i = 0; i < ticks.values.size(); ++i) {
      ASSERT_LT(off_multiple(ticks.values[i], ticks.step), kRoundOff);
      const double from_last = i > 0 ? ticks.values[i] - ticks.values[i - 1] : ticks.step;
      ASSERT_NEAR(from_last / ticks.step, 1.0, kRoundOff);
    }
    ASSERT_GE(ticks.values.front(), axis.low - kRoundOff * ticks.step);
    ASSERT_LE(ticks.values.back(), axis.high + kRoundOff * ticks.step);
    ASSERT_LT(ticks.values.front() - axis.low, (1.0 + kRoundOff) * ticks.step);
    ASSERT_LT(axis.high - ticks.values.back(), (1.0 + kRoundOff) * ticks.step);
  }
}

TEST(AxisTicks, LabelsSayTheirTicks) {
  for (const Axis& axis : drawn_axes(30000)) {
    const AxisTicks ticks = axis_ticks(axis.low, axis.high, axis.preferred);
    ASSERT_EQ(ticks.labels.size(), ticks.values.size());
    for (std::size_t i = 0; i < ticks.values.size(); ++i)
      ASSERT_NEAR((number_of(ticks.labels[i]) - ticks.values[i]) / ticks.step, 0.0, 1e-3) << ticks.labels[i];
  }
}

TEST(AxisTicks, NumberIsTheOneNearestToThePreferred) {
  EXPECT_THAT(axis_ticks(0, 100, 6).values, ElementsAre(0, 20, 40, 60, 80, 100));
  EXPECT_THAT(axis_ticks(105, 543, 5).values, ElementsAre(200, 300, 400, 500));  // Heckbert's example: a step of 100
  EXPECT_THAT(axis_ticks(105, 543, 8).values, ElementsAre(150, 200, 250, 300, 350, 400, 450, 500));
}

TEST(AxisTicks, QuartersFillTheJumpBetweenTwoAndFive) {
  // Three multiples of 5 lie in it, and ten of 2.
  EXPECT_THAT(axis_ticks(5.5, 24.5, 5).values, ElementsAre(7.5, 10, 12.5, 15, 17.5, 20, 22.5));
}

TEST(AxisTicks, OfTimesAreThoseOfAClock) {
  EXPECT_THAT(axis_ticks(0, 250, 8, TickSteps::kMinutes).labels,
              ElementsAre("0", "30", "60", "90", "120", "150", "180", "210", "240"));
  EXPECT_THAT(axis_ticks(0, 300, 6, TickSteps::kMinutes).labels, ElementsAre("0", "60", "120", "180", "240", "300"));
  EXPECT_THAT(axis_ticks(0, 100, 6, TickSteps::kMinutes).labels, ElementsAre("0", "15", "30", "45", "60", "75", "90"));
  EXPECT_THAT(axis_ticks(0, 2.5, 6, TickSteps::kMinutes).labels, ElementsAre("0.0", "0.5", "1.0", "1.5", "2.0", "2.5"));
  EXPECT_THAT(axis_ticks(0, 24, 8, TickSteps::kHours).labels, ElementsAre("0", "3", "6", "9", "12", "15", "18", "21", "24"));
  EXPECT_THAT(axis_ticks(0, 1.5, 8, TickSteps::kHours).labels,
              ElementsAre("0.00", "0.25", "0.50", "0.75", "1.00", "1.25", "1.50"));
  EXPECT_THAT(axis_ticks(0, 168, 8, TickSteps::kHours).labels,
              ElementsAre("0", "24", "48", "72", "96", "120", "144", "168"));
}

TEST(AxisTicks, OfTimesAreFourToNineWhateverTheRange) {
  for (const Axis& axis : drawn_axes(3000)) {
    for (TickSteps steps : {TickSteps::kMinutes, TickSteps::kHours}) {
      const AxisTicks ticks = axis_ticks(axis.low, axis.high, axis.preferred, steps);
      ASSERT_GE(ticks.values.size(), 4u) << axis.low << " to " << axis.high;
      ASSERT_LE(ticks.values.size(), 9u) << axis.low << " to " << axis.high;
    }
  }
}

TEST(AxisTicks, LabelsHaveTheDecimalsOfTheStepOrAnExponentWhenTheyAreLong) {
  EXPECT_THAT(axis_ticks(-1, 1, 5).labels, ElementsAre("−1.0", "−0.5", "0.0", "0.5", "1.0"));
  EXPECT_THAT(axis_ticks(0, 4000, 4).labels, ElementsAre("0", "1000", "2000", "3000", "4000"));
  EXPECT_THAT(axis_ticks(0, 4e9, 4).labels, ElementsAre("0", "1e9", "2e9", "3e9", "4e9"));
  EXPECT_THAT(axis_ticks(-1e-7, 2e-7, 6).labels, ElementsAre("−1e−7", "−5e−8", "0", "5e−8", "1e−7", "1.5e−7", "2e−7"));
  EXPECT_THAT(axis_ticks(1000000.0001, 1000000.0005, 5).labels,
              ElementsAre("1000000.0001", "1000000.0002", "1000000.0003", "1000000.0004", "1000000.0005"));
}

TEST(AxisTicks, RefusesARangeWithoutRoomForTicks) {
  for (const auto& [low, high] : std::vector<std::pair<double, double>>{
           {1, 1}, {2, 1}, {1, 1 + 1e-14}, {0, 1e-300}, {NAN, 1}, {0, NAN}, {0, INFINITY}, {-1e308, 1e308}})
    EXPECT_THROW((void)axis_ticks(low, high, 5), std::logic_error) << low << " to " << high;
}

ValueRange range_of(const std::vector<double>& values) {
  ValueRange range;
  for (double v : values) range.include(v);
  return range;
}

TEST(ShownRange, OfConstantsIsNeverEmptyAndAlwaysHasTicks) {
  struct Case {
    std::vector<double> values;
    double low, high;
  };
  for (const Case& c : std::vector<Case>{{{}, 0, 1},
                                         {{0, 0}, -1, 1},
                                         {{1e-290, 0}, -1, 1},
                                         {{20, 20 + 1e-13}, 19, 21},
                                         {{-20}, -21, -19},
                                         {{1e300}, 0.95e300, 1.05e300},
                                         {{1e-279}, 0.95e-279, 1.05e-279},
                                         {{0, 10}, -1, 11},
                                         {{-1e300, 1e300}, -1.2e300, 1.2e300}}) {
    const ValueRange shown = shown_range(range_of(c.values), 0.1, 1e-6);
    const double slack = 1e-9 * (c.high - c.low);
    EXPECT_NEAR(shown.low, c.low, slack);
    EXPECT_NEAR(shown.high, c.high, slack);
    EXPECT_GE(axis_ticks(shown.low, shown.high, 5).values.size(), 4u);
  }
}

TEST(ShownRange, KeepsDifferencesFromTheLeastOneOn) {
  EXPECT_NEAR(shown_range(range_of({1e6, 1e6 + 2}), 0.0, 1e-6).high, 1e6 + 2, 1e-9);
  EXPECT_NEAR(shown_range(range_of({1e6, 1e6 + 0.5}), 0.0, 1e-6).high, 1.05e6, 1.0);
  EXPECT_NEAR(shown_range(range_of({1e6, 1e6 + 0.5}), 0.0, 1e-12).high, 1e6 + 0.5, 1e-9);
}

}  // namespace
}  // namespace driftwright::output::axis_ticks_test
