// In which stretches of work something acted, in a linear problem whose truth is known: every other one, any of them, all but one; none where there is noise alone.

#include "diagnosis/stretch_choice.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"

namespace driftwright::diagnosis::stretch_choice_test {
namespace {

constexpr int kStretches = 12;
constexpr Eigen::Index kRows = 20;  // of each stretch and of each rest

/// Stretches of work with rests between, of a body that forgets over thirty rows and is read in each row with noise of 1.
struct Works {
  WorkStretches stretches;
  WindowEvidence evidence;
};

Works works(const std::vector<int>& in, double size, std::uint64_t seed) {
  const Eigen::Index n_cells = 2 * kStretches, n_rows = n_cells * kRows;
  Works w;
  w.stretches.edges.resize(1);
  w.stretches.is_work.resize(1);
  w.evidence.runs = {{0, {}, 1.0}};
  for (Eigen::Index c = 0; c <= n_cells; ++c) {
    w.stretches.edges[0].push_back(c * kRows);
    w.evidence.runs[0].edge_s.push_back(static_cast<double>(c * kRows));
    if (c < n_cells) w.stretches.is_work[0].push_back(c % 2 == 0 ? 1 : 0);
  }
  Eigen::MatrixXd s = Eigen::MatrixXd::Zero(n_rows, n_cells);
  for (Eigen::Index c = 0; c < n_cells; ++c) {
    double warm = 0.0;
    for (Eigen::Index row = 0; row < n_rows; ++row) {
      const bool acts = row >= c * kRows && row < (c + 1) * kRows;
      warm += (acts ? 1.0 : 0.0) / 30.0 - warm / 30.0;
      s(row, c) = warm;
    }
  }
  Random random(seed, 0);
  Eigen::VectorXd y(n_rows);
  for (double& v : y) v = random.normal();
  for (int stretch : in) y += size * s.col(2 * stretch);
  w.evidence.slope = s.transpose() * y;
  w.evidence.curvature = s.transpose() * s;
  w.evidence.prior_sd = 5.0;
  return w;
}

std::vector<int> chosen(const FoundWindows& found) {
  std::vector<int> list;
  for (const FoundWindows::Window& w : found.windows) {
    EXPECT_EQ(w.last, w.first + 1);
    list.push_back(static_cast<int>(w.first) / 2);
  }
  return list;
}

TEST(StretchChoice, FindsEveryOtherAndAnyOfThemAndSaysTheirSize) {
  for (const std::vector<int>& in : {std::vector{1, 3, 5, 7, 9, 11}, {0, 1, 6}, {4}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 10, 11}}) {
    const Works w = works(in, 2.0, 1);
    const auto found = choose_stretches(w.evidence, w.stretches);
    ASSERT_TRUE(found);
    EXPECT_EQ(chosen(*found), in);
    EXPECT_GT(found->gain, 10.0);
    const auto n = static_cast<double>(in.size());
    EXPECT_NEAR(found->size, 2.0, 1.0 / std::sqrt(n));
    const double choices = std::tgamma(kStretches + 1.0) / std::tgamma(n + 1.0) / std::tgamma(kStretches - n + 1.0);
    EXPECT_NEAR(found->price_nats, std::log(kStretches * choices), 1e-9);
  }
}

TEST(StretchChoice, IsWorthNothingWhereThereIsNoiseAloneOrAllStretchesAreAlike) {
  int n_taken = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Works w = works({}, 0.0, seed);
    const auto found = choose_stretches(w.evidence, w.stretches);
    if (found && found->gain > 0.0) ++n_taken;
  }
  EXPECT_LE(n_taken, 10);  // of 200: what is paid for is what choosing brings
  const Works all = works({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, 2.0, 3);
  EXPECT_FALSE(choose_stretches(all.evidence, all.stretches));  // a law of the drive
}

TEST(StretchChoice, ChoosesNothingWhereSizesFollowHowFastItWorked) {
  const std::vector<int> fast = {1, 2, 5, 8, 9};
  Works w = works(fast, 2.0, 1);
  std::vector<double> level(2 * kStretches, 0.0);
  for (int k = 0; k < kStretches; ++k) level[static_cast<std::size_t>(2 * k)] = 1000.0 + 10.0 * (k % 3);
  for (int k : fast) level[static_cast<std::size_t>(2 * k)] += 800.0;
  EXPECT_TRUE(choose_stretches(w.evidence, w.stretches));
  w.stretches.levels = {{level}};
  EXPECT_FALSE(choose_stretches(w.evidence, w.stretches));
  for (int k = 0; k < kStretches; ++k)
    level[static_cast<std::size_t>(2 * k)] = 1000.0 + 100.0 * ((7 * k) % 12);  // of another order
  w.stretches.levels = {{level}};
  EXPECT_TRUE(choose_stretches(w.evidence, w.stretches));
}

TEST(StretchChoice, TakesNoSizeThatIsNotAllowed) {
  Works w = works({1, 3, 5, 7, 9, 11}, -2.0, 1);
  EXPECT_GT(choose_stretches(w.evidence, w.stretches)->gain, 10.0);
  w.evidence.is_positive = true;
  const auto found = choose_stretches(w.evidence, w.stretches);
  EXPECT_FALSE(found && found->gain > 0.0);
}

/// Forty rows a minute apart, four of work and four of rest in turn.
MeasuredRun run_of(const std::string& name, double speed_rpm) {
  MeasuredRun run;
  run.name = name;
  for (int k = 0; k <= 40; ++k) run.time_s.push_back(60.0 * k);
  for (int k = 0; k < 5; ++k) {
    run.cyclogram.sections.push_back({240.0, {.speed_rpm = speed_rpm}});
    run.cyclogram.sections.push_back({240.0, {.speed_rpm = 0.0}});
  }
  return run;
}

Cyclogram::Column column_of(const std::string& name, const std::string& unit, const std::vector<double>& values) {
  Cyclogram::Column c;
  c.name = name;
  c.unit = unit;
  for (std::size_t k = 0; k < values.size(); ++k) {
    c.rows.time_s.push_back(60.0 * static_cast<double>(k));
    c.rows.value.push_back(values[k]);
  }
  return c;
}

const std::vector<Eigen::Index> kEdges = {0, 4, 8, 12, 16, 20, 24, 28, 32, 36, 40};

TEST(WorkStretches, AreThoseOfTheSpindle) {
  MeasuredRun run = run_of("monday", 1000.0);
  const std::vector<WorkStretches> list = stretches_of_work({run});
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].edges[0], kEdges);
  EXPECT_EQ(list[0].is_work[0], (std::vector<char>{1, 0, 1, 0, 1, 0, 1, 0, 1, 0}));
  EXPECT_EQ(list[0].levels,
            (std::vector<std::vector<std::vector<double>>>{{{1000, 0, 1000, 0, 1000, 0, 1000, 0, 1000, 0}}}));
  run.cyclogram.sections.resize(4);  // two stretches of work, and the last rest goes on: nothing to choose among
  run.cyclogram.sections.push_back({1440.0, {.speed_rpm = 0.0}});
  EXPECT_TRUE(stretches_of_work({run}).empty());
}

