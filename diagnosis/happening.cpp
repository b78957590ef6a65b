#include "diagnosis/happening.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "effects/time_windows.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kShortestWindow_s = 1.0;       // least length of a window that was shortened by its fitted length
constexpr std::size_t kWindowsFittedAlone = 5;  // up to this number, windows' times are fitted separately
// Exponent of the speed by which heat of bearings and motors usually grows: start value for a fit of another speed.
constexpr double kUsualExponent = 1.5;

/// Whether the twin's reduced machine is valid for such an exchange.
bool holds(const Twin& twin, const effects::Effect& window) {
  const solver::ExchangePlace asked = solver::place_of(effects::heat_balance({window}).exchanges.front());
  const auto& exchanges = twin.machine().system.exchanges;
  return std::any_of(exchanges.begin(), exchanges.end(), [&](const auto& e) { return e.place == asked; });
}

/// The extension of all windows beyond their detected length.
effects::DoubtedNumber longer_by(double sd_min, const std::vector<effects::Effect>& before) {
  effects::DoubtedNumber longer = effects::doubted("longer", "min", sd_min, 0.1 * sd_min);
  longer.set = [before](std::span<effects::Effect> added, double value) {
    for (std::size_t i = 0; i < added.size(); ++i) {
      const TimeSeries& seen_rows = before[i].tables.at(effects::kWindows);
      TimeSeries& rows = added[i].tables.at(effects::kWindows);
      for (std::size_t k = 0; k < rows.value.size(); ++k) {
        const double next_s = k + 1 < rows.time_s.size() ? rows.time_s[k + 1] : 1e9;
        rows.value[k] = std::clamp(seen_rows.value[k] + 60.0 * value, rows.time_s[k] + kShortestWindow_s, next_s);
      }
    }
  };
  return longer;
}

/// Begin and end of windows, each with the uncertainty of its detection as prior.
/// @param wide_s  for all windows, in the order of the effects and their rows
std::vector<effects::DoubtedNumber> times_of_windows(const std::vector<effects::Effect>& windows, const Times& wide_s,
                                                     double row_min) {
  std::vector<effects::DoubtedNumber> numbers;
  for (std::size_t e = 0; e < windows.size(); ++e) {
    const TimeSeries& seen = windows[e].tables.at(effects::kWindows);
    for (std::size_t k = 0; k < seen.time_s.size(); ++k) {
      const std::size_t of = numbers.size() / 2;
      const double before_s = k > 0 ? seen.value[k - 1] : 0.0;
      const double after_s = k + 1 < seen.time_s.size() ? seen.time_s[k + 1] : 1e9;
      effects::DoubtedNumber begin = effects::doubted(fmt::format("begin_{}", of + 1), "min", wide_s[of].first / 60.0,
                                                      0.2 * row_min, seen.time_s[k] / 60.0);
      begin.low = before_s / 60.0;
      begin.high = (seen.value[k] - kShortestWindow_s) / 60.0;
      begin.set = [e, k](std::span<effects::Effect> added, double value) {
        TimeSeries& rows = added[e].tables.at(effects::kWindows);
        rows.time_s[k] = std::max(60.0 * value, k > 0 ? rows.value[k - 1] : 0.0);
      };
      effects::DoubtedNumber end = effects::doubted(fmt::format("end_{}", of + 1), "min", wide_s[of].second / 60.0,
                                                    0.2 * row_min, seen.value[k] / 60.0);
      end.low = begin.low;
      end.high = after_s / 60.0;
      end.set = [e, k](std::span<effects::Effect> added, double value) {
        TimeSeries& rows = added[e].tables.at(effects::kWindows);
        rows.value[k] = std::max(60.0 * value, rows.time_s[k] + kShortestWindow_s);
      };
      numbers.push_back(std::move(begin));
      numbers.push_back(std::move(end));
    }
  }
  return numbers;
}

/// One window: its begin and length are fitted numbers, whose cost is part of their evidence.
std::optional<Event> one_event(const effects::DoubtScene& scene, const Happening& h, const effects::Effect& window,
                               const effects::DoubtedNumber& size) {
  const auto& [run, windows] = h.in.front();
  const auto [begin_s, end_s] = windows.front();
  if (!(end_s - begin_s > kShortestWindow_s)) return std::nullopt;
  const auto of_run = std::find_if(scene.runs.begin(), scene.runs.end(), [&](const auto& r) { return r.name == run->name; });
  const std::string what = h.is_speed ? "another speed for a while" : h.other ? effects::kLid : "heat for a while";
  Event event{.doubt = effects::one_window(*of_run, window, size, h.size, what),
              .once = Event::Window{run->name, begin_s, end_s}};
  const std::vector<effects::DoubtedNumber>& n = event.doubt.numbers;
  event.doubt.grid = {{begin_s - n[1].nominal, (end_s - begin_s) / 60.0 - n[2].nominal}};
  return event;
}

/// The doubt of a happening: the effect without its times, and its size.
struct Asked {
  effects::Effect window;
  effects::DoubtedNumber size = {};
  std::string where = {}, to = {};  ///< the other end in words, if there is one
  double trial = 0.0;               ///< of the size, relative to its nominal value
};

Asked another_speed(const Happening& h) {
  Asked a{.window = effects::make_effect("speed_override", effects::Place::kSpindle, "spindle", {{"factor", 1.0}}),
          .size = effects::doubted("factor", "1", kUnknownSpeed, 0.05, 1.0),
          .where = "spindle"};
  a.size.low = 0.0;
  a.trial = std::pow(std::max(0.01, 1.0 + h.size), 1.0 / kUsualExponent) - 1.0;
  return a;
}

