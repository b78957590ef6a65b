#pragma once
// The result of `schedule`, as a document.

#include "output/document.hpp"
#include "studies/corrected_series.hpp"

namespace driftwright::findings {

/// @param notation  the plan in the paper's notation
[[nodiscard]] output::Document document_of(const studies::CorrectedSeries& series, const std::string& scenario_name,
                                           const std::string& notation, const output::Provenance& made_by);

/// "part 3" or "parts 3 to 20".
[[nodiscard]] std::string parts_of(const compensation::SharedPlan& shared);

}  // namespace driftwright::findings
