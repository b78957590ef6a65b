// Windows found in a linear problem whose truth is known: once, again and again, in turns, and none where there is only noise.

#include "diagnosis/window_search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "base/random.hpp"

namespace driftwright::diagnosis::window_search_test {
namespace {

using ::testing::SizeIs;

constexpr Eigen::Index kCells = 60;
constexpr double kCell_s = 60.0;

/// One body that forgets over six cells, read at the end of each: S of one run. A constant and a slope of the readings are known roughly.
Eigen::MatrixXd responses() {
  Eigen::MatrixXd s = Eigen::MatrixXd::Zero(kCells, kCells);
  for (Eigen::Index row = 0; row < kCells; ++row) {
    for (Eigen::Index cell = 0; cell <= row; ++cell) s(row, cell) = std::exp(-static_cast<double>(row - cell) / 6.0);
  }
  return s;
}

/// @param windows  1 where something acts, of each run in turn
WindowEvidence evidence(const Eigen::VectorXd& windows, double size, std::uint64_t seed) {
  const Eigen::Index n_runs = windows.size() / kCells, n = windows.size();
  Eigen::MatrixXd s = Eigen::MatrixXd::Zero(n, n), j = Eigen::MatrixXd::Zero(n, 2 * n_runs);
  WindowEvidence e;
  for (Eigen::Index r = 0; r < n_runs; ++r) {
    s.block(r * kCells, r * kCells, kCells, kCells) = responses();
    j.block(r * kCells, 2 * r, kCells, 1).setConstant(1.0);
    j.block(r * kCells, 2 * r + 1, kCells, 1) = Eigen::VectorXd::LinSpaced(kCells, -1.0, 1.0);
    WindowEvidence::Run run{r * kCells, {}, kCell_s};
    for (Eigen::Index k = 0; k <= kCells; ++k) run.edge_s.push_back(kCell_s * static_cast<double>(k));
    e.runs.push_back(run);
  }
  Random random(seed, 0);
  Eigen::VectorXd y = size * s * windows;
  for (double& v : y) v += random.normal();
  Eigen::VectorXd known(2 * n_runs);
  for (double& v : known) v = 3.0 * random.normal();
  y += j * known;
  Eigen::MatrixXd hessian = j.transpose() * j;
  hessian.diagonal().array() += 1.0 / 9.0;
  const auto without = [&](const Eigen::MatrixXd& x) -> Eigen::MatrixXd {
    return x - j * hessian.llt().solve(j.transpose() * x);
  };
  e.slope = s.transpose() * without(y);
  e.curvature = s.transpose() * without(s);
  e.prior_sd = 5.0;
  return e;
}

TEST(WindowSearch, FindsOneAndSeveralOfOneSize) {
  Eigen::VectorXd windows = Eigen::VectorXd::Zero(2 * kCells);
  windows.segment(10, 6).setOnes();
  windows.segment(30, 4).setOnes();
  windows.segment(kCells + 40, 8).setOnes();
  const auto found = find_windows(evidence(windows, 4.0, 1));
  ASSERT_TRUE(found);
  ASSERT_THAT(found->windows, SizeIs(3));
  EXPECT_EQ(found->windows[0].run, 0u);
  EXPECT_NEAR(static_cast<double>(found->windows[0].first), 10.0, 1.0);
  EXPECT_NEAR(static_cast<double>(found->windows[0].last), 16.0, 1.0);
  EXPECT_NEAR(static_cast<double>(found->windows[1].first), 30.0, 1.0);
  EXPECT_EQ(found->windows[2].run, 1u);
  EXPECT_NEAR(static_cast<double>(found->windows[2].first), 40.0, 1.0);
  EXPECT_NEAR(found->size, 4.0, 0.5);
  EXPECT_GT(found->gain, 20.0);
  // Their times are sharp: each begins and ends at one of 60 cells, in whatever order the three are.
  EXPECT_NEAR(found->price_nats, 6.0 * std::log(60.0) - std::log(6.0), 6.0);
}

TEST(WindowSearch, FindsSeveralThatLieSoNearThatOneLongWindowIsTheBestOfOne) {
  Eigen::VectorXd windows = Eigen::VectorXd::Zero(kCells);
  for (const auto& [first, n] : {std::pair{6, 6}, {15, 6}, {24, 6}, {33, 6}}) windows.segment(first, n).setOnes();
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto found = find_windows(evidence(windows, 2.5, seed));
    ASSERT_TRUE(found);
    ASSERT_THAT(found->windows, SizeIs(4)) << seed;
    EXPECT_NEAR(static_cast<double>(found->windows[1].first), 15.0, 1.0);
    EXPECT_NEAR(static_cast<double>(found->windows[3].last), 39.0, 1.0);
    EXPECT_NEAR(found->size, 2.5, 0.5);
  }
}

TEST(WindowSearch, FindsTurnsThatRepeat) {
  Eigen::VectorXd windows = Eigen::VectorXd::Zero(2 * kCells);
  for (Eigen::Index r = 0; r < 2; ++r) {
    for (Eigen::Index k = 4; k + 3 <= kCells; k += 11) windows.segment(r * kCells + k, 3).setOnes();
  }
  const WindowEvidence e = evidence(windows, 2.0, 2);
  const auto turns = find_turns(e);
  ASSERT_TRUE(turns);
  EXPECT_NEAR(turns->every_s, 11.0 * kCell_s, 0.3 * kCell_s);
  EXPECT_NEAR(turns->begin_s, 4.0 * kCell_s, 1.5 * kCell_s);
  EXPECT_NEAR(turns->length_s, 3.0 * kCell_s, 1.0 * kCell_s);
  EXPECT_NEAR(turns->size, 2.0, 0.6);
  const auto one_by_one = find_windows(e);
  EXPECT_GT(turns->gain, one_by_one ? one_by_one->gain : 0.0) << "three times say what twelve windows do";
}

TEST(WindowSearch, TellsManyWindowsFromACourse) {
  Eigen::VectorXd windows = Eigen::VectorXd::Zero(kCells);
  for (Eigen::Index begin : {3, 11, 17, 26, 35, 44, 52}) windows.segment(begin, 4).setOnes();
  int n_dropped = 0, n_many = 0, n_told = 0;
  constexpr int kTries = 20;
  for (int seed = 0; seed < kTries; ++seed) {
    Random random(1000 + static_cast<std::uint64_t>(seed), 0);
    Eigen::VectorXd course(2 * kCells);  // that stays alike for five cells
    double value = 0.0;
    for (double& v : course) v = value = std::exp(-0.2) * value + std::sqrt(1.0 - std::exp(-0.4)) * random.normal();
    const WindowEvidence of_windows = evidence(windows, 6.0, static_cast<std::uint64_t>(seed)),
                         of_course = evidence(course, 6.0, static_cast<std::uint64_t>(seed));
    const auto found = find_windows(of_windows), followed = find_windows(of_course);
    ASSERT_TRUE(found && followed);
    n_dropped += course_gain(of_windows, *found) > 1.1 * found->gain;
    if (followed->windows.size() <= 5) continue;
    ++n_many;
    n_told += course_gain(of_course, *followed) > followed->gain;
  }
  EXPECT_LE(n_dropped, kTries / 3);  // seven windows that were not found to the cell
  EXPECT_GE(n_many, kTries / 2);
  EXPECT_EQ(n_told, n_many);
}

TEST(WindowSearch, SaysNothingOfNoise) {
  int n_found = 0;
  constexpr int kTries = 200;
  for (int i = 0; i < kTries; ++i) {
    const WindowEvidence e = evidence(Eigen::VectorXd::Zero(2 * kCells), 0.0, 100 + static_cast<std::uint64_t>(i));
    const auto found = find_windows(e);
    const auto turns = find_turns(e);
    n_found += (found && found->gain > 3.0) || (turns && turns->gain > 3.0);
  }
  // Evidence of 3 nats and more comes by chance once in e^3 = 20 at the most; 1.6 sigmas more are 14 of 200.
  EXPECT_LE(n_found, 14);
}

TEST(WindowSearch, APositiveSizeIsKept) {
  Eigen::VectorXd windows = Eigen::VectorXd::Zero(kCells);
  windows.segment(20, 6).setOnes();
  WindowEvidence e = evidence(windows, -4.0, 3);
  const auto free = find_windows(e);
  ASSERT_TRUE(free);
  EXPECT_LT(free->size, -3.0);
  e.is_positive = true;  // then what is there all the rest of the time would do, if anything
  const auto positive = find_windows(e);
  EXPECT_GE(positive ? positive->size : 0.0, 0.0);
}

}  // namespace
}  // namespace driftwright::diagnosis::window_search_test
