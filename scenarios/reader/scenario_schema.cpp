// Which keys a scenario has.

#include "effects/effect_schema.hpp"
#include "scenarios/reader/read_ambient.hpp"
#include "scenarios/reader/read_columns.hpp"
#include "scenarios/reader/read_cyclogram.hpp"
#include "scenarios/reader/read_limits.hpp"
#include "scenarios/reader/read_materials.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::scenarios {
namespace {

schema::Map solver_schema() {
  using namespace schema;
  const SolverSettings s;
  return {
      .name = "solver",
      .keys =
          {schema::optional("model", choice({"full", "reduced"}), "full",
                            "what cyclograms are run on; `reduced`: docs/theory/reduced_model.md"),
           schema::optional("reduction_tolerance", quantity("K", 1e-5, 1.0), s.reduction_tolerance_K,
                            "of the reduced model against the full one"),
           schema::optional("relative_tolerance", quantity("1", 1e-10, 1e-1), s.transient.relative_tolerance,
                            "of the integration in time"),
           schema::optional("absolute_tolerance", quantity("K", 1e-9, 1.0), s.transient.absolute_tolerance_K, "the same"),
           schema::optional("output_interval", quantity("s", 1e-3, 1e6), s.output_interval_s,
                            "between two rows of a record"),
           schema::optional("fields_every", quantity("s", 1e-3, 1e9), s.fields_every_s,
                            "between two written fields; start and end are written in any case"),
           schema::optional("fields_at", list(quantity("s", 0.0), 1), "or: the times of fields"),
           schema::optional("stresses", flag(), "false",
                            "true: stresses beside the other fields (docs/reference/outputs.md)"),
           schema::optional(
               "fields_format", choice({"vtu", "xdmf", "none"}), "vtu",
               "`vtu`: open `fields.pvd`; `xdmf`: open `fields.xdmf`, for more than about 100 times; `none`: no fields, and "
               "without `displacements` and `tilts` no elasticity is computed")},
      .groups = {{Group::Rule::kAtMostOne,
                  {"fields_every", "fields_at"},
                  "`fields_at` and `fields_every` exclude each other; write only one of them"}}};
}

/// @param of_machine  true: its cyclograms are simulated; false: it is about records alone
schema::Map study_schema(bool of_machine) {
  using namespace schema;
  const Study s;
  schema::Map map = {.name = of_machine ? "study" : "study (of records alone)",
                     .keys = {compulsory("target", text(), "displacement that ranking and verdict are about")},
                     .about = "What is fitted and what it is judged by."};
  if (of_machine) {
    map.keys.push_back(compulsory("train", list(text(), 1), "cyclograms that are fitted on"));
    map.keys.push_back(
        compulsory("judge", text(), "cyclogram that is judged on; none of `train`, under another name either"));
    map.keys.push_back(schema::optional("sensor_resolution", quantity("K", 0.0, 10.0), s.sensor_resolution_K,
                                        "step of the thermometers' readings; 0: exact"));
    map.keys.push_back(schema::optional("thermal_modes", integer(1, 500), s.thermal_modes, "that are computed"));
  }
  for (Key& key : std::vector<Key>{
           schema::optional("candidates", list(text()), Said{"all"}, "temperature channels to choose from"),
           schema::optional("sensors_to_choose", integer(1, 1000), s.sensors_to_choose, "by ranking"),
           schema::optional("image", choice({"automatic", "initial_value", "mean_value", "range"}), "automatic",
                            "of grey grades, that sensors are ranked by"),
           schema::optional("count_from_start", flag(), "false", "true: records count from their first rows"),
           schema::optional("tolerance", quantity("um", 1e-3, 1e6), s.tolerance_um, "that the drift is to be kept in"),
           schema::optional("encoder_period", quantity("um", 1e-3, 1e6), s.encoder_period_um,
                            "travel of one period of the encoder's signal")})
    map.keys.push_back(std::move(key));
  return map;
}

schema::Key name_key() {
  return schema::compulsory("name", schema::name(), "of the scenario; names the folder of results");
}
schema::Key columns_key() {
  return schema::optional(
      "columns", schema::map(columns_schema()),
      "how the records that verbs are given are written where a logger wrote them (docs/reference/record.md)");
}

schema::Map topics_schema() {
  return {.name = "topics",
          .others = {schema::compulsory("channel", schema::text(),
                                        "an MQTT topic, a metric of Sparkplug B, or an MTConnect data item's id or name")},
          .about = "Channels as records name them (`speed_rpm: mill/speed`); `--topic` takes the place of all of them."};
}
schema::Key topics_key() {
  return schema::optional("topics", schema::map(topics_schema()),
                          "where `follow` takes each channel's numbers from (docs/how-to/follow.md)");
}

schema::Key limits_key() {
  return schema::optional("limits", schema::map(machine_limits_schema()),
                          "of the machine and its corrections; beyond them nothing is planned and nothing corrected");
}

schema::Map machine_scenario_schema() {
  using namespace schema;
  return {
      .name = "scenario",
      .keys =
          {name_key(),
           compulsory("machine", mesh_recipe_schema(),
                      "the mesh: a generator and its dimensions, a file (docs/how-to/meshes.md), or none"),
           compulsory("reference_temperature", temperature(), "the machine is straight and free of stress at it"),
           schema::optional("start", Ways{choice({"reference", "ambient", "steady"}), temperature()}, Said{"reference"},
                            "state at t = 0: at the reference temperature, at the first ambient temperature, at standstill "
                            "in it, or at a temperature"),
           schema::optional("materials", schema::map(materials_schema()), "of each region of the mesh"),
           schema::optional("supports", schema::maps(support_schema()),
                            "what holds surfaces to the ground (below); compulsory with a mesh"),
           schema::optional("joints", schema::maps(joint_schema()), Said{"tied"},
                            "mechanics of joints that are not tied (below)"),
           schema::optional("axes", schema::map(axes_schema()), "bodies of the mesh that slide, and where they are"),
           schema::optional("effects", list(one_of(effects::effect_schemas())),
                            "what heats, cools, connects and measures (below); every joint needs a `contact`"),
           ambient_key(),
           schema::optional("known_together", schema::map(known_together_schema()),
                            "how well numbers are known together; `calibrate` writes it"),
           schema::optional("sensors", schema::maps(sensor_schema()), "thermometers"),
           schema::optional("displacements", schema::maps(displacement_schema()), "errors of the tool against the table"),
           schema::optional("tilts", schema::maps(tilt_schema()), "changes of angle"),
           compulsory("cyclograms", schema::map(cyclograms_schema()), "by name: what drives the machine"),
           schema::optional("solver", schema::map(solver_schema()), "model, tolerances, times that are written"),
           schema::optional("study", schema::map(study_schema(true)), "what is fitted and what it is judged by"),
           columns_key(),
           topics_key(),
           limits_key(),
           schema::optional("validation", schema::map(validation_schema()), "what strategies are judged on by `validate`"),
           schema::optional("programme", schema::map(programme_schema()),
                            "what predictors of drift are judged on by `validate`"),
           schema::optional("schedule", schema::map(schedule_schema()), "corrections written into an NC program"),
           schema::optional("axis_loop", schema::map(axis_loop_schema()), "the study's regression through a pulse injector"),
           schema::optional("table", schema::map(table_schema()), "a long table with scale, rings and probe"),
           schema::optional("volume", schema::map(volume_schema()), "errors over the work volume, computed by `run`")},
      .groups = {{Group::Rule::kAtMostOne,
                  {"table", "volume"},
                  "`run` computes one of `table` and `volume`; leave out the other"},
                 {Group::Rule::kAtLeastOne,
                  {"sensors", "displacements"},
                  "`sensors` or `displacements` is required: what is the machine looked at by?"}},
      .when_key = "machine"};
}

schema::Map records_scenario_schema() {
  return {.name = "scenario (of records alone)",
          .keys = {name_key(),
                   schema::compulsory("study", schema::map(study_schema(false)), "what is fitted and what it is judged by"),
                   columns_key(), topics_key(), limits_key()},
          .about = "A scenario without `machine` is about measured records alone (see `scenarios/spindle_22.yaml`)."};
}

}  // namespace

const std::vector<schema::Map>& scenario_schemas() {
  static const std::vector<schema::Map> both = {machine_scenario_schema(), records_scenario_schema()};
  return both;
}

}  // namespace driftwright::scenarios
