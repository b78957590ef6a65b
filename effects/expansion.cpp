#include "effects/doubt.hpp"

namespace driftwright::effects::expansion {

void change_material(const Effect& e, MaterialFactor& factor) {
  factor.expansion *= e["factor"];
  factor.displacement = e.words.at("displacement");
}

void check(const Effect& e, const ConfigMap& in) {
  if (e.place_kind != Place::kRegion && e.words.at("displacement").empty())
    in.fail(
        "displacement",
        "only a region has a material that expands; elsewhere `displacement` must name the one whose sensitivity is meant");
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const DoubtScene::Material& m : s.materials) {
    const auto add = [&](const std::string& displacement) {
      Effect expansion = make_effect("expansion", m.body, {{"factor", 1.0}});
      expansion.words["displacement"] = displacement;
      list.push_back({.finding = "expansion",
                      .where = m.body.name,
                      .law = "another value",
                      .added = {expansion},
                      .numbers = {doubted_factor()},
                      .scatters = true});
    };
    for (const std::string& displacement : m.sensitivities) add(displacement);
    if (m.expands) add("");
  }
  return list;
}

EffectKind kind() {
  return {.key = "expansion",
          .title = "a material that expands more or less than written",
          .law = "alpha = factor alpha_material, along each axis; a displacement's sensitivity to the body times the factor",
          .places = {Place::kRegion, Place::kSurface, Place::kNode},
          .parameters = {{"factor", "1", 0.0, 1e3, {}, "on the thermal expansion of the body"}},
          .change_material = change_material,
          .check = check,
          .mentions = {{"displacement", Mention::Of::kDisplacement, false,
                        "the only displacement by sensitivities that it is about; left out: the material and all of them"}},
          .doubts = doubts};
}

}  // namespace driftwright::effects::expansion
