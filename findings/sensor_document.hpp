#pragma once
// The result of `select`, as a document.

#include "output/document.hpp"
#include "studies/sensor_study.hpp"

namespace driftwright::findings {

/// @param records  as the user named them
[[nodiscard]] output::Document document_of(const studies::SensorStudy& study, const std::string& scenario_name,
                                           const std::vector<std::string>& records, const output::Provenance& made_by);

}  // namespace driftwright::findings
