#pragma once
// Splits a single record into several, so that parts can be left out of a fit.

#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::compensation {

/// Number of blocks of a single record.
inline constexpr std::size_t kBlocks = 8;

/// Two or more records are returned unchanged. A single one becomes eight copies, each with the target in an eighth of the
/// rows that have it. The rows of a block are consecutive, because predicting a row between two fitted rows is too easy a
/// test. All other channels stay, so that lags are continuous. A record with fewer than sixteen values of the target is
/// returned unchanged.
[[nodiscard]] std::vector<Record> in_blocks(std::vector<Record> records, const std::string& target);

/// A third of the shortest record [s], from its first row to the last value of the target: a longer lag cannot be
/// distinguished from a trend.
[[nodiscard]] double longest_lag_s(const std::vector<Record>& records, const std::string& target);

}  // namespace driftwright::compensation
