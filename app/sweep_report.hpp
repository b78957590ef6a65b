#pragma once
// Words and pictures about a sweep, made from the rows of its table, so that parts put together look like one run.

#include "output/html_report.hpp"
#include "output/results_folder.hpp"
#include "output/rows_under_way.hpp"
#include "scenarios/reader/sweep_plan.hpp"

namespace driftwright::app {

/// The columns of a table as numbers; NaN for what is none, such as words and results of failed members.
struct SweepColumns {
  std::vector<std::vector<double>> varied;   ///< as plan.variations; for words the position among the values, from 1
  std::vector<std::vector<double>> results;  ///< as plan.collect
  std::size_t n_failed = 0;
};
[[nodiscard]] SweepColumns sweep_columns(const scenarios::SweepPlan& plan, const output::NumberedRows& rows);

/// Spearman's rank correlation of the pairs without NaN, equal values sharing their mean rank; NaN where one side does not vary.
[[nodiscard]] double rank_correlation(const std::vector<double>& x, const std::vector<double>& y);

/// One line per result: least, median and greatest.
[[nodiscard]] std::string sweep_summary(const scenarios::SweepPlan& plan, const SweepColumns& columns);

[[nodiscard]] output::Report sweep_report(const scenarios::SweepPlan& plan, const output::NumberedRows& rows,
                                          const SweepColumns& columns, const output::Provenance& made_by);

}  // namespace driftwright::app
