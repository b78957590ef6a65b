#include "compensation/injector/quadrature.hpp"

#include <cstdlib>

namespace driftwright::compensation {

std::vector<Lines> motion_rows(Lines from, int n_quarters) {
  const int direction = n_quarters < 0 ? -1 : +1;
  std::vector<Lines> rows;
  int phase = phase_of(from);
  for (int i = 0; i < std::abs(n_quarters); ++i) {
    phase += direction;
    rows.push_back(lines_of_phase(phase));
  }
  return rows;
}

void QuadratureCounter::step(Lines lines) {
  const int step = quarter_step(last_, lines);
  const bool a_changes = ((last_ ^ lines) & kLineA) != 0;
  if (step == kJump) {
    ++n_jumps_;
  } else if (counting_ == Counting::kX4 || (a_changes && (counting_ == Counting::kX2 || !(lines & kLineB)))) {
    count_ += step;
  }
  last_ = lines;
}

}  // namespace driftwright::compensation
