#pragma once
// Plots and tables of residuals, one section per record.

#include "output/document.hpp"
#include "studies/measured_twin.hpp"

namespace driftwright::findings {

/// Per run: the drive; each channel measured, with the scenario as written and afterwards; its residuals with the band of
/// noise; and a description of the residuals. For people only, as details.
/// @param after  name of Diagnosis::extended
[[nodiscard]] std::vector<output::Section> residual_sections(const studies::MeasuredTwin& measured,
                                                             const diagnosis::Diagnosis& d, const std::string& after);

}  // namespace driftwright::findings
