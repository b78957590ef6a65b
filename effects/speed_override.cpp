#include <algorithm>

#include "effects/lasting.hpp"
#include "effects/time_windows.hpp"

namespace driftwright::effects::speed_override {

using Windows = std::vector<std::pair<double, double>>;

constexpr double kCapSd = 0.2, kCapTrial = -0.1;  // of (highest speed - limit) / highest speed

/// The true speed of the spindle while another one is recorded.
struct Turning {
  double factor = 1.0, at_most_rpm = kNotGiven;
  [[nodiscard]] double operator()(double recorded_rpm) const {
    const double rpm = factor * recorded_rpm;
    return rpm > at_most_rpm ? at_most_rpm : rpm;
  }
};

/// Another speed within the windows; sections in which a window begins or ends are split.
Cyclogram turned_within(const Cyclogram& recorded, const Windows& windows, const Turning& turning) {
  std::vector<double> edges_s;
  for (const auto& [begin_s, end_s] : windows) edges_s.insert(edges_s.end(), {begin_s, end_s});
  Cyclogram felt = split_at(recorded, std::move(edges_s));
  double start_s = 0.0;
  for (Cyclogram::Section& section : felt.sections) {
    const double middle_s = start_s + 0.5 * section.duration_s;
    const auto later = std::upper_bound(windows.begin(), windows.end(), middle_s,
                                        [](double time_s, const auto& window) { return time_s < window.first; });
    if (later != windows.begin() && middle_s < std::prev(later)->second)
      section.drive.speed_rpm = turning(section.drive.speed_rpm);
    start_s += section.duration_s;
  }
  return felt;
}

void change_drive(const Effect& e, DriveChange& change) {
  const Turning turning{.factor = e.has("factor") ? e["factor"] : 1.0, .at_most_rpm = e["at_most"]};
  if (e.tables.contains(kWindows)) {
    change.drive.push_back(
        [turning, windows = windows_of(e)](const Cyclogram& recorded) { return turned_within(recorded, windows, turning); });
    return;
  }
  change.drive.push_back([turning](const Cyclogram& recorded) {
    Cyclogram felt = recorded;
    for (Cyclogram::Section& section : felt.sections) section.drive.speed_rpm = turning(section.drive.speed_rpm);
    return felt;
  });
}

/// A factor or a limit is required; windows are checked as everywhere; a repetition requires windows.
void check(const Effect& e, const ConfigMap& in) {
  if (!e.has("factor") && !e.has("at_most"))
    in.fail("factor", "`factor` or `at_most` is required: how the true speed differs from the recorded one");
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
  if (!s.turns) return list;
  DoubtedNumber at_most = doubted("at_most", "rpm", kCapSd * s.top_rpm, 0.02 * s.top_rpm, s.top_rpm);
  at_most.high = s.top_rpm;
  add_in_some_runs(s,
                   {.finding = "speed_override",
                    .where = "spindle",
                    .law = "a speed that is never exceeded, whatever is recorded",
                    .added = {make_effect("speed_override", Place::kSpindle, "spindle", {{"at_most", s.top_rpm}})},
                    .numbers = {at_most},
                    .trial = kCapTrial * s.top_rpm},
                   list);
  return list;
}

EffectKind kind() {
  return {
      .key = "speed_override",
      .title =
          "spindle that turns at a constant multiple of the recorded speed or never faster than a limit, throughout or in "
          "windows of time",
      .law = "n = factor n_recorded, at most `at_most`; with `windows` in these alone; feeds and cutting power as recorded",
      .places = {Place::kSpindle},
      .parameters =
          repeating({{"factor", "1", 0.0, 10.0, kNotGiven, "true over recorded speed; 1 where only `at_most` is given"},
                     {"at_most", "rpm", 0.0, 1e6, kNotGiven, "the speed that it never exceeds: a drive at its limit"}}),
      .timing = Timing::kInRecord,
      .change_drive = change_drive,
      .tables = {windows_table(false)},
      .check = check,
      .doubts = doubts};
}

}  // namespace driftwright::effects::speed_override
