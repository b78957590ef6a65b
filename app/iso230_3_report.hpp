#pragma once
// The figures of ISO 230-3 for people and programs: a block of lines, JSON, a table.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "compensation/judging/iso230_3.hpp"
#include "output/html_report.hpp"

namespace driftwright::app {

/// Lines for the terminal, each with two spaces before it; one line that says why where there are no figures.
[[nodiscard]] std::string iso230_3_text(const compensation::Iso230Figures& figures);

/// {"spindle_running_period_min", "channels": [{"name", "unit", "range_first_60_min", "range_running_period",
/// "at_end_of_running_period", "range_whole_record"}]}, or {"not_available": why}.
[[nodiscard]] nlohmann::ordered_json iso230_3_json(const compensation::Iso230Figures& figures);

/// A table, or a paragraph that says why there is none.
[[nodiscard]] output::ReportBlock iso230_3_block(const compensation::Iso230Figures& figures);

/// Figures of one of several runs.
struct Iso230Run {
  std::string run;
  compensation::Iso230Figures figures;
};
/// A list of the same objects, each with `run` before it.
[[nodiscard]] nlohmann::ordered_json iso230_3_json(const std::vector<Iso230Run>& runs);
/// One table of all runs and their channels, with why there are no figures where there are none.
[[nodiscard]] output::ReportBlock iso230_3_block(const std::vector<Iso230Run>& runs);

}  // namespace driftwright::app
