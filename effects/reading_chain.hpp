#pragma once
// From what the machine does to what its instruments say: displacements that no temperature makes, and errors of sensors. Each effect brings its
// own step; the chain has them in the order in which they act.

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "base/cyclogram.hpp"

namespace driftwright::effects {

/// When a step acts.
enum class ReadingStage {
  kGrowth,      ///< what a displacement has beside the machine's
  kScale,       ///< the scale that measures it
  kShift,       ///< its mount
  kDetachment,  ///< what a sensor touches
  kLag,         ///< how it follows
  kError,       ///< what it adds
  kSwap,        ///< whose channel it is written to
  kClock,       ///< and when
  kKept,        ///< how much of all that is believed, where something was learned beside it
  kLearned,     ///< and what
};

/// The output that holds the mean temperature of a body beside what instruments read: it is in no record.
[[nodiscard]] inline std::string mean_output(const std::string& body) {
  return "mean of " + body;
}
[[nodiscard]] inline bool is_mean_output(const std::string& name) {
  return name.starts_with("mean of ");
}

/// Readings of a run on their way through the chain.
struct Readings {
  const std::vector<std::string>& name;  ///< of the outputs, as unit: "K", "m", "rad"
  const std::vector<std::string>& unit;
  const std::vector<double>& time_s;  ///< increasing, from 0; values between two of them are linear
  const Cyclogram& cyclogram;         ///< the true one
  const TimeSeries& ambient;          ///< the true one [K]
  Eigen::MatrixXd value;              ///< n_outputs x n_times

  /// The row of a sensor; of a displacement or tilt. @throws std::logic_error  for a name that is no such output
  [[nodiscard]] Eigen::Index sensor(const std::string& of) const { return row(of, true); }
  [[nodiscard]] Eigen::Index displacement(const std::string& of) const { return row(of, false); }
  /// The row of a body's mean temperature. @throws std::logic_error  where no effect of the machine names the body
  [[nodiscard]] Eigen::Index mean_of(const std::string& body) const { return row(mean_output(body), true); }
  [[nodiscard]] Eigen::Index n_times() const { return value.cols(); }
  [[nodiscard]] double time(Eigen::Index i) const { return time_s[static_cast<std::size_t>(i)]; }
  /// Whether the spindle turns at each time.
  [[nodiscard]] std::vector<bool> spindle_turns() const;

 private:
  [[nodiscard]] Eigen::Index row(const std::string& of, bool is_temperature) const;
};

class ReadingChain {
 public:
  using Step = std::function<void(Readings&)>;
  void add(ReadingStage stage, Step step);
  [[nodiscard]] bool empty() const { return steps_.empty(); }
  /// Readings of a run. @param outputs  n_outputs x n_times, as Readings has them
  [[nodiscard]] Eigen::MatrixXd apply(const std::vector<std::string>& name, const std::vector<std::string>& unit,
                                      const std::vector<double>& time_s, const Cyclogram& cyclogram,
                                      const TimeSeries& ambient, Eigen::MatrixXd outputs) const;

 private:
  std::vector<std::pair<ReadingStage, Step>> steps_;  ///< by stage; within one as they were added
};

/// x at each time, lag dx/dt = u - x, u by the section of the drive, from nothing at t = 0; exactly. Without lag u itself.
[[nodiscard]] Eigen::RowVectorXd driven(const std::vector<double>& time_s, const Cyclogram& cyclogram,
                                        const std::function<double(const Drive&)>& u, double lag_s);

/// amount (n / at_speed)^exponent at each time, at once or with one lag: each section's exact exponential, from nothing at t = 0.
[[nodiscard]] Eigen::RowVectorXd speed_growth(const Readings& readings, double amount, double at_speed_rpm, double exponent,
                                              double lag_s);

/// y' = (x - y) / lag for a signal x that is linear between its samples, exactly; settled at the first one.
void lag_behind(Eigen::Ref<Eigen::RowVectorXd> signal, const std::vector<double>& time_s, double lag_s);

}  // namespace driftwright::effects
