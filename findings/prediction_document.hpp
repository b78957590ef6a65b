#pragma once
// The result of `predict`, as a document.

#include "output/document.hpp"
#include "studies/prediction.hpp"

namespace driftwright::findings {

/// @param asked  the cyclogram as the user named it
[[nodiscard]] output::Document document_of(const studies::Prediction& prediction, const scenarios::Scenario& scenario,
                                           const Cyclogram& cyclogram, const std::string& asked,
                                           const output::Provenance& made_by);

/// Table `start_checks`: change of each displacement over the run before, recorded and in the model.
[[nodiscard]] output::Table start_checks_table(const std::vector<studies::StartCheck>& checks);

}  // namespace driftwright::findings
