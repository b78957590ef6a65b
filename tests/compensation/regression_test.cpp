#include "compensation/predictors/regression.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "tests/compensation/record_of.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::compensation::regression_test {
namespace {

using fixtures::record_of;

Regression fit_one(const Record& record, const std::vector<std::string>& inputs) {
  return fit_regression(std::span(&record, 1), inputs, "drift");
}

/// drift = 3 um + 2 um/K (a - 20 degC) - 0.5 um/K (b - 20 degC), that is intercept 3 - 40 + 10 = -27 um.
Record plane(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> drift;
  for (std::size_t i = 0; i < a.size(); ++i) drift.push_back(3.0 + 2.0 * (a[i] - 20.0) - 0.5 * (b[i] - 20.0));
  return record_of({{"a", "degC", a}, {"b", "degC", b}, {"drift", "um", drift}});
}

TEST(Regression, RecoversAKnownPlaneFromTwoRecords) {
  const std::vector<Record> records = {plane({20, 22, 25}, {20, 21, 27}), plane({24, 28}, {30, 22})};
  const Regression fit = fit_regression(records, {"a", "b"}, "drift");
  EXPECT_NEAR(fit.coefficients[0], 2.0, 1e-12);
  EXPECT_NEAR(fit.coefficients[1], -0.5, 1e-12);
  EXPECT_NEAR(fit.intercept, -27.0, 1e-12 * 27.0);
  EXPECT_NEAR(fit.residual_rms, 0.0, 1e-12);
  EXPECT_EQ(fit.n_samples, 5);
  EXPECT_EQ(fit.rank, 2);
  EXPECT_EQ(fit.target_unit, "um");
  EXPECT_NEAR(fit.predict(plane({23}, {26}))[0], 3.0 + 2.0 * 3.0 - 0.5 * 6.0, 1e-12);
}

// By hand: x = (0,1,2), y = (0,0,3): slope = 3/2, intercept = -1/2, residuals (1/2, -1, 1/2).
TEST(Regression, ReportsResidualsAndGaps) {
  const Record r = record_of({{"a", "K", {0, 7, 1, 2}}, {"drift", "um", {0, NAN, 0, 3}}});
  const Regression fit = fit_one(r, {"a"});
  EXPECT_NEAR(fit.coefficients[0], 1.5, 1e-14);
  EXPECT_NEAR(fit.intercept, -0.5, 1e-14);
  EXPECT_NEAR(fit.residual_rms, std::sqrt(0.5), 1e-14);
  EXPECT_EQ(fit.n_samples, 3);
  EXPECT_EQ(fit.n_left_out, 1);
}

TEST(Regression, PredictsNothingWhereAnInputIsMissing) {
  const Regression fit = fit_one(plane({20, 22, 25, 24}, {20, 21, 27, 30}), {"a", "b"});
  const std::vector<double> predicted = fit.predict(record_of({{"a", "degC", {20, NAN}}, {"b", "degC", {20, 20}}}));
  EXPECT_NEAR(predicted[0], 3.0, 1e-12);
  EXPECT_TRUE(std::isnan(predicted[1]));
}

// A minimal norm shares 2 um/K equally between two sensors that always agree. In degC and K they still are
// one.
TEST(Regression, SharesTheEffectOfADuplicatedSensorAndIgnoresADeadOne) {
  const std::vector<double> a = {20, 22, 25, 24, 29};
  std::vector<double> drift, a_kelvin;
  for (double t : a) {
    drift.push_back(2.0 * t - 30.0 + 0.1 * std::sin(t));
    a_kelvin.push_back(t + 273.15);
  }
  const Record r = record_of({{"a", "degC", a},
                              {"twin", "degC", a},
                              {"kelvin", "K", a_kelvin},
                              {"dead", "degC", {21.3, 21.3, 21.3, 21.3, 21.3}},
                              {"drift", "um", drift}});
  const Regression alone = fit_one(r, {"a"});
  for (const char* copy : {"twin", "kelvin"}) {
    const Regression fit = fit_one(r, {"a", copy, "dead"});
    EXPECT_EQ(fit.rank, 1) << copy;
    EXPECT_NEAR(fit.coefficients[0], 0.5 * alone.coefficients[0], 1e-10) << copy;
    EXPECT_NEAR(fit.coefficients[1], 0.5 * alone.coefficients[0], 1e-10) << copy;
    EXPECT_EQ(fit.coefficients[2], 0.0) << copy;
    const std::vector<double> expected = alone.predict(r);
    const std::vector<double> predicted = fit.predict(r);
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(predicted[i], expected[i], 1e-10) << copy;
  }
  EXPECT_EQ(fit_one(r, {"dead"}).rank, 0);
  EXPECT_EQ(fit_one(r, {"dead"}).condition_number, 1.0);
}

// Two sensors that differ by 1e-7 of their movement: the condition number is 1e7, so QR keeps 16 - 7 = 9
// digits of the coefficients. X'X would have 1e14 and keep two.
TEST(Regression, KeepsDigitsThatNormalEquationsLose) {
  std::vector<double> a, b, drift;
  for (int i = 0; i < 40; ++i) {
    a.push_back(std::sin(0.37 * i));
    b.push_back(a.back() + 1e-7 * std::cos(1.9 * i));
    drift.push_back(1.0 * a.back() + 2.0 * b.back());
  }
  const Record r = record_of({{"a", "K", a}, {"b", "K", b}, {"drift", "um", drift}});
  const Regression fit = fit_one(r, {"a", "b"});
  EXPECT_EQ(fit.rank, 2);
  EXPECT_NEAR(fit.coefficients[0], 1.0, 1e-7);  // 1e7 times a rounding of 1e-16, with a hundredfold reserve
  EXPECT_NEAR(fit.coefficients[1], 2.0, 1e-7);
  EXPECT_GT(fit.condition_number, 1e6);
}

// Longley (1967); certified values of NIST's Statistical Reference Datasets (itl.nist.gov/div898/strd,
// "Longley").
TEST(Regression, ReproducesLongleysCertifiedCoefficients) {
  const Record r = record_of(
      {{"deflator",
        "1",
        {83.0, 88.5, 88.2, 89.5, 96.2, 98.1, 99.0, 100.0, 101.2, 104.6, 108.4, 110.8, 112.6, 114.2, 115.7, 116.9}},
       {"gnp",
        "1",
        {234289, 259426, 258054, 284599, 328975, 346999, 365385, 363112, 397469, 419180, 442769, 444546, 482704, 502601,
         518173, 554894}},
       {"unemployed", "1", {2356, 2325, 3682, 3351, 2099, 1932, 1870, 3578, 2904, 2822, 2936, 4681, 3813, 3931, 4806, 4007}},
       {"forces", "1", {1590, 1456, 1616, 1650, 3099, 3594, 3547, 3350, 3048, 2857, 2798, 2637, 2552, 2514, 2572, 2827}},
       {"population",
        "1",
        {107608, 108632, 109773, 110929, 112075, 113270, 115094, 116219, 117388, 118734, 120445, 121950, 123366, 125368,
         127852, 130081}},
       {"year", "1", {1947, 1948, 1949, 1950, 1951, 1952, 1953, 1954, 1955, 1956, 1957, 1958, 1959, 1960, 1961, 1962}},
       {"drift",
        "1",
        {60323, 61122, 60171, 61187, 63221, 63639, 64989, 63761, 66019, 67857, 68169, 66513, 68655, 69564, 69331, 70551}}});
  const Regression fit = fit_one(r, {"deflator", "gnp", "unemployed", "forces", "population", "year"});
  const std::vector<double> certified = {15.0618722713733,  -0.0358191792925910, -2.02022980381683,
                                         -1.03322686717359, -0.0511041056535807, 1829.15146461355};
  for (std::size_t j = 0; j < certified.size(); ++j) {
    EXPECT_NEAR(fit.coefficients[j] / certified[j], 1.0, 1e-11) << fit.inputs[j];
  }
  EXPECT_NEAR(fit.intercept / -3482258.63459582, 1.0, 1e-11);
  // NIST divides by n - p = 9 degrees of freedom, residual_rms by n = 16.
  EXPECT_NEAR(fit.residual_rms, 304.854073561965 * std::sqrt(9.0 / 16.0), 1e-8);
}

// Two scaled inputs with correlation r have the singular values sqrt(1 +- r) sqrt(n). Orthogonal: 1.
// c = 0.6 a + 0.8 b has r = 0.6 with a: sqrt(1.6 / 0.4) = 2.
TEST(Regression, ConditionNumberIsThatOfTheScaledInputs) {
  const Record r = record_of({{"a", "K", {1001, 999, 1001, 999}},
                              {"b", "V", {1e-3, 1e-3, -1e-3, -1e-3}},
                              {"c", "K", {1.4, 0.2, -0.2, -1.4}},
                              {"drift", "um", {1, 2, 3, 5}}});
  EXPECT_NEAR(fit_one(r, {"a", "b"}).condition_number, 1.0, 1e-12);
  EXPECT_NEAR(fit_one(r, {"a", "c"}).condition_number, 2.0, 1e-12);
}

TEST(Regression, RefusesWhatItCannotFitOrPredict) {
  const Record r = plane({20, 22, NAN}, {20, 21, 22});
  EXPECT_REFUSED(fit_one(r, {"a", "b"}), "3 unknowns but only 2 complete rows");
  EXPECT_REFUSED(fit_one(r, {}), "no input channels");
  EXPECT_THROW((void)fit_one(r, {"nowhere"}), InputError);
  const Regression fit = fit_one(r, {"a"});
  EXPECT_THROW((void)fit.predict(record_of({{"b", "degC", {20}}})), InputError);
  EXPECT_REFUSED(fit.predict(record_of({{"a", "K", {293.15}}})), "is in K, but the regression was fitted in degC");
}

}  // namespace
}  // namespace driftwright::compensation::regression_test
