#pragma once
// What the machine is told and what surrounds it, over time: the drive in sections, ambient temperature in knots.

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

/// What a recorded column says at one time, where an effect drives the machine by it.
struct Signal {
  std::string name;    ///< as the effect calls it
  double value = 0.0;  ///< in the column's unit
  bool operator==(const Signal&) const = default;
};

/// What the machine is told to do at one time.
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
  /// Something recorded beside the drive: a heater's power, the sun. It does nothing by itself: effects that ask for it (recorded_drive) make it
  /// a signal of the sections.
  struct DRIFTWRIGHT_API Column {
    std::string name;  ///< without the unit, as a record's channel
    std::string unit;  ///< one of a record's units
    TimeSeries rows;   ///< in that unit; each value holds from its time on until the next one, none is missing
    [[nodiscard]] std::string header() const { return name + "_" + unit; }
    [[nodiscard]] double at(double time_s) const;  ///< the first value before its time
  };
  std::string name;
  std::vector<Section> sections;
  std::vector<std::string> remarks = {};  ///< for the user: where it comes from and what was passed over there
  std::vector<Column> columns = {};       ///< names are unique
  double clock_s = 0.0;                   ///< the time at its start for laws that begin and end; < 0 of what came before a record

  [[nodiscard]] double duration_s() const;
  /// Drive at time t >= 0 [s]; a section holds from its start on, the last one also at and after its end.
  /// At rest where there is no section.
  [[nodiscard]] Drive drive(double time_s) const;
  [[nodiscard]] double speed_rpm(double time_s) const;
  /// The column of that name, with or without its unit, or nullptr.
  [[nodiscard]] const Column* column(std::string_view name_or_header) const;
};

/// The same cyclogram with its sections split at further times, wherever these lie within one. Durations of the pieces of a section add up to its
/// end to the last bit, so that both cyclograms end at the same time.
/// @param times_s  in any order; those outside, or within 1e-9 of the time of a cut that is there, do nothing
[[nodiscard]] Cyclogram split_at(const Cyclogram& cyclogram, std::vector<double> times_s);

/// The mean drive over all the time of some cyclograms.
[[nodiscard]] Drive mean_drive(const std::vector<const Cyclogram*>& cyclograms);

/// A stretch of time in which the drive is constant and everything else that drives the machine is linear.
struct LinearStretch {
  double start_s = 0.0;
  double end_s = 0.0;
  Drive drive;
  bool drive_changed = false;  ///< true where the drive before start_s was another one, or at t = 0
  std::string_view run = {};   ///< name of the cyclogram, which must outlive the stretch
  double clock_s = 0.0;        ///< Cyclogram::clock_s of it

  /// A time within it at which laws are asked.
  [[nodiscard]] double law_time_s() const { return clock_s + 0.5 * (start_s + end_s); }
};

/// Cuts a cyclogram at its changes of drive and at further knots, in order, without empty pieces.
/// @param knots_s  times at which an integrator must stop although the drive does not change: knots of the ambient
///                 temperature or of prescribed temperatures, onsets of a draught. Any order, repetitions allowed; those
///                 outside the cyclogram do nothing, nor do those within 1e-9 of the time of another cut.
/// @throws std::logic_error  for a knot that is NaN
[[nodiscard]] std::vector<LinearStretch> linear_stretches(const Cyclogram& cyclogram, const std::vector<double>& knots_s);
/// What of them lies behind a time: the one that it divides begins there, and no drive changes with that.
[[nodiscard]] std::vector<LinearStretch> behind(double time_s, std::vector<LinearStretch> stretches);
/// The same with the knots of the ambient temperature alone.
[[nodiscard]] std::vector<LinearStretch> linear_stretches(const Cyclogram& cyclogram, const TimeSeries& ambient);

}  // namespace driftwright
