#pragma once
// What the machine is told and what surrounds it, over time: spindle speed in sections, hall temperature in knots.

#include <string>
#include <vector>

namespace driftwright {

/// Spindle speed, piecewise constant. Sections follow each other from t = 0.
struct Cyclogram {
  struct Section {
    double duration_s = 0.0;
    double speed_rpm = 0.0;
    bool operator==(const Section&) const = default;
  };
  std::string name;
  std::vector<Section> sections;

  [[nodiscard]] double duration_s() const;
  /// Speed at time t >= 0 [s]; a section holds from its start on, the last one also at and after its end.
  [[nodiscard]] double speed_rpm(double time_s) const;
};

/// A quantity over time, linear between knots and constant outside them.
struct TimeSeries {
  std::vector<double> time_s;  ///< strictly increasing
  std::vector<double> value;   ///< same length

  [[nodiscard]] double at(double t_s) const;
};

/// A stretch of time in which the speed is constant and the hall temperature is linear.
struct LinearStretch {
  double start_s = 0.0;
  double end_s = 0.0;
  double speed_rpm = 0.0;
  bool speed_changed = false;  ///< true where the speed before start_s was another one, or at t = 0
};

/// Cuts a cyclogram at its changes of speed and at the knots of `hall`, in order, without empty pieces.
[[nodiscard]] std::vector<LinearStretch> linear_stretches(const Cyclogram& cyclogram, const TimeSeries& hall);

}  // namespace driftwright
