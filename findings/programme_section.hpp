#pragma once
// The section of a document about a programme of predictors.

#include "output/document.hpp"
#include "studies/programme_study.hpp"

namespace driftwright::findings {

/// Errors of each predictor by kinds of cyclograms, the tolerance that schedules planned with them keep, identified modes
/// and factors.
[[nodiscard]] output::Section programme_section(const studies::ProgrammeStudy& study, const scenarios::Scenario& scenario);

/// One row per predictor, cyclogram and channel: too long for a document.
[[nodiscard]] output::Table predictions_table(const studies::ProgrammeStudy& study);

}  // namespace driftwright::findings
