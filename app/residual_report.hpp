#pragma once
// The pages' pictures and tables of residuals.

#include "output/html_report.hpp"
#include "studies/measured_twin.hpp"

namespace driftwright::app {

/// Per run: the drive, each channel measured, as written and after, its residuals with the band of noise; and what the residuals look like.
/// @param after  what Diagnosis::extended is called
void add_residuals(const studies::MeasuredTwin& measured, const diagnosis::Diagnosis& d, const std::string& after,
                   std::vector<output::ReportBlock>& blocks);

}  // namespace driftwright::app
