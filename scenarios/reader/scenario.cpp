#include "scenarios/reader/scenario.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <set>

#include "effects/effect_schema.hpp"
#include "effects/feed_axis.hpp"
#include "effects/former_words.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "scenarios/reader/film_files.hpp"
#include "scenarios/reader/read_ambient.hpp"
#include "scenarios/reader/read_columns.hpp"
#include "scenarios/reader/read_cyclogram.hpp"
#include "scenarios/reader/read_limits.hpp"
#include "scenarios/reader/read_materials.hpp"
#include "scenarios/reader/travel_places.hpp"

namespace driftwright::scenarios {
namespace {

void reject_repeated_names(const ConfigMap& in, const MachineModel& m) {
  std::set<std::string> names = {"speed",  "time",   "feed_x",  // further columns of records
                                 "feed_y", "feed_z", "cutting_power"};
  const auto add = [&](const std::string& name, const char* list) {
    if (!names.insert(name).second)
      in.fail(list,
              fmt::format(
                  "the name '{}' is used twice, or is a column of every record (time, speed, feeds, cutting power, ambient)",
                  name));
  };
  for (const Sensor& s : m.sensors) add(s.name, "sensors");
  for (const Sensor& s : m.sensors) {
    if (s.name == kAmbient && !is_on_ambient(s)) in.fail("sensors", "the name 'ambient' is that of the ambient temperature");
  }
  names.insert(kAmbient);
  for (const DisplacementOutput& d : m.displacements) add(d.name, "displacements");
  for (const TiltOutput& t : m.tilts) add(t.name, "tilts");
}

/// Drops the places of an NC program's axes that neither an effect nor a moving body asks for.
void keep_wanted_columns(const MachineModel& machine, Cyclogram& cyclogram) {
  std::vector<std::string> wanted = wanted_columns(machine, cyclogram.name);
  for (const MovingAxis& axis : machine.axes) wanted.push_back(axis.column);
  std::erase_if(cyclogram.columns, [&](const Cyclogram::Column& c) {
    return std::none_of(wanted.begin(), wanted.end(),
                        [&](const auto& name) { return name == c.name || name == c.header(); });
  });
}

/// @throws InputError  for a position that is written in rows of a machine with `axes` and moves nothing
void require_known_positions(const MachineModel& machine, const ConfigMap& rows, const Cyclogram& cyclogram) {
  if (machine.axes.empty()) return;
  std::vector<std::string> known = wanted_columns(machine, cyclogram.name);
  for (const MovingAxis& axis : machine.axes) known.push_back(axis.column);
  for (const Cyclogram::Column& c : cyclogram.columns) {
    if (!c.name.starts_with("position_")) continue;
    if (std::any_of(known.begin(), known.end(), [&](const auto& name) { return name == c.name || name == c.header(); }))
      continue;
    rows.fail("columns", fmt::format("'{}' moves nothing; columns of `axes` and effects are {}.{}", c.header(),
                                     fmt::join(known, ", "), did_you_mean(c.name, known)));
  }
}

/// Gives displacements with a `screw` what the effects `feed_axis` say of it.
void find_screws(MachineModel& m) {
  for (DisplacementOutput& d : m.displacements) {
    if (!d.on_screw) continue;
    OnScrew& on = *d.on_screw;
    effects::Effect* axis = effects::feed_axis_of(m.effects, on.screw);
    if (!axis) {
      const std::vector<std::string> known = effects::screw_names(m.effects);
      throw InputError(on.where, known.empty()
                                     ? fmt::format("there is no screw '{}'; an effect `feed_axis` makes one", on.screw)
                                     : fmt::format("there is no screw '{}'; there are {}.{}", on.screw,
                                                   fmt::join(known, ", "), did_you_mean(on.screw, known)));
    }
    try {
      if (!on.at_m) {
        effects::read_out_at_nut(*axis, d.name);
        m.written += fmt::format("at the nut of {}: {}\n", on.screw, d.name);
        continue;
      }
      on.n_own = d.by_sensitivity->terms.size();
      read_axis_error(m, *axis, d);
    } catch (const RangeError& e) {
      throw InputError(on.where, e.what());
    }
  }
}

/// `start: reference | ambient | steady`, or a temperature.
void read_start(const ConfigMap& in, MachineModel& m) {
  if (!in.has("start")) return;
  const std::string text = in.text("start");
  if (text == "reference") {
    m.start = Start::kReference;
  } else if (text == effects::kAmbientName) {
    m.start = Start::kAmbient;
  } else if (text == "steady") {
    m.start = Start::kSteady;
  } else if (std::isdigit(static_cast<unsigned char>(text.front())) || text.find_first_of("+-.") == 0) {
    m.start = Start::kUniform;
    m.start_K = in.quantity("start");
  } else {
    in.fail("start", fmt::format("'{}' is no start; write reference, ambient, steady or a temperature instead", text));
  }
}

/// `axes`, which need a mesh with bodies to move, and points on them that stay.
void read_moving_bodies(const ConfigMap& in, MachineModel& m) {
  const auto axes = in.optional_map("axes");
  if (!axes) return;
  m.axes = read_axes(*axes);
  m.written += fmt::format("axes: {}\n", in.written("axes"));
  if (std::holds_alternative<LumpedMachine>(m.mesh))
    in.fail("axes", "a machine of lumped nodes has no bodies that slide; `feed_axis` is a screw without a mesh");
  for (const DisplacementOutput& d : m.displacements) {
    if (d.points && d.points->travel_m != Eigen::Vector3d::Zero())
      throw InputError(d.points->table->where,
                       fmt::format("displacement '{}' has `positions`, which move the indicator over a "
                                   "mesh that stays; with `axes` the bodies move, and `positions` "
                                   "must be left out",
                                   d.name));
  }
}

MachineModel read_machine(const ConfigMap& in) {
  MachineModel m;
  m.reference_K = in.quantity("reference_temperature");
  m.mesh = read_mesh_recipe(in.map("machine"));
  if (const auto materials = in.optional_map("materials")) m.materials = read_materials(*materials);
  for (const ConfigMap& entry : in.maps("supports")) m.supports.push_back(read_support(entry));
  for (const ConfigMap& entry : in.maps("joints")) m.joints.push_back(read_joint(entry));
  m.effects = effects::read_effects(in.maps("effects"));
  read_film_files(m.effects, std::filesystem::path(in.file()).parent_path().string());
  for (const ConfigMap& entry : in.maps("sensors")) m.sensors.push_back(read_sensor(entry));
  for (const ConfigMap& entry : in.maps("displacements")) {
    for (DisplacementOutput& d : read_displacements(entry)) m.displacements.push_back(std::move(d));
  }
  for (const ConfigMap& entry : in.maps("tilts")) m.tilts.push_back(read_tilt(entry));
  m.ambient = read_ambient(in, m.reference_K);
  read_start(in, m);
  m.where = in.where("machine");
  for (const char* key : {"reference_temperature", "machine", "materials", "supports", "joints", "sensors", "displacements",
                          "tilts", "start"}) {
    m.written += fmt::format("{}: {}\n", key, in.written(key));
  }
  if (const auto known = in.optional_map("known_together")) m.known_together = read_known_together(*known);
  find_screws(m);
  read_moving_bodies(in, m);
  const bool has_mesh = !std::holds_alternative<LumpedMachine>(m.mesh);
  if (has_mesh && m.supports.empty()) in.fail("supports", "there is no support; name at least one surface that is held");
  if (m.sensors.empty() && m.displacements.empty())
    in.fail("sensors",
            "the scenario has neither a sensor nor a displacement, so it would compute nothing; write `sensors` or "
            "`displacements`");
  reject_repeated_names(in, m);
  return m;
}

SolverSettings read_solver(const ConfigMap& in) {
  SolverSettings s;
  if (in.choice("model") == "reduced") s.model = ModelKind::kReduced;
  s.reduction_tolerance_K = in.quantity("reduction_tolerance");
  s.transient.relative_tolerance = in.quantity("relative_tolerance");
  s.transient.absolute_tolerance_K = in.quantity("absolute_tolerance");
  s.output_interval_s = in.quantity("output_interval");
  s.fields_every_s = in.quantity("fields_every");
  if (in.has("fields_at")) {
    s.fields_at_s = in.quantities("fields_at");
    std::sort(s.fields_at_s.begin(), s.fields_at_s.end());
  }
  s.stresses = in.flag("stresses");
  const std::string format = in.choice("fields_format");
  s.fields_format = format == "none" ? FieldsFormat::kNone : format == "xdmf" ? FieldsFormat::kXdmf : FieldsFormat::kVtu;
  if (s.fields_format == FieldsFormat::kNone && (s.stresses || !s.fields_at_s.empty())) {
    in.fail("fields_format",
            "without fields there are neither stresses nor times for them; leave out `stresses` and `fields_at`");
  }
  in.reject_unknown_keys();
  return s;
}

void check_candidates(const ConfigMap& in, const Study& study, const MachineModel& machine) {
  std::vector<std::string> sensors;
  for (const Sensor& sensor : machine.sensors) sensors.push_back(sensor.name);
  for (const std::string& name : study.candidates) {
    const bool is_ambient = name == kAmbient && has_ambient_channel(machine);
    if (!is_ambient && std::find(sensors.begin(), sensors.end(), name) == sensors.end()) {
      in.fail("candidates", fmt::format("there is no sensor '{}'; there are {}", name, fmt::join(sensors, ", ")));
    }
  }
  const std::size_t n_candidates = study.candidates.empty() ? sensors.size() : study.candidates.size();
  if (study.sensors_to_choose > static_cast<int>(n_candidates)) {
    in.fail("sensors_to_choose", fmt::format("{} of {} sensors cannot be chosen", study.sensors_to_choose, n_candidates));
  }
}

Study read_study(const ConfigMap& in, const Scenario& scenario) {
  Study s;
  s.where = in.where();
  s.target = in.text("target");
  if (in.has("candidates")) s.candidates = in.texts("candidates");
  for (const std::string& name : s.candidates) {
    if (name == s.target) in.fail("candidates", fmt::format("'{}' is the target; it cannot predict itself", name));
    if (std::count(s.candidates.begin(), s.candidates.end(), name) > 1)
      in.fail("candidates", fmt::format("'{}' is listed twice", name));
  }
  const std::string image = in.choice("image");
  s.image = image == "initial_value" ? compensation::Image::kInitialValue
            : image == "mean_value"  ? compensation::Image::kMeanValue
            : image == "range"       ? compensation::Image::kRange
                                     : compensation::Image::kAutomatic;
  s.count_from_start = in.flag("count_from_start");
  s.sensors_to_choose = in.integer("sensors_to_choose");
  s.tolerance_um = in.quantity("tolerance");
  s.encoder_period_um = in.quantity("encoder_period");
  if (scenario.machine) {
    s.train = in.texts("train");
    s.judge = in.text("judge");
    s.thermal_modes = in.integer("thermal_modes");
    std::vector<std::string> known;
    for (const Cyclogram& c : scenario.cyclograms) known.push_back(c.name);
    const auto must_know = [&](const char* key, const std::string& name) {
      if (std::find(known.begin(), known.end(), name) == known.end()) {
        in.fail(key, fmt::format("there is no cyclogram '{}'; there are {}.{}", name, fmt::join(known, ", "),
                                 did_you_mean(name, known)));
      }
    };
    for (const std::string& name : s.train) {
      must_know("train", name);
      if (std::count(s.train.begin(), s.train.end(), name) > 1) in.fail("train", fmt::format("'{}' is listed twice", name));
    }
    must_know("judge", s.judge);
    for (const std::string& name : s.train) {
      if (name == s.judge || drive_alike(scenario.cyclogram(name), scenario.cyclogram(s.judge))) {
        in.fail("judge",
                fmt::format("a strategy is judged on a cyclogram it was not fitted on; '{}' is one of `train`", s.judge));
      }
    }
    std::vector<std::string> channels;
    for (const DisplacementOutput& d : scenario.machine->displacements) channels.push_back(d.name);
    if (std::find(channels.begin(), channels.end(), s.target) == channels.end()) {
      in.fail("target", fmt::format("there is no displacement '{}'; there are {}", s.target, fmt::join(channels, ", ")));
    }
    s.sensor_resolution_K = in.quantity("sensor_resolution");
    check_candidates(in, s, *scenario.machine);
  }
  in.reject_unknown_keys();
  return s;
}

/// Checks that the map has the channels of the study, with or without their units, and its target in um.
void check_columns(const ConfigMap& in, const ColumnMap& columns, const Study& study) {
  std::vector<std::string> names = {study.target}, known;
  names.insert(names.end(), study.candidates.begin(), study.candidates.end());
  for (const MappedChannel& c : columns.channels) known.push_back(c.name);
  for (const std::string& name : names) {
    const auto channel = std::find_if(columns.channels.begin(), columns.channels.end(), [&](const MappedChannel& c) {
      return c.name == name || c.name + "_" + c.unit == name;
    });
    if (channel == columns.channels.end())
      in.fail("", fmt::format("`study` is about the channel '{}', which has no column here; there are {}", name,
                              fmt::join(known, ", ")));
    if (name == study.target && channel->unit != "um")
      in.fail(channel->name,
              fmt::format("the target of `study` is in {} here; it must be a length, which records have in um",
                          channel->written_unit));
  }
}

AxisLoopSettings read_axis_loop_of(const ConfigMap& in, const ConfigMap& axis_loop, const Scenario& scenario) {
  if (!scenario.study) in.fail("axis_loop", "an axis is corrected by what a `study` of a machine has learned");
  AxisLoopContext context{.target = scenario.study->target,
                          .sensor_resolution_K = scenario.study->sensor_resolution_K,
                          .encoder_period_um = scenario.study->encoder_period_um,
                          .duration_s = scenario.cyclogram(scenario.study->judge).duration_s()};
  for (const DisplacementOutput& d : scenario.machine->displacements) context.displacements.push_back(d.name);
  for (const Sensor& s : scenario.machine->sensors) context.sensors.push_back(s.name);
  return read_axis_loop(axis_loop, context);
}

/// A clearer error: with `machine` missing, all keys that need it would be unknown keys.
void reject_what_wants_a_machine(const ConfigMap& top) {
  if (top.has("machine")) return;
  if (top.has("vary"))
    top.fail(
        "vary",
        "this file is a study that varies a scenario: `driftwright sweep` runs it, and `scenario` in it names the scenario");
  if (!top.has("study"))
    top.fail("machine",
             "the key `machine` is missing. A scenario requires it, such as `machine: {generator: lumped}`; only a scenario "
             "about records "
             "alone has `study` instead");
  const schema::Map& with = scenario_schemas()[0];
  const schema::Map& without = scenario_schemas()[1];
  for (const schema::Key& key : with.keys) {
    if (top.has(key.name) && !without.find(key.name))
      top.fail(key.name, "`machine` is required to simulate; without one a scenario is about measured records alone");
  }
}

/// Reads the table and gives the machine a displacement for each of its points.
TableSettings add_table(const ConfigMap& in, MachineModel& machine, const std::vector<Cyclogram>& cyclograms) {
  if (std::holds_alternative<LumpedMachine>(machine.mesh))
    in.fail("region", "`table` requires a mesh, but this machine has none");
  std::vector<std::string> sensors, names;
  for (const Sensor& s : machine.sensors) sensors.push_back(s.name);
  for (const Cyclogram& c : cyclograms) names.push_back(c.name);
  TableSettings table = read_table(in, sensors, names);
  const auto run = std::find(names.begin(), names.end(), table.cyclogram) - names.begin();
  const double taught_s = cyclograms[static_cast<std::size_t>(run)].duration_s() - table.train_from_s;
  if (!(taught_s >= 2.0 * table.every_s)) {
    in.fail("train_from", fmt::format("{:g} h are left to learn from; three measurements, {:g} h, are required",
                                      taught_s / 3600.0, table.every_s / 1800.0));
  }
  for (DisplacementOutput& d : table_displacements(table)) machine.displacements.push_back(std::move(d));
  for (const Eigen::Vector3d& p : table_points(table))
    machine.written += fmt::format("table: {} {:.17g} {:.17g} {:.17g}\n", table.region, p[0], p[1], p[2]);
  return table;
}

}  // namespace

const Cyclogram& Scenario::cyclogram(const std::string& cyclogram_name) const {
  std::vector<std::string> known;
  for (const Cyclogram& c : cyclograms) {
    if (c.name == cyclogram_name) return c;
    known.push_back(c.name);
  }
  throw InputError(fmt::format("{}: there is no cyclogram '{}'; there are {}.{}", path, cyclogram_name,
                               fmt::join(known, ", "), did_you_mean(cyclogram_name, known)));
}

void check_cyclogram(const Scenario& scenario, const Cyclogram& cyclogram) {
  constexpr double kMostOutputs = 1e6;
  const double n_outputs = cyclogram.duration_s() / scenario.solver.output_interval_s;
  if (!(n_outputs <= kMostOutputs)) {
    throw InputError(
        fmt::format("{}: cyclogram '{}' would give {:.1e} rows of output, more than {:.0e}; take a longer output_interval",
                    scenario.path, cyclogram.name, n_outputs, kMostOutputs));
  }
  for (const Cyclogram::Section& section : cyclogram.sections)
    require_speed_within_limits(scenario, section.drive.speed_rpm, fmt::format("cyclogram '{}'", cyclogram.name));
  require_within_range(scenario.machine->axes, cyclogram);
  const Cyclogram felt = felt_run_as_far_as_known(*scenario.machine, cyclogram).cyclogram;
  for (const effects::Effect& effect : scenario.machine->effects) {
    const effects::HeatBalance balance = effects::heat_balance({effect});
    for (const Cyclogram::Section& section : felt.sections) {
      effects::Inputs at{.drive = section.drive};
      at.run = cyclogram.name;
      try {
        balance.for_each_law([&](const std::string&, const effects::Law& law) {
          if (law.probes.empty()) (void)law(at);  // laws of temperatures are tried during the run
        });
      } catch (const RangeError& e) {
        throw InputError(effect.where, fmt::format("{} at the {:g} rpm of cyclogram '{}': {}", effect.name(),
                                                   section.drive.speed_rpm, cyclogram.name, e.what()));
      }
    }
  }
}

void require_speed_within_limits(const Scenario& scenario, double speed_rpm, const std::string& who) {
  constexpr double kRounding = 1.0 + 1e-9;  // of units: 2000 rpm through 1/s and back
  if (!(speed_rpm > scenario.limits.speed_rpm * kRounding)) return;
  throw InputError(
      fmt::format("{}: {} turns the spindle at {:g} rpm, but `limits` allows {:g} rpm at most; lower the speed, "
                  "or raise `speed` of `limits` if the machine may turn so fast",
                  scenario.path, who, speed_rpm, scenario.limits.speed_rpm));
}

Scenario read_scenario(const std::string& path) {
  return read_scenario(ConfigMap::of_tree(effects::read_scenario_tree(path)));
}

Scenario read_scenario(const ConfigMap& top) {
  reject_what_wants_a_machine(top);
  const ConfigMap in = top.described_by(scenario_schemas());
  Scenario scenario;
  scenario.path = in.file();
  scenario.name = in.name("name");
  const bool has_machine = in.description().when_key == "machine";
  if (const auto limits = in.optional_map("limits")) scenario.limits = read_machine_limits(*limits);
  if (has_machine) {
    scenario.machine = read_machine(in);
    const ConfigMap cyclograms = in.map("cyclograms");
    for (const std::string& name : cyclograms.keys()) {
      Cyclogram& read = scenario.cyclograms.emplace_back(read_cyclogram(cyclograms, name));
      if (!cyclograms.is_map(name)) continue;
      const ConfigMap map = cyclograms.map(name);
      if (map.description().when_key == "rows") require_known_positions(*scenario.machine, map, read);
      if (map.description().when_key != "nc_program") continue;
      require_within_range(scenario.machine->axes, read);  // while it has the strokes that nobody asks for
      keep_wanted_columns(*scenario.machine, read);
    }
    if (scenario.cyclograms.empty())
      in.fail("cyclograms", "there is no cyclogram; at least one list of [duration, speed] is required");
    if (const auto solver = in.optional_map("solver")) scenario.solver = read_solver(*solver);
    for (const Cyclogram& c : scenario.cyclograms) check_cyclogram(scenario, c);
    const bool has_fields = scenario.solver.stresses || !scenario.solver.fields_at_s.empty();
    if (has_fields && std::holds_alternative<LumpedMachine>(scenario.machine->mesh)) {
      in.fail("solver", "a lumped machine has no fields; leave out `fields_at` and `stresses`");
    }
    double longest_s = 0.0;
    for (const Cyclogram& c : scenario.cyclograms) longest_s = std::max(longest_s, c.duration_s());
    if (!scenario.solver.fields_at_s.empty() && scenario.solver.fields_at_s.back() > longest_s) {
      in.fail("solver", fmt::format("`fields_at` names {:g} min; the longest cyclogram ends at {:g} min",
                                    scenario.solver.fields_at_s.back() / 60.0, longest_s / 60.0));
    }
  }
  if (const auto study = in.optional_map("study")) scenario.study = read_study(*study, scenario);
  if (const auto columns = in.optional_map("columns")) {
    scenario.columns = read_columns(*columns);
    if (scenario.study) check_columns(columns->map("channels"), *scenario.columns, *scenario.study);
  }
  if (const auto topics = in.optional_map("topics")) {
    for (const std::string& channel : topics->keys()) scenario.topics[channel] = topics->text(channel);
    topics->reject_unknown_keys();
  }
  if (!has_machine) {
    in.reject_unknown_keys();
    return scenario;
  }
  if (const auto programme = in.optional_map("programme")) {
    if (scenario.machine->displacements.empty())
      in.fail("programme", "a programme judges predictors of drift and requires `displacements`");
    scenario.programme = read_programme(*programme);
    for (const Cyclogram& c : scenario.programme->cyclograms) check_cyclogram(scenario, c);
    for (const Cyclogram& c : test_cyclograms(*scenario.programme)) check_cyclogram(scenario, c);
  }
  if (const auto validation = in.optional_map("validation")) {
    if (!scenario.study) in.fail("validation", "a `study` that names the target is required");
    std::vector<const Cyclogram*> known;
    for (const Cyclogram& c : scenario.cyclograms) known.push_back(&c);
    if (scenario.programme) {
      for (const Cyclogram& c : scenario.programme->cyclograms) {
        if (std::none_of(known.begin(), known.end(), [&](const Cyclogram* k) { return k->name == c.name; }))
          known.push_back(&c);
      }
    }
    scenario.validation = read_validation(*validation, known, scenario.study->tolerance_um);
    for (const Validation::Family& family : scenario.validation->families) {
      for (const Cyclogram& c : family.cyclograms) check_cyclogram(scenario, c);
    }
  }
  if (const auto schedule = in.optional_map("schedule")) {
    const double tolerance_um = scenario.study ? scenario.study->tolerance_um : Study{}.tolerance_um;
    scenario.schedule = read_schedule(*schedule, scenario.machine->displacements, tolerance_um);
  }
  if (const auto axis_loop = in.optional_map("axis_loop")) scenario.axis_loop = read_axis_loop_of(in, *axis_loop, scenario);
  if (const auto table = in.optional_map("table")) {
    scenario.table = add_table(*table, *scenario.machine, scenario.cyclograms);
  }
  if (const auto volume = in.optional_map("volume"))
    scenario.volume = read_volume(*volume, scenario.machine->axes, scenario.cyclograms);
  check_instruments(*scenario.machine, scenario.cyclograms);  // displacements include the points of a table
  in.reject_unknown_keys();
  return scenario;
}

bool says_known_to(const MachineModel& model) {
  const auto says = [](const auto& entry) {
    return std::any_of(entry.known_to.begin(), entry.known_to.end(), [](const auto& said) { return said.second > 0.0; });
  };
  return !model.known_together.numbers.empty() || std::any_of(model.effects.begin(), model.effects.end(), says) ||
         std::any_of(model.materials.begin(), model.materials.end(), says);
}

const MachineModel& require_machine(const Scenario& scenario, const std::string& verb) {
  if (scenario.machine) return *scenario.machine;
  throw InputError(
      fmt::format("{}: `{}` needs the key `machine`; this scenario is about measured records alone (select, validate)",
                  scenario.path, verb));
}

const Study& require_study(const Scenario& scenario, const std::string& verb) {
  if (scenario.study) return *scenario.study;
  throw InputError(fmt::format("{}: `{}` needs the key `study`, which says the target and what to fit{}", scenario.path,
                               verb, scenario.machine ? "; `simulate` and `predict` need none" : ""));
}

}  // namespace driftwright::scenarios
