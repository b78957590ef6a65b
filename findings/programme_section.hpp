#pragma once
// A programme of predictors as part of a document.

#include "output/document.hpp"
#include "studies/programme_study.hpp"

namespace driftwright::findings {

/// Errors of each predictor by kinds of cyclograms, what schedules planned on them keep, modes and factors that were identified.
[[nodiscard]] output::Section programme_section(const studies::ProgrammeStudy& study, const scenarios::Scenario& scenario);

/// One row a predictor, cyclogram and channel: too long for a document.
[[nodiscard]] output::Table predictions_table(const studies::ProgrammeStudy& study);

}  // namespace driftwright::findings
