#pragma once
// From what the machine does to what its instruments say: displacements that no temperature makes, and errors of sensors.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/cyclogram.hpp"

namespace driftwright::effects {

/// Steps in the order in which they act.
struct ReadingChain {
  /// amount (n / at_speed)^exponent, reached with one lag, of which nothing has grown at t = 0; without lag at once.
  struct Growth {
    std::string displacement;  ///< or tilt
    double amount = 0.0;       ///< [m] or [rad]
    double at_speed_rpm = 1000.0, exponent = 1.0, lag_s = 0.0;
  };
  std::vector<Growth> growths;
  /// factor x displacement, behind one lag that is settled at the first reading.
  struct Scale {
    std::string displacement;  ///< or tilt
    double factor = 1.0, lag_s = 0.0;
  };
  std::vector<Scale> scales;
  struct Shift {
    std::string displacement;
    double amount = 0.0;  ///< [m] or [rad]
    double time_s = 0.0;
    std::string in = {};  ///< name of the cyclogram; "": in each
  };
  std::vector<Shift> shifts;
  /// From a time on the reading is share x air + (1 - share) x body.
  struct Detachment {
    std::string sensor;
    double share = 0.0, time_s = 0.0;
    std::string in = {};
  };
  std::vector<Detachment> detachments;
  struct Lag {
    std::string sensor;
    double lag_s = 0.0;
  };
  std::vector<Lag> lags;
  struct Error {
    std::string sensor;
    double bias_K = 0.0, drift_K_s = 0.0;
  };
  std::vector<Error> errors;
  struct Swap {
    std::string a, b;
  };
  std::vector<Swap> swaps;
  double clock_offset_s = 0.0;  ///< > 0: a reading carries a later time than it was taken at

  [[nodiscard]] bool empty() const {
    return growths.empty() && scales.empty() && shifts.empty() && detachments.empty() && lags.empty() && errors.empty() &&
           swaps.empty() && clock_offset_s == 0.0;
  }
};

/// Readings of a run.
/// @param name, unit  of the outputs, as solver::Outputs has them: "K", "m", "rad"
/// @param time_s      increasing, from 0; values between two of them are linear
/// @param cyclogram   the true one
/// @param hall        the true one [K]
/// @param outputs     n_outputs x n_times
/// @throws std::logic_error  for a name that is no output
[[nodiscard]] Eigen::MatrixXd readings(const ReadingChain& chain, const std::vector<std::string>& name,
                                       const std::vector<std::string>& unit, const std::vector<double>& time_s,
                                       const Cyclogram& cyclogram, const TimeSeries& hall, Eigen::MatrixXd outputs);

}  // namespace driftwright::effects
