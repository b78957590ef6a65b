// The policies of correction schedules: the paper's example, and the fewest changes against all plans there are.

#include "compensation/schedule/schedule_policy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <random>

#include "base/errors.hpp"
#include "compensation/sensors/interpolate.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::compensation::schedule_policy_test {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

std::vector<double> minutes(std::vector<double> t_min) {
  for (double& t : t_min) t *= 60.0;
  return t_min;
}

/// Multiples of `step_s` from 0 to the end.
std::vector<double> grid(double step_s, double end_s) {
  std::vector<double> times_s;
  for (int i = 0; i * step_s <= end_s; ++i) times_s.push_back(i * step_s);
  return times_s;
}

int count_changes(const std::vector<double>& correction_um) {
  int n = 0;
  double before = 0.0;
  for (double c : correction_um) {
    n += static_cast<int>(c != before);
    before = c;
  }
  return n;
}

// Polyakov et al.: tolerance 10 um, five operations of 60 min. The drift is made to pass 10, 20, 30, 40 um at 18, 45, 75,
// 115 min and 50 um never; the text is the paper's, and what is left stays in [0, 10] um.
TEST(PaperPolicy, YieldsThePapersExample) {
  const std::vector<double> t_s = minutes({0, 18, 45, 75, 115, 300}), d_um = {0, 10, 20, 30, 40, 49};
  const std::vector<DriftCell> cells = drift_cells(t_s, d_um, grid(60.0, 300 * 60.0));
  const std::vector<double> c_um = steps_of_tolerance(cells, 10.0);
  const Schedule s = schedule_of(cells, c_um, minutes({0, 60, 120, 180, 240, 300}), 10.0);
  EXPECT_EQ(to_text(s), "3-{18,27,15}-{0,10,10}\n3-{15,40,5}-{0,10,10}\n1-{60}-{0}\n1-{60}-{0}\n1-{60}-{0}\n");
  EXPECT_EQ(c_um.back(), 40.0);  // the increments add up to it
  for (std::size_t k = 0; k < cells.size(); ++k) {
    EXPECT_GE(cells[k].low_um - c_um[k], -1e-9) << k;
    EXPECT_LE(cells[k].high_um - c_um[k], 10.0 + 1e-9) << k;
  }
}

// From 2 to 26 um in one cell, with a step of 3: no multiple serves, 15 misses by the least (14 is the middle). The rule
// serves cells of 2 and 4.5 um.
TEST(PaperPolicy, TakesTheMiddleOfACellTooLongForOneMultiple) {
  const std::vector<DriftCell> cells = {{0, 1, 0, 2}, {1, 2, 2, 26}, {2, 3, 26, 28}, {3, 4, 28, 32.5}, {4, 5, -26, -2}};
  EXPECT_EQ(steps_of_tolerance(cells, 3.0), (std::vector<double>{0, 15, 27, 30, -15}));
}

// Up to 25 um and back to -25: forward at 10 and 20, back when it passes them downward, the mirror image below zero.
TEST(PaperPolicy, StepsBackAtTheSameMultiplesAndMirrorsNegativeDrift) {
  const std::vector<double> t_s = {0, 250, 750, 1000}, d_um = {0, 25, -25, 0};
  const std::vector<DriftCell> cells = drift_cells(t_s, d_um, grid(10.0, 1000.0));
  const std::vector<double> c_um = steps_of_tolerance(cells, 10.0);
  const auto at = [&](double t) { return c_um[static_cast<std::size_t>(t / 10.0)]; };
  EXPECT_EQ(at(90), 0.0);
  EXPECT_EQ(at(100), 10.0);
  EXPECT_EQ(at(200), 20.0);
  EXPECT_EQ(at(290), 20.0);  // 21 um at its start, passes 20 within
  EXPECT_EQ(at(300), 10.0);
  EXPECT_EQ(at(400), 0.0);
  EXPECT_EQ(at(600), -10.0);
  EXPECT_EQ(at(700), -20.0);
  EXPECT_EQ(at(990), 0.0);
  std::vector<DriftCell> mirrored = cells;
  for (DriftCell& cell : mirrored) {
    std::swap(cell.low_um, cell.high_um);
    cell.low_um *= -1.0;
    cell.high_um *= -1.0;
  }
  const std::vector<double> other = steps_of_tolerance(mirrored, 10.0);
  for (std::size_t k = 0; k < cells.size(); ++k) EXPECT_EQ(other[k], -c_um[k]) << k;
}

