#pragma once
// The inputs that drive a machine, with the first-order lag of a body.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "identification/record_roles.hpp"

namespace driftwright::identification {

/// Share of the top speed above which a spindle turns: smaller values are a tachometer's noise at rest.
inline constexpr double kTurns = 0.01;

/// Heating by a drive, scaled to between 0 and 1 (or -1 and 1) over the records.
struct Law {
  enum class Kind { kTurning, kPower, kColumn };
  Kind kind = Kind::kTurning;
  std::string channel;
  double exponent = 1.0;  ///< of kPower
  double sign = 1.0;      ///< of kColumn: -1 if it cools
  double top = 1.0;       ///< the channel's largest absolute value in the records, at which the law is 1
  [[nodiscard]] double value(double of_channel) const;
};

/// Values of a law in a record's rows. held(): a channel in which a missing value is replaced by the last valid one, before
/// that by the first.
[[nodiscard]] Eigen::VectorXd values_of(const Law& law, const Record& record);
[[nodiscard]] Eigen::VectorXd held(const Channel& channel);

/// x of tau dx/dt = u - x at the rows, u held from each row on, x = 0 at the first.
[[nodiscard]] Eigen::VectorXd lagged_steps(std::span<const double> time_s, const Eigen::VectorXd& u, double tau_s);
/// The same for an input that is linear between rows, with x = u at the first.
[[nodiscard]] Eigen::VectorXd lagged_ramps(std::span<const double> time_s, const Eigen::VectorXd& u, double tau_s);

}  // namespace driftwright::identification
