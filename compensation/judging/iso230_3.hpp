#pragma once
// The figures that ISO 230-3 requires of its tests: thermal distortion caused by a rotating spindle, by moving linear axes,
// and environmental temperature variation.

#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::compensation {

inline constexpr double kHour_s = 3600.0;  ///< the first 60 min, whose range the standard requires

/// The figures of one displacement or tilt X. Ranges are maximum minus minimum, so they do not depend on the zero of the
/// gauge. NaN if the channel has no reading in that time.
struct Iso230Channel {
  std::string name;
  std::string unit;                 ///< of all four numbers: um, mm or urad
  double range_first_60_min = 0.0;  ///< d(X),60: in the first 60 min
  double range_running = 0.0;       ///< d(X),t: in the spindle running period, from its start to t
  double at_end_of_running = 0.0;   ///< X at t, counted from the first reading
  double range_whole_record = 0.0;  ///< including the time at rest after t
};

/// The test that a record is, by what drives the machine in it.
enum class Iso230Test {
  kSpindle,     ///< the spindle turns
  kLinearAxis,  ///< no spindle turns, and axes move
  kAmbient,     ///< nothing moves: environmental temperature variation error (ETVE)
};

/// The figures of all channels. Of kAmbient only the range of the whole record is a figure; the others are NaN.
struct Iso230Figures {
  Iso230Test test = Iso230Test::kSpindle;
  std::string axes = {};                ///< of kLinearAxis: those that move at the start, "x"
  double running_period_s = 0.0;        ///< t: from the start of the record to the last time at which spindle or axes move
  std::vector<Iso230Channel> channels;  ///< displacements and tilts in the record's order
  std::string not_available;            ///< why there are no figures; empty if there are
};

/// The figures of a record. The test requires the spindle, or axes, to move from the start of the record, for at least 60
/// min; stops within the running period belong to it (a spectrum of speeds). The speed or feed of a row applies until the
/// next row; if it is missing, the last one applies. A record in which nothing ever moves is a test of the ambient, of 60
/// min at least.
/// Displacements are linear between readings, so 60 min and t need not be rows.
/// @param record  channels `speed` [rpm], `feed_x`, `feed_y`, `feed_z` [mm/min]; displacements in um or mm, tilts in urad.
///                Where displacements are in um and axes move, columns in mm are places of axes
/// Source: ISO 230-3:2020, clauses 5 to 7; the figures are those of the rotating spindle, also in ISO 10791-10. For moving
///         axes they are taken at each place of the axis that the record has.
[[nodiscard]] Iso230Figures iso230_3_figures(const Record& record);

}  // namespace driftwright::compensation
