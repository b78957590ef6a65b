// Standard errors, VIF, Durbin-Watson and R^2: certified values, hand arithmetic, and extended precision where sensors
// are alike.

#include "compensation/predictors/regression_quality.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "compensation/sensors/product_sums.hpp"
#include "tests/shared/sensor_records.hpp"

namespace driftwright::compensation::regression_quality_test {
namespace {

using Real = __float128;

double root(Real x) {
  return std::sqrt(static_cast<double>(x));
}

/// Least squares with intercept by normal equations in 113 bits: cond^2 of 1e14 leaves 20 digits.
struct Exact {
  std::vector<Real> b;                            // intercept first
  std::vector<Real> predicted;                    // per row
  std::vector<double> standard_error, inflation;  // without the intercept
  double r_squared = 0.0;
};

/// A x = B by Gauss with pivoting; B is replaced.
void solve(std::vector<std::vector<Real>> a, std::vector<std::vector<Real>>& b) {
  const std::size_t n = a.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i) {
      if ((a[i][k] < 0 ? -a[i][k] : a[i][k]) > (a[pivot][k] < 0 ? -a[pivot][k] : a[pivot][k])) pivot = i;
    }
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const Real f = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] -= f * a[k][j];
      for (std::size_t j = 0; j < b[i].size(); ++j) b[i][j] -= f * b[k][j];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (Real& v : b[i]) v /= a[i][i];
  }
}

Exact exact_fit(const std::vector<Record>& records, const std::vector<std::string>& inputs, const std::string& target) {
  std::vector<std::vector<Real>> x;
  std::vector<Real> y;
  for (const Record& record : records) {
    for (std::size_t i = 0; i < record.n_samples(); ++i) {
      std::vector<Real> row = {1};
      for (const std::string& name : inputs) row.push_back(record.at(name).values[i]);
      x.push_back(row);
      y.push_back(record.at(target).values[i]);
    }
  }
  const std::size_t m = inputs.size() + 1;
  std::vector<std::vector<Real>> a(m, std::vector<Real>(m, 0)), b(m, std::vector<Real>(m + 1, 0));
  Real sum_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum_y += y[i];
    for (std::size_t j = 0; j < m; ++j) {
      b[j][m] += x[i][j] * y[i];
      for (std::size_t k = 0; k < m; ++k) a[j][k] += x[i][j] * x[i][k];
    }
  }
  for (std::size_t j = 0; j < m; ++j) b[j][j] = 1;
  solve(a, b);
  Exact fit;
  for (std::size_t j = 0; j < m; ++j) fit.b.push_back(b[j][m]);
  Real squares = 0, spread = 0;
  const Real n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    Real p = 0;
    for (std::size_t j = 0; j < m; ++j) p += fit.b[j] * x[i][j];
    fit.predicted.push_back(p);
    squares += (y[i] - p) * (y[i] - p);
    spread += (y[i] - sum_y / n) * (y[i] - sum_y / n);
  }
  fit.r_squared = static_cast<double>(1 - squares / spread);
  for (std::size_t j = 1; j < m; ++j) {
    fit.standard_error.push_back(root(squares / (n - static_cast<double>(m)) * b[j][j]));
    fit.inflation.push_back(static_cast<double>(b[j][j] * (a[j][j] - a[0][j] * a[0][j] / n)));
  }
  return fit;
}

double largest(const std::vector<Real>& x) {
  double most = 0.0;
  for (const Real v : x) most = std::max(most, std::abs(static_cast<double>(v)));
  return most;
}

/// Sensors of which X2 and X3 follow X1 within `apart_K`.
std::vector<Record> alike(double apart_K, std::uint64_t seed) {
  std::vector<Record> records = {fixtures::sensor_record(seed, 300, 5), fixtures::sensor_record(seed + 1, 200, 5)};
  Random random(seed, 3);
  for (Record& record : records) {
    for (std::size_t i = 0; i < record.n_samples(); ++i) {
      record.channels[1].values[i] = record.channels[0].values[i] + apart_K * random.normal();
      record.channels[2].values[i] = 5.0 + 0.7 * record.channels[0].values[i] + apart_K * random.normal();
    }
  }
  return records;
}

class Alike : public ::testing::TestWithParam<double> {};

