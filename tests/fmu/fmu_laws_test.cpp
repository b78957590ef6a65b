// Functional mock-up units of small machines: laws that follow temperatures, thermostats, effects `learned`, places of axes.

#include <cmath>

#include "studies/prediction.hpp"
#include "tests/fmu/unit.hpp"
#include "tests/shared/edited_text.hpp"

namespace driftwright::output::fmu_test {
namespace {

using fixtures::replaced;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class FmuOfLaws : public OfBothVersions {};
INSTANTIATE_TEST_SUITE_P(Versions, FmuOfLaws, ::testing::Values(FmiVersion::k2, FmiVersion::k3), kVersionName);

/// A spindle whose oil thins and whose preload grows, a housing cooled by a formula that has a cusp between equal
/// temperatures, and a channel of three sections.
constexpr const char* kOiled = R"yaml(name: oiled
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: shaft, capacity: 5.6 kJ/K}
  - {type: node, node: bearing, capacity: 0.7 kJ/K}
  - {type: node, node: housing, capacity: 19 kJ/K}
  - {type: node, node: column, capacity: 60 kJ/K}
  - type: bearing_friction
    node: bearing
    count: 2
    f0: 0.8
    viscosity_40: 25 mm^2/s
    viscosity_100: 5.4 mm^2/s
    mean_diameter: 90 mm
    f1: 0.0006
    load: 300 N
    preload_growth: 15 N/K
    inner: {node: shaft}
    outer: {node: housing}
  - {type: friction_law, node: column, power: 30 W, at_speed: 9000 rpm, decay: 0.02 1/K}
  - {type: motor_loss, node: shaft, power: 90 W, at_speed: 12000 rpm, exponent: 1.5}
  - {type: link, node: bearing, to: shaft, conductance: 15 W/K}
  - {type: link, node: bearing, to: housing, conductance: 30 W/K}
  - {type: link, node: housing, to: column, conductance: 20 W/K}
  - type: formula
    node: column
    conductance: "G*(1 + abs((T_c - T_a)/d)^0.25)"
    to: ambient
    G: 4 W/K
    d: 1 K
    T_c: column
    T_a: ambient
  - type: coolant_channel
    node: housing
    then: [bearing, column]
    medium: glycol_30
    flow: 0.4 L/min
    diameter: 8.9 mm
    length: 1200 mm
    set_point: 21 degC
    runs: while_spindle_turns
start: ambient
ambient: [[0 h, 20 degC], [1 h, 23 degC], [9 h, 22 degC]]
sensors: [{name: t_bearing, node: bearing}, {name: t_housing, node: housing}, {name: t_column, node: column}]
displacements:
  - {name: nose_z, sensitivities: [{node: shaft, sensitivity: 2.9 um/K}, {node: housing, sensitivity: -1.2 um/K}]}
cyclograms: {shift: [[70 min, 9000 rpm], [30 min, 0 rpm], [60 min, 4000 rpm]], fast: [[9 min, 9999 rpm]]}
solver: {model: reduced, relative_tolerance: 1e-9, absolute_tolerance: 1e-8 K, output_interval: 60 s}
)yaml";

/// The C-frame on a coarse mesh, with films of free convection and radiation, without its door that opens for a while.
std::string frame_yaml() {
  std::string text = read_text("scenarios/c_frame.yaml");
  const auto replace = [&](const std::string& what, const std::string& by) { text = replaced(text, what, by); };
  replace("mesh: parts/", "mesh: " + std::filesystem::absolute("scenarios/parts").string() + "/");
  replace("nc_program: parts/", "nc_program: " + std::filesystem::absolute("scenarios/parts").string() + "/");
  replace("mesh_size: {default: 90 mm, head: 60 mm, spindle: 40 mm}", "mesh_size: {default: 150 mm}");
  replace("element_order: 2", "element_order: 1");
  replace("film: 12 W/(m^2 K), from: 10 min, until: 15 min}", "film: 2 W/(m^2 K)}");
  replace("  relative_tolerance: 1e-3\n  absolute_tolerance: 5e-3 K\n",
          "  model: reduced\n  relative_tolerance: 1e-8\n  absolute_tolerance: 1e-7 K\n");
  replace("warm_up: [[60 min, 6000 rpm]]", "warm_up: [[60 min, 6000 rpm], [20 min, 0 rpm]]");
  replace("  fields_at: [10 min, 15 min]\n  stresses: true\n", "");
  return text;
}

