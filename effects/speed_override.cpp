#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void change_drive(const Effect& e, DriveChange& change) {
  change.speed_factor *= e["factor"];
}

}  // namespace

EffectKind speed_override() {
  return {.key = "speed_override",
          .title = "spindle that turns at a constant multiple of the recorded speed",
          .law = "n = factor n_recorded; feeds and cutting power as recorded",
          .places = {Place::kSpindle},
          .parameters = {{"factor", "1", 0.0, 10.0, {}, "true over recorded speed"}},
          .change_drive = change_drive};
}

}  // namespace driftwright::effects
