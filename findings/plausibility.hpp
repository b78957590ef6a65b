#pragma once
// What no machine has or does, as warnings of a document; `--strict` refuses a document that has some.

#include "output/document.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::findings {

/// Adds the numbers of the scenario that are unusual (scenarios/reader/unusual.hpp), and what was found unusual in what came of it.
void add_plausibility(output::Section& body, const scenarios::Scenario& scenario,
                      const std::vector<std::string>& found = {});

/// The warnings of a document; empty where it has none.
[[nodiscard]] std::vector<std::string> implausible(const output::Document& document);

}  // namespace driftwright::findings
