// Choices of points against closed forms of normal distributions.

#include "studies/probe_points.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numeric>

#include "base/errors.hpp"
#include "base/random.hpp"

namespace driftwright::studies::probe_points_test {
namespace {

using Points = std::vector<std::size_t>;

Points all_of(const PointErrors& errors) {
  Points all(errors.names.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

PointErrors with_covariance(const Eigen::MatrixXd& c) {
  PointErrors errors{.names = {}, .covariance_um2 = c, .n_rows = 100};
  for (Eigen::Index k = 0; k < c.rows(); ++k) errors.names.push_back("p" + std::to_string(k));
  return errors;
}

// Two points with deviations a and b and correlation q: a probing of the first with noise r leaves a² r² / (a² + r²) and
// b² (1 - q² a² / (a² + r²)), and tells ln((a² + r²) / r²) / 2 of both.
TEST(ProbePoints, OneOfTwoIsTheClosedForm) {
  const double a = 4.0, b = 3.0, q = 0.8, r = 2.0;
  Eigen::Matrix2d c;
  c << a * a, q * a * b, q * a * b, b * b;
  const PointErrors errors = with_covariance(c);
  const PointSet set = judged_points(errors, {0}, all_of(errors), r);
  const double first = a * a * r * r / (a * a + r * r), second = b * b * (1.0 - q * q * a * a / (a * a + r * r));
  EXPECT_NEAR(set.left_um, std::sqrt(0.5 * (first + second)), 1e-9);
  EXPECT_NEAR(set.worst_um, std::sqrt(std::max(first, second)), 1e-9);
  EXPECT_NEAR(set.nats, 0.5 * std::log((a * a + r * r) / (r * r)), 1e-6);
  EXPECT_NEAR(judged_points(errors, {}, all_of(errors), r).left_um, std::sqrt(0.5 * (a * a + b * b)), 1e-12);
}

// A table of 10 m that is shifted by s, grows by g and turns by t (at its ends), each alone in two rows: variances of
// s²/3, g²/3, t²/3. Of four rings on its middle line the two at the ends tell most. Each reads s +- g in x and +- t in y,
// with noise r: each of the three is then known with a variance of 1 / (2 / r² + 3 / its square), and errors at three
// columns of points are s + g x, t x with x = -1, 0, 1.
TEST(ProbePoints, OfATablesFrameTheRingsAtItsEndsAreProbed) {
  scenarios::Scenario scenario;
  scenario.machine.emplace();
  scenarios::TableSettings& table = scenario.table.emplace();
  table.low_m = {-5.0, -1.0, 0.0};
  table.high_m = {5.0, 1.0, 0.0};
  table.n_x = table.n_y = 3;
  table.scale_x.sensors = {"scale"};
  table.rings = {{"a", {-5.0, 0.0, 0.0}}, {"b", {-2.0, 0.0, 0.0}}, {"c", {2.0, 0.0, 0.0}}, {"d", {5.0, 0.0, 0.0}}};
  const Eigen::Vector3d largest_um(5.0, 10.0, 8.0);
  Record record{.source = "table", .time_s = {}, .channels = {{"scale", "degC", {}}}};
  const std::vector<Eigen::Vector3d> points = scenarios::table_points(table);
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (const char* axis : {"x", "y", "z"}) record.channels.push_back({fmt::format("table_{}_{}", k + 1, axis), "um", {}});
  }
  for (int row = 0; row < 6; ++row) {
    Eigen::Vector3d now_um = Eigen::Vector3d::Zero();
    now_um[row / 2] = (row % 2 ? 1.0 : -1.0) * largest_um[row / 2];
    record.time_s.push_back(60.0 * row);
    record.channels[0].values.push_back(20.0);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const bool is_head = k + 1 == points.size();
      const double x = points[k][0] / 5.0;
      record.channels[1 + 3 * k].values.push_back(is_head ? 0.0 : now_um[0] + now_um[1] * x);
      record.channels[2 + 3 * k].values.push_back(is_head ? 0.0 : now_um[2] * x);
      record.channels[3 + 3 * k].values.push_back(0.0);
    }
  }
  const PointErrors errors = table_point_errors(scenario, std::span(&record, 1));
  EXPECT_EQ(errors.n_rows, 6u);
  ASSERT_EQ(errors.names.size(), 13u);
  const Points rings = {0, 1, 2, 3};
  Points judged(9);
  std::iota(judged.begin(), judged.end(), 4);
  const double r = 0.5;
  const Eigen::Vector3d known_um2 = (2.0 / (r * r) + 3.0 * largest_um.array().square().inverse()).inverse();
  const double mean_um2 = (known_um2[0] + 2.0 / 3.0 * (known_um2[1] + known_um2[2])) / 3.0;  // z is known
  for (const PointCriterion criterion : {PointCriterion::kMeanVariance, PointCriterion::kDeterminant}) {
    const PointSet two = best_points(errors, rings, 2, judged, r, criterion);
    EXPECT_THAT(two.points, testing::ElementsAre(0, 3));
    EXPECT_NEAR(two.left_um, std::sqrt(mean_um2), 1e-9);
    EXPECT_THAT(errors.names[two.worst], testing::StartsWith("table_"));
  }
  record.channels.pop_back();
  EXPECT_THROW((void)table_point_errors(scenario, std::span(&record, 1)), InputError);
}

// A scale and a shift of a table of five rings, equally uncertain at its ends: with two probings both ends are chosen, with
// one the ring that errs as the mean of all does.
TEST(ProbePoints, OfATableItsEndsAreProbed) {
  Eigen::MatrixXd j(5, 2);
  for (int k = 0; k < 5; ++k) j.row(k) << 5.0, 10.0 * (k - 2) / 2.0;  // shift 5 um, scale 10 um at the ends
  const PointErrors errors = with_covariance(j * j.transpose());
  for (const PointCriterion criterion : {PointCriterion::kMeanVariance, PointCriterion::kDeterminant}) {
    const PointSet two = best_points(errors, all_of(errors), 2, all_of(errors), 0.5, criterion);
    EXPECT_THAT(two.points, testing::ElementsAre(0, 4));
    EXPECT_LT(two.left_um, 0.5);
  }
  const Points inner = {1, 2, 3};  // the ends cannot be probed, but count
  EXPECT_THAT(best_points(errors, inner, 2, all_of(errors), 0.5, PointCriterion::kMeanVariance).points,
              testing::ElementsAre(1, 3));
  const Points middle = {2};  // only the shift counts
  EXPECT_THAT(best_points(errors, all_of(errors), 1, middle, 0.5, PointCriterion::kMeanVariance).points,
              testing::ElementsAre(2));
}

// 25 points, 5 of them: 53,130 sets, so it is searched by exchanges. The set of independent points is known: those with the
// largest a⁴ / (a² + r²).
TEST(ProbePoints, ExchangesFindTheKnownSetOfManyPoints) {
  Random random(3, 1);
  Eigen::VectorXd a2(25);
  for (double& v : a2) v = std::pow(1.0 + 9.0 * random.uniform(), 2);
  const PointErrors errors = with_covariance(a2.asDiagonal());
  Points expected = all_of(errors);
  std::sort(expected.begin(), expected.end(), [&](std::size_t i, std::size_t k) {
    return a2[static_cast<Eigen::Index>(i)] > a2[static_cast<Eigen::Index>(k)];
  });
  expected.resize(5);
  std::sort(expected.begin(), expected.end());
  for (const PointCriterion criterion : {PointCriterion::kMeanVariance, PointCriterion::kDeterminant})
    EXPECT_EQ(best_points(errors, all_of(errors), 5, all_of(errors), 1.0, criterion).points, expected);
}

TEST(ProbePoints, ErrorsComeFromRowsThatHaveAllPoints) {
  const double nan = std::nan("");
  const Record first{
      .source = "a.csv",
      .time_s = {0.0, 1.0, 2.0},
      .channels = {{"x", "um", {2.0, nan, 0.0}}, {"t", "degC", {20.0, 20.0, 20.0}}, {"y", "um", {1.0, 5.0, 4.0}}}};
  const Record second{
      .source = "b.csv", .time_s = {0.0}, .channels = {{"y", "um", {-3.0}}, {"x", "um", {1.0}}, {"z", "um", {9.0}}}};
  const std::vector<Record> both = {first, second};
  const PointErrors errors = point_errors(both);
  EXPECT_THAT(errors.names, testing::ElementsAre("x", "y"));
  EXPECT_EQ(errors.n_rows, 3U);
  EXPECT_NEAR(errors.covariance_um2(0, 0), 5.0 / 3.0, 1e-12);
  EXPECT_NEAR(errors.covariance_um2(0, 1), -1.0 / 3.0, 1e-12);
  EXPECT_NEAR(errors.covariance_um2(1, 1), 26.0 / 3.0, 1e-12);
  const Record empty{.source = "c.csv", .time_s = {0.0}, .channels = {{"x", "um", {nan}}, {"y", "um", {1.0}}}};
  EXPECT_THROW((void)point_errors(std::vector<Record>{empty}), InputError);
  const Record one{.source = "d.csv", .time_s = {0.0}, .channels = {{"x", "um", {1.0}}}};
  EXPECT_THROW((void)point_errors(std::vector<Record>{one}), InputError);
}

}  // namespace
}  // namespace driftwright::studies::probe_points_test
