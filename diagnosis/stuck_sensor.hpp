#pragma once
// Finds readings that stay constant although the machine changes, and the resolution of the instrument.

#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::diagnosis {

/// The step of which all values are multiples, from zero or from the smallest value: the instrument's resolution as the
/// readings show it, whatever number of digits was written; 0 for none.
[[nodiscard]] double quantum_of(const std::vector<double>& values);

/// Whether noise changes the readings from row to row: such a channel never repeats one value for long.
[[nodiscard]] bool dithers(const std::vector<double>& values);

/// Equal consecutive readings that no machine gives.
struct StuckStretch {
  std::size_t first = 0, last = 0;  ///< rows
  std::string neighbour;            ///< channel that shows how far it should have moved; "": such fine readings never repeat
  double missed = 0.0;              ///< by this amount, in the channel's unit
};

/// Stretches in which a sensor is stuck (or saturated), in order.
///
/// Fine readings: 30 equal ones in a row. Coarse readings without visible noise also stay constant at rest; then the
/// other channels decide. Each is fitted to the channel outside the stretch (as it is, and after lags of 15 and 60 min).
/// The channel that best predicts stretches of the same length elsewhere, left out of the fit, gives the movement that
/// the sensor should have had: at least 5 steps, and three times the error elsewhere. A sensor that recovers must jump by
/// at least 3 steps.
/// @param quantum  of the channel, from quantum_of()
[[nodiscard]] std::vector<StuckStretch> stuck_stretches(const Record& record, const Channel& channel, double quantum);

}  // namespace driftwright::diagnosis
