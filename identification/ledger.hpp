#pragma once
// What each driver does to a channel.

#include "identification/foster_network.hpp"

namespace driftwright::identification {

struct Driver {
  std::string
      name;  ///< "while speed turns", "speed^1.67", "heater", "ambient", "the scenario" that is extended, which has no size in the end and no delay
  double share = 0.0;  ///< of what the network gives of the channel's variance; all drivers' sum is 1, one may be negative
  double swing = 0.0;  ///< largest less smallest in the records [K or um]
  double in_the_end = 0.0;  ///< of the largest drive that was recorded, held for ever; of the ambient for 1 K [K or um]
  double delay_s = 0.0;     ///< until 63 % of the largest that a step comes to is reached
};

/// By the covariance of each part with their sum. The largest share first.
[[nodiscard]] std::vector<Driver> ledger(const FosterProblem& problem, std::size_t channel, const ChannelFit& fit);

}  // namespace driftwright::identification
