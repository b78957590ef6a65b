#pragma once
// The contribution of each driver to a channel.

#include "identification/foster_network.hpp"

namespace driftwright::identification {

/// One driver.
struct Driver {
  /// "while speed turns", "speed^1.67", "heater", "ambient", or "the scenario" that is extended, which has no final size or
  /// delay.
  std::string name;
  /// Share of the variance of the channel's predicted values; the sum over drivers is 1, one may be negative.
  double share = 0.0;
  double swing = 0.0;       ///< largest minus smallest value in the records [K or um]
  double in_the_end = 0.0;  ///< steady effect of the largest recorded drive; of the ambient for 1 K [K or um]
  double delay_s = 0.0;     ///< time until 63 % of the largest value of the step response is reached
};

/// The drivers of a channel; shares come from the covariance of each part with the sum. The largest share first.
[[nodiscard]] std::vector<Driver> ledger(const FosterProblem& problem, std::size_t channel, const ChannelFit& fit);

inline constexpr const char* kLeft = "left";
/// The same of what an extended scenario misses of a channel's readings, apart from terms of single records: who explains
/// it, as shares of its variance. Two entries have no final size or delay: "less of the scenario", where not all of it is
/// kept, and kLeft, what nothing explains.
[[nodiscard]] std::vector<Driver> ledger_of_missing(const FosterProblem& problem, std::size_t channel,
                                                    const ChannelFit& fit);

}  // namespace driftwright::identification
