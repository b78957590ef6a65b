#include "compensation/schedule/program_limits.hpp"

#include <fmt/format.h>

namespace driftwright::compensation {
namespace {

constexpr double kUnitRounding = 1.0 + 1e-9;  // 2000 rpm through 1/s and back
constexpr double kPositionRounding_m = 1e-9;

}  // namespace

std::vector<BlockBeyond> blocks_beyond(const std::vector<NcStep>& steps, const MachineLimits& limits) {
  std::vector<BlockBeyond> beyond;
  using What = BlockBeyond::What;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const NcDemand& d = steps[i].demand;
    if (d.speed_rpm > limits.speed_rpm * kUnitRounding)
      beyond.push_back({.step = i, .what = What::kSpeed, .value = d.speed_rpm, .limit = limits.speed_rpm});
    if (d.feed_m_s > limits.feed_m_s * kUnitRounding)
      beyond.push_back({.step = i, .what = What::kFeed, .value = d.feed_m_s, .limit = limits.feed_m_s});
    for (int axis = 0; axis < 3; ++axis) {
      const double low_m = limits.low_m[axis], high_m = limits.high_m[axis];
      if (d.low_m[axis] < low_m - kPositionRounding_m)
        beyond.push_back({.step = i, .what = What::kTravel, .axis = axis, .value = d.low_m[axis], .limit = low_m});
      if (d.high_m[axis] > high_m + kPositionRounding_m)
        beyond.push_back({.step = i, .what = What::kTravel, .axis = axis, .value = d.high_m[axis], .limit = high_m});
    }
  }
  return beyond;
}

std::string words_of(const BlockBeyond& block) {
  switch (block.what) {
    case BlockBeyond::What::kSpeed:
      return fmt::format("the spindle turns at {:g} rpm; at most {:g} rpm is allowed", block.value, block.limit);
    case BlockBeyond::What::kFeed:
      return fmt::format("the feed is {:g} mm/min; at most {:g} mm/min is allowed", 6e4 * block.value, 6e4 * block.limit);
    case BlockBeyond::What::kTravel:
      return fmt::format("{} goes to {:g} mm; the travel ends at {:g} mm", "XYZ"[block.axis], 1e3 * block.value,
                         1e3 * block.limit);
  }
  return "";
}

}  // namespace driftwright::compensation
