#include "effects/doubt.hpp"

namespace driftwright::effects::radiation {

void contribute(const Effect& e, HeatBalance& balance) {
  balance.radiations.push_back({e.name(), e.place, e["emissivity"], e.references.at("surrounding").name});
}

/// Radiation of the sun, a furnace or a cold neighbour on a surface.
std::vector<Doubt> doubts(const DoubtScene& s) {
  const double sd_W = s.unknown_heat_W(), trial_W = 0.1 * sd_W;
  std::vector<Doubt> list;
  for (const std::string& name : s.surfaces) {
    list.push_back({.finding = "radiation",
                    .where = name,
                    .law = "constant heat from a hot body, or to a cold one",
                    .added = {make_effect("heat_source", Place::kSurface, name)},
                    .numbers = {doubted("power", "W", sd_W, trial_W)},
                    .trial = trial_W});
  }
  return list;
}

EffectKind kind() {
  return {.key = "radiation",
          .title = "grey radiation to a surrounding that encloses the surface",
          .law = "q = emissivity sigma (T^4 - T_surrounding^4), T local (Stefan-Boltzmann, CODATA 2018)",
          .places = {Place::kSurface},
          .parameters = {{"emissivity",
                          "1",
                          0.0,
                          1.0,
                          {},
                          "painted or oxidised: 0.8 to 0.95; bright steel: 0.1 to 0.3",
                          0.1,
                          "radiation",
                          Doubted::kFactor}},
          .contribute = contribute,
          .references = {surrounding_reference()},
          .doubts = doubts};
}

}  // namespace driftwright::effects::radiation
