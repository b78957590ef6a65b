#pragma once
// Records that were cut out of a longer one: what was read before a run is known to whoever predicts it.

#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::compensation {

/// A record with the rows before it.
struct RunUp {
  Record record;        ///< the rows before it, without the target, then its own
  std::string follows;  ///< source of the record that it follows; empty: none, and `record` is as it was
};

/// Puts the rows of up to 12 h before a run in front of it, without the target, so that lags have their memory. They are those of the one of `earlier` with the same
/// channels that ends before `run` begins, by no more than five of its own usual steps of time. Records that start their own clock follow none.
[[nodiscard]] RunUp with_run_up(const Record& run, const std::vector<Record>& earlier, const std::string& target);

}  // namespace driftwright::compensation
