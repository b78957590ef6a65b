#pragma once
// Events that come again and again, as one cause: windows that the waveform of what is missing shows, of one size in all of them.

#include "diagnosis/twin.hpp"
#include "effects/doubt.hpp"

namespace driftwright::diagnosis {

struct Event {
  effects::Doubt
      doubt;  ///< windows of heat or of an exchange, in one run or in several; its numbers: the size, and how much longer
  double price_nats =
      0.0;  ///< of their times, which were read off the data: the logarithm of how many rows each could have begun and ended at
};

/// Where the waveform of a body, missing in the twin as written, has windows, in all runs together.
[[nodiscard]] std::vector<Event> events(const Twin& twin, const std::vector<MeasuredRun>& runs);

}  // namespace driftwright::diagnosis
