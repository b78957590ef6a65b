#include "effects/time_window.hpp"

namespace driftwright::effects {
namespace {

void contribute(const Effect& e, HeatBalance& balance) {
  const double htc = e["film"];
  const Law law = in_window(
      e, [=](const Inputs&) { return htc; }, balance);
  balance.films.push_back({e.name(), e.place, law, e.references.at("surrounding").name});
}

}  // namespace

EffectKind convection() {
  return {.key = "convection",
          .title = "film on a surface, constant or for a time (a draught)",
          .law = "q = film (T - T_surrounding)",
          .places = {Place::kSurface},
          .parameters = with_window({{"film",
                                      "W/(m^2 K)",
                                      0.0,
                                      1e6,
                                      {},
                                      "film coefficient; free convection with radiation: 5 to 12",
                                      0.1,
                                      "convection"}}),
          .contribute = contribute,
          .references = {surrounding_reference()},
          .check = check_window};
}

}  // namespace driftwright::effects
