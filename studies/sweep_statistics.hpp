#pragma once
// What a sweep's table says as a whole, made from its rows, so that parts put together look like one run.

#include <map>
#include <optional>

#include "scenarios/reader/sweep_plan.hpp"

namespace driftwright::studies {

/// The columns of a table as numbers; NaN for what is none, such as words and results of failed members.
struct SweepColumns {
  std::vector<std::vector<double>> varied;   ///< as plan.variations; for words the position among the values, from 1
  std::vector<std::vector<double>> results;  ///< as plan.collect
  std::size_t n_failed = 0;
};
/// @param rows  by the member's number, as table_row() has them
[[nodiscard]] SweepColumns sweep_columns(const scenarios::SweepPlan& plan, const std::map<std::size_t, std::string>& rows);

/// Spearman's rank correlation of the pairs without NaN, equal values sharing their mean rank; NaN where one side does not vary.
[[nodiscard]] double rank_correlation(const std::vector<double>& x, const std::vector<double>& y);

struct Spread {
  double least = 0.0, median = 0.0, greatest = 0.0;
};
/// Of the values without NaN; none where there are none.
[[nodiscard]] std::optional<Spread> spread_of(const std::vector<double>& values);

}  // namespace driftwright::studies
