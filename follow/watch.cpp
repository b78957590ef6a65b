#include "follow/watch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace driftwright::follow {
namespace {

constexpr double kCalm = 0.5, kCalmFor_s = 3600.0;  // share of the threshold, and time below it, before an alarm ends
constexpr double kRegular = 0.01;                   // share of the mean variance added to the diagonal
constexpr std::size_t kNamed = 3;                   // most sensors that an alarm names

}  // namespace

ResidualMeans::ResidualMeans(std::size_t n_sensors) {
  mean_.fill(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n_sensors)));
}

void ResidualMeans::take(const std::vector<double>& innovation_K, double step_s) {
  for (std::size_t j = 0; j < mean_.size(); ++j) {
    const double share = 1.0 - std::exp(-step_s / kWatchedOver_s[j]);
    for (std::size_t k = 0; k < innovation_K.size(); ++k) {
      double& m = mean_[j](static_cast<Eigen::Index>(k));
      m += share * ((std::isfinite(innovation_K[k]) ? innovation_K[k] : 0.0) - m);
    }
  }
}

double size_of(const Eigen::MatrixXd& inverse, const Eigen::VectorXd& mean) {
  return mean.dot(inverse * mean);
}

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& covariance) {
  Eigen::MatrixXd c = covariance;
  c.diagonal().array() += kRegular * covariance.diagonal().mean();
  return c.llt().solve(Eigen::MatrixXd::Identity(c.rows(), c.cols()));
}

Watch::Watch(const compensation::Observer& observer, WatchLimits limits)
    : limits_(std::move(limits)),
      observer_(std::make_unique<compensation::Observer>(observer.with_sensors(limits_.sensors))),
      follower_(observer_->watch()),
      means_(limits_.sensors.size()) {
  for (std::size_t j = 0; j < inverse_.size(); ++j) inverse_[j] = inverse_of(limits_.scales[j].covariance);
}

double Watch::next(const MachineRun& run) {
  (void)follower_->next(run);
  const double now_s = run.readings.time_s.back(), step_s = has_row_ ? now_s - last_s_ : 0.0;
  has_row_ = true;
  last_s_ = now_s;
  means_.take(follower_->innovation_K(), step_s);
  const auto [scale, level] = largest();
  level_ = level;
  calm_s_ = level_ < kCalm ? calm_s_ + step_s : 0.0;
  if (level_ > 1.0 && !alarm_) alarm_ = Alarm{now_s, ""};
  if (alarm_ && calm_s_ >= kCalmFor_s) alarm_.reset();
  if (alarm_) alarm_->words = words(scale);
  return level_;
}

std::pair<std::size_t, double> Watch::largest() const {
  std::pair<std::size_t, double> most = {0, 0.0};
  for (std::size_t j = 0; j < inverse_.size(); ++j) {
    const double level = size_of(inverse_[j], means_.mean(j)) / limits_.scales[j].threshold;
    if (level > most.second) most = {j, level};
  }
  return most;
}

std::string Watch::words(std::size_t scale) const {
  const Eigen::VectorXd& mean = means_.mean(scale);
  std::vector<std::size_t> order(limits_.sensors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto weight = [&](std::size_t k) {  // relative to the sensor's usual size
    const auto i = static_cast<Eigen::Index>(k);
    return mean(i) * mean(i) / limits_.scales[scale].covariance(i, i);
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return weight(a) > weight(b); });
  order.resize(std::min(order.size(), kNamed));
  std::vector<std::string> parts;
  for (std::size_t k : order) {
    const double now = follower_->deviation_K()[k], m = std::isfinite(now) ? now : mean(static_cast<Eigen::Index>(k));
    parts.push_back(fmt::format("{} is {:.2f} K {} than the model expects", limits_.sensors[k], std::abs(m),
                                m > 0.0 ? "warmer" : "colder"));
  }
  return fmt::format("{} (the mean over {:.0f} min is beyond its limit)", fmt::join(parts, ", "),
                     kWatchedOver_s[scale] / 60.0);
}

std::vector<double> Watch::memory() const {
  std::vector<double> m = {level_, last_s_, calm_s_, static_cast<double>(has_row_), alarm_ ? alarm_->since_s : -1.0};
  for (std::size_t j = 0; j < kWatchedOver_s.size(); ++j) {
    for (double x : means_.mean(j)) m.push_back(x);
  }
  for (double x : follower_->memory()) m.push_back(x);
  return m;
}

void Watch::recall(std::span<const double> memory) {
  const std::size_t n = limits_.sensors.size(), own = 5 + kWatchedOver_s.size() * n;
  if (memory.size() < own) throw std::logic_error("the memory of another watch");
  level_ = memory[0];
  last_s_ = memory[1];
  calm_s_ = memory[2];
  has_row_ = memory[3] != 0.0;
  for (std::size_t j = 0; j < kWatchedOver_s.size(); ++j)
    means_.recall(j, Eigen::Map<const Eigen::VectorXd>(memory.data() + 5 + j * n, static_cast<Eigen::Index>(n)));
  if (memory[4] >= 0.0) alarm_ = Alarm{memory[4], words(largest().first)};
  follower_->recall(memory.subspan(own));
}

}  // namespace driftwright::follow
