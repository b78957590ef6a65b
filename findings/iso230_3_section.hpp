#pragma once
// The figures of ISO 230-3 as part of a document.

#include <string>
#include <vector>

#include "compensation/judging/iso230_3.hpp"
#include "output/document.hpp"

namespace driftwright::findings {

/// Section `iso_230_3`: `test`, `spindle_running_period_min` (`axis_running_period_min`, `duration_min`) and the table
/// `channels` with `name`, `unit`, `range_first_60_min`, `range_running_period`, `at_end_of_running_period`,
/// `range_whole_record`; or `not_available`: why.
[[nodiscard]] output::Section iso230_3_section(const compensation::Iso230Figures& figures);

/// The figures of one run out of several.
struct Iso230Run {
  std::string run;
  compensation::Iso230Figures figures;
};
/// Table `iso_230_3` of all runs and their channels, shown as a detail: `run`, `test`, `running_period_min`, the columns
/// above, `not_available`.
[[nodiscard]] output::Table iso230_3_table(const std::vector<Iso230Run>& runs);

/// The section above for each run, as items with the key `iso_230_3`, for programs.
[[nodiscard]] std::vector<output::Section> iso230_3_items(const std::vector<Iso230Run>& runs);

}  // namespace driftwright::findings
