#include "compensation/quadrature.hpp"

#include <array>
#include <cstdlib>

namespace driftwright::compensation {

int phase_of(QuadratureState state) {
  if (!state.b) return state.a ? 1 : 0;
  return state.a ? 2 : 3;
}

QuadratureState state_of_phase(std::int64_t phase) {
  static constexpr std::array<QuadratureState, 4> kStates = {QuadratureState{false, false}, QuadratureState{true, false},
                                                             QuadratureState{true, true}, QuadratureState{false, true}};
  return kStates[static_cast<std::size_t>(((phase % 4) + 4) % 4)];
}

std::vector<QuadratureState> motion_rows(QuadratureState from, int n_quarters) {
  const int direction = n_quarters < 0 ? -1 : +1;
  std::vector<QuadratureState> rows;
  int phase = phase_of(from);
  for (int i = 0; i < std::abs(n_quarters); ++i) {
    phase += direction;
    rows.push_back(state_of_phase(phase));
  }
  return rows;
}

void QuadratureDecoder::step(QuadratureState state) {
  if (last_) {
    switch ((phase_of(state) - phase_of(*last_) + 4) % 4) {
      case 1:
        ++count_;
        break;
      case 3:
        --count_;
        break;
      case 2:
        ++n_illegal_;
        break;
      default:
        break;
    }
  }
  last_ = state;
}

}  // namespace driftwright::compensation
