#pragma once
// Watches whether the machine still behaves as modelled, by the residuals of a running observer that reads all
// thermometers, over several time constants.
//
// Each sensor's innovation (reading minus its expected value) is smoothed by exponential means of several time constants,
// m_τ. Over healthy machines, scattered by their priors, these means have a covariance C_τ, and their size
//
//     T²_τ = m_τ' C_τ⁻¹ m_τ
//
// exceeds h_τ as rarely as required. An alarm is raised when one of them exceeds its h, and ends when all have been below
// half of it for an hour.
// Source: Lowry, Woodall, Champ & Rigdon, Technometrics 34 (1992) 46 (multivariate exponentially weighted mean charts);
// thresholds are simulated (watch_trial.hpp), since innovations of a slightly wrong model are neither white nor normal.

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

/// The usual size of the means, from simulation.
struct WatchLimits {
  struct Scale {
    Eigen::MatrixXd covariance;  ///< of the means [K^2], n_sensors x n_sensors
    double threshold = 0.0;      ///< of T²
  };
  std::vector<std::string> sensors;
  std::array<Scale, kWatchedOver_s.size()> scales;
  double machine_days = 0.0;  ///< simulated days, over all machines
  int n_alarms = 0;           ///< alarms on those days with these thresholds
};

/// Exponential means of the residuals.
class ResidualMeans {
 public:
  explicit ResidualMeans(std::size_t n_sensors);
  /// @param innovation_K  NaN where there is none: that mean then decays to 0
  void take(const std::vector<double>& innovation_K, double step_s);
  [[nodiscard]] const Eigen::VectorXd& mean(std::size_t scale) const { return mean_[scale]; }
  void recall(std::size_t scale, Eigen::VectorXd mean) { mean_[scale] = std::move(mean); }

 private:
  std::array<Eigen::VectorXd, kWatchedOver_s.size()> mean_;
};

/// T² of a scale. @param inverse  of its covariance
[[nodiscard]] double size_of(const Eigen::MatrixXd& inverse, const Eigen::VectorXd& mean);
/// The inverse of a covariance, with a hundredth of its mean variance added to the diagonal.
[[nodiscard]] Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& covariance);

class Watch {
 public:
  struct Alarm {
    double since_s = 0.0;  ///< time in the run
    std::string words;     ///< of the last row: "t06 is 0.8 K warmer than the model expects (mean over 40 min)"
  };
  /// @throws InputError  for limits of sensors that the model does not have
  Watch(const compensation::Observer& observer, WatchLimits limits);

  /// Takes the last row of a run. @return the largest T² divided by its threshold; above 1 is an alarm
  double next(const MachineRun& run);
  [[nodiscard]] const std::optional<Alarm>& alarm() const { return alarm_; }
  [[nodiscard]] double level() const { return level_; }
  [[nodiscard]] const WatchLimits& limits() const { return limits_; }

  [[nodiscard]] std::vector<double> memory() const;
  void recall(std::span<const double> memory);

 private:
  /// The scale with the largest T² over its threshold, and that ratio.
  [[nodiscard]] std::pair<std::size_t, double> largest() const;
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
