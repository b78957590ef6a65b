#include "effects/axis.hpp"

namespace driftwright::effects::ball_screw {

void contribute(const Effect& e, HeatBalance& balance) {
  const auto law = [axis = axis_of(e), friction = screw_friction(e), share = e["share"]](const Inputs& u) {
    return share * friction.power_W(u.drive.feed_m_s[axis]);
  };
  balance.heats.push_back({e.name(), e.body(), law});
}

EffectKind kind() {
  return {
      .key = "ball_screw",
      .title = "friction of a ball screw and its nut, into one body; `feed_axis` knows where the nut is",
      .law =
          "P = share (2 pi torque v / lead + thrust v (1 / efficiency - 1)): drag of the preloaded nut times the screw's "
          "angular velocity, and what the drive loses on a thrust (drag torque and efficiency as in THK's or NSK's "
          "catalogue of ball screws)",
      .places = {Place::kRegion, Place::kSurface, Place::kNode},
      .parameters = {{"torque", "N m", 0.0, 1e4, {}, "drag torque of the preloaded nut", 0.1, "heat_source"},
                     {"lead", "mm", 0.1, 1000.0, {}, "travel per turn"},
                     {"thrust", "N", 0.0, 1e7, 0.0, "mean axial load"},
                     {"efficiency", "1", 0.1, 1.0, 0.9, "from torque to thrust"},
                     {"share", "1", 0.0, 1.0, 1.0,
                      "part of the heat that enters this body; nut and screw: about half each"}},
      .timing = Timing::kInTime,
      .contribute = contribute,
      .choices = {axis_choice()}};
}

}  // namespace driftwright::effects::ball_screw
