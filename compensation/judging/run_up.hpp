#pragma once
// Records that were cut out of a longer one: the readings before a run are known when it is predicted.

#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::compensation {

/// A record with the rows before it.
struct RunUp {
  Record record;        ///< the rows before it, without the target, then its own
  std::string follows;  ///< source of the record before it; empty: none, and `record` is unchanged
};

/// Puts the rows of up to 12 h before a run in front of it, without the target, so that lags have their history. They come
/// from the record of `earlier` with the same channels that ends before `run` begins, by no more than five of its usual time
/// steps. A record whose clock starts anew has none.
[[nodiscard]] RunUp with_run_up(const Record& run, const std::vector<Record>& earlier, const std::string& target);

}  // namespace driftwright::compensation
