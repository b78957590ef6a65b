#include "effects/doubt.hpp"

namespace driftwright::effects::heat_capacity {

void change_material(const Effect& e, MaterialFactor& factor) {
  factor.heat_capacity *= e["factor"];
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const DoubtScene::Material& m : s.materials) {
    if (!m.stores) continue;
    list.push_back({.finding = "heat_capacity",
                    .where = m.body.name,
                    .law = "another value",
                    .added = {make_effect("heat_capacity", m.body, {{"factor", 1.0}})},
                    .numbers = {doubted_factor()},
                    .scatters = true});
  }
  return list;
}

EffectKind kind() {
  return {.key = "heat_capacity",
          .title = "a material or a lumped node that stores more or less heat than written",
          .law = "c = factor c_material, at every temperature; C = factor C_node",
          .places = {Place::kRegion, Place::kNode},
          .parameters = {{"factor", "1", 1e-3, 1e3, {}, "on the heat capacity of the region or node"}},
          .change_material = change_material,
          .doubts = doubts};
}

}  // namespace driftwright::effects::heat_capacity
