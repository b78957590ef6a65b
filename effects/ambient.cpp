#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void change_drive(const Effect& e, DriveChange& change) {
  change.hall.push_back({e["offset"], e["ramp"] / 3600.0, e["from"] * 60.0});
}

void check(const Effect&, const ConfigMap& in) {
  if (!in.has("offset") && !in.has("ramp")) in.fail("offset", "`offset`, `ramp` or both are wanted");
}

}  // namespace

EffectKind ambient() {
  return {.key = "ambient",
          .title = "hall that is warmer or colder than recorded",
          .law = "T_hall = recorded + offset + ramp (t - from) from a time on, in every cyclogram",
          .places = {Place::kHall},
          .parameters = {{"offset", "K", -50.0, 50.0, 0.0, "true minus recorded"},
                         {"ramp", "K/h", -50.0, 50.0, 0.0, "its growth"},
                         {"from", "min", 0.0, 1e7, 0.0, "when it begins; a step takes a millisecond"}},
          .change_drive = change_drive,
          .check = check};
}

}  // namespace driftwright::effects
