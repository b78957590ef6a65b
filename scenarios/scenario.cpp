#include "scenarios/scenario.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "base/quantity.hpp"

namespace driftwright::scenarios {
namespace {

int read_axis(const ConfigMap& in, const std::string& key) {
  return in.choice(key, {"x", "y", "z"})[0] - 'x';
}

PointOnRegion read_point(const ConfigMap& in) {
  PointOnRegion point{in.text("region"), in.vector3("at", "m"), in.where("at")};
  in.reject_unknown_keys();
  return point;
}

Sensor read_sensor(const ConfigMap& in) {
  Sensor sensor{.name = in.text("name"), .place = {}, .where = in.where()};
  if (in.has("node")) {
    sensor.place = in.text("node");
    sensor.where = in.where("node");
  } else {
    sensor.place = PointOnRegion{in.text("region"), in.vector3("at", "m"), in.where("at")};
  }
  in.reject_unknown_keys();
  return sensor;
}

DisplacementOutput read_displacement(const ConfigMap& in) {
  DisplacementOutput d{in.text("name"), read_axis(in, "along"), read_point(in.map("tool")), read_point(in.map("table"))};
  in.reject_unknown_keys();
  return d;
}

TiltOutput read_tilt(const ConfigMap& in) {
  TiltOutput t{in.text("name"), read_axis(in, "about"), read_point(in.map("from")), read_point(in.map("to")),
               read_point(in.map("table"))};
  if ((t.to.at_m - t.from.at_m).norm() < 1e-3) in.fail("to", "the two points of a tilt must be at least 1 mm apart");
  in.reject_unknown_keys();
  return t;
}

SupportEntry read_support(const ConfigMap& in) {
  SupportEntry entry{{in.text("surface"), {false, false, false}}, in.where("surface")};
  for (const std::string& direction : in.texts("fixed")) {
    if (direction != "x" && direction != "y" && direction != "z") {
      in.fail("fixed", fmt::format("'{}' is no direction; a list of x, y, z is wanted", direction));
    }
    entry.support.fixed[direction[0] - 'x'] = true;
  }
  in.reject_unknown_keys();
  return entry;
}

/// `materials:` maps each region to a name of the library or to a map of values.
std::vector<MaterialEntry> read_materials(const ConfigMap& in) {
  std::vector<std::string> names;
  for (const auto& [name, material] : solver::material_library()) names.push_back(name);
  std::vector<MaterialEntry> entries;
  for (const std::string& region : in.keys()) {
    solver::Material material;
    if (in.is_map(region)) {
      material = solver::read_material(in.map(region));
    } else {
      material = solver::material_library().at(in.choice(region, names));
    }
    entries.push_back({region, material, in.where(region)});
  }
  return entries;
}

TimeSeries read_hall(const ConfigMap& in, double reference_K) {
  TimeSeries hall;
  for (const std::vector<double>& row : in.rows("hall", {"s", "degC"})) {
    if (!hall.time_s.empty() && !(row[0] > hall.time_s.back())) in.fail("hall", "times must increase from row to row");
    hall.time_s.push_back(row[0]);
    hall.value.push_back(row[1] - reference_K);
  }
  return hall;
}

Cyclogram read_cyclogram(const ConfigMap& in, const std::string& name) {
  Cyclogram cyclogram{.name = name, .sections = {}};
  for (const std::vector<double>& row : in.rows(name, {"s", "rpm"})) {
    if (!(row[0] > 0.0)) in.fail(name, fmt::format("a section of {:g} s; a duration above zero is wanted", row[0]));
    if (!(row[1] >= 0.0 && row[1] <= 1e6))
      in.fail(name, fmt::format("a speed of {:g} rpm; 0 to 1e6 rpm is allowed", row[1]));
    cyclogram.sections.push_back({row[0], row[1]});
  }
  return cyclogram;
}

MeshRecipe read_mesh_recipe(const ConfigMap& in) {
  (void)in.choice("generator", {"knee_mill"});
  MeshRecipe recipe = mesh::read_knee_mill(in);
  in.reject_unknown_keys();
  return recipe;
}

void reject_repeated_names(const ConfigMap& in, const MachineModel& m) {
  std::set<std::string> names;
  const auto add = [&](const std::string& name, const char* list) {
    if (!names.insert(name).second) in.fail(list, fmt::format("the name '{}' is used twice", name));
  };
  for (const Sensor& s : m.sensors) add(s.name, "sensors");
  for (const DisplacementOutput& d : m.displacements) add(d.name, "displacements");
  for (const TiltOutput& t : m.tilts) add(t.name, "tilts");
}

MachineModel read_machine(const ConfigMap& in) {
  MachineModel m;
  m.reference_K = in.temperature_K("reference_temperature");
  m.mesh = read_mesh_recipe(in.map("machine"));
  m.materials = read_materials(in.map("materials"));
  for (const ConfigMap& entry : in.maps("supports")) m.supports.push_back(read_support(entry));
  for (const ConfigMap& entry : in.maps("effects")) m.effects.push_back(effects::read_effect(entry));
  for (const ConfigMap& entry : in.maps("sensors")) m.sensors.push_back(read_sensor(entry));
  for (const ConfigMap& entry : in.maps("displacements")) m.displacements.push_back(read_displacement(entry));
  for (const ConfigMap& entry : in.maps("tilts")) m.tilts.push_back(read_tilt(entry));
  m.hall = read_hall(in, m.reference_K);
  m.where = in.where("machine");
  if (m.supports.empty()) in.fail("supports", "no support; name at least one surface that is held");
  if (m.sensors.empty() || m.displacements.empty())
    in.fail("sensors", "at least one sensor and one displacement are wanted");
  reject_repeated_names(in, m);
  return m;
}

SolverSettings read_solver(const ConfigMap& in) {
  SolverSettings s;
  s.transient.relative_tolerance = in.quantity("relative_tolerance", "1", 1e-10, 1e-1, s.transient.relative_tolerance);
  s.transient.absolute_tolerance_K = in.quantity("absolute_tolerance", "K", 1e-9, 1.0, s.transient.absolute_tolerance_K);
  s.output_interval_s = in.quantity("output_interval", "s", 1e-3, 1e6, s.output_interval_s);
  s.fields_every_s = in.quantity("fields_every", "s", 1e-3, 1e9, s.fields_every_s);
  in.reject_unknown_keys();
  return s;
}

Study read_study(const ConfigMap& in, const Scenario& scenario) {
  Study s;
  s.where = in.where();
  s.target = in.text("target");
  if (in.has("candidates")) s.candidates = in.texts("candidates");
  s.sensors_to_choose = in.integer("sensors_to_choose", 1, 1000, s.sensors_to_choose);
  s.tolerance_um = in.quantity("tolerance", "um", 1e-3, 1e6, s.tolerance_um);
  s.encoder_period_um = in.quantity("encoder_period", "um", 1e-3, 1e6, s.encoder_period_um);
  if (scenario.machine) {
    s.train = in.texts("train");
    s.judge = in.text("judge");
    s.thermal_modes = in.integer("thermal_modes", 1, 500, s.thermal_modes);
    std::vector<std::string> known;
    for (const Cyclogram& c : scenario.cyclograms) known.push_back(c.name);
    const auto must_know = [&](const char* key, const std::string& name) {
      if (std::find(known.begin(), known.end(), name) == known.end()) {
        in.fail(key, fmt::format("no cyclogram '{}'; there are {}", name, fmt::join(known, ", ")));
      }
    };
    if (s.train.empty()) in.fail("train", "no cyclogram to train on");
    for (const std::string& name : s.train) must_know("train", name);
    must_know("judge", s.judge);
    if (std::find(s.train.begin(), s.train.end(), s.judge) != s.train.end()) {
      in.fail("judge", "a strategy is judged on a cyclogram it was not fitted on; take another than those of `train`");
    }
    std::vector<std::string> channels;
    for (const DisplacementOutput& d : scenario.machine->displacements) channels.push_back(d.name);
    if (std::find(channels.begin(), channels.end(), s.target) == channels.end()) {
      in.fail("target", fmt::format("no displacement '{}'; there are {}", s.target, fmt::join(channels, ", ")));
    }
    if (s.sensors_to_choose > static_cast<int>(scenario.machine->sensors.size())) {
      in.fail("sensors_to_choose",
              fmt::format("{} of {} sensors cannot be chosen", s.sensors_to_choose, scenario.machine->sensors.size()));
    }
  }
  in.reject_unknown_keys();
  return s;
}

}  // namespace

const Cyclogram& Scenario::cyclogram(const std::string& cyclogram_name) const {
  std::vector<std::string> known;
  for (const Cyclogram& c : cyclograms) {
    if (c.name == cyclogram_name) return c;
    known.push_back(c.name);
  }
  throw InputError(fmt::format("{}: no cyclogram '{}'; there are {}", path, cyclogram_name, fmt::join(known, ", ")));
}

Scenario read_scenario(const std::string& path) {
  const ConfigMap in = ConfigMap::read_file(path);
  Scenario scenario;
  scenario.path = path;
  scenario.name = in.text("name");
  const bool has_machine = in.has("machine");
  if (has_machine) scenario.machine = read_machine(in);
  if (has_machine) {
    const ConfigMap cyclograms = in.map("cyclograms");
    for (const std::string& name : cyclograms.keys()) scenario.cyclograms.push_back(read_cyclogram(cyclograms, name));
    if (scenario.cyclograms.empty()) in.fail("cyclograms", "no cyclogram; at least one list of [duration, speed] is wanted");
    if (const auto solver = in.optional_map("solver")) scenario.solver = read_solver(*solver);
  }
  if (const auto study = in.optional_map("study")) scenario.study = read_study(*study, scenario);
  if (!has_machine && !scenario.study) in.fail("machine", "neither a machine to simulate nor a study of records");
  in.reject_unknown_keys();
  return scenario;
}

}  // namespace driftwright::scenarios
