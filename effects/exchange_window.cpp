#include <fmt/format.h>

#include "effects/doubt.hpp"

namespace driftwright::effects {
namespace {

constexpr const char* kWindows = "windows";
constexpr double kMostWindows = 10000.0;

/// A region or node takes a conductance of its own, a surface or joint one per area.
bool is_total(const Effect& e) {
  return e.place_kind == Place::kNode || e.place_kind == Place::kRegion;
}

/// Beginnings and ends [s], repeated where they repeat.
std::vector<std::pair<double, double>> windows_of(const Effect& e) {
  const TimeSeries& rows = e.tables.at(kWindows);
  std::vector<std::pair<double, double>> list;
  for (std::size_t i = 0; i < rows.time_s.size(); ++i) list.emplace_back(rows.time_s[i], rows.value[i]);
  if (!e.has("every")) return list;
  const std::size_t n_written = list.size();
  for (double by_s = e["every"]; list.front().first + by_s < e["until_time"]; by_s += e["every"]) {
    for (std::size_t i = 0; i < n_written; ++i) list.emplace_back(list[i].first + by_s, list[i].second + by_s);
  }
  return list;
}

void contribute(const Effect& e, HeatBalance& balance) {
  const auto windows = windows_of(e);
  const double coefficient = is_total(e) ? e["conductance"] : e["film"];
  const std::string to = e.references.contains("surrounding") ? e.references.at("surrounding").name : kHallName;
  balance.exchanges.push_back({.name = e.name(),
                               .body = e.body(),
                               .coefficient =
                                   [=](const Inputs& u) {
                                     for (const auto& [begin_s, end_s] : windows) {
                                       if (u.time_s >= begin_s && u.time_s < end_s) return coefficient;
                                     }
                                     return 0.0;
                                   },
                               .per = is_total(e) ? Per::kTotal : Per::kArea,
                               .surrounding = to});
  for (const auto& [begin_s, end_s] : windows) {
    if (begin_s > 0.0) balance.change_times_s.push_back(begin_s);
    balance.change_times_s.push_back(end_s);
  }
}

void check(const Effect& e, const ConfigMap& in) {
  if (e.has("conductance") != is_total(e) || e.has("film") == is_total(e)) {
    in.fail(is_total(e) ? "conductance" : "film",
            "a region or node wants `conductance`, in W/K; a surface or joint `film`, in W/(m^2 K)");
  }
  const TimeSeries& rows = e.tables.at(kWindows);
  for (std::size_t i = 0; i < rows.time_s.size(); ++i) {
    if (!(rows.value[i] > rows.time_s[i])) in.fail(kWindows, "each window is [begin, end] with an end behind its beginning");
    if (i > 0 && rows.time_s[i] < rows.value[i - 1]) in.fail(kWindows, "windows follow each other without overlap");
  }
  if (e.has("every") != e.has("until_time")) in.fail("every", "`every` and `until_time` go together");
  if (!e.has("every")) return;
  if (!(e["every"] >= rows.value.back() - rows.time_s.front()))
    in.fail("every", "the next turn would begin before this one ends");
  if (e["until_time"] > kMostWindows * e["every"])
    in.fail("every", fmt::format("at most {:.0f} turns are wanted", kMostWindows));
}

Doubt doubt(const DoubtScene::Run& run, Effect window, DoubtedNumber size, double trial) {
  window.in = run.name;
  window.tables[kWindows] = {{0.25 * run.length_s}, {0.5 * run.length_s}};
  const auto begin = [](std::span<Effect> added, double value) {
    TimeSeries& rows = added[0].tables[kWindows];
    const double length_s = rows.value[0] - rows.time_s[0];
    rows = {{value}, {value + length_s}};
  };
  DoubtedNumber length = doubted("length", "min", run.length_s / 60.0 / 4.0, 1.0, run.length_s / 60.0 / 8.0);
  length.low = 1.0;
  length.high = run.length_s / 60.0;
  length.set = [](std::span<Effect> added, double value) {
    TimeSeries& rows = added[0].tables[kWindows];
    rows.value[0] = rows.time_s[0] + 60.0 * value;
  };
  size.low = 0.0;
  std::vector<std::vector<double>> grid;
  for (const auto& at : time_grid(run.length_s, 8)) grid.push_back({at[0], 0.0});
  return {.finding = "exchange_window",
          .where = window.place,
          .law = "a lid or door that opens for a while, in " + run.name,
          .added = {window},
          .numbers = {size, doubted_time("begin", run.length_s, begin), length},
          .trial = trial,
          .grid = grid};
}

/// A surface that more air reaches for a while, or a node.
std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const DoubtScene::Run& run : s.runs) {
    for (const std::string& name : s.surfaces) {
      Effect window = make_effect("exchange_window", Place::kSurface, name);
      for (const Exchange& e : s.balance.exchanges) {
        if (e.body == surface(name) && e.per == Per::kArea) {
          window.references["surrounding"] = node(e.surrounding);
          break;
        }
      }
      window.set("film", 0.0);
      DoubtedNumber film = doubted("film", "W/(m^2 K)", 15.0, 2.0);
      list.push_back(doubt(run, window, film, 4.0));
    }
    for (const Body& body : s.bodies) {
      if (body.kind != BodyKind::kNode) continue;
      Effect window = make_effect("exchange_window", Place::kNode, body.name, {{"conductance", 0.0}});
      const double sd_W_K = 0.2 * s.unknown_heat_W();
      list.push_back(doubt(run, window, doubted("conductance", "W/K", sd_W_K, 0.1 * sd_W_K), 0.1 * sd_W_K));
    }
  }
  return list;
}

}  // namespace

EffectKind exchange_window() {
  return {.key = "exchange_window",
          .title = "exchange that is there for a while, once or again and again: a lid, a door, a valve",
          .law = "q = film (T - T_surrounding) or Q = conductance (T - T_surrounding) within the windows, else 0",
          .places = {Place::kSurface, Place::kJoint, Place::kRegion, Place::kNode},
          .parameters = {{"film", "W/(m^2 K)", 0.0, 1e7, kNotGiven, "of a surface or joint"},
                         {"conductance", "W/K", 0.0, 1e9, kNotGiven, "or: in all, of a region or node"},
                         {"every", "s", 1.0, 1e9, kNotGiven, "the windows come again after this; wants `until_time`"},
                         {"until_time", "s", 1.0, 1e9, kNotGiven, "when no further turn begins"}},
          .timing = Timing::kInRecord,
          .contribute = contribute,
          .references = {surrounding_reference()},
          .tables = {{kWindows, "s", "s", 0.0, 1e9, true, "rows of [begin, end]"}},
          .check = check,
          .doubts = doubts};
}

}  // namespace driftwright::effects
