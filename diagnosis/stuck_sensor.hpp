#pragma once
// Readings that stand still though the machine moves, and the step of the instrument that they come in.

#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::diagnosis {

/// The step that all values are multiples of, from zero or from the least of them, as instruments have it and as the readings show it,
/// whatever the digits they were written with; 0 for none.
[[nodiscard]] double quantum_of(const std::vector<double>& values);

/// Whether noise moves the readings to and fro from row to row: such a channel never repeats one reading for long.
[[nodiscard]] bool dithers(const std::vector<double>& values);

/// Equal readings in a row that no machine makes.
struct StuckStretch {
  std::size_t first = 0, last = 0;  ///< rows
  std::string neighbour;            ///< channel that tells how far it should have moved; "": readings so fine never repeat
  double missed = 0.0;              ///< by so much, in the channel's unit
};

/// Stretches in which a sensor is stuck (or saturated), in order.
///
/// Fine readings: 30 equal ones in a row. Readings in steps that noise does not blur stand still at rest, too: there the other channels
/// judge. Each is fitted to the channel outside the stretch (itself and behind lags of 15 and 60 min); the one that predicts best stretches
/// as long elsewhere, left out of the fit, says how far the channel should have moved: 5 steps at least, and thrice what it misses elsewhere.
/// A sensor that goes on later must do so by 3 steps at once.
/// @param quantum  of the channel, by quantum_of()
[[nodiscard]] std::vector<StuckStretch> stuck_stretches(const Record& record, const Channel& channel, double quantum);

}  // namespace driftwright::diagnosis