// Rounding of readings of 20 degC to rises of 5 K, times the condition number (root of the VIF), is 1e-15 * 4 * 300 at
// the worst here: coefficients are 1e-10 within a hundredfold reserve, predictions far better.
TEST_P(Alike, RegressionByQRAgreesWithExtendedPrecision) {
  const std::vector<Record> records = alike(GetParam(), 11);
  const std::vector<std::string> inputs = fixtures::sensor_names(5);
  const Exact exact = exact_fit(records, inputs, "drift_y");
  EXPECT_GT(exact.inflation[0], 1000.0);
  const Regression fit = fit_regression(records, inputs, "drift_y");
  const RegressionQuality quality = regression_quality(records, fit);
  ASSERT_EQ(fit.rank, 5);
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    EXPECT_NEAR(fit.coefficients[j] / static_cast<double>(exact.b[j + 1]), 1.0, 1e-10) << inputs[j];
    EXPECT_NEAR(quality.standard_error[j] / exact.standard_error[j], 1.0, 1e-10) << inputs[j];
    EXPECT_NEAR(quality.variance_inflation[j] / exact.inflation[j], 1.0, 1e-9) << inputs[j];  // a square
  }
  EXPECT_NEAR(quality.r_squared, exact.r_squared, 1e-12);
  std::size_t at = 0;
  const double scale_um = largest(exact.predicted);
  for (const Record& record : records) {
    for (double p : fit.predict(record)) EXPECT_NEAR(p, static_cast<double>(exact.predicted[at++]), 1e-10 * scale_um);
  }
}

// Sums of products square the condition number: 1e-16 times the VIF in the coefficients, of which predictions see little.
TEST_P(Alike, RegressionBySumsAgreesWithExtendedPrecision) {
  const std::vector<Record> records = alike(GetParam(), 11);
  const std::vector<std::string> inputs = fixtures::sensor_names(5);
  const Exact exact = exact_fit(records, inputs, "drift_y");
  const ProductSums sums = product_sums(records, inputs, "drift_y");
  const std::vector<int> columns = {0, 1, 2, 3, 4};
  const ScaledFit fit = fit_columns(sums.total(), columns);
  std::size_t at = 0;
  const double scale_um = largest(exact.predicted);
  double worst = 0.0, worst_coefficient = 0.0;
  for (const Record& record : records) {
    for (std::size_t i = 0; i < record.n_samples(); ++i) {
      double p = fit.intercept;
      for (int j : columns)
        p += fit.slope(j) * (record.channels[static_cast<std::size_t>(j)].values[i] - sums.mean(j)) / sums.deviation(j);
      p = sums.mean(5) + sums.deviation(5) * p;
      worst = std::max(worst, std::abs(p - static_cast<double>(exact.predicted[at++])) / scale_um);
    }
  }
  double most_inflation = 0.0;
  for (int j : columns) {
    const double b = fit.slope(j) * sums.deviation(5) / sums.deviation(j);
    worst_coefficient =
        std::max(worst_coefficient, std::abs(b / static_cast<double>(exact.b[static_cast<std::size_t>(j) + 1]) - 1.0));
    most_inflation = std::max(most_inflation, exact.inflation[static_cast<std::size_t>(j)]);
  }
  // as product_sums.hpp states; measured 8e-18 and 1e-15 per VIF at most
  EXPECT_LT(worst, 1e-13 + 5e-17 * most_inflation);
  EXPECT_LT(worst_coefficient, 1e-11 + 1e-14 * most_inflation);
  EXPECT_TRUE(worst < 1e-10 || most_inflation > 2e6) << worst;
}

INSTANTIATE_TEST_SUITE_P(Apart_K, Alike, ::testing::Values(0.03, 0.01, 1e-3, 1e-4));