TEST(WorkStretches, AreThoseOfAnAxisToo) {  // where the spindle turns all along
  MeasuredRun run = run_of("monday", 1000.0);
  for (std::size_t k = 0; k < run.cyclogram.sections.size(); ++k) {
    run.cyclogram.sections[k].drive.speed_rpm = 1000.0;
    run.cyclogram.sections[k].drive.feed_m_s = {0.0, k % 2 == 1 ? 0.1 : 0.0, 0.0};
  }
  const std::vector<WorkStretches> list = stretches_of_work({run});
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].edges[0], kEdges);
  EXPECT_EQ(list[0].is_work[0], (std::vector<char>{0, 1, 0, 1, 0, 1, 0, 1, 0, 1}));
}

TEST(WorkStretches, AreThoseOfAColumnThatAllRecordsHave) {
  std::vector<double> door(41, 0.0), heater(41, 500.0), warm(41, 20.0);
  for (std::size_t k = 0; k < 41; ++k) {
    if (k % 8 >= 4) door[k] = 1.0;  // open where the spindle rests: its stretches are others though they have the same ends
    if (k % 8 >= 4) warm[k] = 25.0;
  }
  MeasuredRun monday = run_of("monday", 1000.0), tuesday = run_of("tuesday", 800.0);
  for (MeasuredRun* run : {&monday, &tuesday}) {
    run->cyclogram.columns.push_back(column_of("door", "1", door));
    run->cyclogram.columns.push_back(column_of("oil", "degC", warm));  // a temperature does not work
  }
  tuesday.cyclogram.columns.push_back(column_of("heater", "W", heater));  // of one record alone
  for (const auto& runs : {std::vector{monday, tuesday}, {tuesday, monday}}) {
    const std::vector<WorkStretches> list = stretches_of_work(runs);
    ASSERT_EQ(list.size(), 2u);
    for (const WorkStretches& s : list) {
      EXPECT_EQ(s.edges, (Edges{kEdges, kEdges}));
      EXPECT_EQ(s.levels.size(), 3u);  // door, oil, speed
    }
    EXPECT_NE(list[0].is_work, list[1].is_work);
  }
}

TEST(WorkStretches, AreToldByWhatRestsInAnyRecord) {  // one that works all along in one of them has a single stretch there
  std::vector<double> changes(41, 0.0), stays(41, 500.0);
  for (std::size_t k = 0; k < 41; ++k) {
    if (k % 8 < 4) changes[k] = 500.0;
    stays[k] += k % 2 == 0 ? 5.0 : -5.0;
  }
  MeasuredRun monday = run_of("monday", 1000.0), tuesday = run_of("tuesday", 1000.0);
  for (MeasuredRun* run : {&monday, &tuesday}) {
    for (auto& section : run->cyclogram.sections) section.drive.speed_rpm = 1000.0;
  }
  monday.cyclogram.columns.push_back(column_of("heater", "W", changes));
  tuesday.cyclogram.columns.push_back(column_of("heater", "W", stays));
  const std::vector<WorkStretches> list = stretches_of_work({monday, tuesday});
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].edges[0], kEdges);
  EXPECT_EQ(list[0].edges[1], (std::vector<Eigen::Index>{0, 40}));
  EXPECT_EQ(list[0].is_work[1], (std::vector<char>{1}));
}

}  // namespace
}  // namespace driftwright::diagnosis::stretch_choice_test
