#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void change_material(const Effect& e, MaterialFactor& factor) {
  factor.expansion *= e["factor"];
}

}  // namespace

EffectKind expansion() {
  return {.key = "expansion",
          .title = "a material that expands more or less than written",
          .law = "alpha = factor alpha_material, along each axis",
          .places = {Place::kRegion},
          .parameters = {{"factor", "1", 0.0, 1e3, {}, "on the thermal expansion of the region"}},
          .change_material = change_material};
}

}  // namespace driftwright::effects
