#pragma once
// The result of `plan-test`, as a document.

#include "output/document.hpp"
#include "studies/test_plan.hpp"

namespace driftwright::findings {

/// @param rows  the planned programme in the form of a scenario's `cyclograms`
[[nodiscard]] output::Document document_of(const studies::TestPlan& plan, const scenarios::Scenario& scenario,
                                           const std::string& rows, const output::Provenance& made_by);

}  // namespace driftwright::findings
