#include "effects/lasting.hpp"

namespace driftwright::effects {
namespace {

void change_drive(const Effect& e, DriveChange& change) {
  change.drive.push_back([factor = e["factor"]](const Cyclogram& recorded) {
    Cyclogram felt = recorded;
    for (Cyclogram::Section& section : felt.sections) section.drive.speed_rpm *= factor;
    return felt;
  });
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  DoubtedNumber factor = doubted_factor();
  factor.prior_sd = 0.3;
  std::vector<Doubt> list;
  add_in_some_runs(s,
                   {.finding = "speed_override",
                    .where = "spindle",
                    .law = "true speed over the recorded one",
                    .added = {make_effect("speed_override", Place::kSpindle, "spindle", {{"factor", 1.0}})},
                    .numbers = {factor},
                    .trial = 0.1},
                   list);
  return list;
}

}  // namespace

EffectKind speed_override() {
  return {.key = "speed_override",
          .title = "spindle that turns at a constant multiple of the recorded speed",
          .law = "n = factor n_recorded; feeds and cutting power as recorded",
          .places = {Place::kSpindle},
          .parameters = {{"factor", "1", 0.0, 10.0, {}, "true over recorded speed"}},
          .timing = Timing::kInRecord,
          .change_drive = change_drive,
          .doubts = doubts};
}

}  // namespace driftwright::effects
