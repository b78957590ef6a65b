#include "scenarios/reader/read_materials.hpp"

#include "effects/effect_schema.hpp"

namespace driftwright::scenarios {
namespace {

const std::vector<std::string> kKnownRoughly = {"conductivity", "heat_capacity", "expansion"};

}  // namespace

schema::Map materials_schema() {
  using namespace schema;
  std::vector<std::string> names;
  for (const auto& [name, material] : solver::material_library()) names.push_back(name);
  const Key known_to = effects::known_to_key(kKnownRoughly);
  schema::Map like = solver::material_schema(false);
  like.name = "materials, like one of the library";
  like.keys.insert(like.keys.begin(),
                   compulsory("like", choice(names),
                              "of the library (docs/reference/materials.md); what is written beside it replaces its value"));
  like.keys.push_back(known_to);
  like.when_key = "like";
  schema::Map values = solver::material_schema();
  values.name = "materials, by values";
  values.keys.push_back(known_to);
  return {.name = "materials",
          .others = {schema::optional("region", Ways{choice(names), one_of({like, values})},
                                      "a material of the library, or a map: as one of it, or by values")}};
}

std::vector<MaterialEntry> read_materials(const ConfigMap& in) {
  std::vector<MaterialEntry> entries;
  for (const std::string& region : in.keys()) {
    MaterialEntry& entry = entries.emplace_back();
    entry.region = region;
    entry.where = in.where(region);
    if (!in.is_map(region)) {
      entry.material = solver::material_library().at(in.choice(region));
      continue;
    }
    const ConfigMap values = in.map(region);
    entry.known_to = effects::read_known_to(values, kKnownRoughly);
    if (values.description().when_key == "like") {
      entry.material = solver::read_material(values, solver::material_library().at(values.choice("like")));
    } else {
      entry.material = solver::read_material(values);
    }
  }
  return entries;
}

}  // namespace driftwright::scenarios
