#include "effects/axis.hpp"

namespace driftwright::effects::guideway_friction {

void contribute(const Effect& e, HeatBalance& balance) {
  const double coulomb_N = e["friction"] * e["load"], viscous_N_s_m = e["viscous"], share = e["share"];
  const std::size_t axis = axis_of(e);
  const auto law = [=](const Inputs& u) {
    const double v_m_s = u.drive.feed_m_s[axis];
    return share * (coulomb_N + viscous_N_s_m * v_m_s) * v_m_s;
  };
  balance.heats.push_back({e.name(), e.body(), law});
}

EffectKind kind() {
  return {
      .key = "guideway_friction",
      .title = "friction of a guideway",
      .law = "P = share (friction load + viscous v) v (Coulomb 1785; viscous drag of seals and oil)",
      .places = {Place::kRegion, Place::kSurface, Place::kNode},
      .parameters = {{"friction",
                      "1",
                      0.0,
                      1.0,
                      {},
                      "coefficient; rolling: 0.003 to 0.01, sliding in oil: 0.05 to 0.15",
                      0.1,
                      "heat_source"},
                     {"load", "N", 0.0, 1e7, {}, "normal force, weight and preload of all carriages"},
                     {"viscous", "N s/m", 0.0, 1e7, 0.0, "drag per velocity", 0.1, "heat_source"},
                     {"share", "1", 0.0, 1.0, 1.0, "part of the heat that enters this body; the other side has the rest"}},
      .timing = Timing::kInTime,
      .contribute = contribute,
      .choices = {axis_choice()}};
}

}  // namespace driftwright::effects::guideway_friction
