#include "effects/effect.hpp"

namespace driftwright::effects::cutting_heat {

void contribute(const Effect& e, HeatBalance& balance) {
  const double share = e["share"];
  balance.heats.push_back({e.name(), e.body(), [=](const Inputs& u) { return share * u.drive.cutting_power_W; }});
}

EffectKind kind() {
  return {
      .key = "cutting_heat",
      .title = "heat of cutting",
      .law =
          "P = share P_cutting: nearly all of the cutting power becomes heat in chips, tool, workpiece and coolant (Shaw, "
          "Metal Cutting Principles, ch. on temperatures)",
      .places = {Place::kRegion, Place::kSurface, Place::kNode},
      .parameters = {{"share",
                      "1",
                      0.0,
                      1.0,
                      {},
                      "part of the heat that enters this body; chips keep most of it",
                      0.1,
                      "recorded_drive",
                      Doubted::kFactor}},
      .timing = Timing::kInTime,
      .contribute = contribute};
}

}  // namespace driftwright::effects::cutting_heat
