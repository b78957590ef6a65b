#pragma once
// A row of a stream: the values that a source gives for one time.

#include <limits>
#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::follow {

struct StreamRow {
  double time_s = std::numeric_limits<double>::quiet_NaN();  ///< by the source's clock, with the source's own zero
  std::vector<double> values;  ///< one per channel of the stream, in its unit; NaN where missing
  int n_unreadable = 0;        ///< cells that are no number; their values are NaN
};

/// In usual steps: a row that comes later than this has missing rows before it, and a value may be missing this long from
/// rows before its age counts.
inline constexpr double kMissingSteps = 2.5;

/// A column whose numbers are probings: each belongs to the one row that has it. "probe_drift_y" in um: the drift of the
/// axis; "probe_left_drift_y" in um: what was left of it on the corrected axis.
inline constexpr const char* kProbePrefix = "probe_";
inline constexpr const char* kProbeLeftPrefix = "probe_left_";
[[nodiscard]] inline bool is_probing(const Channel& channel) {
  return channel.unit == "um" && channel.name.starts_with(kProbePrefix);
}

/// What the numbers in a column of a stream are, for sources that say in which unit theirs are.
struct ColumnUnit {
  std::string unit;            ///< as UDUNITS reads it; "": nothing says
  bool is_difference = false;  ///< of two temperatures
  bool is_scaled = false;      ///< a map multiplies them or adds to them: they are in `unit` already
};

/// A channel that a stream must have.
struct WantedChannel {
  std::string name, unit;
  std::string by;  ///< the model that requires it, for messages
};

}  // namespace driftwright::follow