struct Live {
  scenarios::Scenario scenario;
  FmuModel fmu;
  std::vector<std::string> outputs;
  Record predicted;
  explicit Live(const std::string& name, const std::string& yaml, const std::string& cyclogram)
      : scenario(scenarios::read_scenario(driftwright::write_file(name, yaml))) {
    require_exportable(scenario);
    const scenarios::Model model = scenarios::open_model(scenario, {}, {}, false);
    fmu = machine_fmu(scenario, *model.reduced());
    outputs = names_of(fmu.outputs);
    predicted = studies::predict_drift(scenario, scenario.cyclogram(cyclogram), {.model = "reduced"}, {}, "a test").record;
  }
  [[nodiscard]] std::size_t n_live() const {
    const auto is_live = [](const auto& law) { return law.live.has_value(); };
    return static_cast<std::size_t>(std::count_if(fmu.sources.begin(), fmu.sources.end(), is_live) +
                                    std::count_if(fmu.exchanges.begin(), fmu.exchanges.end(), is_live));
  }
  [[nodiscard]] Record speed() const { return speed_of(predicted); }
  /// @param stays  a channel of the inputs: rows at which it changes are left out. In co-simulation an output is told before
  /// the inputs of its row are set, and some follow them at once.
  void expect_predicted(const Told& told, const std::vector<double>& stays = {}) const {
    for (std::size_t o = 0; o < outputs.size(); ++o) {
      std::vector<double> wanted = predicted.at(outputs[o]).values;
      for (std::size_t i = 1; i < stays.size(); ++i) {
        if (stays[i] != stays[i - 1]) wanted[i] = told.of[o][i];
      }
      EXPECT_LT(largest_gap(told.of[o], wanted, predicted.n_samples()), kLive[is_length(o)]) << outputs[o];
    }
  }
  void expect_same(const Told& a, const Told& b, double share) const {
    for (std::size_t o = 0; o < outputs.size(); ++o)
      EXPECT_LT(largest_gap(a.of[o], b.of[o], predicted.n_samples()), share * kLive[is_length(o)]) << outputs[o];
  }
  static constexpr double kLive[2] = {1e-4, 1e-3};  ///< K; um and urad
  [[nodiscard]] std::size_t is_length(std::size_t o) const { return fmu.outputs[o].unit == "degC" ? 0 : 1; }
};

const Live& oiled() {
  static const Live live("oiled.yaml", kOiled, "shift");
  return live;
}
const Live& frame() {
  static const Live live("c_frame.yaml", frame_yaml(), "warm_up");
  return live;
}

TEST_P(FmuOfLaws, WithLawsOfTemperaturesIsWhatPredictSaysWhateverTheStep) {
  EXPECT_EQ(oiled().n_live(), 5u) << "two frictions, the formula, what the channel brings back to two sections";
  EXPECT_EQ(frame().n_live(), 13u) << "seven films of free convection, five of radiation, the bearings";
  for (const Live* live : {&oiled(), &frame()}) {
    const Unit unit({.model = live->fmu, .version = GetParam()}, name("live"));
    const Told minutes = import_unit(unit, live->speed(), live->outputs, {}),
               seconds = import_unit(unit, live->speed(), live->outputs, {.step_s = 1.0});
    live->expect_predicted(minutes);
    live->expect_predicted(seconds);
    live->expect_same(minutes, seconds, 0.1);
    EXPECT_EQ(minutes.run.allocated, 0) << "no memory is taken after the start";
    EXPECT_EQ(import_unit(of_sources(unit), live->speed(), live->outputs, {}).of, minutes.of);
    live->expect_same(import_unit(unit, live->speed(), live->outputs, {.rewind_at_row = 37}), minutes, 1e-9);
    RecordProperty("seconds_" + live->fmu.name, std::to_string(minutes.run.seconds));
  }
}

