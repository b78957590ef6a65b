#pragma once
// Statistics of a sweep's table, made from its rows, so that merged shards give the same as one run.

#include <map>
#include <optional>

#include "scenarios/reader/sweep_plan.hpp"

namespace driftwright::studies {

/// The columns of a table as numbers; NaN for anything else, such as words and results of failed members.
struct SweepColumns {
  std::vector<std::vector<double>>
      varied;  ///< in the order of plan.variations; for words the index among the values, from 1
  std::vector<std::vector<double>> results;  ///< in the order of plan.collect
  std::size_t n_failed = 0;
};
/// @param rows  by the member's number, as from table_row()
[[nodiscard]] SweepColumns sweep_columns(const scenarios::SweepPlan& plan, const std::map<std::size_t, std::string>& rows);

/// Spearman's rank correlation of the pairs without NaN; equal values share their mean rank; NaN if one side is constant.
[[nodiscard]] double rank_correlation(const std::vector<double>& x, const std::vector<double>& y);

struct Spread {
  double least = 0.0, median = 0.0, greatest = 0.0;
};
/// The spread of the values without NaN; none if all are NaN.
[[nodiscard]] std::optional<Spread> spread_of(const std::vector<double>& values);

}  // namespace driftwright::studies
