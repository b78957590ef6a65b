#include "effects/doubt.hpp"

namespace driftwright::effects::conductivity {

void change_material(const Effect& e, MaterialFactor& factor) {
  factor.conductivity *= e["factor"];
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const DoubtScene::Material& m : s.materials) {
    if (!m.conducts) continue;
    list.push_back({.finding = "conductivity",
                    .where = m.body.name,
                    .law = "another value",
                    .added = {make_effect("conductivity", m.body, {{"factor", 1.0}})},
                    .numbers = {doubted_factor()},
                    .scatters = true});
  }
  return list;
}

EffectKind kind() {
  return {.key = "conductivity",
          .title = "a material that conducts better or worse than written",
          .law = "k = factor k_material, at every temperature",
          .places = {Place::kRegion},
          .parameters = {{"factor", "1", 1e-3, 1e3, {}, "on the conductivity of the region"}},
          .change_material = change_material,
          .doubts = doubts};
}

}  // namespace driftwright::effects::conductivity
