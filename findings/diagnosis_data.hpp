#pragma once
// The part of a diagnosis that is for programs only: keys of diagnosis.json that are in no table for people (DESIGN.md fixes
// them).

#include "diagnosis/diagnosis.hpp"
#include "output/document.hpp"

namespace driftwright::findings {

/// Items `causes`, each with its parameters and alternatives; an empty list without causes.
void add_causes_data(output::Section& section, const std::vector<diagnosis::Cause>& causes,
                     const std::string& key = "causes");
/// `compared`: how many channels of the records are in the scenario, and which are left out.
[[nodiscard]] output::Section compared_data(const std::vector<diagnosis::MeasuredRun>& runs);
/// `probability_nothing_wrong` and the items `statements`.
void add_statements_data(output::Section& section, const diagnosis::Diagnosis& d);
/// `complete`, `n_candidates` and how causes were weighted.
[[nodiscard]] output::Section search_data(const diagnosis::Diagnosis& d);
/// An empty list in place of items.
[[nodiscard]] output::Value no_items(const std::string& key);

}  // namespace driftwright::findings
