#include "effects/displacement_amount.hpp"

namespace driftwright::effects {
namespace {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.shifts.push_back({e.place, amount_of(e, "shift"), e["time"] * 60.0, e.words.at("in")});
}

void check(const Effect& e, const ConfigMap& in) {
  check_amount(e, in, "shift");
}

}  // namespace

EffectKind mount_shift() {
  return {.key = "mount_shift",
          .title = "step of a displacement channel: a magnet base, a clamp, a crash",
          .law = "u = u + shift from a time on",
          .places = {Place::kDisplacement},
          .parameters = amount_parameters("shift", "step", {{"time", "min", 0.0, 1e7, {}, "when it slips"}}),
          .change_readings = change_readings,
          .check = check,
          .mentions = {in_cyclogram()}};
}

}  // namespace driftwright::effects
