#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void change_drive(const Effect& e, DriveChange& change) {
  change.stops.push_back({e["start"] * 60.0, e["length"] * 60.0, e.words.at("in")});
}

}  // namespace

EffectKind missing_stop() {
  return {.key = "missing_stop",
          .title = "stop of the spindle that the record does not have",
          .law = "n = 0 from start to start + length; feeds and cutting power as recorded",
          .places = {Place::kSpindle},
          .parameters = {{"start", "min", 0.0, 1e7, {}, "when it stops"}, {"length", "min", 1e-3, 1e7, {}, "for how long"}},
          .change_drive = change_drive,
          .mentions = {in_cyclogram()}};
}

}  // namespace driftwright::effects
