#pragma once
// The document of planned probings (`probe-plan`).

#include "output/document.hpp"
#include "scenarios/reader/scenario.hpp"
#include "studies/probe_plan.hpp"

namespace driftwright::findings {

/// @param warnings  what the predictor's file says against this job, a sentence each
[[nodiscard]] output::Document document_of(const studies::ProbePlan& plan, const scenarios::Scenario& scenario,
                                           const std::vector<std::string>& warnings, const output::Provenance& made_by);

}  // namespace driftwright::findings
