#pragma once
// The result of `run` for a scenario with a table, as a document.

#include "findings/machine_section.hpp"
#include "output/document.hpp"
#include "studies/table_study.hpp"

namespace driftwright::findings {

/// The longest interval between measurements that keeps the tolerance, as all shorter ones do; nullptr if even the shortest
/// does not.
[[nodiscard]] const studies::IntervalRow* longest_interval(const studies::TableStudy& study, double tolerance_m,
                                                           bool with_model);

[[nodiscard]] output::Document document_of(const studies::TableStudy& study, const scenarios::Scenario& scenario,
                                           const mesh::Mesh& mesh, const WorstMoment& worst,
                                           const output::Provenance& made_by);

/// Largest position error on the table over the judged time, one column per strategy, as a record CSV.
[[nodiscard]] std::string strategies_csv(const studies::TableStudy& study, const std::vector<std::string>& comments);

}  // namespace driftwright::findings
