#pragma once
// Blocks of an NC program that ask more of a machine than its limits allow.

#include <string>
#include <vector>

#include "base/machine_limits.hpp"
#include "nc/step.hpp"

namespace driftwright::compensation {

/// A block beyond a limit.
struct BlockBeyond {
  enum class What { kSpeed, kFeed, kTravel };
  std::size_t step = 0;
  What what = What::kSpeed;
  int axis = 0;        ///< of kTravel: 0, 1, 2 = x, y, z
  double value = 0.0;  ///< [rpm], [m/s] or [m]
  double limit = 0.0;  ///< the same
};

/// Every block beyond a limit, in their order; a block beyond several is listed once for each. Blocks without duration have
/// no speed.
[[nodiscard]] std::vector<BlockBeyond> blocks_beyond(const std::vector<NcStep>& steps, const MachineLimits& limits);

/// "the spindle turns at 60000 rpm; at most 2000 rpm are allowed", without the block.
[[nodiscard]] std::string words_of(const BlockBeyond& block);

}  // namespace driftwright::compensation
