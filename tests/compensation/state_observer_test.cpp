// The filter of a state observer against what it is an algorithm for: the least-squares estimate from all readings at once.

#include "compensation/control/state_observer.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <vector>

#include "base/random.hpp"

namespace driftwright::compensation::state_observer_test {
namespace {

constexpr int kRows = 60;
constexpr double kStep_s = 60.0, kPower_W = 10.0;
const Eigen::Vector2d kRate(1.0 / 900.0, 1.0 / 5400.0), kLoad(0.02, 0.005), kOnes(30.0, 70.0), kStart(5.0, -2.0);

/// Two modes, so that each step has a closed form, one heat source, and two thermometers.
struct TwoModes {
  Eigen::Matrix2d conduction = kRate.asDiagonal();
  Eigen::Matrix<double, 2, 3> outputs = (Eigen::Matrix<double, 2, 3>() << 0.03, 0.001, 2e-6, 0.002, 0.012, 1e-6).finished();
  Eigen::Vector3d outputs_ambient = Eigen::Vector3d(0.0, 0.1, 0.0);
  std::array<int, 2> sensor_output = {0, 1};
  Eigen::Vector2d factor_mean = Eigen::Vector2d(0.1, 0.0);
  Eigen::Matrix2d factor_covariance = Eigen::Vector2d(0.04, 0.0025).asDiagonal();
  double rest_W = 0.0, heat_W = kPower_W;
  state_observer core = {};
  std::vector<std::array<double, 2>> reading_C = std::vector<std::array<double, 2>>(kRows);

  TwoModes() {
    core.machine = {.n = 2,
                    .n_sources = 1,
                    .n_exchanges = 0,
                    .conduction = conduction.data(),
                    .loads = kLoad.data(),
                    .exchanges = nullptr,
                    .to_ambient = nullptr,
                    .offsets = nullptr,
                    .ones = kOnes.data()};
    core.settings = {.reading_K = 0.1,
                     .model_K = 0.05,
                     .drift_um = 1.0,
                     .model_um = 0.5,
                     .model_holds_s = 600.0,
                     .factor = 0.2,
                     .factor_walk = 0.3,
                     .longest_step_s = kStep_s,
                     .period_s = kStep_s,
                     .most_apart = 1.0};
    core.n_outputs = 3;
    core.outputs = outputs.data();
    core.outputs_ambient = outputs_ambient.data();
    core.reference_degC = 20.0;
    core.start = kStart.data();
    core.n_sensors = 2;
    core.sensor_output = sensor_output.data();
    core.drift_output = 2;
    core.factor_mean = factor_mean.data();
    core.factor_covariance = factor_covariance.data();
    core.rest_W = &rest_W;
    core.with_drift = 1;  // factors walk at random
    core.keeps_all = 1;
  }

  [[nodiscard]] observer_rows rows() {
    return {
        .of = this,
        .time_s = [](void*, long row) { return kStep_s * static_cast<double>(row); },
        .ambient_K = [](void*, long, double) { return 0.0; },
        .reading_C =
            [](void* of, long row, int sensor) {
              return static_cast<TwoModes*>(of)->reading_C[static_cast<std::size_t>(row)][static_cast<std::size_t>(sensor)];
            },
        .drift_um = [](void*, long) { return std::nan(""); },
        .piece =
            [](void*, long, int piece, double* until_s) {
              *until_s = INFINITY;
              return piece == 0 ? 1 : 0;
            },
        .laws =
            [](void* of, long, int, double, double, double* power_W, double*) {
              *power_W = static_cast<TwoModes*>(of)->heat_W;
              return 0;
            }};
  }
};

/// The state and the factor of a row are linear in what is unknown: how much warmer all was at the start, the factor then,
/// and its change in each step.
struct Unknowns {
  Eigen::Matrix<double, 3, Eigen::Dynamic> slope = Eigen::Matrix<double, 3, Eigen::Dynamic>::Zero(3, kRows + 1);
  Eigen::Vector3d constant = Eigen::Vector3d(kStart(0), kStart(1), 0.0);