/// Films of a file at 0, 3000 and 6000 rpm, linear between them.
TEST_P(FmuOfLaws, TakesFilmsOfAFileAtSeveralSpeeds) {
  std::string yaml = replaced(read_text("scenarios/column_film.yaml"), "shift: [[60 min, 3000 rpm]",
                              "shift: [[30 min, 3000 rpm], [30 min, 1700 rpm]");
  for (const std::string file : {"parts/column.inp", "films/column_front.csv"})
    yaml = replaced(yaml, file, std::filesystem::absolute("scenarios/" + file).string());
  const Live live("column_film.yaml", yaml, "shift");
  live.expect_predicted(import_unit(Unit({.model = live.fmu, .version = GetParam()}, name("film_field")), live.speed(),
                                    live.outputs, {.step_s = 60.0}));
}

TEST_P(FmuOfLaws, WithLawsOfTemperaturesInModelExchangeIsTheSame) {
  const Live& live = oiled();
  Record rows = live.speed();
  const Told told = import_unit(Unit({.model = live.fmu, .version = GetParam()}, name("live_exchange")), rows, live.outputs,
                                {.co_simulation = false});
  live.expect_predicted(told);
  EXPECT_LT(told.run.jacobian_gap, 1e-6) << "directional derivatives along states and speed, against differences";
}

TEST_P(FmuOfLaws, WithLawsOfTemperaturesTakesTheAmbientAsAnInput) {
  const Live& live = oiled();
  Record inputs = live.speed();
  inputs.channels.push_back(ambient_of(live.scenario, inputs));
  live.expect_predicted(import_unit(Unit({.model = live.fmu, .version = GetParam()}, name("live_ambient")), inputs,
                                    live.outputs, {.step_s = 7.0, .ambient_from_input = 1}));
}

/// A ball screw whose nut heats it where it is, in the motor encoder's loop, beside the same axis closed by a scale.
constexpr const char* kScrewAxis = R"(name: axis
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: nut, capacity: 2 kJ/K}
  - {type: node, node: scale, capacity: 1 kJ/K}
  - {type: link, node: nut, to: ambient, conductance: 5 W/K}
  - {type: link, node: scale, to: nut, conductance: 1 W/K}
  - {type: feed_axis, node: nut, screw: s, axis: x, travel: 800 mm, fixed_gap: 100 mm, far_gap: 100 mm, diameter: 36 mm,
     lead: 10 mm, nut_length: 80 mm, torque: 1 N m, nut_conductance: 4 W/K, mounting: stretched, fixed_stiffness: 200 N/um,
     far_stiffness: 100 N/um, position: position_x, stroke: stroke_x_mm}
  - {type: linear_scale, displacement: by_scale, body: scale, expansion: 8e-6 1/K, fixed_at: 100 mm, position: position_x_mm}
start: ambient
ambient: [[0 h, 21 degC]]
displacements:
  - {name: at_nut, screw: s}
  - {name: by_scale, sensitivities: [{node: nut, sensitivity: 0.5 um/K}]}
cyclograms:
  strokes:
    columns: [duration, feed_x, position_x_mm, stroke_x_mm]
    rows: [[10 min, 5 m/min, 410 mm, 590 mm], [9 min, 3 m/min, 700 mm, 200 mm], [1 min, 6 m/min, 20 mm, 0 mm],
           [15 min, 6 m/min, 150 mm, 60 mm], [5 min, 0 m/min, 790 mm, 0 mm]]
solver: {model: reduced, output_interval: 1 min}
)";

