#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.scales.push_back({e.place, e["factor"], e["lag"] * 60.0});
}

void check(const Effect&, const ConfigMap& in) {
  if (!in.has("factor") && !in.has("lag")) in.fail("factor", "`factor`, `lag` or both are wanted");
}

}  // namespace

EffectKind scale_expansion() {
  return {.key = "scale_expansion",
          .title = "linear scale that expands itself, and so scales what it measures, or follows late",
          .law =
              "lag du/dt = factor u_machine - u, u = factor u_machine at t = 0; a scale that takes part in the machine's "
              "expansion by the share s sees the factor 1 - s",
          .places = {Place::kDisplacement},
          .parameters = {{"factor", "1", -10.0, 10.0, 1.0, "on the displacement"},
                         {"lag", "min", 0.0, 1e5, 0.0, "time constant of the scale"}},
          .change_readings = change_readings,
          .check = check};
}

}  // namespace driftwright::effects
