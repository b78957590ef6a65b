#pragma once
// The error of a prediction, and of two simple baselines. A strategy that does not beat both baselines is useless.

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::compensation {

/// Error measures in the unit of the residual. With n = 0 the three numbers are NaN, so that every comparison with a bound
/// fails.
struct Score {
  double rmse = std::numeric_limits<double>::quiet_NaN();      ///< sqrt(mean r^2)
  double peak_abs = std::numeric_limits<double>::quiet_NaN();  ///< max |r|
  double mean = std::numeric_limits<double>::quiet_NaN();      ///< the remaining bias
  int n = 0;                                                   ///< values that are not NaN
};

/// Score of a residual series (measured minus predicted); NaN values are left out.
[[nodiscard]] Score score(std::span<const double> residual);

/// Baseline 1: the mean of all training values of `channel`, each sample with equal weight, at every row of
/// `test`.
/// @throws InputError  when no training value exists, and as complete_rows()
[[nodiscard]] std::vector<double> baseline_mean(std::span<const Record> train, const Record& test,
                                                const std::string& channel);

/// The same with the last training value of the last record that has one, as if the machine stayed in that state.
[[nodiscard]] std::vector<double> baseline_last(std::span<const Record> train, const Record& test,
                                                const std::string& channel);

/// Baseline 2: at each row of `test` the average of the training records at the same time, linear between
/// samples. A record counts only inside its own time span and not beside its missing values; where none
/// counts, NaN.
/// @throws InputError  when there is no training record or one lacks the channel
[[nodiscard]] std::vector<double> baseline_same_time(std::span<const Record> train, const Record& test,
                                                     const std::string& channel);

}  // namespace driftwright::compensation
