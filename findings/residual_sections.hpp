#pragma once
// Pictures and tables of residuals, a section a record.

#include "output/document.hpp"
#include "studies/measured_twin.hpp"

namespace driftwright::findings {

/// Per run: the drive, each channel measured, as written and after, its residuals with the band of noise; and what the residuals look like.
/// For people alone, as details.
/// @param after  what Diagnosis::extended is called
[[nodiscard]] std::vector<output::Section> residual_sections(const studies::MeasuredTwin& measured,
                                                             const diagnosis::Diagnosis& d, const std::string& after);

}  // namespace driftwright::findings
