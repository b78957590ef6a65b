#pragma once
// 95 % intervals beside the channels of a record, row by row.

#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright {

/// Intervals of some channels of a record. They are kept as a record of their own, with the same times and the channels
/// `<name>_low` and `<name>_high`, because programs that read a record take every channel of it as a reading.
struct RecordBand {
  Record limits;
  std::string words;  ///< what the band contains and what it does not, in sentences

  /// The limits of a channel; null if it has no interval.
  [[nodiscard]] const Channel* low(const std::string& channel) const { return limits.find(channel + "_low"); }
  [[nodiscard]] const Channel* high(const std::string& channel) const { return limits.find(channel + "_high"); }
};

}  // namespace driftwright
