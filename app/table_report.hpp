#pragma once
// Words, tables and pictures about a table study.

#include <nlohmann/json_fwd.hpp>

#include "app/results.hpp"
#include "output/html_report.hpp"
#include "studies/table_study.hpp"

namespace driftwright::app {

/// The longest wait between measurements that keeps the tolerance, as all shorter ones do; nullptr when even the shortest does not.
[[nodiscard]] const studies::IntervalRow* longest_interval(const studies::TableStudy& study, double tolerance_m,
                                                           bool with_model);

[[nodiscard]] std::string table_terminal(const scenarios::Scenario& scenario, const studies::TableStudy& study);
[[nodiscard]] nlohmann::ordered_json table_json(const scenarios::Scenario& scenario, const studies::TableStudy& study,
                                                const output::Provenance& made_by);
[[nodiscard]] output::Report table_report(const scenarios::Scenario& scenario, const studies::TableStudy& study,
                                          const output::Provenance& made_by);
/// Largest position error on the table over the judged time, a column a strategy.
[[nodiscard]] std::string strategies_csv(const studies::TableStudy& study, const std::vector<std::string>& comments);
/// Errors of probed touches by axis, feed and motion.
[[nodiscard]] std::string probe_csv(const studies::TableStudy& study, const std::vector<std::string>& comments);

}  // namespace driftwright::app
