#pragma once
// What no machine has, in a scenario as it is written and in what comes of it: sentences, each with the number and the usual range
// (base/usual_ranges.hpp).

#include <string>
#include <vector>

#include "base/record.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::scenarios {

/// Heats, films, contacts, links, capacities, sensitivities, materials, feeds and ambient temperatures of a scenario, each with the line it stands in.
/// Laws are asked at every drive of its cyclograms, with bodies at the reference temperature, as if they acted all the time.
[[nodiscard]] std::vector<std::string> unusual_numbers(const Scenario& scenario);

/// Temperatures, displacements and tilts of a record: of each kind the channel that goes farthest, and how many do.
/// @param with_temperatures  false where those of the bodies themselves are known
[[nodiscard]] std::vector<std::string> unusual_values(const Record& record, bool with_temperatures = true);

}  // namespace driftwright::scenarios
