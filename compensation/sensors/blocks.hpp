#pragma once
// A single record as several, so that something can be left out of a fit.

#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::compensation {

/// Parts that a single record is left out by.
inline constexpr std::size_t kBlocks = 8;

/// Two records or more as they are. A single one as eight copies, each with the target in an eighth of the rows that have it: rows that lie
/// together, because a row between two that were fitted says little of what a fit is worth. Everything else stays, so that lags run through. One
/// with fewer than sixteen values of the target stays as it is.
[[nodiscard]] std::vector<Record> in_blocks(std::vector<Record> records, const std::string& target);

/// A third of the shortest record [s], from its first row to the last value of the target: no lag that is longer can be told from a trend.
[[nodiscard]] double longest_lag_s(const std::vector<Record>& records, const std::string& target);

}  // namespace driftwright::compensation
