#pragma once
// The steps from the machine's true outputs to the readings of its instruments: displacements without a thermal cause, and
// errors of sensors. Each effect adds its own step; the chain orders them by stage.

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "base/cyclogram.hpp"

namespace driftwright::effects {

/// The stage of a step; stages are applied in this order.
enum class ReadingStage {
  kGrowth,      ///< displacement in addition to the machine's thermal one
  kScale,       ///< the scale that measures it
  kShift,       ///< a shift of the probe's mount
  kDetachment,  ///< the medium that the sensor touches
  kLag,         ///< the sensor's lag
  kError,       ///< the sensor's error
  kSwap,        ///< the channel that it is written to
  kClock,       ///< the time that it is written at
  kKept,        ///< the share of the result that is kept, for learned models
  kLearned,     ///< what a learned model adds
};

/// Name of the output with the mean temperature of a body. It exists next to the instruments and is in no record.
[[nodiscard]] inline std::string mean_output(const std::string& body) {
  return "mean of " + body;
}
[[nodiscard]] inline bool is_mean_output(const std::string& name) {
  return name.starts_with("mean of ");
}

/// Readings of a run while they pass through the chain.
struct Readings {
  const std::vector<std::string>& name;  ///< of the outputs; their units are "K", "m" or "rad"
  const std::vector<std::string>& unit;
  const std::vector<double>& time_s;  ///< increasing, from 0; values between two of them are linear
  const Cyclogram& cyclogram;         ///< the true one
  const TimeSeries& ambient;          ///< the true one [K]
  Eigen::MatrixXd value;              ///< n_outputs x n_times

  /// The row of a sensor, or of a displacement or tilt. @throws std::logic_error  if there is no such output
  [[nodiscard]] Eigen::Index sensor(const std::string& of) const { return row(of, true); }
  [[nodiscard]] Eigen::Index displacement(const std::string& of) const { return row(of, false); }
  /// The row of a body's mean temperature. @throws std::logic_error  if no effect of the machine uses this body
  [[nodiscard]] Eigen::Index mean_of(const std::string& body) const { return row(mean_output(body), true); }
  [[nodiscard]] Eigen::Index n_times() const { return value.cols(); }
  [[nodiscard]] double time(Eigen::Index i) const { return time_s[static_cast<std::size_t>(i)]; }
  /// True at each time at which the spindle turns.
  [[nodiscard]] std::vector<bool> spindle_turns() const;

 private:
  [[nodiscard]] Eigen::Index row(const std::string& of, bool is_temperature) const;
};

/// The steps of all reading effects of a machine.
class ReadingChain {
 public:
  using Step = std::function<void(Readings&)>;
  void add(ReadingStage stage, Step step);
  [[nodiscard]] bool empty() const { return steps_.empty(); }
  /// Applies all steps. @param outputs  n_outputs x n_times, in the layout of Readings
  [[nodiscard]] Eigen::MatrixXd apply(const std::vector<std::string>& name, const std::vector<std::string>& unit,
                                      const std::vector<double>& time_s, const Cyclogram& cyclogram,
                                      const TimeSeries& ambient, Eigen::MatrixXd outputs) const;

 private:
  std::vector<std::pair<ReadingStage, Step>> steps_;  // by stage; within a stage in the order of adding
};

/// Exact solution x of lag dx/dt = u - x at each time, u constant in each section of the drive, x = 0 at t = 0. With lag 0:
/// u itself.
[[nodiscard]] Eigen::RowVectorXd driven(const std::vector<double>& time_s, const Cyclogram& cyclogram,
                                        const std::function<double(const Drive&)>& u, double lag_s);

/// amount (n / at_speed)^exponent at each time, with or without a lag; exact in each section, zero at t = 0.
[[nodiscard]] Eigen::RowVectorXd speed_growth(const Readings& readings, double amount, double at_speed_rpm, double exponent,
                                              double lag_s);

/// Exact solution y of y' = (x - y) / lag for a signal x that is linear between its samples; y = x at the first one.
/// Replaces x by y.
void lag_behind(Eigen::Ref<Eigen::RowVectorXd> signal, const std::vector<double>& time_s, double lag_s);

}  // namespace driftwright::effects
