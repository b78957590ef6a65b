#pragma once
// Finds values that no machine has, in a scenario and in its results: sentences, each with the number and the usual range
// (base/usual_ranges.hpp).

#include <string>
#include <vector>

#include "base/record.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::scenarios {

/// Heats, films, contacts, links, capacities, sensitivities, materials, feeds and ambient temperatures of a scenario,
/// each with its line. Laws are evaluated at every drive of its cyclograms, with bodies at the reference temperature, as
/// if they always acted.
[[nodiscard]] std::vector<std::string> unusual_numbers(const Scenario& scenario);

/// Temperatures, displacements and tilts of a record: for each kind the most extreme channel, and the number of extreme
/// channels.
/// @param with_temperatures  false if the temperatures of the bodies themselves are checked elsewhere
[[nodiscard]] std::vector<std::string> unusual_values(const Record& record, bool with_temperatures = true);

}  // namespace driftwright::scenarios
