// Numbers as a scenario contains them: digits by their uncertainty, and what the rounding costs, by closed form.

#include "diagnosis/written_numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftwright::diagnosis::written_numbers_test {
namespace {

Knob linear(double nominal) {
  Knob k;
  k.nominal = nominal;
  return k;
}

Knob logarithmic(double nominal) {
  Knob k = linear(nominal);
  k.scale = Knob::Scale::kLog;
  return k;
}

TEST(WithDigits, CountsInTheUnitOfTheFile) {
  const Knob plain = linear(0.0);
  EXPECT_EQ(with_digits(plain, 16.830521, 3), 16.8);
  EXPECT_EQ(with_digits(plain, -0.00075169523, 3), -0.000752);
  EXPECT_EQ(with_digits(plain, 1407.5446, 3), 1410.0);
  EXPECT_EQ(with_digits(plain, 0.0, 3), 0.0);
  Knob time = linear(0.0);
  time.is_time = true;
  EXPECT_EQ(with_digits(time, 5692.3, 3), 60.0 * 94.9);
  Knob temperature = linear(0.0);
  temperature.unit = "degC";
  EXPECT_NEAR(with_digits(temperature, 273.15 + 24.5678, 3), 273.15 + 24.6, 1e-12);
}

TEST(WithFewDigits, TakesMoreDigitsWhereANumberIsKnownBetter) {
  const Knob k = linear(0.0);
  const std::vector<WrittenNumber> one = {{&k, 0, false}};
  const auto rounded = [&](double sd) {
    return with_few_digits(one, Eigen::VectorXd::Constant(1, 16.830521), Eigen::MatrixXd::Constant(1, 1, sd * sd))[0];
  };
  EXPECT_EQ(rounded(0.5), 16.8);      // 0.031 off, a sixteenth of 0.5
  EXPECT_EQ(rounded(0.1), 16.83);     // 0.031 would be a third of 0.1
  EXPECT_EQ(rounded(1e-9), 16.8305);  // six digits at the most
}

TEST(WithFewDigits, KeepsTheScenariosNumberIfItIsAsGood) {
  const Knob k = logarithmic(12.0);
  const Eigen::MatrixXd c = Eigen::MatrixXd::Constant(1, 1, 0.01);  // 10 %
  EXPECT_EQ(with_few_digits({{&k, 0, true}}, Eigen::VectorXd::Constant(1, 0.024), c)[0], 0.0);
  EXPECT_NEAR(k.value(with_few_digits({{&k, 0, true}}, Eigen::VectorXd::Constant(1, 0.06), c)[0]), 12.7, 1e-12);
  EXPECT_NEAR(k.value(with_few_digits({{&k, 0, false}}, Eigen::VectorXd::Constant(1, 0.024), c)[0]), 12.3, 1e-12);
}

// Heat P and conductance G of a body: P / G is known to 1e-4, each alone to 5 %. Both rounded on their own would move P / G
// by up to 2e-3, 20 standard deviations.
TEST(WithFewDigits, LetsTheOtherNumbersFollow) {
  const Knob heat = logarithmic(100.0), conductance = logarithmic(5.0);
  Eigen::MatrixXd c = Eigen::MatrixXd::Constant(2, 2, 0.05 * 0.05);
  c(1, 1) += 1e-8;
  const Eigen::Vector2d x(std::log(1.1234567), std::log(1.1587654));
  const Eigen::VectorXd shorter = with_few_digits({{&heat, 0, true}, {&conductance, 1, true}}, x, c);
  const Eigen::VectorXd by = shorter - x;
  EXPECT_LT(0.5 * by.dot(c.ldlt().solve(by)), 2.0 / 32.0);  // nats; alone: some hundred
  EXPECT_LT(std::abs(by[1] - by[0]), 0.5e-4);
  EXPECT_NEAR(conductance.value(shorter[1]), 5.79, 1e-9);  // the heat then has the digits that P / G needs
}

TEST(WrittenX, LeavesTheScenariosNumbersForCausesOnly) {
  Diagnosis d;
  d.scatter = {logarithmic(12.0), logarithmic(3.0)};
  d.moved = {1};
  d.written.fit.x = Eigen::Vector2d(0.0123456, 0.7654321);
  d.written.fit.covariance = 1e-4 * Eigen::Matrix2d::Identity();
  const Eigen::VectorXd all = written_x(d, false), causes = written_x(d, true);
  EXPECT_NEAR(12.0 * std::exp(all[0]), 12.15, 1e-9);  // 12.1 is 0.4 % off, two fifths of 1 %
  EXPECT_EQ(causes[0], d.written.fit.x[0]);           // not rounded, since it is not written
  EXPECT_NEAR(3.0 * std::exp(causes[1]), 6.45, 1e-9);
  d.written.fit.covariance.resize(0, 0);
  EXPECT_EQ(written_x(d, false), d.written.fit.x);
}

}  // namespace
}  // namespace driftwright::diagnosis::written_numbers_test
