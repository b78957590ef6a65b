#include "compensation/injector/timed_injector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "base/errors.hpp"
#include "base/random.hpp"
#include "compensation/injector/encoder.hpp"

namespace driftwright::compensation::timed_injector_test {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::IsEmpty;

constexpr Lines k00 = 0, k10 = kLineA, k11 = kLineA | kLineB, k01 = kLineB;

std::vector<Edge> feed(TimedInjector& injector, const std::vector<Edge>& edges, std::int64_t until) {
  std::vector<Edge> out;
  for (const Edge& edge : edges) injector.input(edge, out);
  injector.advance(until, out);
  return out;
}

/// Edges at constant speed from 00 on.
std::vector<Edge> steady(int n_quarters, std::int64_t interval) {
  std::vector<Edge> edges = {{0, k00}};
  int i = 0;
  for (Lines row : motion_rows(k00, n_quarters)) edges.push_back({++i * interval, row});
  return edges;
}

/// A control that looks whether edges keep their distance.
struct Control {
  QuadratureCounter counter;
  Edge last;
  std::int64_t least_separation = kNever;

  explicit Control(const Edge& first) : counter(first.lines), last(first) {}
  void take(const std::vector<Edge>& edges) {
    for (const Edge& edge : edges) {
      if (((edge.lines ^ last.lines) & kLinesAB) == 0) continue;
      least_separation = std::min(least_separation, edge.t - last.t);
      counter.step(edge.lines);
      last = edge;
    }
  }
};

TEST(TimedInjector, IsTheIdentityWithNothingToInsert) {
  std::vector<Edge> edges = steady(40, 10);
  edges[8].lines |= kLineIndex;
  TimedInjector injector({.separation = 10});
  EXPECT_THAT(feed(injector, edges, 10000), ElementsAreArray(edges));
}

// At rest at 00: after the time that an insertion takes without an edge it begins; its four edges keep the separation.
TEST(TimedInjector, InsertsAtStandstillWhereBothAreLow) {
  TimedInjector injector({.separation = 10});
  std::vector<Edge> out = feed(injector, {{0, k00}}, 0);
  injector.set_target(100, 4, out);
  injector.advance(1000, out);
  EXPECT_THAT(out, ElementsAre(Edge{0, k00}, Edge{100, k10}, Edge{110, k11}, Edge{120, k01}, Edge{130, k00}));
}

TEST(TimedInjector, WaitsAtStandstillElsewhere) {
  TimedInjector injector({.separation = 10});
  std::vector<Edge> out;
  injector.set_target(0, 4, out);
  out = feed(injector, {{0, k10}}, 1000000);
  EXPECT_THAT(out, ElementsAre(Edge{0, k10}));
  EXPECT_EQ(injector.next_event(), kNever);
  TimedInjector anywhere({.rules = {.anywhere = true}, .separation = 10});
  out.clear();
  anywhere.set_target(0, -4, out);
  out = feed(anywhere, {{0, k10}}, 1000);
  EXPECT_THAT(out, ElementsAre(Edge{0, k10}, Edge{50, k00}, Edge{60, k01}, Edge{70, k11}, Edge{80, k10}));
}

// Room is (4 + 1) separations: at an interval of 50 a cycle fits between two edges, at 49 none does.
TEST(TimedInjector, InsertsBetweenEdgesAsLongAsThereIsRoom) {
  for (auto [interval, n] : {std::pair{50, 10}, {49, 0}}) {
    TimedInjector injector({.separation = 10});
    std::vector<Edge> out;
    injector.set_target(-1, 40, out);
    const std::vector<Edge> edges = steady(44, interval);
    Control control(edges.front());
    control.take(feed(injector, edges, 44 * interval));
    EXPECT_EQ(injector.n_insertions(), n) << interval;
    EXPECT_GE(control.least_separation, 10);
    EXPECT_EQ(control.counter.count(), 44 + 4 * n);
    EXPECT_EQ(injector.longest_wait(), 0);  // no edge of the encoder had to wait
  }
}

TEST(TimedInjector, QuartersFindRoomAtHigherSpeed) {
  EXPECT_DOUBLE_EQ(largest_feed_um_s(1.0, 4, 1e-6), 1e6 / 5.0);
  EXPECT_DOUBLE_EQ(largest_feed_um_s(1.0, 1, 1e-6), 1e6 / 2.0);
  TimedInjector injector({.rules = {.quarters = 1}, .separation = 10});
  std::vector<Edge> out;
  injector.set_target(-1, 5, out);
  (void)feed(injector, steady(44, 20), 44 * 20);
  EXPECT_EQ(injector.n_insertions(), 5);
}

// The rate at which a correction comes in, against the injector itself: 4000 quarters at steady speed, more requested
// than fits.
TEST(TimedInjector, InsertionRateIsThatOfTheFormula) {
  for (int quarters : {4, 2, 1}) {
    for (std::int64_t interval : {19, 20, 35, 50, 51, 90, 130, 400}) {
      TimedInjector injector({.rules = {.quarters = quarters}, .separation = 10, .insertion_interval = 10 * quarters});
      std::vector<Edge> out;
      injector.set_target(-1, 1000000, out);
      out = feed(injector, steady(4000, interval), 4000 * interval - 1);
      const double rate = static_cast<double>(injector.inserted()) / (4000.0 * static_cast<double>(interval));
      // unit of time 1 s, quarter 1 um; the edges at both ends make up to one window of 1000 more or less
      EXPECT_NEAR(rate, insertion_rate_um_s(1.0 / static_cast<double>(interval), 1.0, quarters, 10.0, 1e9),
                  2e-3 * (rate + 1e-9))
          << quarters << " " << interval;
    }
  }
}

TEST(TimedInjector, KeepsTheSlew) {
  TimedInjector injector({.separation = 10, .insertion_interval = 1000});
  std::vector<Edge> out;
  injector.set_target(-1, 400, out);
  (void)feed(injector, {{0, k00}}, 10500);
  EXPECT_EQ(injector.n_insertions(), 11);  // at 50, 1050, ... 10050
}

// The encoder turns back in the middle of an insertion: the cycle is completed, and then the step back follows.
TEST(TimedInjector, CompletesTheCycleWhenTheEncoderMovesMeanwhile) {
  TimedInjector injector({.separation = 10});
  std::vector<Edge> out = feed(injector, {{0, k00}}, 0);
  injector.set_target(100, 4, out);
  out.clear();
  out = feed(injector, {{115, k01}}, 1000);
  EXPECT_THAT(out, ElementsAre(Edge{100, k10}, Edge{110, k11}, Edge{120, k01}, Edge{130, k00}, Edge{140, k01}));
  EXPECT_EQ(injector.longest_wait(), 25);
}

TEST(TimedInjector, StepsThatWaitAreTakenBackByAReversal) {
  TimedInjector injector({.separation = 10});
  std::vector<Edge> out = feed(injector, {{0, k00}}, 0);
  injector.set_target(100, 4, out);
  out = feed(injector, {{115, k10}, {125, k00}}, 1000);
  EXPECT_THAT(out, ElementsAre(Edge{100, k10}, Edge{110, k11}, Edge{120, k01}, Edge{130, k00}));
  EXPECT_EQ(injector.waiting(), 0);
}

// Ten times faster than the control can count: the output follows as fast as it may, loses nothing, and nothing is inserted.
TEST(TimedInjector, AboveTheControlsLimitTheCorrectionWaitsAndNoCountIsLost) {
  TimedInjector injector({.separation = 100});
  std::vector<Edge> out;
  injector.set_target(-1, 40, out);
  const std::vector<Edge> fast = steady(1000, 10);
  Control control(fast.front());
  control.take(feed(injector, fast, 10 * 1000));
  EXPECT_EQ(injector.n_insertions(), 0);
  EXPECT_EQ(injector.n_too_fast(), 999);
  EXPECT_EQ(control.counter.count() + injector.waiting(), 1000);
  EXPECT_GT(injector.waiting(), 850);
  out.clear();
  injector.advance(200000, out);
  control.take(out);
  EXPECT_EQ(control.counter.count(), 1000 + 40);
  EXPECT_EQ(control.least_separation, 100);
  EXPECT_EQ(control.counter.n_jumps(), 0);
}

TEST(TimedInjector, AGlitchIsToldAndDoesNotCount) {
  TimedInjector injector({.separation = 100});
  const std::vector<Edge> out = feed(injector, {{0, k00}, {1000, k10}, {2000, k11}, {2003, k10}, {3000, k11}}, 5000);
  EXPECT_EQ(injector.n_glitches(), 1);
  EXPECT_EQ(injector.encoder().count(), 2);
  EXPECT_EQ(out.back().lines, k11);
}

TEST(TimedInjector, ALostEdgeIsMadeUpForWithTheSeparation) {
  TimedInjector injector({.separation = 10});
  std::vector<Edge> edges = steady(12, 100);
  edges.erase(edges.begin() + 6);
  Control control(edges.front());
  control.take(feed(injector, edges, 5000));
  EXPECT_EQ(control.counter.count(), 12);
  EXPECT_EQ(control.counter.n_jumps(), 0);
  EXPECT_EQ(control.least_separation, 10);
  EXPECT_EQ(injector.encoder().n_jumps(), 1);
}

TEST(TimedInjector, FrozenItInsertsNoMoreAndKeepsWhatIsIn) {
  TimedInjector injector({.separation = 10});
  std::vector<Edge> out = feed(injector, {{0, k00}}, 0);
  injector.set_target(0, 4, out);
  injector.advance(1000, out);
  injector.freeze();
  injector.set_target(1000, 0, out);
  injector.advance(100000, out);
  EXPECT_EQ(injector.inserted(), 4);
}

TEST(TimedInjector, BypassIsAWireWithAllItsFaults) {
  Random random(3);
  std::vector<Edge> edges;
  for (int i = 0; i < 10000; ++i) edges.push_back({i * 3, static_cast<Lines>(random.below(8))});
  TimedInjector injector({.rules = {.bypass = true}, .separation = 100});
  std::vector<Edge> out;
  injector.set_target(-1, 400, out);
  EXPECT_EQ(feed(injector, edges, 1000000), edges);
}

TEST(TimedInjector, RefusesLimitsBelowOne) {
  EXPECT_THROW(TimedInjector({.separation = 0}), RangeError);
  EXPECT_THROW(TimedInjector({.insertion_interval = 0}), RangeError);
  EXPECT_THROW(TimedInjector({.rules = {.quarters = 3}}), RangeError);
}

/// One random case: speeds over four decades, jitter, reversals, rests, faults now and then, targets, limits.
void check_motion(std::uint64_t seed) {
  Random random(seed);
  InsertionLimits limits{.rules = {.quarters = 1 << random.below(3), .anywhere = random.chance(0.3)},
                         .separation = 1 + random.below(50),
                         .insertion_interval = 1 + random.below(1000)};
  const bool faulty = random.chance(0.3);
  TimedInjector injector(limits);
  EncoderEdges encoder({.period_um = 4.0, .periods_per_index = 3, .jitter = random.uniform(0.0, 0.49), .seed = seed},
                       random.uniform(-5.0, 5.0));
  std::vector<Edge> out;
  injector.input({0, encoder.lines()}, out);
  Control control(out.front());
  out.clear();
  const std::int64_t start = encoder.phase();
  std::int64_t t = 0;
  double x_um = 0.0;
  std::vector<Edge> edges;
  std::vector<std::int64_t> begins;  // of insertions, as next_event() had announced them
  for (int leg = 0; leg < 8; ++leg) {
    if (random.chance(0.6)) injector.set_target(t, random.below(81) - 40, out);
    const std::int64_t to_t = t + 1 + static_cast<std::int64_t>(random.log_uniform(1.0, 5000.0));
    if (random.chance(0.8)) x_um += random.sign() * random.log_uniform(0.1, 40.0);
    edges.clear();
    encoder.move(t, to_t, x_um, edges);
    for (Edge edge : edges) {
      if (faulty && random.chance(0.05)) edge.lines = static_cast<Lines>(random.below(8));
      const std::int64_t before = injector.n_insertions();
      const bool was_low = (injector.encoder().lines() & kLinesAB) == 0;
      injector.input(edge, out);
      // an insertion that began before this edge did so on the lines that were
      if (injector.n_insertions() > before) {
        ASSERT_TRUE(was_low || limits.rules.anywhere) << "seed " << seed;
      }
      control.take(out);
      out.clear();
      ASSERT_EQ(control.counter.count(), injector.encoder().count() + injector.inserted() - injector.waiting())
          << "seed " << seed;
    }
    const std::int64_t before = injector.n_insertions();
    injector.advance(to_t, out);
    if (injector.n_insertions() > before) {
      ASSERT_TRUE((injector.encoder().lines() & kLinesAB) == 0 || limits.rules.anywhere) << "seed " << seed;
    }
    t = to_t;
  }
  injector.advance(t + 1000000, out);
  control.take(out);
  ASSERT_EQ(control.counter.n_jumps(), 0) << "seed " << seed;
  if (control.least_separation != kNever) {
    ASSERT_GE(control.least_separation, limits.separation) << "seed " << seed;
  }
  ASSERT_EQ(injector.waiting(), 0) << "seed " << seed;
  ASSERT_EQ(control.counter.count(), injector.encoder().count() + injector.inserted()) << "seed " << seed;
  if (!faulty) {
    ASSERT_EQ(injector.encoder().count(), encoder.phase() - start) << "seed " << seed;
    ASSERT_EQ(injector.encoder().n_jumps(), 0);
  }
  ASSERT_EQ(injector.inserted() % limits.rules.quarters, 0);
}

TEST(TimedInjector, KeepsItsPropertiesInRandomMotion) {
  for (std::uint64_t seed = 0; seed < 50000 && !::testing::Test::HasFatalFailure(); ++seed) check_motion(seed);
}

/// Edges and targets of one random case, ended long after the last of them.
struct Errand {
  InsertionLimits limits;
  std::vector<Edge> edges = {{0, k00}};
  std::vector<std::pair<std::int64_t, std::int64_t>> targets = {};  // time, quarters
};

Errand random_errand(std::uint64_t seed) {
  Random random(seed);
  Errand errand{.limits = {.rules = {.quarters = 1 << random.below(3), .anywhere = random.chance(0.3)},
                           .separation = 10,
                           .insertion_interval = 1 + random.below(100)}};
  const bool slower_than_separation = random.chance(0.6);
  std::int64_t t = 0, phase = 0;
  int direction = 1;
  for (int i = 0; i < 60; ++i) {
    if (random.chance(0.15)) direction = -direction;
    t += slower_than_separation ? 10 + random.below(random.chance(0.5) ? 200 : 60) : 1 + random.below(100);
    errand.edges.push_back({t, lines_of_phase(phase += direction)});
  }
  for (int i = 0; i < 6; ++i) {
    const std::int64_t at = random.below(t);
    errand.targets.push_back({at, random.below(81) - 40});
  }
  std::sort(errand.targets.begin(), errand.targets.end());
  return errand;
}

std::vector<Edge> run_errand(const Errand& errand, bool tick_by_tick) {
  TimedInjector injector(errand.limits);
  std::vector<Edge> out;
  std::int64_t now = 0;
  const auto go_to = [&](std::int64_t t) {
    for (; tick_by_tick && now + 1 < t; ++now) injector.advance(now + 1, out);
    now = t;
  };
  std::size_t edge = 0, target = 0;
  while (edge < errand.edges.size() || target < errand.targets.size()) {
    const bool edge_next = target == errand.targets.size() ||
                           (edge < errand.edges.size() && errand.edges[edge].t <= errand.targets[target].first);
    if (edge_next) {
      go_to(errand.edges[edge].t);
      injector.input(errand.edges[edge++], out);
    } else {
      go_to(errand.targets[target].first);
      injector.set_target(now, errand.targets[target].second, out);
      ++target;
    }
  }
  const std::int64_t end = now + 2000;
  go_to(end);
  injector.advance(end, out);
  return out;
}

TEST(TimedInjector, DoesNotDependOnHowOftenItIsAdvanced) {
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    const Errand errand = random_errand(seed);
    ASSERT_EQ(run_errand(errand, false), run_errand(errand, true)) << "seed " << seed;
  }
}

