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

/// A result from one end of a varied number to the other, all other numbers at their means.
struct EndToEnd {
  std::size_t variation = 0;           ///< index among plan.variations
  double low = 0.0, high = 0.0;        ///< ends of the number, in its unit
  double at_low = 0.0, at_high = 0.0;  ///< the result there
};
/// The bars of a tornado of one result.
struct Tornado {
  double mean = 0.0;           ///< of the result
  double explained = 0.0;      ///< share of the variance that the fit explains, R² [-]
  std::vector<EndToEnd> bars;  ///< of the varied numbers, the longest first
};
/// The bars by least squares over the members, y = a + Σ b_i x_i; for a log_uniform number x_i is the logarithm. The ends of
/// a distribution are the values that 2.5 % and 97.5 % of all lie below; of listed values and steps the least and the
/// greatest.
/// @param result  index among plan.collect
/// @returns none without varied numbers, for fewer whole members than two for each number and two more, for numbers that
///          the members do not tell apart, and for a constant result
[[nodiscard]] std::optional<Tornado> tornado_of(const scenarios::SweepPlan& plan, const SweepColumns& columns,
                                                std::size_t result);

}  // namespace driftwright::studies
