#pragma once
// A row of a stream: what a source says of one time.

#include <limits>
#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::follow {

struct StreamRow {
  double time_s = std::numeric_limits<double>::quiet_NaN();  ///< by the source's clock; its zero is the source's own
  std::vector<double> values;                                ///< one a channel of the stream, in its unit; NaN where missing
  int n_unreadable = 0;                                      ///< cells that are no number, missing now
};

/// Of usual steps: rows that come later than this miss some between them, and so long a value may be missing from rows that come.
inline constexpr double kMissingSteps = 2.5;

/// A channel that a stream must have.
struct WantedChannel {
  std::string name, unit;
  std::string by;  ///< who wants it, for messages
};

}  // namespace driftwright::follow
