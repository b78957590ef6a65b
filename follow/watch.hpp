#pragma once
// Is the machine still as modelled? The residuals of a running observer that reads all thermometers there are, watched over several times.
//
// Each sensor's innovation (reading minus what was expected of it) goes through exponential means of several time constants, m_τ. Over machines that
// are scattered by their priors, and that nothing is wrong with, these means have a covariance C_τ, and their size
//
//     T²_τ = m_τ' C_τ⁻¹ m_τ
//
// exceeds h_τ as seldom as is required. An alarm is raised where one of them exceeds its h, and goes when all have been below half of it for an hour.
// Source: Lowry, Woodall, Champ & Rigdon, Technometrics 34 (1992) 46 (multivariate exponentially weighted mean charts); thresholds are simulated
// (watch_trial.hpp), since innovations of a model that is a little wrong are neither white nor normal.

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compensation/predictors/observer.hpp"

namespace driftwright::follow {

inline constexpr std::array<double, 3> kWatchedOver_s = {600.0, 2400.0, 9600.0};

/// What is usual, by simulation.
struct WatchLimits {
  struct Scale {
    Eigen::MatrixXd covariance;  ///< of the means [K^2], n_sensors x n_sensors
    double threshold = 0.0;      ///< of T²
  };
  std::vector<std::string> sensors;
  std::array<Scale, kWatchedOver_s.size()> scales;
  double machine_days = 0.0;  ///< that were simulated
  int n_alarms = 0;           ///< among them with these thresholds
};

/// Residuals on their way.
class ResidualMeans {
 public:
  explicit ResidualMeans(std::size_t n_sensors);
  /// @param innovation_K  NaN where there is none: the mean then goes to 0
  void take(const std::vector<double>& innovation_K, double step_s);
  [[nodiscard]] const Eigen::VectorXd& mean(std::size_t scale) const { return mean_[scale]; }
  void recall(std::size_t scale, Eigen::VectorXd mean) { mean_[scale] = std::move(mean); }

 private:
  std::array<Eigen::VectorXd, kWatchedOver_s.size()> mean_;
};

/// T² of a scale. @param inverse  of its covariance
[[nodiscard]] double size_of(const Eigen::MatrixXd& inverse, const Eigen::VectorXd& mean);
/// Of a covariance that is regular by a hundredth of its mean variance.
[[nodiscard]] Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& covariance);

class Watch {
 public:
  struct Alarm {
    double since_s = 0.0;  ///< of the run
    std::string words;     ///< "t06 is 0.8 K warmer than the model says, t01 0.5 K warmer; mean over 40 min"
  };
  /// @throws InputError  for limits of sensors that the model has not
  Watch(const compensation::Observer& observer, WatchLimits limits);

  /// Takes the last row of a run. @return the largest T² over its threshold: above 1 is an alarm
  double next(const compensation::ObservedRun& run);
  [[nodiscard]] const std::optional<Alarm>& alarm() const { return alarm_; }
  [[nodiscard]] double level() const { return level_; }
  [[nodiscard]] const WatchLimits& limits() const { return limits_; }

  [[nodiscard]] std::vector<double> memory() const;
  void recall(std::span<const double> memory);

 private:
  [[nodiscard]] std::string words(std::size_t scale) const;

  WatchLimits limits_;
  std::array<Eigen::MatrixXd, kWatchedOver_s.size()> inverse_;
  std::unique_ptr<compensation::Observer> observer_;
  std::unique_ptr<compensation::ObserverFollower> follower_;
  ResidualMeans means_;
  std::optional<Alarm> alarm_;
  double level_ = 0.0, last_s_ = 0.0, calm_s_ = 0.0;
  bool has_row_ = false;
};

}  // namespace driftwright::follow
