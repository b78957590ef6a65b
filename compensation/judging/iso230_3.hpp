#pragma once
// The figures that ISO 230-3 requires of a test of thermal distortion caused by a rotating spindle.

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

/// The figures of all channels.
struct Iso230Figures {
  double running_period_s = 0.0;        ///< t: from the start of the record to the last time at which the spindle turns
  std::vector<Iso230Channel> channels;  ///< displacements and tilts in the record's order
  std::string not_available;            ///< why there are no figures; empty if there are
};

/// The figures of a record. The test requires the spindle to turn from the start of the record, for at least 60 min; stops
/// within the running period belong to it (a spectrum of speeds). The speed of a row applies until the next row; if it is
/// missing, the last one applies. Displacements are linear between readings, so 60 min and t need not be rows.
/// @param record  channels `speed` [rpm]; displacements in um or mm, tilts in urad
/// Source: ISO 230-3:2020, thermal distortion caused by rotating spindle; the same figures in ISO 10791-10.
[[nodiscard]] Iso230Figures iso230_3_figures(const Record& record);

}  // namespace driftwright::compensation
