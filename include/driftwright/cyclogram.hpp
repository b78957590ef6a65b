#pragma once
// What drives a machine over time: the commanded drive in sections of constant speed, feed and power, and recorded columns.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "driftwright/api.hpp"

namespace driftwright {

/// A quantity over time, linear between knots and constant outside them.
struct DRIFTWRIGHT_API TimeSeries {
  std::vector<double> time_s;  ///< strictly increasing
  std::vector<double> value;   ///< same length

  [[nodiscard]] double at(double t_s) const;  ///< @throws std::logic_error  without knots
};

/// The value of a recorded column at one time, for an effect that drives the machine by this column.
struct Signal {
  std::string name;    ///< as the effect calls it
  double value = 0.0;  ///< in the column's unit
  bool operator==(const Signal&) const = default;
};

/// What the machine is commanded to do at one time.
struct Drive {
  double speed_rpm = 0.0;                            ///< of the spindle, >= 0
  std::array<double, 3> feed_m_s = {0.0, 0.0, 0.0};  ///< mean absolute velocity of the axes x, y, z, each >= 0
  double cutting_power_W = 0.0;                      ///< at the cutting edge, >= 0
  std::vector<Signal> signals = {};                  ///< of recorded columns that effects ask for; most machines have none
  bool operator==(const Drive&) const = default;
};

/// The drive over time, piecewise constant. Sections follow each other from t = 0.
struct DRIFTWRIGHT_API Cyclogram {
  struct Section {
    double duration_s = 0.0;
    Drive drive;
    bool operator==(const Section&) const = default;
  };
  /// Something recorded beside the drive: a heater's power, the sun. A column alone changes nothing: an effect that asks for
  /// it (recorded_drive) turns it into a signal of the sections.
  struct DRIFTWRIGHT_API Column {
    std::string name;  ///< without the unit, as a record's channel
    std::string unit;  ///< one of a record's units
    TimeSeries rows;   ///< in that unit; each value holds from its time on until the next one, none is missing
    [[nodiscard]] std::string header() const { return name + "_" + unit; }
    [[nodiscard]] double at(
        double time_s) const;  ///< the value of the row at or before this time; before the first row, the first value
  };
  std::string name;
  std::vector<Section> sections;
  std::vector<std::string> remarks = {};  ///< for the user: where the cyclogram comes from and what was ignored there
  std::vector<Column> columns = {};       ///< names are unique
  double clock_s = 0.0;                   ///< time at its start for laws that begin and end; < 0: the time before a record

  /// Sum of the durations of all sections [s].
  [[nodiscard]] double duration_s() const;
  /// Drive at time t >= 0 [s]. A section applies from its start on, the last one also at and after its end.
  /// Without sections the machine is at rest.
  [[nodiscard]] Drive drive(double time_s) const;
  [[nodiscard]] double speed_rpm(double time_s) const;
  /// The column of that name, with or without its unit, or nullptr.
  [[nodiscard]] const Column* column(std::string_view name_or_header) const;
};

/// The same cyclogram with its sections split at further times that lie within a section. The durations of the pieces of a
/// section add up to its end to the last bit, so both cyclograms end at the same time.
/// @param times_s  in any order; times outside, or within 1e-9 of an existing cut, do nothing
[[nodiscard]] Cyclogram split_at(const Cyclogram& cyclogram, std::vector<double> times_s);

/// The mean drive over the total time of several cyclograms.
[[nodiscard]] Drive mean_drive(const std::vector<const Cyclogram*>& cyclograms);

/// A stretch of time in which the drive is constant and everything else that drives the machine is linear.
struct LinearStretch {
  double start_s = 0.0;
  double end_s = 0.0;
  Drive drive;
  bool drive_changed = false;  ///< true where the drive before start_s was different, or at t = 0
  std::string_view run = {};   ///< name of the cyclogram, which must outlive the stretch
  double clock_s = 0.0;        ///< Cyclogram::clock_s of it

  /// The time at which laws are evaluated for this stretch: its middle, on the clock of the laws.
  [[nodiscard]] double law_time_s() const { return clock_s + 0.5 * (start_s + end_s); }
};

/// Cuts a cyclogram at its changes of drive and at further knots, in order, without empty pieces.
/// @param knots_s  times at which an integrator must stop although the drive does not change: knots of the ambient
///                 temperature or of prescribed temperatures, onsets of a draught. Any order, repetitions allowed; those
///                 outside the cyclogram do nothing, nor do those within 1e-9 of the time of another cut.
/// @throws std::logic_error  for a knot that is NaN
[[nodiscard]] std::vector<LinearStretch> linear_stretches(const Cyclogram& cyclogram, const std::vector<double>& knots_s);
/// The stretches after a time. A stretch that contains the time is cut there; its remaining part counts as "drive not
/// changed".
[[nodiscard]] std::vector<LinearStretch> behind(double time_s, std::vector<LinearStretch> stretches);
/// Cuts a cyclogram at its changes of drive and at the knots of the ambient temperature.
[[nodiscard]] std::vector<LinearStretch> linear_stretches(const Cyclogram& cyclogram, const TimeSeries& ambient);

}  // namespace driftwright