/// Longley (1967), with the values that NIST certifies (Statistical Reference Datasets, itl.nist.gov/div898/strd).
Record longley() {
  return {
      .source = "Longley",
      .time_s = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15},
      .channels = {
          {"deflator",
           "1",
           {83.0, 88.5, 88.2, 89.5, 96.2, 98.1, 99.0, 100.0, 101.2, 104.6, 108.4, 110.8, 112.6, 114.2, 115.7, 116.9}},
          {"gnp",
           "1",
           {234289, 259426, 258054, 284599, 328975, 346999, 365385, 363112, 397469, 419180, 442769, 444546, 482704, 502601,
            518173, 554894}},
          {"unemployed",
           "1",
           {2356, 2325, 3682, 3351, 2099, 1932, 1870, 3578, 2904, 2822, 2936, 4681, 3813, 3931, 4806, 4007}},
          {"forces", "1", {1590, 1456, 1616, 1650, 3099, 3594, 3547, 3350, 3048, 2857, 2798, 2637, 2552, 2514, 2572, 2827}},
          {"population",
           "1",
           {107608, 108632, 109773, 110929, 112075, 113270, 115094, 116219, 117388, 118734, 120445, 121950, 123366, 125368,
            127852, 130081}},
          {"year", "1", {1947, 1948, 1949, 1950, 1951, 1952, 1953, 1954, 1955, 1956, 1957, 1958, 1959, 1960, 1961, 1962}},
          {"employed",
           "1",
           {60323, 61122, 60171, 61187, 63221, 63639, 64989, 63761, 66019, 67857, 68169, 66513, 68655, 69564, 69331,
            70551}}}};
}
const std::vector<std::string> kLongleyInputs = {"deflator", "gnp", "unemployed", "forces", "population", "year"};

TEST(RegressionQuality, ReproducesLongleysCertifiedDeviations) {
  const std::vector<Record> records = {longley()};
  const Regression fit = fit_regression(records, kLongleyInputs, "employed");
  const RegressionQuality q = regression_quality(records, fit);
  const std::vector<double> certified = {84.9149257747669,  0.334910077722432e-01, 0.488399681651699,
                                         0.214274163161675, 0.226073200069370,     455.478499142212};
  for (std::size_t j = 0; j < certified.size(); ++j)
    EXPECT_NEAR(q.standard_error[j] / certified[j], 1.0, 1e-10) << kLongleyInputs[j];
  EXPECT_NEAR(q.r_squared, 0.995479004577296, 1e-12);
  EXPECT_GT(q.variance_inflation[1], 1000.0);
  // As every statistics package has them to their five digits: Durbin-Watson 2.559488, VIF 135.53, 1788.51, 33.62, 3.59,
  // 399.15, 758.98.
  EXPECT_NEAR(q.durbin_watson, 2.559488, 1e-6);
  const std::vector<double> inflation = {135.53, 1788.51, 33.62, 3.59, 399.15, 758.98};
  for (std::size_t j = 0; j < inflation.size(); ++j)
    EXPECT_NEAR(q.variance_inflation[j], inflation[j], 0.005) << kLongleyInputs[j];
}

TEST(RegressionQuality, ProductSumsReproduceLongleysCertifiedCoefficients) {
  const std::vector<Record> records = {longley()};
  const ProductSums sums = product_sums(records, kLongleyInputs, "employed");
  const ScaledFit fit = fit_columns(sums.total(), std::vector<int>{0, 1, 2, 3, 4, 5});
  const std::vector<double> certified = {15.0618722713733,  -0.0358191792925910, -2.02022980381683,
                                         -1.03322686717359, -0.0511041056535807, 1829.15146461355};
  for (int j = 0; j < 6; ++j)
    EXPECT_NEAR(fit.slope(j) * sums.deviation(6) / sums.deviation(j) / certified[static_cast<std::size_t>(j)], 1.0, 1e-10);
}

// By hand: x = (0,1,2,3), y = (0,2,1,3): mean 3/2 each, Sxx = 5, Sxy = 4, Syy = 5; b = 4/5, residuals y - 3/10 - 4/5 x =
// (-0.3, 0.9, -0.9, 0.3), sum of squares 1.8; R^2 = 1 - 1.8/5 = 0.64; s^2 = 0.9, error sqrt(0.9/5) = sqrt(0.18);
// steps 1.2, -1.8, 1.2: 6.12, over 1.8 = 3.4.
TEST(RegressionQuality, MatchesHandArithmetic) {
  const std::vector<Record> one = {
      {.source = "a", .time_s = {0, 1, 2, 3}, .channels = {{"x", "K", {0, 1, 2, 3}}, {"y", "um", {0, 2, 1, 3}}}}};
  const RegressionQuality q = regression_quality(one, fit_regression(one, {"x"}, "y"));
  EXPECT_NEAR(q.r_squared, 0.64, 1e-14);
  EXPECT_NEAR(q.durbin_watson, 3.4, 1e-13);
  EXPECT_NEAR(q.standard_error[0], std::sqrt(0.18), 1e-14);
  EXPECT_EQ(q.variance_inflation[0], 1.0);
  // the same rows in two records: the step from one to the other (-1.8) does not count, 2.88/1.8 = 1.6
  const std::vector<Record> two = {{.source = "a", .time_s = {0, 1}, .channels = {{"x", "K", {0, 1}}, {"y", "um", {0, 2}}}},
                                   {.source = "b", .time_s = {0, 1}, .channels = {{"x", "K", {2, 3}}, {"y", "um", {1, 3}}}}};
  EXPECT_NEAR(regression_quality(two, fit_regression(two, {"x"}, "y")).durbin_watson, 1.6, 1e-13);
}