TEST_P(FmuOfLaws, TakesThePositionOfAFeedAxis) {
  const Live axis("screw_axis.yaml", kScrewAxis, "strokes");
  EXPECT_EQ(axis.n_live(), 0u) << "a formula of the drive is exact over a step";
  Record inputs{.source = "inputs", .time_s = axis.predicted.time_s, .channels = {}};
  for (const char* name : {"feed_x", "position_x", "stroke_x"}) inputs.channels.push_back(axis.predicted.at(name));
  const std::vector<double>& place_mm = inputs.channels[1].values;
  const Unit unit({.model = axis.fmu, .version = GetParam()}, name("axis"));
  const Told exchanged = import_unit(unit, inputs, axis.outputs, {.co_simulation = false});
  axis.expect_predicted(exchanged);
  EXPECT_LT(exchanged.run.jacobian_gap, 1e-6) << "along states, feed, position and stroke, against differences";
  const Told minutes = import_unit(unit, inputs, axis.outputs, {}),
             seconds = import_unit(unit, inputs, axis.outputs, {.step_s = 7.0});
  axis.expect_predicted(minutes, place_mm);
  axis.expect_predicted(seconds, place_mm);
  axis.expect_same(minutes, seconds, 1e-3);
  EXPECT_EQ(import_unit(of_sources(unit), inputs, axis.outputs, {}).of, minutes.of);
  const auto drift_um = [&](std::size_t row) { return axis.predicted.at("at_nut").values[row]; };
  EXPECT_GT(std::abs(drift_um(18) - drift_um(19)), 5.0) << "the place makes the error";
  const std::string stretched = replaced(kScrewAxis, "mounting: stretched", "mounting: stretched, stretch: 30 um");
  EXPECT_THAT([&] { require_exportable(scenarios::read_scenario(driftwright::write_file("stretched.yaml", stretched))); },
              ThrowsMessage<InputError>(HasSubstr("grows freely once it is used up")));
}

// --- thermostats

/// A tank on a thermostat, linear: the chiller is on for about a minute of two.
constexpr const char* kChilled = R"(name: chilled
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: shaft, capacity: 6 kJ/K}
  - {type: node, node: housing, capacity: 20 kJ/K}
  - {type: motor_loss, node: shaft, power: 400 W, at_speed: 6000 rpm, exponent: 1}
  - {type: link, node: shaft, to: housing, conductance: 25 W/K}
  - {type: link, node: housing, to: ambient, conductance: 3 W/K}
  - {type: coolant, node: housing, tank: cooler, flow: 6 L/min, passage_conductance: 120 W/K, volume: 8 L, tank_exchange: 2 W/K,
     pump_power: 60 W, cooling_power: 900 W, set_point: 21 degC, hysteresis: 1 K, runs: while_spindle_turns}
start: ambient
ambient: [[0 h, 20 degC], [1 h, 23 degC], [9 h, 22 degC]]
sensors: [{name: t_tank, node: cooler}, {name: t_housing, node: housing}]
displacements:
  - {name: nose_z, sensitivities: [{node: shaft, sensitivity: 2.9 um/K}, {node: housing, sensitivity: -1.2 um/K}]}
cyclograms: {shift: [[50 min, 6000 rpm], [20 min, 0 rpm], [30 min, 3000 rpm]], fast: [[9 min, 6999 rpm]]}
solver: {model: reduced, relative_tolerance: 1e-9, absolute_tolerance: 1e-8 K, output_interval: 20 s}
)";
const Live& chilled() {
  static const Live live("chilled.yaml", kChilled, "shift");
  return live;
}
/// The spindle that ships: its oil thins, and its chiller is on a thermostat.
const Live& lumped_spindle() {
  const std::string yaml =
      replaced(replaced(read_text("scenarios/lumped_spindle.yaml"), "60 min, 12000 rpm", "60 min, 12999 rpm"),
               "[120 min, 12000 rpm], [30 min, 0 rpm], [90 min, 8000 rpm]",
               "[40 min, 12000 rpm], [10 min, 0 rpm], [20 min, 8000 rpm]");
  static const Live live("lumped.yaml",
                         replaced(yaml, "  relative_tolerance: 1e-4\n  absolute_tolerance: 1e-3 K\n",
                                  "  model: reduced\n  relative_tolerance: 1e-9\n  absolute_tolerance: 1e-8 K\n"),
                         "shift");
  return live;
}

