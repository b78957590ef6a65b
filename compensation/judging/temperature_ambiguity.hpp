#pragma once
// Tests whether the drift is a function of one temperature. If two records have the same reading and different
// displacements, a compensation by this temperature alone cannot serve both.

#include <optional>
#include <span>
#include <string>

#include "base/record.hpp"

namespace driftwright::compensation {

/// One record at the moment its temperature crosses the value in question.
struct Crossing {
  std::string source;  ///< of the record
  double time_s = 0.0;
  double displacement_um = 0.0;
};

struct TemperatureAmbiguity {
  double temperature = 0.0;  ///< in the temperature channel's unit
  Crossing first;            ///< in the record that comes earlier in the span
  Crossing second;
  double spread = 0.0;  ///< |d1 - d2| / min(|d1|, |d2|) [-]; 0.5 means half of the smaller one
};

/// The temperature at which the displacements of two different records differ most in relative terms,
///
///     spread = |d1 - d2| / min(|d1|, |d2|)     over all T and all pairs of crossings with |d1|, |d2| >=
///     floor.
///
/// Records are linear between samples, and every crossing of T counts, with rising and with falling temperature. The
/// search is exact: between two breakpoints of the curves d(T) the ratio of two linear functions is
/// monotone, so only the T of samples and of points where |d| passes the floor must be tried. A segment
/// next to a missing value is left out. Of equal spreads the lowest temperature is reported.
///
/// @param floor_um  smaller displacements are ignored, because their ratio means nothing; > 0
/// @return none if no two records share a temperature with both displacements at or above the floor
/// @throws RangeError  when the floor is not positive
/// @throws InputError  when a record lacks a channel, the displacement is not in um, or the temperature's
/// unit differs
///                     between records
/// Source: the finding of Polyakov, Marusich & Nikitina on a Deckel FP3: 25 um and over 50 % at one
/// temperature.
[[nodiscard]] std::optional<TemperatureAmbiguity> temperature_ambiguity(std::span<const Record> records,
                                                                        const std::string& temperature,
                                                                        const std::string& displacement,
                                                                        double floor_um = 5.0);

}  // namespace driftwright::compensation
