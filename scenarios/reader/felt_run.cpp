#include "scenarios/reader/felt_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/lists.hpp"
#include "base/quantity.hpp"
#include "effects/recorded_column.hpp"

namespace driftwright::scenarios {
namespace {

void must_be_one_of(const Where& where, const char* what, const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  if (known.empty()) throw InputError(where, fmt::format("there is no {} '{}', nor any other", what, name));
  const std::string near = nearest_word(name, known);
  throw InputError(where, fmt::format("there is no {} '{}'; there are {}.{}", what, name, fmt::join(known, ", "),
                                      near.empty() ? "" : fmt::format(" Did you mean '{}'?", near)));
}

/// A loop is closed by the motor's encoder or by a scale: a displacement has the error of one of them.
void require_one_loop(const effects::Effect& effect, const std::vector<DisplacementOutput>& displacements) {
  if (effect.kind->key != "linear_scale") return;
  for (const DisplacementOutput& d : displacements) {
    if (d.name != effect.place || !d.on_screw) continue;
    throw InputError(
        effect.where,
        fmt::format("'{}' reads screw '{}' in a loop that the motor's encoder closes; a scale that closes the loop "
                    "leaves nothing of the screw's growth. Write another displacement without `screw` for the scale",
                    d.name, d.on_screw->screw));
  }
}

/// Requires `tilt` for tilts, and any other amount for displacements.
void require_fitting_amount(const effects::Effect& effect, bool is_tilt) {
  if (is_tilt && effect.kind->key == "linear_scale")
    throw InputError(effect.where, fmt::format("'{}' is a tilt; a linear_scale fits displacements alone", effect.place));
  const std::vector<effects::Parameter>& parameters = effect.kind->parameters;
  const auto knows = [&](const char* name) {
    return std::any_of(parameters.begin(), parameters.end(), [&](const auto& p) { return p.name == name; });
  };
  if (!knows("tilt") || effect.has("tilt") == is_tilt) return;
  if (knows("share") && effect.has("share")) {
    if (is_tilt)
      throw InputError(effect.where,
                       fmt::format("'{}' is a tilt; a `share` of a displacement fits displacements alone", effect.place));
    return;
  }
  if (knows("gain") && effect.has("gain")) return;  // a gain has the unit of its displacement
  throw InputError(effect.where,
                   is_tilt ? fmt::format("'{}' is a tilt; {} requires `tilt` in urad there", effect.place, effect.kind->key)
                           : fmt::format("'{}' is a displacement, no tilt; `tilt` does not fit", effect.place));
}

/// Calls work(effect, mention, name) for each column that effects name and that is no channel of the drive.
template <class Work>
void for_each_wanted_column(const MachineModel& model, const std::string& cyclogram, Work work) {
  for (const effects::Effect& e : model.effects) {
    if (!e.acts_in(cyclogram)) continue;
    for (const effects::Mention& mention : e.kind->mentions) {
      if (mention.of != effects::Mention::Of::kColumn) continue;
      if (const std::string& name = e.words.at(mention.name); !name.empty() && !effects::is_drive_channel(name))
        work(e, mention, name);
    }
  }
}

}  // namespace

bool is_on_ambient(const Sensor& sensor) {
  const auto* node = std::get_if<std::string>(&sensor.place);
  return node && *node == effects::kAmbientName;
}

bool has_ambient_channel(const MachineModel& model) {
  return std::none_of(model.sensors.begin(), model.sensors.end(), is_on_ambient);
}

std::vector<std::string> wanted_columns(const MachineModel& model, const std::string& cyclogram) {
  std::vector<std::string> names;
  for_each_wanted_column(model, cyclogram,
                         [&](const auto&, const auto&, const std::string& name) { names.push_back(name); });
  return names;
}

void require_columns(const MachineModel& model, const Cyclogram& cyclogram) {
  const auto require = [&](const effects::Effect& effect, const effects::Mention& mention, const std::string& name) {
    const Cyclogram::Column* column = cyclogram.column(name);
    if (!column) {
      const std::string unit = mention.unit.empty() ? "" : "_" + mention.unit,
                        column_header = name.ends_with(unit) ? name : name + unit;  // as `columns` requires it
      std::vector<std::string> known;
      for (const Cyclogram::Column& c : cyclogram.columns) known.push_back(c.header());
      throw InputError(
          effect.where,
          fmt::format("{} requires the column '{}', which cyclogram '{}' does not have ({}); take a record that has "
                      "it (`{{csv: FILE}}`), or give it in rows (`columns: [duration, speed, {}]`)",
                      effect.name(), name, cyclogram.name,
                      known.empty() ? "it has none beside the drive" : fmt::format("it has {}", fmt::join(known, ", ")),
                      column_header));
    }
    if (!mention.unit.empty() && column->unit != mention.unit)
      throw InputError(effect.where, fmt::format("the `{}` of {} must be in {}; the column '{}' is in {}", mention.name,
                                                 effect.name(), mention.unit, column->name, column->unit));
    const bool wants_temperature = effect.kind->key == "displacement_path" && !effect.has("gain");
    if (wants_temperature && column->unit != "degC")
      throw InputError(effect.where,
                       fmt::format("{} follows temperatures in degC by its `sensitivity`; the column '{}' is in "
                                   "{}, which `gain` (um per {}) is for",
                                   effect.name(), column->name, column->unit, column->unit));
  };
  for_each_wanted_column(model, cyclogram.name, require);
}

MachineRun felt_run(const MachineModel& model, const Cyclogram& recorded) {
  require_columns(model, recorded);
  require_resting(model.axes, recorded);
  return felt_run_as_far_as_known(model, recorded);
}

MachineRun felt_run_as_far_as_known(const MachineModel& model, const Cyclogram& recorded) {
  const effects::DriveChange change = effects::drive_change(model.effects, recorded.name);
  MachineRun felt{.cyclogram = effects::true_cyclogram(change, recorded), .ambient = {}};
  felt.ambient = effects::true_ambient(change, model.ambient, felt.cyclogram);
  felt.before = effects::driven_before(change, felt.cyclogram);
  return felt;
}

void require_nothing_before(const MachineModel& model, const std::string& verb) {
  for (const effects::Effect& e : model.effects) {
    if (effects::drive_change({e}, e.in).before.empty()) continue;
    throw InputError(e.where,
                     fmt::format("{} has the machine driven before cyclogram '{}'; `{}` begins every cyclogram at the "
                                 "scenario's `start`: take it out (`simulate`, `diagnose`, `predict` and `view` know it)",
                                 e.name(), e.in, verb));
  }
}

namespace {

double felt_at_start_K(const MachineModel& model, const TimeSeries& ambient) {
  return effects::true_ambient(effects::drive_change(model.effects, ""), ambient, {}).at(0.0);
}

bool starts_with_ambient(const MachineModel& model) {
  return model.start == Start::kAmbient || model.start == Start::kSteady;
}

}  // namespace

double felt_ambient_at_start_K(const MachineModel& model) {
  return felt_at_start_K(model, model.ambient);
}

double warmer_start_K(const MachineModel& model, const Cyclogram& recorded) {
  if (!starts_with_ambient(model)) return 0.0;
  return felt_run_as_far_as_known(model, recorded).ambient.at(0.0) - felt_ambient_at_start_K(model);
}

double warmer_start_K(const MachineModel& model, const TimeSeries& ambient) {
  if (!starts_with_ambient(model)) return 0.0;
  return felt_at_start_K(model, ambient) - felt_ambient_at_start_K(model);
}

std::vector<std::string> sensor_channels(const Record& record) {
  std::vector<std::string> names = record.names_with_unit("degC");
  std::erase(names, kAmbient);
  return names;
}

void check_instruments(const MachineModel& model, const std::vector<Cyclogram>& cyclograms) {
  const std::vector<std::string> sensors = names_of(model.sensors), runs = names_of(cyclograms),
                                 tilts = names_of(model.tilts);
  std::vector<std::string> displacements = names_of(model.displacements);
  std::vector<std::string> by_sensitivities;
  for (const DisplacementOutput& d : model.displacements) {
    if (d.by_sensitivity) by_sensitivities.push_back(d.name);
  }
  displacements.insert(displacements.end(), tilts.begin(), tilts.end());
  for (const effects::Effect& e : model.effects) {
    if (e.place_kind == effects::Place::kSensor) must_be_one_of(e.where, "sensor", e.place, sensors);
    if (e.place_kind == effects::Place::kDisplacement) {
      must_be_one_of(e.where, "displacement", e.place, displacements);
      require_fitting_amount(e, std::find(tilts.begin(), tilts.end(), e.place) != tilts.end());
      require_one_loop(e, model.displacements);
    }
    for (const effects::Mention& mention : e.kind->mentions) {
      const std::string& name = e.words.at(mention.name);
      const bool is_sensor = mention.of == effects::Mention::Of::kSensor;
      const bool is_instrument = is_sensor || mention.of == effects::Mention::Of::kDisplacement;
      if (name.empty() || !is_instrument) continue;  // not given; or a column, which require_columns() checks; or no name
      must_be_one_of(e.reference_where.at(mention.name), is_sensor ? "sensor" : "displacement", name,
                     is_sensor ? sensors : by_sensitivities);
    }
    if (!e.in.empty()) must_be_one_of(e.reference_where.at("in"), "cyclogram", e.in, runs);
  }
}

}  // namespace driftwright::scenarios