// x1 = (1,1,-1,-1), x2 = (2,0,0,-2): correlation 4/sqrt(4*8) = sqrt(1/2), so VIF = 1/(1 - 1/2) = 2 for both.
TEST(RegressionQuality, InflationOfTwoSensorsIsThatOfTheirCorrelation) {
  const std::vector<Record> r = {
      {.source = "a",
       .time_s = {0, 1, 2, 3},
       .channels = {{"x1", "K", {1, 1, -1, -1}}, {"x2", "K", {2, 0, 0, -2}}, {"y", "um", {1, 2, 3, 5}}}}};
  const RegressionQuality q = regression_quality(r, fit_regression(r, {"x1", "x2"}, "y"));
  EXPECT_NEAR(q.variance_inflation[0], 2.0, 1e-14);
  EXPECT_NEAR(q.variance_inflation[1], 2.0, 1e-14);
}

TEST(RegressionQuality, OfASensorGivenTwiceOrDeadIsInfiniteAndOfTheOthersAsAlone) {
  Record record = fixtures::sensor_record(2, 100, 4);
  record.channels[1].values = record.channels[0].values;
  std::fill(record.channels[2].values.begin(), record.channels[2].values.end(), 20.25);
  const std::vector<Record> records = {record};
  const RegressionQuality q = regression_quality(records, fit_regression(records, fixtures::sensor_names(4), "drift_y"));
  for (const std::size_t j : {0u, 1u, 2u}) {
    EXPECT_TRUE(std::isinf(q.variance_inflation[j])) << j;
    EXPECT_TRUE(std::isnan(q.standard_error[j])) << j;
  }
  const RegressionQuality alone = regression_quality(records, fit_regression(records, {"X1", "X4"}, "drift_y"));
  EXPECT_NEAR(q.variance_inflation[3] / alone.variance_inflation[1], 1.0, 1e-10);
}

TEST(RegressionQuality, WithoutFreedomThereIsNoStandardError) {
  const std::vector<Record> r = {{.source = "a", .time_s = {0, 1}, .channels = {{"x", "K", {1, 2}}, {"y", "um", {1, 3}}}}};
  EXPECT_TRUE(std::isnan(regression_quality(r, fit_regression(r, {"x"}, "y")).standard_error[0]));
}

TEST(NearDuplicates, AreNamedStrongestFirstWhateverTheirSign) {
  Record record = fixtures::sensor_record(9, 300, 5, 0.0);
  Random random(1);
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    record.channels[1].values[i] = record.channels[0].values[i] + 0.05 * random.normal();
    record.channels[2].values[i] = 50.0 - record.channels[0].values[i] + 0.01 * random.normal();
  }
  std::fill(record.channels[4].values.begin(), record.channels[4].values.end(), 3.0);
  const std::vector<NearDuplicate> pairs = near_duplicates(std::span(&record, 1), {"X1", "X2", "X3", "X5"});
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(pairs[0].first + pairs[0].second, "X1X3");
  EXPECT_LT(pairs[0].correlation, -0.999);
  for (std::size_t i = 1; i < 3; ++i) EXPECT_LE(std::abs(pairs[i].correlation), std::abs(pairs[i - 1].correlation));
}

TEST(NearDuplicates, WithoutARowInCommonThereAreNone) {
  const Record r{.source = "a", .time_s = {0, 1}, .channels = {{"x", "K", {1, NAN}}, {"z", "K", {NAN, 3}}}};
  EXPECT_TRUE(near_duplicates(std::span(&r, 1), {"x", "z"}).empty());
}

}  // namespace
}  // namespace driftwright::compensation::regression_quality_test
