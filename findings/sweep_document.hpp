#pragma once
// The result of a sweep, as a document.

#include "output/document.hpp"
#include "studies/sweep_statistics.hpp"

namespace driftwright::findings {

/// @param rows  by the member's number, as studies::table_row() returns them
[[nodiscard]] output::Document sweep_document(const scenarios::SweepPlan& plan,
                                              const std::map<std::size_t, std::string>& rows,
                                              const output::Provenance& made_by);

}  // namespace driftwright::findings
