#pragma once
// The result of `compensate --through frame`, as a document.

#include "output/document.hpp"
#include "studies/frame_study.hpp"
#include "studies/table_strategy.hpp"

namespace driftwright::findings {

/// @param model  as the user named it
[[nodiscard]] output::Document document_of(const studies::FrameStudy& study, const scenarios::Scenario& scenario,
                                           const std::string& model, const output::Provenance& made_by);

}  // namespace driftwright::findings
