// A regression on a record's own columns: it finds what follows them, and what is kept out is not seen.

#include "diagnosis/plain_regression.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"

namespace driftwright::diagnosis::plain_regression_test {
namespace {

/// Ten hours of a cyclogram whose growth is 20 um at 2000 rpm after a lag of 20 min, beside a thermometer of the same
/// course, 0.1 um noise.
MeasuredRun growing(std::uint64_t seed) {
  MeasuredRun run;
  run.name = "run";
  for (int i = 0; i <= 600; ++i) run.time_s.push_back(60.0 * i);
  Random random(seed, 0);
  for (int section = 0; section < 10; ++section)
    run.cyclogram.sections.push_back(
        {.duration_s = 3600.0, .drive = {.speed_rpm = section % 2 ? 2000.0 * random.uniform() : 0.0}});
  run.ambient = {{0.0}, {0.0}};
  Eigen::VectorXd growth(601), warm(601);
  double lagged = 0.0;
  for (int i = 0; i <= 600; ++i) {
    growth[i] = 20e-6 * lagged + 0.1e-6 * random.normal();
    warm[i] = 5.0 * lagged + 0.05 * random.normal();
    lagged += (run.cyclogram.speed_rpm(60.0 * i) / 2000.0 - lagged) * -std::expm1(-60.0 / 1200.0);
  }
  run.channels = {{.name = "tip", .output = 1, .unit = "m", .value = growth},
                  {.name = "head", .output = 0, .unit = "K", .value = warm}};
  return run;
}

double rms_behind(const Prediction& p, const MeasuredRun& run, std::size_t channel, Eigen::Index from) {
  const MeasuredChannel& c = run.channels[channel];
  const Eigen::VectorXd miss = c.value - p[0].row(c.output).transpose();
  return std::sqrt(miss.tail(miss.size() - from).squaredNorm() / static_cast<double>(miss.size() - from));
}

// Without noise 0.04 um are left. With 0.1 um of noise three speeds hardly distinguish n from n², and the error at the
// fourth speed is 0.45 um of some 20.
TEST(PlainRegression, PredictsWhatFollowsTheDriveOnRowsItHasNotSeen) {
  const MeasuredRun run = growing(1);
  MeasuredRun fitted = run;
  for (MeasuredChannel& c : fitted.channels) c.value.tail(200).setConstant(std::nan(""));
  for (Regressors regressors : {Regressors::kDrive, Regressors::kDriveAndReadings})
    EXPECT_LT(rms_behind(plain_regression({run}, {fitted}, 2, regressors), run, 0, 401), 0.6e-6);
}

TEST(PlainRegression, DoesNotLookAtReadingsThatAreKeptOut) {
  const MeasuredRun run = growing(2);
  MeasuredRun fitted = run, other = run;
  fitted.channels[0].value.tail(200).setConstant(std::nan(""));
  other.channels[0].value.tail(200).array() += 1e-3;
  EXPECT_EQ(plain_regression({run}, {fitted}, 2, Regressors::kDrive)[0],
            plain_regression({other}, {fitted}, 2, Regressors::kDrive)[0]);
}

TEST(PlainRegression, TakesThermometersWhereTheyAreAskedFor) {
  MeasuredRun run = growing(3);
  for (Eigen::Index i = 0; i <= 600; ++i) {  // unrelated to the drive
    const double wave = std::sin(static_cast<double>(i) / 60.0);
    run.channels[0].value[i] += 8e-6 * wave;
    run.channels[1].value[i] += 2.0 * wave;
  }
  MeasuredRun fitted = run;
  for (MeasuredChannel& c : fitted.channels) c.value.tail(200).setConstant(std::nan(""));
  EXPECT_GT(rms_behind(plain_regression({run}, {fitted}, 2, Regressors::kDrive), run, 0, 401), 4e-6);
  EXPECT_LT(rms_behind(plain_regression({run}, {fitted}, 2, Regressors::kDriveAndReadings), run, 0, 401), 0.6e-6);
}

}  // namespace
}  // namespace driftwright::diagnosis::plain_regression_test
