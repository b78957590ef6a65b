#pragma once
// The 95 % band about simulated channels that follows from how well a scenario is known:
// its numbers (`known_to`), and what was learned beside them (`misses`).

#include <optional>

#include "base/listener.hpp"
#include "base/record_band.hpp"
#include "machine/simulated_run.hpp"

namespace driftwright::studies {

/// Number of machines that a band is made of, where a run takes about a millisecond; otherwise about four times the number
/// of uncertain numbers, at least 80.
inline constexpr int kBandDraws = 200;

/// What a band is about: a run of a machine, already simulated.
struct BandedRun {
  const scenarios::Model& model;  ///< that was run
  const Cyclogram& cyclogram;     ///< as recorded
  const TimeSeries& ambient;      ///< as recorded, minus the reference temperature [K]
  const Record& record;           ///< what was simulated; its first row may be later than the run's start
  double first_row_s = 0.0;       ///< time of the first row from the start of the run
};

/// The band about the displacements, tilts and temperatures of a run. Machines are drawn whose numbers differ from the
/// scenario's: ln(x / x_scenario) is normal with the standard deviation that `known_to` says, independently for each number,
/// or together as a fit left them (`known_together`); numbers without either are exact. Draws are a Latin hypercube with a
/// fixed seed, so the band is the same in each run.
/// The reduced model runs each machine (of a lumped machine it is exact), and the band holds the middle 95 % of their
/// differences from the machine as written (band_limits.hpp), added to the record. At most 250 rows are computed; between
/// them the differences are linear.
/// A channel with effects `learned` that say what they still miss (`misses`, one sigma) has a band 1.96 times as wide about
/// it, in all rows, independent of the numbers; that needs no draws.
/// Drawn machines without a solution, at temperatures beyond a law's range for example, are left out, and the words say so.
/// @returns none if no number of the scenario has a `known_to` and no effect says what it misses; no intervals, and the
///          reason in words, if there are numbers with `known_to` and no reduced model follows the machine (a temperature
///          prescribed over time, a body that cannot lose its heat), or more than half of the drawn ones have no solution
[[nodiscard]] std::optional<RecordBand> known_band(const scenarios::Scenario& scenario, const BandedRun& run,
                                                   const Listener& listener);

}  // namespace driftwright::studies
