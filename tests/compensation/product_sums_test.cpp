// Sets of sensors judged from sums alone, against fits made anew; and what is refused or passed over.

#include "compensation/sensors/product_sums.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "compensation/predictors/regression.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/sensor_records.hpp"

namespace driftwright::compensation::product_sums_test {
namespace {

std::vector<Record> four_records(int n_sensors) {
  std::vector<Record> records;
  for (int r = 0; r < 4; ++r)
    records.push_back(fixtures::sensor_record(40 + static_cast<std::uint64_t>(r), 80 + 30 * r, n_sensors));
  return records;
}

/// Each record predicted by fit_regression() on the others.
double rmse_by_refits(const std::vector<Record>& records, const std::vector<std::string>& inputs) {
  double squares = 0.0, n = 0.0;
  for (std::size_t out = 0; out < records.size(); ++out) {
    std::vector<Record> rest = records;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(out));
    const std::vector<double> predicted = fit_regression(rest, inputs, "drift_y").predict(records[out]);
    const std::vector<double>& drift = records[out].at("drift_y").values;
    for (std::size_t i = 0; i < drift.size(); ++i) {
      if (!std::isfinite(predicted[i]) || !std::isfinite(drift[i])) continue;
      squares += std::pow(drift[i] - predicted[i], 2);
      n += 1.0;
    }
  }
  return std::sqrt(squares / n);
}

TEST(HeldOutRmse, IsThatOfFitsMadeAnewForEachRecordLeftOut) {
  const std::vector<Record> records = four_records(6);
  const ProductSums sums = product_sums(records, fixtures::sensor_names(6), "drift_y");
  for (const std::vector<int>& set : {std::vector<int>{0}, {1, 4}, {5, 2, 0}, {0, 1, 2, 3, 4, 5}}) {
    std::vector<std::string> inputs;
    for (int j : set) inputs.push_back(sums.inputs[static_cast<std::size_t>(j)]);
    const double anew = rmse_by_refits(records, inputs);
    EXPECT_GT(anew, 0.1);
    EXPECT_NEAR(held_out_rmse(sums, set) / anew, 1.0, 1e-10);  // a VIF below 1e3, and a residual of a hundredth of the drift
  }
}

TEST(HeldOutRmse, CountsCompleteRowsAlone) {
  std::vector<Record> records = four_records(3);
  records[1].channels[1].values[7] = NAN;
  records[2].channels.back().values[0] = NAN;
  const ProductSums sums = product_sums(records, fixtures::sensor_names(3), "drift_y");
  EXPECT_EQ(sums.n_left_out, 2);
  EXPECT_EQ(sums.by_record[1](0, 0), 109.0);
  EXPECT_NEAR(held_out_rmse(sums, std::vector<int>{0, 1, 2}) / rmse_by_refits(records, fixtures::sensor_names(3)), 1.0,
              1e-10);
}

// An ambient thermometer moves in one run only: without that run it shows nothing, and the others must not be spoilt by a
// slope made of rounding.
TEST(HeldOutRmse, OfASensorThatStandsStillInTheOtherRunsIsThatOfTheOthers) {
  for (const double stands_at : {20.0, 21.7, 19.999}) {
    std::vector<Record> records = four_records(3);
    for (std::size_t r = 0; r < 3; ++r)
      std::fill(records[r].channels[1].values.begin(), records[r].channels[1].values.end(), stands_at);
    const ProductSums sums = product_sums(records, fixtures::sensor_names(3), "drift_y");
    // the record in which it moves is predicted as without it; the others by fits that know it
    EXPECT_NEAR(held_out_rmse(sums, std::vector<int>{0, 1, 2}) / rmse_by_refits(records, fixtures::sensor_names(3)), 1.0,
                1e-9)
        << stands_at;
    const Eigen::MatrixXd rest = sums.total() - sums.by_record[3];
    for (const std::vector<int>& set : {std::vector<int>{0, 1, 2}, {1}}) {
      const ScaledFit fit = fit_columns(rest, set);
      EXPECT_EQ(fit.slope(set.size() == 1 ? 0 : 1), 0.0) << stands_at;
    }
  }
}

TEST(FitColumns, WithAPenaltyShrinksAsTheClosedFormSays) {
  // one column: slope = S_xy / (S_xx + penalty n) about the mean
  const std::vector<Record> records = four_records(2);
  const ProductSums sums = product_sums(records, {"X1", "X2"}, "drift_y");
  const Eigen::MatrixXd s = sums.by_record[2];
  const double n = s(0, 0), sxx = s(1, 1) - s(1, 0) * s(1, 0) / n, sxy = s(1, 3) - s(1, 0) * s(3, 0) / n;
  for (const double penalty : {0.0, 0.01, 1.0}) {
    const ScaledFit fit = fit_columns(s, std::vector<int>{0}, penalty);
    EXPECT_NEAR(fit.slope(0), sxy / (sxx + penalty * n), 1e-13);
    EXPECT_NEAR(fit.intercept, s(3, 0) / n - fit.slope(0) * s(1, 0) / n, 1e-13);
  }
}

TEST(FitColumns, GivesARepeatedSensorNothing) {
  std::vector<Record> records = four_records(3);
  for (Record& record : records) record.channels[2].values = record.channels[0].values;
  const ProductSums sums = product_sums(records, fixtures::sensor_names(3), "drift_y");
  const ScaledFit both = fit_columns(sums.total(), std::vector<int>{0, 1, 2}),
                  one = fit_columns(sums.total(), std::vector<int>{0, 1});
  EXPECT_EQ(both.slope(2), 0.0);
  EXPECT_NEAR(both.slope(0), one.slope(0), 1e-13);
}

TEST(ResidualSquares, AreThoseOfTheRows) {
  const std::vector<Record> records = four_records(3);
  const ProductSums sums = product_sums(records, fixtures::sensor_names(3), "drift_y");
  const std::vector<int> set = {2, 0};
  const ScaledFit fit{.slope = Eigen::Vector2d(0.4, -1.3), .intercept = 0.7};
  double squares = 0.0;
  for (std::size_t i = 0; i < records[1].n_samples(); ++i) {
    const auto scaled = [&](std::size_t j) {
      return (records[1].channels[j].values[i] - sums.mean(static_cast<Eigen::Index>(j))) /
             sums.deviation(static_cast<Eigen::Index>(j));
    };
    squares += std::pow(scaled(3) - 0.7 - 0.4 * scaled(2) + 1.3 * scaled(0), 2);
  }
  EXPECT_NEAR(residual_squares(sums.by_record[1], set, fit) / squares, 1.0, 1e-12);
}

TEST(ProductSums, NameWhatCannotBeFitted) {
  const std::vector<Record> records = four_records(3);
  std::vector<Record> still = records, empty = records;
  for (Record& r : still) std::fill(r.channels.back().values.begin(), r.channels.back().values.end(), 3.0);
  for (Record& r : empty) std::fill(r.channels[1].values.begin(), r.channels[1].values.end(), NAN);
  EXPECT_REFUSED(product_sums(still, {"X1"}, "drift_y"), "'drift_y' never changes");
  EXPECT_REFUSED(product_sums(empty, {"X1", "X2"}, "drift_y"), "no row has a value");
  const std::vector<Record> one(records.begin(), records.begin() + 1);
  const ProductSums sums = product_sums(one, {"X1"}, "drift_y");
  EXPECT_REFUSED(held_out_rmse(sums, std::vector<int>{0}), "two training records");
}

TEST(HeldOutRmse, NamesFewerRowsThanCoefficients) {
  std::vector<Record> records = {fixtures::sensor_record(1, 3, 4), fixtures::sensor_record(2, 60, 4)};
  const ProductSums sums = product_sums(records, fixtures::sensor_names(4), "drift_y");
  EXPECT_GT(held_out_rmse(sums, std::vector<int>{0, 1}), 0.0);  // three rows for three
  EXPECT_REFUSED(held_out_rmse(sums, std::vector<int>{0, 1, 2}), "4 coefficients but only 3 complete rows");
}

TEST(ProductSums, KeepADeadSensorOutOfEverything) {
  std::vector<Record> records = four_records(3);
  for (Record& r : records) std::fill(r.channels[0].values.begin(), r.channels[0].values.end(), 21.3);
  const ProductSums sums = product_sums(records, fixtures::sensor_names(3), "drift_y");
  EXPECT_TRUE(sums.is_constant[0]);
  EXPECT_FALSE(sums.is_constant[1]);
  EXPECT_EQ(fit_columns(sums.total(), std::vector<int>{0, 1, 2}).slope(0), 0.0);
  EXPECT_NEAR(held_out_rmse(sums, std::vector<int>{0, 1, 2}) / held_out_rmse(sums, std::vector<int>{1, 2}), 1.0, 1e-12);
}

}  // namespace
}  // namespace driftwright::compensation::product_sums_test
