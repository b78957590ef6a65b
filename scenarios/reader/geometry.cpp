#include "scenarios/reader/geometry.hpp"

#include <filesystem>

#include "effects/effect_schema.hpp"
#include "effects/former_words.hpp"
#include "scenarios/reader/film_files.hpp"
#include "scenarios/reader/read_materials.hpp"

namespace driftwright::scenarios {
namespace {

const schema::Map& geometry_schema() {
  using namespace schema;
  static const schema::Map description = {
      .name = "scenario (geometry alone)",
      .keys = {compulsory("name", schema::name(), "of the scenario"),
               compulsory("machine", mesh_recipe_schema(), "the mesh"),
               schema::optional("materials", schema::map(materials_schema()), "of each region"),
               schema::optional("sensors", schema::maps(sensor_schema()), "thermometers"),
               schema::optional("displacements", schema::maps(displacement_schema()),
                                "errors of the tool against the table"),
               schema::optional("tilts", schema::maps(tilt_schema()), "changes of angles"),
               schema::optional("effects", list(one_of(effects::effect_schemas())), "what heats, cools and connects")},
      .others = {schema::optional("key", schema::anything(), "of the whole scenario")}};
  return description;
}

/// The effects that take their film from a file; the others may still be unfinished.
std::vector<effects::Effect> read_films(const ConfigMap& in) {
  std::vector<effects::Effect> films;
  if (!in.has("effects") || !in.is_list("effects")) return films;
  for (const ConfigNodePtr& entry : in.value("effects")->items) {
    const ConfigNode* type = entry->is_map() ? entry->find("type") : nullptr;
    if (type && type->is_scalar() && type->text == "film_field")
      films.push_back(effects::read_effect(ConfigMap::of_tree(entry)));
  }
  read_film_files(films, std::filesystem::path(in.file()).parent_path().string());
  return films;
}

}  // namespace

Geometry read_geometry(const std::string& path, bool with_effects) {
  const ConfigMap in = ConfigMap::of_tree(effects::read_scenario_tree(path)).described_by(geometry_schema());
  Geometry geometry{in.name("name"), {}};
  MachineModel& m = geometry.machine;
  m.mesh = read_mesh_recipe(in.map("machine"));
  m.where = in.where("machine");
  if (const auto materials = in.optional_map("materials")) m.materials = read_materials(*materials);
  for (const ConfigMap& entry : in.maps("sensors")) m.sensors.push_back(read_sensor(entry));
  for (const ConfigMap& entry : in.maps("displacements")) {
    for (DisplacementOutput& d : read_displacements(entry)) m.displacements.push_back(std::move(d));
  }
  if (with_effects) {
    for (const ConfigMap& entry : in.maps("tilts")) m.tilts.push_back(read_tilt(entry));
  }
  m.effects = with_effects ? effects::read_effects(in.maps("effects")) : read_films(in);
  return geometry;
}

}  // namespace driftwright::scenarios
