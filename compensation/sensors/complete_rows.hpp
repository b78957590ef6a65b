#pragma once
// Several records as one table: the rows in which no requested channel is missing.

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::compensation {

/// The table.
struct CompleteRows {
  Eigen::MatrixXd values;           ///< n_rows x n_channels, each column in its channel's unit
  std::vector<std::string> units;   ///< one per channel
  std::vector<Eigen::Index> first;  ///< first row of each record, followed by n_rows: n_records + 1
  int n_left_out = 0;               ///< rows in which at least one of the channels is missing
};

/// Stacks the records in their order and keeps the rows in which all of `channels` have a value.
///
/// @param channels  names, with or without unit; column j of the result is channels[j]
/// @throws InputError  when there is no record, a record lacks a channel, or the unit of a channel differs between
///                     records
[[nodiscard]] CompleteRows complete_rows(std::span<const Record> records, const std::vector<std::string>& channels);

}  // namespace driftwright::compensation
