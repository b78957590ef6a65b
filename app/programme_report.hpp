#pragma once
// A programme of predictors as a page, a table and a few lines.

#include <nlohmann/json_fwd.hpp>

#include "app/results.hpp"
#include "output/html_report.hpp"
#include "studies/programme_study.hpp"

namespace driftwright::app {

[[nodiscard]] output::Report programme_report(const scenarios::Scenario& scenario, const studies::ProgrammeStudy& study,
                                              const output::Provenance& made_by);
[[nodiscard]] nlohmann::ordered_json programme_json(const studies::ProgrammeStudy& study, const output::Provenance& made_by);
/// One row a predictor, cyclogram and channel.
[[nodiscard]] std::string programme_csv(const studies::ProgrammeStudy& study);
[[nodiscard]] std::string programme_text(const studies::ProgrammeStudy& study);
/// What schedules planned on the predictions keep, a line each.
[[nodiscard]] std::string schedule_text(const studies::ProgrammeStudy& study);

}  // namespace driftwright::app
