#pragma once
// Warnings of a document about implausible data or results; `--strict` refuses a document with warnings.

#include "output/document.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::findings {

/// Adds warnings for unusual numbers of the scenario (scenarios/reader/unusual.hpp), and those in `found` for its results.
void add_plausibility(output::Section& body, const scenarios::Scenario& scenario,
                      const std::vector<std::string>& found = {});

/// The warnings of a document; empty if it has none.
[[nodiscard]] std::vector<std::string> implausible(const output::Document& document);

}  // namespace driftwright::findings
