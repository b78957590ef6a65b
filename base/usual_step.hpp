#pragma once
// The usual time from row to row.

#include <cstddef>
#include <utility>
#include <vector>

#include "base/median.hpp"

namespace driftwright {

/// Times from each row to the next.
[[nodiscard]] inline std::vector<double> row_steps_s(const std::vector<double>& time_s) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < time_s.size(); ++i) steps_s.push_back(time_s[i] - time_s[i - 1]);
  return steps_s;
}

/// Their median; 0 for fewer than two rows.
[[nodiscard]] inline double usual_step_s(const std::vector<double>& time_s) {
  return upper_median(row_steps_s(time_s));
}

}  // namespace driftwright
