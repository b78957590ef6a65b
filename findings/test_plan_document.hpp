#pragma once
// What `plan-test` found, as a document.

#include "output/document.hpp"
#include "studies/test_plan.hpp"

namespace driftwright::findings {

/// @param rows  the planned programme as a scenario's `cyclograms` has it
[[nodiscard]] output::Document document_of(const studies::TestPlan& plan, const scenarios::Scenario& scenario,
                                           const std::string& rows, const output::Provenance& made_by);

}  // namespace driftwright::findings
