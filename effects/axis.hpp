#pragma once
// The parameter `axis` that all effects of an axis' motion share.

#include "effects/effect.hpp"

namespace driftwright::effects {

/// The key `axis` of such an effect.
[[nodiscard]] inline Choice axis_choice() {
  return {"axis", {"x", "y", "z"}, {}, "axis whose feed drives it"};
}
/// Index into Drive::feed_m_s of an effect with axis_choice().
[[nodiscard]] inline std::size_t axis_of(const Effect& effect) {
  return static_cast<std::size_t>(effect.words.at("axis")[0] - 'x');
}

}  // namespace driftwright::effects
