#pragma once
// What all effects of an axis' motion share: the parameter `axis`, a ball screw's speed and friction.

#include <numbers>

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

/// Speed of a screw [rpm] at a feed. @param lead_m  travel per turn, > 0
[[nodiscard]] inline double screw_speed_rpm(double feed_m_s, double lead_m) {
  return 60.0 * feed_m_s / lead_m;
}

/// Heat of a ball screw and its nut [W]: drag of the preloaded nut times the screw's angular velocity, and what the drive
/// loses on a thrust.
///
///     P = 2 pi torque v / lead + thrust v (1 / efficiency - 1)
///
/// Source: drag torque and efficiency as in THK's or NSK's catalogue of ball screws.
struct ScrewFriction {
  double torque_Nm = 0.0, lead_m = 0.01, thrust_N = 0.0, efficiency = 0.9;
  [[nodiscard]] double power_W(double feed_m_s) const {
    return 2.0 * std::numbers::pi * torque_Nm * feed_m_s / lead_m + thrust_N * feed_m_s * (1.0 / efficiency - 1.0);
  }
};
/// That of an effect with the parameters `torque`, `lead`, `thrust` and `efficiency`.
[[nodiscard]] inline ScrewFriction screw_friction(const Effect& e) {
  return {e["torque"], 1e-3 * e["lead"], e["thrust"], e["efficiency"]};
}

}  // namespace driftwright::effects
