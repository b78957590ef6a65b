#pragma once
// Compares two records channel by channel: the difference of the second from the first.

#include <optional>
#include <string>
#include <vector>

#include "base/record_band.hpp"

namespace driftwright::studies {

/// Second minus first, at the rows of the first that lie within both records.
struct ChannelDifference {
  std::string name, unit;
  int n_rows = 0;        ///< rows in which both have a value
  double rms = 0.0;      ///< [unit]
  double largest = 0.0;  ///< [unit] value of the largest magnitude, with its sign
  double largest_at_s = 0.0;
  double at_end = 0.0;  ///< [unit] in the last of these rows
  double range = 0.0;   ///< [unit] of the first in these rows: maximum minus minimum
  /// Share of these rows [-] in which one record is within the band of the other: of the first, if that has a band of the
  /// channel, else of the second. None if neither has one.
  std::optional<double> within_band = {};
};

struct RecordComparison {
  Record first;
  Record second_at_rows;  ///< channels of both, linear at the rows of the first; NaN where the second has no value
  std::vector<ChannelDifference> channels = {};
  std::vector<std::string> only_first = {}, only_second = {};   ///< headers of channels without a partner
  std::optional<RecordBand> first_band = {}, second_band = {};  ///< those given, linear at the rows of the first
};

/// @throws InputError  for records that share no channel of the same name and unit, or no stretch of time
/// @param first_band, second_band  of the records, at rows of their own; none if a record has no band
[[nodiscard]] RecordComparison compare_records(const Record& first, const Record& second,
                                               const std::optional<RecordBand>& first_band = std::nullopt,
                                               const std::optional<RecordBand>& second_band = std::nullopt);

}  // namespace driftwright::studies
