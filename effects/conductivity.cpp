#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void change_material(const Effect& e, MaterialFactor& factor) {
  factor.conductivity *= e["factor"];
}

}  // namespace

EffectKind conductivity() {
  return {.key = "conductivity",
          .title = "a material that conducts better or worse than written",
          .law = "k = factor k_material, at every temperature",
          .places = {Place::kRegion},
          .parameters = {{"factor", "1", 1e-3, 1e3, {}, "on the conductivity of the region"}},
          .change_material = change_material};
}

}  // namespace driftwright::effects
