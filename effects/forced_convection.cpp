#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "effects/doubt.hpp"

namespace driftwright::effects::forced_convection {

void contribute(const Effect& e, HeatBalance& balance) {
  const double growth = e["growth"], n0_rpm = e["at_speed"], exponent = e["exponent"];
  balance.exchanges.push_back(make_film(
      e.name(), e.place, [=](const Inputs& u) { return growth * std::pow(u.drive.speed_rpm / n0_rpm, exponent); },
      e.references.at("surrounding").name));
}

bool grows(const Exchange& film, double rpm) {
  return film.coefficient.probes.empty() &&
         film.coefficient(Inputs{.drive = {.speed_rpm = rpm}}) > film.coefficient(Inputs{});
}

/// Surfaces without a film that grows with speed.
std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const std::string& name : s.surfaces) {
    const auto is_film = [&](const Exchange& e) { return e.body == surface(name) && e.per == Per::kArea; };
    const auto first = std::find_if(s.balance.exchanges.begin(), s.balance.exchanges.end(), is_film);
    const bool has_film = first != s.balance.exchanges.end();
    if (std::any_of(s.balance.exchanges.begin(), s.balance.exchanges.end(),
                    [&](const Exchange& e) { return is_film(e) && grows(e, s.typical_rpm); })) {
      continue;
    }
    Effect film = make_effect("forced_convection", Place::kSurface, name, {{"growth", 0.0}, {"at_speed", s.typical_rpm}});
    if (has_film) film.references["surrounding"] = node(first->surrounding);
    list.push_back({.finding = "forced_convection",
                    .where = name,
                    .law = fmt::format("a film that grows with speed, at {:.0f} rpm", s.typical_rpm),
                    .added = {film},
                    .numbers = {doubted("growth", "W/(m^2 K)", 15.0, 2.0)},
                    .trial = 4.0,
                    .at_speed_rpm = s.typical_rpm});
    list.back().numbers[0].low = 0.0;
    if (!has_film) continue;  // else two films are unknown at once; the exponent is then that of the law
    list.back().numbers.push_back(doubted("exponent", "1", 0.2, 0.05, 0.75));
    list.back().numbers[1].low = 0.3;
    list.back().numbers[1].high = 1.5;
    list.back().grid = {{0.0}};
  }
  return list;
}

EffectKind kind() {
  return {.key = "forced_convection",
          .title = "film that grows with speed, beside the film at standstill",
          .law = "q = growth (n / at_speed)^exponent (T - T_surrounding)",
          .places = {Place::kSurface},
          .parameters = {{"growth", "W/(m^2 K)", 0.0, 1e6, {}, "film added at the stated speed", 0.1, "forced_convection"},
                         {"at_speed", "rpm", 1.0, 1e6, {}, "the stated speed"},
                         {"exponent", "1", 0.1, 2.0, 2.0 / 3.0, "growth with speed", 0.03, "forced_convection"}},
          .timing = Timing::kInTime,
          .contribute = contribute,
          .references = {surrounding_reference()},
          .doubts = doubts,
          .exchange_finding = "forced_convection"};
}

}  // namespace driftwright::effects::forced_convection