// Property: for a smooth drift of either sign and cells in which it moves by 0.4 um at most, what is left is on the
// drift's own side of zero but for that much, and never above the step.
TEST(PaperPolicy, LeavesBetweenZeroAndOneStepOfASmoothDrift) {
  std::vector<double> t_s, d_um;
  for (int i = 0; i <= 1000; ++i) {
    t_s.push_back(i);
    d_um.push_back(55.0 * std::sin(i / 150.0) + 0.02 * i);
  }
  const std::vector<DriftCell> cells = drift_cells(t_s, d_um, t_s);
  const std::vector<double> c_um = steps_of_tolerance(cells, 7.0);
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const double side = d_um[k] < 0.0 ? -1.0 : 1.0;
    for (double d : {cells[k].low_um, cells[k].high_um}) {
      EXPECT_GE(side * (d - c_um[k]), -0.4) << k;
      EXPECT_LE(side * (d - c_um[k]), 7.0 + 1e-9) << k;
    }
  }
  EXPECT_GT(count_changes(c_um), 10);
}

// 1 um per cell passes 10 um at the start of cell 10: a cheaper place one cell earlier costs 1 um of 10 and is taken, one
// two cells earlier would cost 2 and is not. On the way back from 19, 10 is passed at the start of cell 28: a place one
// later is taken.
TEST(PaperPolicy, PrefersACheaperPlaceWithinATenthOfTheStep) {
  const std::vector<double> t_s = {0, 19, 38}, d_um = {0, 19, 0};
  const std::vector<DriftCell> cells = drift_cells(t_s, d_um, grid(1.0, 38.0));
  const auto first_and_last = [&](std::initializer_list<std::size_t> cheap) {
    std::vector<int> cost(cells.size(), 4);
    for (std::size_t k : cheap) cost[k] = 0;
    const std::vector<double> c_um = steps_of_tolerance(cells, 10.0, cost);
    const auto first = std::find(c_um.begin(), c_um.end(), 10.0);
    return std::pair{first - c_um.begin(), std::count(c_um.begin(), c_um.end(), 10.0) + (first - c_um.begin())};
  };
  EXPECT_EQ(first_and_last({}), (std::pair<long, long>{10, 28}));
  EXPECT_EQ(first_and_last({9, 29}), (std::pair<long, long>{9, 29}));
  EXPECT_EQ(first_and_last({8, 30}), (std::pair<long, long>{10, 28}));
}

struct Bruteforce {
  int n_changes = 1000;
  long cost = 0;
};

/// All plans there are: each subset of the cells begins a new correction. A piece exists where one value serves all its
/// cells; the cells before the first change have none.
Bruteforce all_plans(const std::vector<DriftCell>& cells, double tolerance_um, double resolution_um,
                     const std::vector<int>& cost) {
  const auto serves = [&](std::size_t from, std::size_t to) {
    double low = -1e300, high = 1e300;
    for (std::size_t k = from; k < to; ++k) {
      low = std::max(low, cells[k].high_um - tolerance_um);
      high = std::min(high, cells[k].low_um + tolerance_um);
    }
    if (resolution_um > 0.0) return std::ceil(low / resolution_um) * resolution_um <= high;
    return low <= high;
  };
  const auto zero_serves = [&](std::size_t to) {
    return std::all_of(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(to),
                       [&](const DriftCell& c) { return c.high_um <= tolerance_um && c.low_um >= -tolerance_um; });
  };
  Bruteforce best;
  for (unsigned mask = 0; mask < (1u << cells.size()); ++mask) {
    std::vector<std::size_t> starts;
    long sum = 0;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if ((mask >> k & 1u) == 0) continue;
      starts.push_back(k);
      sum += cost[k];
    }
    bool fine = zero_serves(starts.empty() ? cells.size() : starts[0]);
    for (std::size_t i = 0; fine && i < starts.size(); ++i)
      fine = serves(starts[i], i + 1 < starts.size() ? starts[i + 1] : cells.size());
    const int n = std::popcount(mask);
    if (fine && (n < best.n_changes || (n == best.n_changes && sum < best.cost))) best = {n, sum};
  }
  return best;
}