TEST(EncoderEdges, PlacesAndTimesAtConstantSpeed) {
  EncoderEdges encoder({.period_um = 4.0, .periods_per_index = 1}, 0.5);
  std::vector<Edge> edges;
  EXPECT_EQ(encoder.lines(), k00 | kLineIndex);
  encoder.move(0, 1000, 5.5, edges);  // 1, 2, 3, 4, 5 um at 200 ticks per um
  EXPECT_THAT(edges,
              ElementsAre(Edge{100, k10}, Edge{300, k11}, Edge{500, k01}, Edge{700, k00 | kLineIndex}, Edge{900, k10}));
  edges.clear();
  encoder.move(1000, 2000, 0.5, edges);
  EXPECT_THAT(edges, ElementsAre(Edge{1100, k00 | kLineIndex}, Edge{1300, k01}, Edge{1500, k11}, Edge{1700, k10},
                                 Edge{1900, k00 | kLineIndex}));
  edges.clear();
  encoder.move(2000, 3000, 0.5, edges);
  EXPECT_THAT(edges, IsEmpty());
}

TEST(EncoderEdges, JitterMovesEdgesWithinItsBoundsAndNeverTheirOrder) {
  EncoderEdges encoder({.period_um = 4.0, .jitter = 0.3, .seed = 5}, 0.5);
  std::vector<Edge> edges;
  encoder.move(0, 1000000, 1000.5, edges);  // 1000 ticks per um
  ASSERT_EQ(edges.size(), 1000u);
  double worst = 0.0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    EXPECT_EQ(edges[i].lines, lines_of_phase(static_cast<std::int64_t>(i) + 1));
    worst = std::max(worst, std::abs(static_cast<double>(edges[i].t) - (500.0 + 1000.0 * static_cast<double>(i))));
  }
  EXPECT_LE(worst, 301.0);
  EXPECT_GT(worst, 290.0);
  EXPECT_THROW(EncoderEdges({.jitter = 0.5}, 0.0), RangeError);
  EXPECT_THROW(EncoderEdges({.period_um = 0.0}, 0.0), RangeError);
}

TEST(Feedback, AMotorEncoderMissesTheScrewsGrowthAndAScaleItsOwn) {
  const AxisStrain strain{.screw = 100e-6, .scale = 20e-6};
  EXPECT_DOUBLE_EQ(unseen_um(Feedback::kMotor, strain, 500e3), 50.0);
  EXPECT_DOUBLE_EQ(unseen_um(Feedback::kScale, strain, 500e3), 10.0);
}

}  // namespace
}  // namespace driftwright::compensation::timed_injector_test
