#include <algorithm>

#include "effects/doubt.hpp"

namespace driftwright::effects::slipping_belt {

void change_drive(const Effect& e, DriveChange& change) {
  change.drive.push_back([slip_rpm = e["slip"]](const Cyclogram& recorded) {
    Cyclogram felt = recorded;
    for (auto& s : felt.sections) {
      if (s.drive.speed_rpm > 0.0) s.drive.speed_rpm = std::max(0.0, s.drive.speed_rpm - slip_rpm);
    }
    return felt;
  });
}

std::vector<Doubt> doubts(const DoubtScene&) {
  return {{.finding = "slipping_belt",
           .where = "spindle",
           .law = "slower by as much at each speed",
           .added = {make_effect("slipping_belt", Place::kSpindle, "spindle")},
           .numbers = {doubted("slip", "rpm", 200.0, 10.0)},
           .trial = 50.0}};
}

EffectKind kind() {
  return {.key = "slipping_belt",
          .title = "belt that slips by as many turns at each speed",
          .law = "n = n_recorded - slip while it turns",
          .places = {Place::kSpindle},
          .parameters = {{"slip", "rpm", -1e5, 1e5, {}, "turns lost", 0.1, "slipping_belt"}},
          .timing = Timing::kInRecord,
          .change_drive = change_drive,
          .doubts = doubts};
}

}  // namespace driftwright::effects::slipping_belt