/// A random walk seen at random permitted times; no cell moves by more than twice the tolerance.
std::vector<DriftCell> random_cells(std::mt19937& random, std::size_t n_cells, double tolerance_um, double start_um) {
  std::uniform_real_distribution<double> length(0.2, 3.0), step(-0.8, 0.8);
  std::vector<double> t_s = {0.0}, d_um = {start_um}, permitted_s = {0.0};
  while (permitted_s.size() <= n_cells) {
    const double until_s = permitted_s.back() + length(random);
    permitted_s.push_back(until_s);
    while (t_s.back() < until_s) {
      t_s.push_back(t_s.back() + 0.7);
      d_um.push_back(d_um.back() + step(random) * tolerance_um * 0.8);
    }
  }
  return drift_cells(t_s, d_um, permitted_s);
}

TEST(MinimalPolicy, NeedsNoMoreChangesNorDearerOnesThanAnyPlanThereIs) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> dear(0, 4);
  std::uniform_real_distribution<double> start(-14.0, 14.0);
  int most = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const double tolerance_um = 5.0, resolution_um = trial % 2 == 0 ? 0.0 : 0.7;
    const std::vector<DriftCell> cells = random_cells(random, 11, tolerance_um, trial % 3 == 0 ? start(random) : 0.0);
    std::vector<int> cost;
    for (std::size_t k = 0; k < cells.size(); ++k) cost.push_back(dear(random));
    const bool keeps = std::all_of(cells.begin(), cells.end(), [&](const DriftCell& c) {
      return resolution_um > 0.0
                 ? std::ceil((c.high_um - tolerance_um) / resolution_um) * resolution_um <= c.low_um + tolerance_um
                 : c.high_um - c.low_um <= 2.0 * tolerance_um;
    });
    if (!keeps) continue;
    const std::vector<double> c_um = fewest_changes(cells, tolerance_um, resolution_um, cost);
    long spent = 0;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      EXPECT_LE(cells[k].high_um - c_um[k], tolerance_um + 1e-9) << trial;
      EXPECT_GE(cells[k].low_um - c_um[k], -tolerance_um - 1e-9) << trial;
      if (c_um[k] != (k == 0 ? 0.0 : c_um[k - 1])) spent += cost[k];
    }
    const Bruteforce best = all_plans(cells, tolerance_um, resolution_um, cost);
    EXPECT_EQ(count_changes(c_um), best.n_changes) << trial;
    EXPECT_EQ(spent, best.cost) << trial;
    most = std::max(most, best.n_changes);
  }
  EXPECT_GE(most, 4);  // the curves ask for something
}

// The same against dynamic programming over 300 cells: f(j), the fewest pieces that cover the first j cells.
TEST(MinimalPolicy, EqualsDynamicProgrammingOnLongCurves) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 20; ++trial) {
    const double tolerance_um = 3.0;
    std::vector<DriftCell> cells = random_cells(random, 300, tolerance_um, 0.0);
    for (DriftCell& cell : cells) cell.high_um = std::min(cell.high_um, cell.low_um + 2.0 * tolerance_um);
    std::vector<int> fewest(cells.size() + 1, 1000000);
    for (std::size_t from = 0; from < cells.size(); ++from) {
      double low = -1e300, high = 1e300;
      bool zero = from == 0;
      for (std::size_t to = from; to < cells.size(); ++to) {
        low = std::max(low, cells[to].high_um - tolerance_um);
        high = std::min(high, cells[to].low_um + tolerance_um);
        if (low > high + 1e-9) break;
        zero = zero && low <= 0.0 && high >= 0.0;
        const int before = from == 0 ? 0 : fewest[from];
        fewest[to + 1] = std::min(fewest[to + 1], before + static_cast<int>(!zero));
      }
    }
    EXPECT_EQ(count_changes(fewest_changes(cells, tolerance_um)), fewest.back()) << trial;
  }
}

// A ramp of 35 um: nothing until 10, then pieces of 20 um each in their middle. The paper's policy needs 3 changes.
TEST(MinimalPolicy, HoldsTheMiddleOfTwiceTheTolerance) {
  const std::vector<DriftCell> cells =
      drift_cells(std::vector<double>{0, 350}, std::vector<double>{0, 35}, grid(1.0, 350.0));
  const std::vector<double> c_um = fewest_changes(cells, 10.0);
  EXPECT_EQ(count_changes(c_um), 2);
  EXPECT_EQ(c_um[99], 0.0);
  EXPECT_NEAR(c_um[100], 20.0, 1e-6);  // 10 to 30 um
  EXPECT_NEAR(c_um[300], 32.5, 1e-6);  // 30 to 35 um
  EXPECT_EQ(count_changes(steps_of_tolerance(cells, 10.0)), 3);
}

