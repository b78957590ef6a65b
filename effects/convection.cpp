#include "effects/doubt.hpp"

namespace driftwright::effects::convection {

void contribute(const Effect& e, HeatBalance& balance) {
  balance.exchanges.push_back(make_film(
      e.name(), e.place, [htc = e["film"]](const Inputs&) { return htc; }, e.references.at("surrounding").name));
}

/// Outer surfaces on which the scenario has no film.
std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const std::string& name : s.surfaces) {
    if (has_film(s.balance, name)) continue;
    list.push_back({.finding = "convection",
                    .where = name,
                    .law = "a film where the scenario has none",
                    .added = {make_effect("convection", Place::kSurface, name)},
                    .numbers = {doubted("film", "W/(m^2 K)", 10.0, 1.0)},
                    .trial = 3.0});
    list.back().numbers[0].low = 0.0;
  }
  return list;
}

EffectKind kind() {
  return {.key = "convection",
          .title = "film on a surface, constant or for a time (a draught)",
          .law = "q = film (T - T_surrounding)",
          .places = {Place::kSurface},
          .parameters = {{"film",
                          "W/(m^2 K)",
                          0.0,
                          1e6,
                          {},
                          "film coefficient; free convection with radiation: 5 to 12",
                          0.1,
                          "convection"}},
          .timing = Timing::kInTime,
          .contribute = contribute,
          .references = {surrounding_reference()},
          .doubts = doubts,
          .exchange_finding = "convection"};
}

}  // namespace driftwright::effects::convection
