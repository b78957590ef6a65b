#include "effects/time_windows.hpp"

namespace driftwright::effects::heat_window {

void contribute(const Effect& e, HeatBalance& balance) {
  const auto windows = windows_of(e);
  balance.heats.push_back({e.name(), e.body(), within(windows, e["power"])});
  add_change_times(windows, balance);
}

EffectKind kind() {
  return {.key = "heat_window",
          .title = "heat that is there for a while, once or again and again: a pump, a lamp, a bearing that drags",
          .law = "P = power within the windows, else 0",
          .places = {Place::kRegion, Place::kSurface, Place::kNode},
          .parameters = repeating({{"power", "W", -1e6, 1e6, {}, "negative cools", 0.1, "heat_window"}}),
          .timing = Timing::kInRecord,
          .contribute = contribute,
          .tables = {windows_table()},
          .check = check_windows};
}

}  // namespace driftwright::effects::heat_window