TEST_P(FmuOfLaws, SwitchesWhereThePredictionDoesWhateverTheStep) {
  for (const Live* live : {&chilled(), &lumped_spindle()}) {
    const Unit unit({.model = live->fmu, .version = GetParam()}, name("chilled"));
    expect_valid(unit);
    EXPECT_EQ(unit.n_indicators, 1u);
    const Told minutes = import_unit(unit, live->speed(), live->outputs, {}),
               seconds = import_unit(unit, live->speed(), live->outputs, {.step_s = 1.0});
    live->expect_predicted(minutes);
    live->expect_predicted(seconds);
    live->expect_same(minutes, seconds, 0.1);
    EXPECT_EQ(minutes.run.allocated, 0) << "no memory is taken after the start";
    EXPECT_EQ(import_unit(of_sources(unit), live->speed(), live->outputs, {}).of, minutes.of);
    const std::vector<double> is_on = import_unit(unit, live->speed(), {"on.cooler"}, {}).of[0];
    for (double on : {0.0, 1.0}) {  // the state that is written and read contains the switch
      const auto row = static_cast<std::size_t>(std::find(is_on.begin() + 100, is_on.end(), on) - is_on.begin());
      ASSERT_LT(row, is_on.size());
      live->expect_same(import_unit(unit, live->speed(), live->outputs, {.rewind_at_row = row}), minutes, 1e-9);
    }
    const Told exchanged = import_unit(unit, live->speed(), live->outputs, {.co_simulation = false});
    live->expect_predicted(exchanged);
    EXPECT_GT(exchanged.run.n_switches, 20);
  }
}

// A tank without a wall, in an ambient of 20 degC: its pump alone would take it to 50 degC, with the chiller to -250 degC.
TEST_P(FmuOfLaws, SwitchesWithinALongStepByTheClosedForm) {
  std::string yaml = replaced(kChilled, "passage_conductance: 120 W/K", "passage_conductance: 0 W/K");
  yaml = replaced(replaced(yaml, "cooling_power: 900 W", "cooling_power: 600 W"), ", runs: while_spindle_turns", "");
  const Live live("tank.yaml", replaced(yaml, "[1 h, 23 degC], [9 h, 22 degC]", "[9 h, 20 degC]"), "shift");
  const Unit unit({.model = live.fmu, .version = GetParam()}, name("tank"));
  const double constant_s = 8.0 * 3800.0 / 2.0, end_s = 36000.0;
  double t_s = 0.0, degC = 20.0;
  int n_switches = 0;
  for (bool is_on = false;; is_on = !is_on, ++n_switches) {
    const double to_degC = is_on ? -250.0 : 50.0, switch_degC = is_on ? 20.5 : 21.5;
    const double span_s = constant_s * std::log((degC - to_degC) / (switch_degC - to_degC));
    if (t_s + span_s > end_s) {
      degC = to_degC + (degC - to_degC) * std::exp((t_s - end_s) / constant_s);
      break;
    }
    t_s += span_s;
    degC = switch_degC;
  }
  EXPECT_GT(n_switches, 100);
  const Record inputs{.source = "inputs", .time_s = {0.0, end_s}, .channels = {{"spindle_speed", "rpm", {0.0, 0.0}}}};
  for (double step_s : {end_s, 3600.0, 60.0})
    EXPECT_NEAR(import_unit(unit, inputs, {"t_tank"}, {.step_s = step_s}).of[0][1], degC, 1e-6) << step_s;
}

// --- effects `learned`

