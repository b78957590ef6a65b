#pragma once
// The result of `compare` for two records, as a document.

#include "output/document.hpp"
#include "studies/record_comparison.hpp"

namespace driftwright::findings {

[[nodiscard]] output::Document document_of(const studies::RecordComparison& comparison, const output::Provenance& made_by);

}  // namespace driftwright::findings
