#pragma once
// The result of `warmup`, as a document.

#include "output/document.hpp"
#include "studies/warm_up.hpp"

namespace driftwright::findings {

/// @param asked  the job as the user named it
[[nodiscard]] output::Document document_of(const studies::WarmUpPlan& plan, const scenarios::Scenario& scenario,
                                           const Cyclogram& job, const std::string& asked,
                                           const output::Provenance& made_by);

}  // namespace driftwright::findings