/// To the machine on a thermostat: shares that are kept, an offset, lags of the drive and of the ambient, and terms at once.
constexpr const char* kLearned = R"(effects:
  - {type: learned, sensor: t_housing, keeps: 0.9, offset: 0.3 K, follows: speed, at_speed: 5000 rpm, exponent: 1.6,
     rises: [[12 min, 2 K], [40 min, -0.5 K]]}
  - {type: learned, sensor: t_housing, keeps: 0.8, offset: -0.1 K, follows: ambient, rises: [[0 min, 0.2 K], [25 min, 0.4 K]]}
  - {type: learned, displacement: nose_z, keeps: 0.6, follows: speed, at_speed: 5000 rpm, exponent: 1.6,
     grows: [[0 min, 2 um], [12 min, 7 um]]}
  - {type: learned, displacement: nose_z, follows: running, above: 4000 rpm, grows: [[0 min, 3 um], [8 min, -5 um]]}
  - {type: learned, displacement: nose_z, follows: ambient, grows: [[25 min, 2 um]]}
)";

TEST_P(FmuOfLaws, HoldsWhatWasLearned) {
  const Live live("learned.yaml", replaced(kChilled, "effects:\n", kLearned), "shift"),
      axis("learned_axis.yaml",
           replaced(replaced(kScrewAxis, "effects:\n",
                             "effects:\n  - {type: learned, displacement: at_nut, keeps: 0.7, follows: ambient, grows: [[9 "
                             "min, 4 um]]}\n"),
                    "ambient: [[0 h, 21 degC]]", "ambient: [[0 h, 22 degC], [1 h, 25 degC]]"),
           "strokes");
  EXPECT_EQ(live.fmu.start.size(), chilled().fmu.start.size() + 3 + 1 + 1 + 1)
      << "three lags of drives, of which two outputs share one; the ambient and the displacement of the start; one lag of "
         "the ambient";
  Record inputs = live.speed();
  const Unit unit({.model = live.fmu, .version = GetParam()}, name("learned"));
  const Told exchanged = import_unit(unit, inputs, live.outputs, {.co_simulation = false});
  live.expect_predicted(exchanged);
  EXPECT_LT(exchanged.run.jacobian_gap, 1e-6) << "directional derivatives along states and speed, against differences";
  const std::vector<double> speed_rpm = inputs.channels[0].values;
  live.expect_predicted(import_unit(unit, inputs, live.outputs, {.rewind_at_row = 37}), speed_rpm);
  live.expect_predicted(import_unit(unit, inputs, live.outputs, {.step_s = 1.0}), speed_rpm);
  inputs.channels.push_back(ambient_of(live.scenario, inputs));
  live.expect_predicted(import_unit(unit, inputs, live.outputs, {.step_s = 7.0, .ambient_from_input = 1}), speed_rpm);

  Record places{.source = "inputs", .time_s = axis.predicted.time_s, .channels = {}};
  for (const char* of : {"feed_x", "position_x", "stroke_x"}) places.channels.push_back(axis.predicted.at(of));
  axis.expect_predicted(import_unit(Unit({.model = axis.fmu, .version = GetParam()}, name("learned_axis")), places,
                                    axis.outputs, {.co_simulation = false}));
  const std::string column =
      replaced(kChilled, "effects:\n",
               "effects:\n  - {type: learned, displacement: nose_z, follows: column, column: bed_W, at: 100, "
               "grows: [[5 min, 4 um]]}\n");
  EXPECT_THAT([&] { require_exportable(scenarios::read_scenario(driftwright::write_file("column.yaml", column))); },
              ThrowsMessage<InputError>(HasSubstr("no input of an FMU")));
}

TEST_P(FmuOfLaws, SaysThatALawHasNoValueWhereItsRangeEnds) {
  FmuOrder order{.model = oiled().fmu, .version = GetParam()};
  order.model.start.array() += 200.0 * order.model.ones.array();  // oil at 220 degC; the law ends at 180 degC
  const Unit unit(order, name("beyond"));
  const Record inputs{.source = "inputs", .time_s = {0.0, 60.0}, .channels = {{"spindle_speed", "rpm", {9000.0, 9000.0}}}};
  (void)import_unit(unit, inputs, {"nose_z"}, {.fails_with = "a law has no value at the temperatures"});
}

}  // namespace
}  // namespace driftwright::output::fmu_test