// A cell of 30 um admits its middle alone: off by 15 um, the least there is; its neighbours are not drawn into it.
TEST(MinimalPolicy, TakesTheMiddleWhereNothingServes) {
  const std::vector<DriftCell> cells = {{0, 1, 0, 5}, {1, 2, 5, 35}, {2, 3, 35, 40}};
  EXPECT_THAT(fewest_changes(cells, 10.0), ElementsAre(0.0, 20.0, 37.5));
  EXPECT_THAT(fewest_changes(std::vector<DriftCell>{{0, 1, -9, 9}, {1, 2, 0, 10}}, 10.0), Each(0.0));
  EXPECT_THAT(fewest_changes({}, 10.0), ElementsAre());
}

TEST(DriftCells, HoldTheExtremesOfSamplesAndEnds) {
  const std::vector<double> t_s = {0, 1, 2, 4}, d_um = {0, 6, -2, 2};
  const std::vector<DriftCell> cells = drift_cells(t_s, d_um, std::vector<double>{0, 1.5, 1.75, 4});
  ASSERT_EQ(cells.size(), 3u);
  EXPECT_EQ(cells[0].low_um, 0.0);
  EXPECT_EQ(cells[0].high_um, 6.0);  // the sample inside
  EXPECT_EQ(cells[1].low_um, 0.0);   // 6 - 8 (0.75)
  EXPECT_EQ(cells[1].high_um, 2.0);
  EXPECT_EQ(cells[2].low_um, -2.0);
  EXPECT_EQ(cells[2].high_um, 2.0);
}

// A change in the middle of an operation and one at the start of another, by hand.
TEST(ScheduleOf, CutsThePlanAtTheBoundariesOfOperations) {
  const std::vector<DriftCell> cells = {{0, 60, 0, 1}, {60, 120, 1, 2}, {120, 180, 2, 3}, {180, 240, 3, 4}};
  const std::vector<double> c_um = {0, 2.5, 2.5, -1};
  EXPECT_EQ(to_text(schedule_of(cells, c_um, std::vector<double>{0, 90, 180, 240}, 5.0)),
            "2-{1,0.5}-{0,2.5}\n1-{1.5}-{0}\n1-{1}-{-3.5}\n");
}

TEST(SchedulePolicies, RefuseATolerancesThatIsNotPositiveAndADriftWithoutValue) {
  const std::vector<DriftCell> cells = {{0, 1, 0, 5}};
  EXPECT_THROW((void)steps_of_tolerance(cells, 0.0), RangeError);
  EXPECT_THROW((void)fewest_changes(cells, NAN), RangeError);
  EXPECT_REFUSED(drift_cells(std::vector<double>{0, 1}, std::vector<double>{0, NAN}, std::vector<double>{0, 1}),
                 "no value at 1 s");
}

TEST(HoldWithin, KeepsTheCorrectionBeforeUntilAPlannedOneIsWithinTheLimits) {
  std::vector<double> c_um = {0, 8, 20, 30, 9, -2, 5};
  const std::vector<HeldCell> held = hold_within(c_um, {.most_um = 15.0, .most_step_um = 10.0});
  EXPECT_EQ(c_um, (std::vector<double>{0, 8, 8, 8, 9, 9, 5}));
  ASSERT_EQ(held.size(), 3u);
  EXPECT_EQ(held[0].cell, 2u);
  EXPECT_FALSE(held[0].is_step);
  EXPECT_EQ(held[1].planned_um, 30.0);
  EXPECT_EQ(held[2].cell, 5u);
  EXPECT_TRUE(held[2].is_step);  // from 9 to -2
  EXPECT_EQ(held[2].held_um, 9.0);
  std::vector<double> warm_um = {14, 14};  // before the program nothing cuts: the value alone is limited
  EXPECT_TRUE(hold_within(warm_um, {.most_um = 15.0, .most_step_um = 1.0}).empty());
  std::vector<double> hot_um = {16};
  EXPECT_EQ(hold_within(hot_um, {.most_um = 15.0}).size(), 1u);
  EXPECT_EQ(hot_um[0], 0.0);
}

}  // namespace
}  // namespace driftwright::compensation::schedule_policy_test