/// @returns  nothing if the twin has no place for it, or if no size is allowed
std::optional<Asked> asked_of(const Twin& twin, const effects::DoubtScene& scene, const Happening& h) {
  if (h.is_speed) return another_speed(h);
  Asked a{.window = effects::make_effect("heat_window", h.body)};
  if (h.other) {
    const auto between = exchange_window(twin, h.body, *h.other);
    if (!between) return std::nullopt;
    a.window = *between;
    a.to = ", to " + h.other->name;
  }
  const double sd = (h.other ? kUnknownExchange : 1.0) * scene.unknown_heat_W();
  a.size = effects::doubted(h.other ? "conductance" : "power", h.other ? "W/K" : "W", sd, 0.05 * sd);
  if (h.other || h.size > 0.0) a.size.low = 0.0;
  a.where = h.other && !(*h.other == effects::ambient_node()) ? h.body.name + "," + h.other->name : h.body.name;
  a.trial = std::clamp(h.size, -sd, sd);
  if (a.trial == 0.0 || a.trial < a.size.low) return std::nullopt;
  return a;
}

}  // namespace

std::optional<effects::Effect> exchange_window(const Twin& twin, const effects::Body& a, const effects::Body& b) {
  const bool is_turned = b.kind != effects::BodyKind::kNode;
  if (is_turned && a.kind != effects::BodyKind::kNode) return std::nullopt;
  effects::Effect window = effects::make_effect("exchange_window", is_turned ? b : a);
  window.set("conductance", 0.0);
  window.references["surrounding"] = is_turned ? a : b;
  window.tables[effects::kWindows] = {{0.0}, {1.0}};
  const bool joins_nodes = a.kind == effects::BodyKind::kNode && b.kind == effects::BodyKind::kNode;
  if (!joins_nodes && !holds(twin, window)) return std::nullopt;
  return window;
}

bool is_unseen(const Happening& happening) {
  double all_s = 0.0, unseen_s = 0.0;
  for (const auto& [run, windows] : happening.in) {
    for (const auto& [begin_s, end_s] : windows) {
      all_s += end_s - begin_s;
      for (const Hole& hole : run->holes)
        unseen_s += std::max(0.0, std::min(end_s, hole.end_s) - std::max(begin_s, hole.begin_s));
    }
  }
  return all_s > 0.0 && unseen_s >= 0.5 * all_s;
}

double share_of_time(const Happening& happening) {
  double windows_s = 0.0, all_s = 0.0;
  for (const auto& [run, windows] : happening.in) {
    for (const auto& [begin_s, end_s] : windows) windows_s += end_s - begin_s;
    all_s += run->time_s.back();
  }
  return windows_s / all_s;
}

std::optional<Event> event_of(const Twin& twin, const effects::DoubtScene& scene, const Happening& h) {
  auto asked = asked_of(twin, scene, h);
  if (!asked) return std::nullopt;
  auto& [window, size, where, to, trial] = *asked;
  if (h.in.size() == 1 && h.in.front().second.size() == 1) {
    auto event = one_event(scene, h, window, size);
    if (event) {
      event->doubt.where = where;
      event->doubt.trial = trial;
    }
    return event;
  }
  Event event{.doubt = {}, .price_nats = h.price_nats};
  effects::Doubt& d = event.doubt;
  std::size_t n_windows = 0;
  double longest_row_s = 0.0;
  std::vector<std::string> times;
  for (const auto& [run, windows] : h.in) {
    effects::Effect in_run = window;
    in_run.in = run->name;
    TimeSeries& rows = in_run.tables[effects::kWindows];
    rows = {};
    for (const auto& [begin_s, end_s] : windows) {
      if (!(end_s - begin_s > kShortestWindow_s)) continue;
      rows.time_s.push_back(std::round(begin_s));
      rows.value.push_back(std::max(std::round(begin_s) + 1.0, std::round(end_s)));
      times.push_back(fmt::format("{:.1f} to {:.1f}", begin_s / 60.0, end_s / 60.0));
      ++n_windows;
    }
    if (rows.time_s.empty()) continue;
    longest_row_s = std::max(longest_row_s, row_s(*run));
    d.added.push_back(std::move(in_run));
  }
  if (n_windows == 0) return std::nullopt;
  const bool is_fitted = n_windows <= kWindowsFittedAlone && n_windows == h.wide_s.size();
  d.numbers = {size};
  if (is_fitted) {
    for (effects::DoubtedNumber& n : times_of_windows(d.added, h.wide_s, longest_row_s / 60.0))
      d.numbers.push_back(std::move(n));
    // Each prior is as wide as the uncertainty of its detection: that part of the choice among all rows is in the price
    // already.
    event.price_nats -= static_cast<double>(n_windows) * std::log(2.0 * std::numbers::pi);
  } else {
    d.numbers.push_back(longer_by(longest_row_s / 60.0, d.added));
  }
  d.finding = window.kind->key;
  d.where = where;
  const std::string how_many = n_windows == 1 ? std::string("a window") : fmt::format("{} windows of one size", n_windows);
  if (is_fitted) {
    std::vector<std::string> in;
    for (const effects::Effect& e : d.added) in.push_back(e.in);
    d.law = fmt::format("{}{}, in {}", how_many, to, fmt::join(in, " and "));
  } else {
    d.law = fmt::format("{}{}: {} min", how_many, to, fmt::join(times, ", "));
  }
  d.trial = trial;
  return event;
}

}  // namespace driftwright::diagnosis
