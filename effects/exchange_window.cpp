#include "effects/time_windows.hpp"

namespace driftwright::effects::exchange_window {

/// A region or node has a conductance in total, a surface or joint one per area.
bool is_total(const Effect& e) {
  return e.place_kind == Place::kNode || e.place_kind == Place::kRegion;
}

void contribute(const Effect& e, HeatBalance& balance) {
  const auto windows = windows_of(e);
  const double coefficient = is_total(e) ? e["conductance"] : e["film"];
  const std::string to = e.references.contains("surrounding") ? e.references.at("surrounding").name : kAmbientName;
  balance.exchanges.push_back({.name = e.name(),
                               .body = e.body(),
                               .coefficient = within(windows, coefficient),
                               .per = is_total(e) ? Per::kTotal : Per::kArea,
                               .surrounding = to});
  add_change_times(windows, balance);
}

void check(const Effect& e, const ConfigMap& in) {
  if (e.has("conductance") != is_total(e) || e.has("film") == is_total(e)) {
    in.fail(is_total(e) ? "conductance" : "film",
            "a region or node requires `conductance`, in W/K; a surface or joint requires `film`, in W/(m^2 K)");
  }
  check_windows(e, in);
}

/// A surface that more air reaches for a while. For a region or node, diagnosis/naming.hpp finds place and time from the
/// readings.
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
      film.low = 0.0;
      list.push_back(one_window(run, window, film, 4.0, kLid));
    }
  }
  return list;
}

EffectKind kind() {
  return {.key = "exchange_window",
          .title = "exchange that is there for a while, once or again and again: a lid, a door, a valve",
          .law = "q = film (T - T_surrounding) or Q = conductance (T - T_surrounding) within the windows, else 0",
          .places = {Place::kSurface, Place::kJoint, Place::kRegion, Place::kNode},
          .parameters = repeating({{"film", "W/(m^2 K)", 0.0, 1e7, kNotGiven, "of a surface or joint"},
                                   {"conductance", "W/K", 0.0, 1e9, kNotGiven, "or: in all, of a region or node"}}),
          .timing = Timing::kInRecord,
          .contribute = contribute,
          .references = {surrounding_reference()},
          .tables = {windows_table()},
          .check = check,
          .doubts = doubts};
}

}  // namespace driftwright::effects::exchange_window