  Unknowns() {
    slope.col(0).head(2) = kOnes;
    slope(2, 1) = 1.0;
  }
  void step(int row) {
    for (int i = 0; i < 2; ++i) {
      const double kept = std::exp(-kRate(i) * kStep_s), added = (1.0 - kept) / kRate(i) * kLoad(i) * kPower_W;
      constant(i) = kept * constant(i) + added * (1.0 + constant(2));
      slope.row(i) = kept * slope.row(i) + added * slope.row(2);
    }
    slope(2, 1 + row) = 1.0;
  }
};

TEST(StateObserver, IsTheLeastSquaresEstimateOfAllReadings) {
  TwoModes of;
  Random random(5, 6);
  for (int row = 0; row < kRows; ++row) {  // of another machine; a fifth of the readings is missing
    const double t_s = kStep_s * row;
    for (std::size_t k = 0; k < 2; ++k)
      of.reading_C[static_cast<std::size_t>(row)][k] =
          random.chance(0.2) ? std::nan("")
                             : 20.0 + (k == 0 ? 5.0 : 1.0) * (1.0 - std::exp(-t_s / 1200.0)) + 0.1 * random.normal();
  }
  std::vector<double> remembered(observer_n_remembered(&of.core)), room(observer_n_room(&of.core, 4, 2));
  const observer_run run = observer_run_in(&of.core, remembered.data(), room.data(), 4, 2);
  observer_clear_room(&run);
  observer_start(&run);

  const observer_settings& s = of.core.settings;
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(kRows + 1, kRows + 1);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(kRows + 1), prior = Eigen::VectorXd::Constant(kRows + 1, 0.0);
  information(0, 0) = 1.0 / (0.1 * 0.1);
  information(1, 1) = 1.0 / of.factor_covariance(0, 0);
  right(1) = of.factor_mean(0) / of.factor_covariance(0, 0);
  for (int row = 1; row < kRows; ++row) information(1 + row, 1 + row) = 3600.0 / (s.factor_walk * s.factor_walk * kStep_s);
  Unknowns unknowns;
  std::array<double, 2> last_s = {NAN, NAN};
  const observer_rows rows = of.rows();
  for (int row = 0; row < kRows; ++row) {
    ASSERT_EQ(observer_next(&run, &rows), 0);
    if (row > 0) unknowns.step(row);
    for (std::size_t k = 0; k < 2; ++k) {
      const double read_C = of.reading_C[static_cast<std::size_t>(row)][k], t_s = kStep_s * row;
      if (std::isnan(read_C)) continue;
      ASSERT_EQ(run.readings[k].innovation_K, run.readings[k].deviation_K) << "no reading is ignored";
      const Eigen::Vector2d l = of.outputs.col(static_cast<Eigen::Index>(k));
      const double since_s = std::isnan(last_s[k]) ? kStep_s : t_s - last_s[k];
      last_s[k] = t_s;
      const double variance = s.reading_K * s.reading_K + s.model_K * s.model_K * std::max(1.0, s.model_holds_s / since_s);
      const Eigen::VectorXd h = unknowns.slope.topRows(2).transpose() * l;
      information += h * h.transpose() / variance;
      right += h * (read_C - 20.0 - l.dot(unknowns.constant.head(2))) / variance;
    }
    Eigen::MatrixXd known = information;  // changes of the factor that are still to come tell nothing
    for (int later = row + 1; later < kRows; ++later) known(1 + later, 1 + later) = 1.0;
    const Eigen::MatrixXd covariance = known.inverse();
    const Eigen::Vector3d mean = unknowns.constant + unknowns.slope * (covariance * right);
    const Eigen::Matrix3d spread = unknowns.slope * covariance * unknowns.slope.transpose();
    const Eigen::Map<const Eigen::Matrix<double, 5, 5>> by_filter(run.filter.covariance);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(run.filter.mean[i], mean(i), 1e-8 * std::sqrt(spread(i, i))) << row << " " << i;
      for (int j = 0; j < 3; ++j) {
        EXPECT_NEAR(by_filter(i, j), spread(i, j), 1e-8 * std::sqrt(spread(i, i) * spread(j, j))) << row << " " << i << j;
        EXPECT_EQ(by_filter(i, j), by_filter(j, i));
      }
    }
  }
}

// A single number read again and again: 1 / P = 1 / P0 + n / r.
TEST(StateObserver, ANumberThatStaysIsKnownBetterByEachReading) {
  TwoModes of;
  of.conduction.setZero();
  of.heat_W = 0.0;
  of.factor_covariance.setZero();
  of.core.settings.factor_walk = 0.0;
  of.core.n_sensors = 1;
  for (auto& row : of.reading_C) row = {20.0, NAN};
  std::vector<double> remembered(observer_n_remembered(&of.core)), room(observer_n_room(&of.core, 1, 1));
  const observer_run run = observer_run_in(&of.core, remembered.data(), room.data(), 1, 1);
  observer_clear_room(&run);
  observer_start(&run);
  const observer_rows rows = of.rows();
  const double per_K = of.outputs.col(0).dot(kOnes), r = 0.01 + 0.0025 * 10.0;
  for (int row = 0; row < 10; ++row) {
    ASSERT_EQ(observer_next(&run, &rows), 0);
    const double known = 1.0 / (0.1 * 0.1) + (row + 1) * per_K * per_K / r;
    EXPECT_NEAR(observer_filter_variance(&run.filter, of.outputs.data(), 2), per_K * per_K / known, 1e-12) << row;
  }
}

}  // namespace
}  // namespace driftwright::compensation::state_observer_test
