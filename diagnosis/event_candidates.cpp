#include "diagnosis/event_candidates.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/no_solution.hpp"
#include "diagnosis/scene.hpp"
#include "diagnosis/waveform.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kShortest_s = 1.0;  // of a window that another length has shortened

/// Whether the twin's reduced machine holds for such an exchange.
bool holds(const Twin& twin, const effects::Effect& window) {
  const solver::ExchangePlace asked = solver::place_of(effects::heat_balance({window}).exchanges.front());
  const auto& exchanges = twin.machine().system.exchanges;
  return std::any_of(exchanges.begin(), exchanges.end(), [&](const auto& e) { return e.place == asked; });
}

/// Waveforms of one body, between it and the same other end.
struct Seen {
  std::string where, to;
  std::vector<const Waveform*> of_runs;
};

/// The window of an exchange between two bodies, either end of which may be the one that stands first. None between two regions, or where the twin has no
/// place for it.
std::optional<effects::Effect> exchange_window(const Twin& twin, const effects::Body& a, const effects::Body& b) {
  const bool is_turned = b.kind != effects::BodyKind::kNode;
  if (is_turned && a.kind != effects::BodyKind::kNode) return std::nullopt;
  effects::Effect window = effects::make_effect("exchange_window", is_turned ? b : a);
  window.set("conductance", 0.0);
  window.references["surrounding"] = is_turned ? a : b;
  window.tables["windows"] = {{0.0}, {1.0}};
  const bool joins_nodes = a.kind == effects::BodyKind::kNode && b.kind == effects::BodyKind::kNode;
  if (!joins_nodes && !holds(twin, window)) return std::nullopt;
  return window;
}

std::optional<Event> event_of(const Twin& twin, const effects::DoubtScene& scene, const Seen& seen) {
  const effects::Body body = twin.body_of(seen.where);
  effects::Effect window = effects::make_effect("heat_window", body);
  if (!seen.to.empty()) {
    const effects::Body other = seen.to == effects::kHallName ? effects::hall() : twin.body_of(seen.to);
    const auto between = exchange_window(twin, body, other);
    if (!between) return std::nullopt;
    window = *between;
  }
  Event event;
  effects::Doubt& d = event.doubt;
  std::size_t n_windows = 0;
  double mean = 0.0, row_s = 0.0;
  std::vector<std::string> times;
  for (const Waveform* w : seen.of_runs) {
    effects::Effect in_run = window;
    in_run.in = w->run;
    TimeSeries& rows = in_run.tables["windows"];
    rows = {};
    for (const auto& [begin_s, end_s] : w->shape.windows_s) {
      if (!(end_s - begin_s > kShortest_s)) continue;
      rows.time_s.push_back(std::round(begin_s));
      rows.value.push_back(std::max(std::round(begin_s) + 1.0, std::round(end_s)));
      times.push_back(fmt::format("{:.1f} to {:.1f}", begin_s / 60.0, end_s / 60.0));
      event.price_nats += 2.0 * std::log(static_cast<double>(w->time_s.size()));
      ++n_windows;
    }
    if (rows.time_s.empty()) continue;
    mean += w->shape.size * static_cast<double>(rows.time_s.size());
    row_s = std::max(row_s, w->time_s.back() / static_cast<double>(w->time_s.size() - 1));
    d.added.push_back(std::move(in_run));
  }
  if (n_windows == 0) return std::nullopt;
  for (std::size_t k = 2; k <= n_windows; ++k) event.price_nats -= std::log(static_cast<double>(k));  // in whatever order
  const bool is_exchange = !seen.to.empty();
  const double sd = is_exchange ? 0.2 * scene.unknown_heat_W() : scene.unknown_heat_W();
  effects::DoubtedNumber size =
      effects::doubted(is_exchange ? "conductance" : "power", is_exchange ? "W/K" : "W", sd, 0.05 * sd);
  if (is_exchange || mean > 0.0) size.low = 0.0;
  effects::DoubtedNumber longer = effects::doubted("longer", "min", row_s / 60.0, 0.1 * row_s / 60.0);
  longer.set = [before = d.added](std::span<effects::Effect> added, double value) {
    for (std::size_t i = 0; i < added.size(); ++i) {
      const TimeSeries& seen_rows = before[i].tables.at("windows");
      TimeSeries& rows = added[i].tables.at("windows");
      for (std::size_t k = 0; k < rows.value.size(); ++k) {
        const double next_s = k + 1 < rows.time_s.size() ? rows.time_s[k + 1] : 1e9;
        rows.value[k] = std::clamp(seen_rows.value[k] + 60.0 * value, rows.time_s[k] + kShortest_s, next_s);
      }
    }
  };
  d.finding = window.kind->key;
  d.where = is_exchange && seen.to != effects::kHallName ? seen.where + "," + seen.to : seen.where;
  d.law = fmt::format("{}, seen in the waveform{}: {} min",
                      n_windows == 1 ? std::string("a window") : fmt::format("{} windows of one size", n_windows),
                      is_exchange ? ", to " + seen.to : std::string(), fmt::join(times, ", "));
  d.numbers = {size, longer};
  d.trial = std::clamp(mean / static_cast<double>(n_windows), -sd, sd);
  if (d.trial == 0.0 || d.trial < size.low) return std::nullopt;
  return event;
}

}  // namespace

std::vector<Event> events(const Twin& twin, const std::vector<MeasuredRun>& runs) {
  std::vector<Waveform> list;
  const bool is_solved = has_solution([&] {
    Twin::Workspace workspace(twin);
    Prediction prediction;
    for (const MeasuredRun& run : runs)
      prediction.push_back(twin.read(twin.as_written(), run, twin.respond(twin.as_written(), run, workspace)));
    list = waveforms(twin, runs, twin.as_written(), prediction);
  });
  if (!is_solved) return {};
  std::vector<Seen> seen;
  for (const Waveform& w : list) {
    if (w.of != Waveform::Of::kHeat || w.shape.shape != Shape::kWindows) continue;
    const auto same =
        std::find_if(seen.begin(), seen.end(), [&](const Seen& s) { return s.where == w.where && s.to == w.to; });
    if (same == seen.end()) {
      seen.push_back({w.where, w.to, {&w}});
    } else {
      same->of_runs.push_back(&w);
    }
  }
  const effects::DoubtScene scene = scene_of(twin, runs);
  std::vector<Event> found;
  for (const Seen& s : seen) {
    if (auto event = event_of(twin, scene, s)) found.push_back(*std::move(event));
  }
  return found;
}

}  // namespace driftwright::diagnosis
