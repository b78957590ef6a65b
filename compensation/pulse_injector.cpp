#include "compensation/pulse_injector.hpp"

namespace driftwright::compensation {

std::span<const QuadratureState> PulseInjector::step(QuadratureState encoder) {
  rows_[0] = encoder;
  const bool low = !encoder.a && !encoder.b;
  if (!low) window_used_ = false;
  if (!low || window_used_ || inserted_ == target_) return {rows_.data(), 1};

  const int direction = target_ > inserted_ ? +1 : -1;
  for (int quarter = 1; quarter <= kQuartersPerPeriod; ++quarter) {
    rows_[static_cast<std::size_t>(quarter)] = state_of_phase(direction * quarter);
  }
  inserted_ += direction;
  window_used_ = true;
  return rows_;
}

}  // namespace driftwright::compensation
