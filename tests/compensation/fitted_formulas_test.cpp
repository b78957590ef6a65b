// Each kind of regression against a closed form, against least squares where it must be that, and on laws known beforehand.

#include "compensation/predictors/fitted_formulas.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <set>

#include "base/errors.hpp"
#include "compensation/sensors/product_sums.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/sensor_records.hpp"

namespace driftwright::compensation::fitted_formulas_test {
namespace {

using ::testing::HasSubstr;

using Fit = std::function<FittedFormula(std::span<const Record>, const std::vector<std::string>&, const std::string&)>;
const std::vector<Fit> kFits = {
    fit_ridge, fit_principal_components, fit_partial_least_squares,
    [](auto records, const auto& inputs, const auto& target) { return fit_with_lags(records, inputs, target); }};

std::vector<Record> three_records(int n_sensors, double noise_um) {
  std::vector<Record> records;
  for (std::uint64_t r = 0; r < 3; ++r)
    records.push_back(fixtures::sensor_record(90 + r, 200 + 50 * static_cast<int>(r), n_sensors, 0.05, noise_um));
  return records;
}

void expect_same_formula(const DriftModel& a, const DriftModel& b, double relative) {
  ASSERT_EQ(a.terms.size(), b.terms.size());
  double most = 0.0;
  for (const DriftModel::Term& t : b.terms) most = std::max(most, std::abs(t.coefficient));
  for (std::size_t j = 0; j < a.terms.size(); ++j) {
    EXPECT_EQ(a.terms[j].input, b.terms[j].input);
    EXPECT_EQ(a.terms[j].unit, b.terms[j].unit);
    EXPECT_NEAR(a.terms[j].coefficient, b.terms[j].coefficient, relative * most) << a.terms[j].input;
  }
  EXPECT_NEAR(a.intercept, b.intercept, 100.0 * relative * most);  // 20 degC times the coefficients, several of them
}

// A drift that is a plane without noise: nothing less than all components, and no penalty, predicts left-out runs as well.
TEST(Formulas, WithNothingLeftOutAreLeastSquares) {
  const std::vector<Record> records = three_records(5, 0.0);
  const std::vector<std::string> inputs = fixtures::sensor_names(5);
  const DriftModel plain = as_drift_model(fit_regression(records, inputs, "drift_y"));
  const FittedFormula ridge = fit_ridge(records, inputs, "drift_y"),
                      principal = fit_principal_components(records, inputs, "drift_y"),
                      partial = fit_partial_least_squares(records, inputs, "drift_y");
  EXPECT_THAT(ridge.reason, HasSubstr("ridge penalty 0:"));
  EXPECT_THAT(principal.reason, HasSubstr("5 of 5 components"));
  EXPECT_THAT(partial.reason, HasSubstr("5 of 5 components"));
  for (const FittedFormula* f : {&ridge, &principal, &partial}) {
    expect_same_formula(f->model, plain, 1e-10);  // VIF below 1e3 here, sums lose its square root twice
    EXPECT_LT(f->held_out_rmse, 1e-6);            // sqrt(1e-16) of a drift of 30 um
  }
}

/// Least squares by its library on centred columns of unit deviation, one or the other way; slopes per unit of the inputs.
Eigen::VectorXd by_rows(const std::vector<Record>& records, int m,
                        const std::function<Eigen::VectorXd(const Eigen::MatrixXd&, const Eigen::VectorXd&)>& fit) {
  std::vector<double> flat;
  Eigen::Index n = 0;
  for (const Record& r : records) n += static_cast<Eigen::Index>(r.n_samples());
  Eigen::MatrixXd x(n, m);
  Eigen::VectorXd y(n);
  Eigen::Index i = 0;
  for (const Record& r : records) {
    for (std::size_t k = 0; k < r.n_samples(); ++k, ++i) {
      for (int j = 0; j < m; ++j) x(i, j) = r.channels[static_cast<std::size_t>(j)].values[k];
      y(i) = r.channels[static_cast<std::size_t>(m)].values[k];
    }
  }
  x.rowwise() -= x.colwise().mean().eval();
  y.array() -= y.mean();
  const Eigen::RowVectorXd deviation = x.colwise().norm() / std::sqrt(static_cast<double>(n));
  x.array().rowwise() /= deviation.array();
  return fit(x, y).array() / deviation.transpose().array();
}

/// The first of two sensors of equal weight in a drift along their mean: one component is all there is.
std::vector<Record> of_one_component(double noise_um) {
  std::vector<Record> records = three_records(2, 0.0);
  Random random(5);
  for (Record& r : records) {
    for (std::size_t i = 0; i < r.n_samples(); ++i) {
      const double base = std::sin(static_cast<double>(i) / 30.0) + (&r - records.data());
      r.channels[0].values[i] = 20.0 + base + 0.3 * random.normal();
      r.channels[1].values[i] = 20.0 + base + 0.3 * random.normal();
      r.channels[2].values[i] = 3.0 * base + noise_um * random.normal();
    }
  }
  return records;
}

// One component of PLS: w = X'y, t = X w, slope = w (t'y)/(t't) = w (w'w)/(w'X'X w).
TEST(PartialLeastSquares, OfOneComponentIsItsClosedForm) {
  const std::vector<Record> records = of_one_component(1.0);
  const FittedFormula f = fit_partial_least_squares(records, {"X1", "X2"}, "drift_y");
  ASSERT_THAT(f.reason, HasSubstr("1 of 2 components"));
  const Eigen::VectorXd expected =
      by_rows(records, 2, [](const Eigen::MatrixXd& x, const Eigen::VectorXd& y) -> Eigen::VectorXd {
        const Eigen::VectorXd w = x.transpose() * y;
        return w * w.squaredNorm() / (x * w).squaredNorm();
      });
  for (int j = 0; j < 2; ++j) EXPECT_NEAR(f.model.terms[static_cast<std::size_t>(j)].coefficient / expected(j), 1.0, 1e-11);
}

// Two columns of unit deviation have the components (1, 1) and (1, -1) over sqrt(2), whatever their correlation.
TEST(PrincipalComponents, OfTwoSensorsTheFirstIsTheirMean) {
  const std::vector<Record> records = of_one_component(1.0);
  const FittedFormula f = fit_principal_components(records, {"X1", "X2"}, "drift_y");
  ASSERT_THAT(f.reason, HasSubstr("1 of 2 components"));
  const Eigen::VectorXd expected =
      by_rows(records, 2, [](const Eigen::MatrixXd& x, const Eigen::VectorXd& y) -> Eigen::VectorXd {
        const Eigen::VectorXd t = x.col(0) + x.col(1);
        return Eigen::Vector2d::Constant(t.dot(y) / t.squaredNorm());
      });
  for (int j = 0; j < 2; ++j) EXPECT_NEAR(f.model.terms[static_cast<std::size_t>(j)].coefficient / expected(j), 1.0, 1e-11);
}

TEST(Ridge, SolvesItsNormalEquations) {
  std::vector<Record> records = of_one_component(3.0);
  const FittedFormula f = fit_ridge(records, {"X1", "X2"}, "drift_y");
  const auto at = f.reason.find("ridge penalty ");
  ASSERT_NE(at, std::string::npos);
  const double penalty = std::stod(f.reason.substr(at + 14));
  EXPECT_GT(penalty, 0.0);
  const Eigen::VectorXd expected =
      by_rows(records, 2, [&](const Eigen::MatrixXd& x, const Eigen::VectorXd& y) -> Eigen::VectorXd {
        const double n = static_cast<double>(x.rows());
        return (x.transpose() * x / n + penalty * Eigen::Matrix2d::Identity()).inverse() * (x.transpose() * y) / n;
      });
  for (int j = 0; j < 2; ++j) EXPECT_NEAR(f.model.terms[static_cast<std::size_t>(j)].coefficient / expected(j), 1.0, 1e-11);
}

TEST(Formulas, SurviveASensorThatStandsStillInAllRunsButOne) {
  for (const double stands_at : {20.0, 21.7, 19.999, 22.3, 24.1}) {
    std::vector<Record> records = three_records(3, 0.2);
    for (std::size_t r = 0; r < 2; ++r)
      std::fill(records[r].channels[1].values.begin(), records[r].channels[1].values.end(), stands_at);
    for (Record& r : records) {
      for (std::size_t i = 0; i < r.n_samples(); ++i)  // it has no part in the drift
        r.channels[3].values[i] =
            r.channels[0].values[i] + 3.0 * r.channels[2].values[i] + 0.1 * std::sin(9.0 * static_cast<double>(i));
    }
    const double alone_um = held_out_rmse(product_sums(records, {"X2"}, "drift_y"), std::vector<int>{0});
    for (const Fit& fit : kFits)
      EXPECT_LT(fit(records, fixtures::sensor_names(3), "drift_y").held_out_rmse, 0.2) << stands_at;  // 0.07 of the sine
    // of one sensor both are least squares, and without the only run in which it moves it shows nothing
    for (const auto& fit : {fit_principal_components, fit_partial_least_squares})
      EXPECT_NEAR(fit(records, {"X2"}, "drift_y").held_out_rmse / alone_um, 1.0, 1e-9) << stands_at;
  }
}

/// A sensor of random steps; the drift 3 um/K after its first-order lag of 20 min, dL/dt = (x - L)/tau between linear
/// readings.
Record lagging(std::uint64_t seed) {
  Random random(seed);
  Record r{.source = "lag", .time_s = {}, .channels = {{"X1", "degC", {}}, {"drift_y", "um", {}}}};
  double x = 20.0, lag = x, towards = x;
  for (int i = 0; i < 400; ++i) {
    r.time_s.push_back(60.0 * i);
    r.channels[0].values.push_back(x);
    r.channels[1].values.push_back(1.5 * (x - 20.0) + 3.0 * (lag - 20.0) + 7.0);
    if (random.chance(0.02)) towards = random.uniform(15.0, 40.0);
    const double next = x + 0.1 * (towards - x);
    for (int s = 0; s < 600; ++s)
      lag += 0.1 / 1200.0 * (x + (next - x) * (s + 0.5) / 600.0 - lag);  // 0.1 s: 4e-5 of the truth
    x = next;
  }
  return r;
}

TEST(WithLags, FindsALagOfTwentyMinutes) {
  const std::vector<Record> records = {lagging(1), lagging(2), lagging(3)};
  const FittedFormula f = fit_with_lags(records, {"X1"}, "drift_y");
  EXPECT_THAT(f.reason, HasSubstr("a lag of 20 min"));
  ASSERT_EQ(f.model.terms.size(), 2u);
  // The lag is exact to second order in the row, 1/12 (60/1200) (a change in slope per row): 1e-3 here.
  EXPECT_EQ(f.model.terms[0].lag_s, 0.0);
  EXPECT_EQ(f.model.terms[1].lag_s, 1200.0);
  EXPECT_NEAR(f.model.terms[0].coefficient, 1.5, 3e-3);
  EXPECT_NEAR(f.model.terms[1].coefficient, 3.0, 3e-3);
  EXPECT_LT(f.held_out_rmse, 0.02);
  const Record judged = lagging(4);
  const std::vector<double> predicted = f.model.predict(judged);
  for (std::size_t i = 0; i < predicted.size(); ++i) EXPECT_NEAR(predicted[i], judged.channels[1].values[i], 0.1);
}

/// Drift of a drive, tau d' + d = 1e-6 n^2 + 0.002 n at tau = 35 min, exact between rows; and the ambient at 0.5 um/K
/// after 100 min.
Record driven(std::uint64_t seed, double ambient_um_K) {
  Random random(seed);
  Record r{
      .source = "driven", .time_s = {}, .channels = {{"speed", "rpm", {}}, {"ambient", "degC", {}}, {"drift_y", "um", {}}}};
  double speed = 2000.0 * random.uniform(), ambient = 20.0, lag = 0.0, lag_ambient = 20.0;
  for (int i = 0; i < 500; ++i) {
    r.time_s.push_back(60.0 * i);
    r.channels[0].values.push_back(speed);
    r.channels[1].values.push_back(ambient);
    r.channels[2].values.push_back(lag + ambient_um_K * (lag_ambient - 20.0));
    lag += (1.0 - std::exp(-60.0 / 2100.0)) * (1e-6 * speed * speed + 0.002 * speed - lag);
    const double next = 20.0 + 4.0 * std::sin(2e-2 * i + static_cast<double>(seed));
    lag_ambient += (1.0 - std::exp(-60.0 / 6000.0)) * (0.5 * (ambient + next) - lag_ambient);
    ambient = next;
    if (random.chance(0.03)) speed = 4000.0 * random.uniform();
  }
  return r;
}

TEST(FromSpeed, FindsGainAndTimeConstant) {
  const std::vector<Record> records = {driven(1, 0.0), driven(2, 0.0), driven(3, 0.0)};
  const FittedFormula f = fit_from_speed(records, "speed", "", "drift_y");
  EXPECT_LT(f.held_out_rmse, 1e-6);
  double linear = 0.0, square = 0.0;
  for (const DriftModel::Term& t : f.model.terms) {
    EXPECT_EQ(t.input, "speed");
    if (std::abs(t.coefficient) * (t.power == 1 ? 4e3 : 1.6e7) < 1e-4) continue;  // a lag added on rounding
    EXPECT_EQ(t.lag_s, 2100.0);
    (t.power == 1 ? linear : square) += t.coefficient;
  }
  EXPECT_NEAR(linear, 0.002, 1e-9);
  EXPECT_NEAR(square, 1e-6, 1e-12);
}

TEST(FromSpeed, FindsTheAmbientBesideIt) {
  const std::vector<Record> records = {driven(1, 0.5), driven(2, 0.5), driven(3, 0.5)};
  const FittedFormula f = fit_from_speed(records, "speed", "ambient", "drift_y");
  EXPECT_LT(f.held_out_rmse, 1e-5);
  bool has_ambient = false;
  for (const DriftModel::Term& t : f.model.terms) {
    if (t.input != "ambient") continue;
    has_ambient = true;
    EXPECT_EQ(t.lag_s, 6000.0);
    EXPECT_NEAR(t.coefficient, 0.5, 1e-5);
  }
  EXPECT_TRUE(has_ambient);
}

TEST(FromSpeed, GoesOnWithoutAnAmbientThatNeverChanges) {
  std::vector<Record> records = {driven(1, 0.0), driven(2, 0.0)};
  for (Record& r : records) std::fill(r.channels[1].values.begin(), r.channels[1].values.end(), 20.0);
  const FittedFormula f = fit_from_speed(records, "speed", "ambient", "drift_y");
  for (const DriftModel::Term& t : f.model.terms) EXPECT_EQ(t.input, "speed");
  EXPECT_LT(f.held_out_rmse, 1e-5);
}

TEST(Formulas, OfOneRunOrTooFewRowsAreRefused) {
  const std::vector<Record> one = {fixtures::sensor_record(1, 60, 3)},
                            few = {fixtures::sensor_record(1, 3, 3), fixtures::sensor_record(2, 60, 3)};
  for (const Fit& fit : kFits) {
    EXPECT_REFUSED(fit(one, fixtures::sensor_names(3), "drift_y"), "two training records");
    EXPECT_REFUSED(fit(few, fixtures::sensor_names(3), "drift_y"), "but only 3 complete rows");
  }
  EXPECT_THROW((void)fit_from_speed({}, "speed", "", "drift_y"), InputError);
}

// tau = 60 s, step 1 at t = 0 of a drive: 1 - exp(-t/tau) from the row after. Of a temperature that ramps, r (t - tau (1
// - exp(-t/tau))).
TEST(Lagged, IsTheFirstOrderLagOfStepsAndRamps) {
  std::vector<double> t, step, ramp;
  for (int i = 0; i < 60; ++i) {
    t.push_back(2.0 * i);
    step.push_back(3.0);
    ramp.push_back(20.0 + 0.01 * t.back());
  }
  const std::vector<double> of_step = lagged(t, step, 2, 60.0, true), of_ramp = lagged(t, ramp, 1, 60.0, false);
  for (std::size_t i = 0; i < t.size(); ++i) {
    EXPECT_NEAR(of_step[i], 9.0 * (1.0 - std::exp(-t[i] / 60.0)), 1e-12);
    EXPECT_NEAR(of_ramp[i] - 20.0, 0.01 * (t[i] - 60.0 * (1.0 - std::exp(-t[i] / 60.0))), 1e-4);  // h^2 / (12 tau) r = 6e-5
  }
  EXPECT_EQ(lagged(t, step, 1, 0.0, true), step);
}

TEST(Lagged, WaitsWhileAReadingIsMissing) {
  const std::vector<double> t = {0, 60, 120, 180}, x = {1, 1, NAN, 1};
  const std::vector<double> l = lagged(t, x, 1, 100.0, true);
  EXPECT_TRUE(std::isnan(l[2]));
  EXPECT_NEAR(l[3], 1.0 - std::exp(-1.8), 1e-14);
}

TEST(DriftModel, CountsTemperaturesFromTheirFirstReadingAndSpeedsNot) {
  const DriftModel model{
      .kind = "",
      .target = "d",
      .target_unit = "um",
      .intercept = 1.0,
      .terms = {{.input = "T", .unit = "degC", .coefficient = 2.0}, {.input = "n", .unit = "rpm", .coefficient = 0.01}},
      .from_start = true};
  const Record r{.source = "r",
                 .time_s = {0, 1, 2},
                 .channels = {{"T", "degC", {NAN, 21, 23}}, {"n", "rpm", {100, 200, 300}}, {"d", "um", {5, 6, 9}}}};
  const std::vector<double> d = model.predict(r);
  EXPECT_TRUE(std::isnan(d[0]));
  EXPECT_DOUBLE_EQ(d[1], 1.0 + 0.0 + 2.0);
  EXPECT_DOUBLE_EQ(d[2], 1.0 + 4.0 + 3.0);
  const Record rises = counted_from_start(r, "d");
  EXPECT_EQ(rises.channels[0].values[2], 2.0);
  EXPECT_EQ(rises.channels[1].values, r.channels[1].values);
  EXPECT_EQ(rises.channels[2].values[2], 4.0);
  Record kelvin = r;
  kelvin.channels[0].unit = "K";
  EXPECT_REFUSED(model.predict(kelvin), "is in K, but the model was fitted in degC");
}

}  // namespace
}  // namespace driftwright::compensation::fitted_formulas_test
