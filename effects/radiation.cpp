#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void contribute(const Effect& e, HeatBalance& balance) {
  balance.radiations.push_back({e.name(), e.place, e["emissivity"], e.references.at("surrounding").name});
}

}  // namespace

EffectKind radiation() {
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
                          "radiation"}},
          .contribute = contribute,
          .references = {surrounding_reference()}};
}

}  // namespace driftwright::effects
