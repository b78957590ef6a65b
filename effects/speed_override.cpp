#include <algorithm>

#include "effects/lasting.hpp"
#include "effects/time_windows.hpp"

namespace driftwright::effects {
namespace {

using Windows = std::vector<std::pair<double, double>>;

/// The speed times a factor within the windows; sections that a window begins or ends in are split.
Cyclogram faster_within(const Cyclogram& recorded, const Windows& windows, double factor) {
  std::vector<double> edges_s;
  for (const auto& [begin_s, end_s] : windows) edges_s.insert(edges_s.end(), {begin_s, end_s});
  Cyclogram felt = split_at(recorded, std::move(edges_s));
  double start_s = 0.0;
  for (Cyclogram::Section& section : felt.sections) {
    const double middle_s = start_s + 0.5 * section.duration_s;
    const auto later = std::upper_bound(windows.begin(), windows.end(), middle_s,
                                        [](double time_s, const auto& window) { return time_s < window.first; });
    if (later != windows.begin() && middle_s < std::prev(later)->second) section.drive.speed_rpm *= factor;
    start_s += section.duration_s;
  }
  return felt;
}

void change_drive(const Effect& e, DriveChange& change) {
  const double factor = e["factor"];
  if (e.tables.contains(kWindows)) {
    change.drive.push_back([factor, windows = windows_of(e)](const Cyclogram& recorded) {
      return faster_within(recorded, windows, factor);
    });
    return;
  }
  change.drive.push_back([factor](const Cyclogram& recorded) {
    Cyclogram felt = recorded;
    for (Cyclogram::Section& section : felt.sections) section.drive.speed_rpm *= factor;
    return felt;
  });
}

/// Windows are as everywhere; what repeats must have some.
void check(const Effect& e, const ConfigMap& in) {
  if (e.tables.contains(kWindows)) {
    check_windows(e, in);
  } else if (e.has("every") || e.has("until_time")) {
    in.fail(e.has("every") ? "every" : "until_time", "only `windows` come again, and this effect has none");
  }
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
          .title = "spindle that turns at a constant multiple of the recorded speed, throughout or in windows of time",
          .law = "n = factor n_recorded, with `windows` in these alone; feeds and cutting power as recorded",
          .places = {Place::kSpindle},
          .parameters = repeating({{"factor", "1", 0.0, 10.0, {}, "true over recorded speed"}}),
          .timing = Timing::kInRecord,
          .change_drive = change_drive,
          .tables = {windows_table(false)},
          .check = check,
          .doubts = doubts};
}

}  // namespace driftwright::effects
