#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/model_files.hpp"
#include "app/results.hpp"
#include "app/verbs.hpp"
#include "base/quantity.hpp"
#include "base/version.hpp"
#include "output/fmu/plain_c.hpp"
#include "output/predictor_file.hpp"
#include "studies/prediction.hpp"

namespace driftwright::app {
namespace {

namespace fs = std::filesystem;

/// A table for an importer: one column per variable, under the variable's name.
struct Columns {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;
  void add(const std::string& name, std::vector<double> column) {
    names.push_back(name);
    values.push_back(std::move(column));
  }
  [[nodiscard]] std::string csv() const {
    std::string text;
    for (std::size_t c = 0; c < names.size(); ++c) text += fmt::format("{}\"{}\"", c > 0 ? "," : "", names[c]);
    text += "\n";
    for (std::size_t row = 0; row < values.front().size(); ++row) {
      for (std::size_t c = 0; c < names.size(); ++c) text += fmt::format("{}{:.12g}", c > 0 ? "," : "", values[c][row]);
      text += "\n";
    }
    return text;
  }
};

/// Time and drive, under the names of variables_of().
Columns drive_columns(const output::FmuModel& model, const Cyclogram& recorded, const std::vector<double>& time_s) {
  const Cyclogram cyclogram = output::with_places(recorded, model.drive);
  Columns columns;
  columns.add("time", time_s);
  const std::vector<output::FmuVariable> variables = output::variables_of(model);
  for (std::size_t d = 0; d < model.drive.size(); ++d) {  // after the time
    std::vector<double> values;
    for (double t_s : time_s) values.push_back(output::value_of(model.drive[d].variable, cyclogram.drive(t_s)));
    columns.add(variables[d + 1].name, std::move(values));
  }
  return columns;
}

/// The cyclogram that the study judges by, else the first.
const Cyclogram& reference_cyclogram(const scenarios::Scenario& scenario) {
  return scenario.study ? scenario.cyclogram(scenario.study->judge) : scenario.cyclograms.front();
}

std::vector<double> ambient_column(const scenarios::Scenario& scenario, const std::vector<double>& time_s) {
  std::vector<double> ambient_degC;
  for (double t_s : time_s)
    ambient_degC.push_back(scenario.machine->ambient.at(t_s) + scenario.machine->reference_K - kZeroCelsius_K);
  return ambient_degC;
}

/// @param with_ambient  the ambient is an input
void add_machine_reference(output::FmuOrder& order, const scenarios::Scenario& scenario, const Record& record,
                           const Cyclogram& cyclogram, bool with_ambient) {
  Columns in = drive_columns(order.model, cyclogram, record.time_s), out;
  if (with_ambient) in.add("ambient_temperature", ambient_column(scenario, record.time_s));
  order.reference_in = in.csv();
  out.add("time", record.time_s);
  for (const output::FmuOutput& o : order.model.outputs) out.add(o.name, record.at(o.name).values);
  order.reference_out = out.csv();
  order.reference_words = fmt::format("what `driftwright predict` says of the cyclogram '{}'", cyclogram.name);
}

/// The reference output: the observer run on a machine that equals its model.
void add_observer_reference(output::FmuOrder& order, const compensation::Observer& observer,
                            const scenarios::Scenario& scenario, const Record& record, const Cyclogram& cyclogram) {
  MachineRun run{.cyclogram = cyclogram, .ambient = {}, .readings = record};
  Columns in = drive_columns(order.model, cyclogram, record.time_s), out;
  for (double t_s : record.time_s) {
    run.ambient.time_s.push_back(t_s);
    run.ambient.value.push_back(scenario.machine->ambient.at(t_s));
  }
  in.add("ambient_temperature", ambient_column(scenario, record.time_s));
  for (const std::string& sensor : observer.sensors()) in.add(sensor, record.at(sensor).values);
  const compensation::Observation seen = observer.observe(run);
  out.add("time", record.time_s);
  out.add(observer.state().drift, seen.drift_um);
  out.add(observer.state().drift + "_deviation", seen.deviation_um);
  order.reference_in = in.csv();
  order.reference_out = out.csv();
  order.reference_words = fmt::format(
      "the observer on the simulated cyclogram '{}', without noise; an output holds from its row on until "
      "the next one",
      cyclogram.name);
}

const compensation::Observer& observer_in(const output::PredictorFile& file, const std::string& path) {
  const compensation::Observer* observer = file.predictor.predictor->observer();
  if (!observer)
    throw InputError(
        fmt::format("{}: '{}' is no observer; `validate` writes one as models/observer.json", path, file.predictor.name));
  return *observer;
}

fs::path target_of(const ExportOptions& options, const std::string& name) {
  const fs::path target =
      options.out.empty() ? fs::path("results") / (output::model_identifier(name) + ".fmu") : fs::path(options.out);
  if (target.extension() != ".fmu")
    throw InputError(fmt::format("-o '{}': an FMU is one file; its name must end with .fmu", target.string()));
  if (fs::is_directory(target)) throw InputError(fmt::format("-o '{}' is a folder; it must be a file", target.string()));
  std::error_code failed;
  if (target.has_parent_path()) fs::create_directories(target.parent_path(), failed);
  if (failed) throw InputError(fmt::format("-o '{}': {}", target.string(), failed.message()));
  return target;
}

void show_files(const output::ResultsFolder& folder) {
  for (const std::string& file : folder.files()) {
    if (file != output::kManifestName) fmt::print("{}/{}\n", shown_path(folder.target()), file);
  }
}

/// @throws InputError  for options of a functional mock-up unit that a control or a PLC does not have
void refuse_options_of_units(const ExportOptions& options) {
  const ExportOptions usual;
  if (options.fmi == usual.fmi && options.type == usual.type) return;
  throw InputError(
      fmt::format("--fmi and --type are for a functional mock-up unit (--fmu); leave them out of --as {}", options.as));
}

/// @throws InputError  for options of an axis: a machine or an observer says displacements, and moves none
void refuse_options_of_axes(const ExportOptions& options) {
  if (options.axis.empty() && options.axis_moves == ExportOptions{}.axis_moves) return;
  throw InputError(
      "--axis and --axis-moves are for a formula (--model, without a scenario) and --as siemens, heidenhain or fanuc. A "
      "machine or an observer corrects no axis itself: its outputs are displacements under their names in the scenario; "
      "leave these options out");
}

/// A formula of models/, as a control runs it. @throws InputError  for another predictor
output::DeployedModel formula_in(const output::PredictorFile& file, const std::string& path) {
  const compensation::DeployedPredictor& d = file.predictor;
  if (d.predictor->observer())
    throw InputError(
        fmt::format("{}: an observer is no formula. It becomes C: `driftwright export SCENARIO --as c --of "
                    "observer --model {}`, with the scenario that it was fitted with",
                    path, path));
  if (!d.predictor->formula() || !d.fail_safe)
    throw InputError(fmt::format("{}: '{}' is no formula of readings, and no control takes it; export a formula of models/",
                                 path, d.name));
  return output::deployed_model(d);
}

/// Formulas for places of one screw, by rising position, and that screw's name.
struct OverTravel {
  std::string screw;
  std::vector<output::PlacedModel> places;
};
OverTravel over_travel(const std::vector<std::string>& paths) {
  OverTravel travel;
  std::string first;
  for (const std::string& path : paths) {
    const output::PredictorFile file = output::read_predictor(path);
    const auto& judged = file.judged;
    if (!judged.is_object() || !judged.contains("screw") || !judged["screw"].is_string() ||
        !judged.contains("position_mm") || !judged["position_mm"].is_number())
      throw InputError(fmt::format(
          "{}: several --model are places of one axis, and this file does not say its place; `validate` writes it where the "
          "target is one of several places (`at`) of a `screw` (docs/how-to/feed_axis.md)",
          path));
    const std::string screw = judged["screw"];
    if (travel.places.empty()) {
      travel.screw = screw;
      first = path;
    }
    if (screw != travel.screw)
      throw InputError(fmt::format("{} is of screw '{}' and {} of screw '{}'; several --model must be places of one screw",
                                   path, screw, first, travel.screw));
    travel.places.push_back({formula_in(file, path), judged["position_mm"].get<double>()});
  }
  std::stable_sort(travel.places.begin(), travel.places.end(),
                   [](const auto& a, const auto& b) { return a.at_mm < b.at_mm; });
  for (std::size_t k = 1; k < travel.places.size(); ++k) {
    if (travel.places[k].at_mm == travel.places[k - 1].at_mm)
      throw InputError(fmt::format("two --model are of {:g} mm; each place may have one", travel.places[k].at_mm));
  }
  return travel;
}

/// A formula of models/ as files for a control.
void export_formula(const ExportOptions& options) {
  if (options.models.empty())
    throw InputError(fmt::format("--as {} requires --model FILE, a formula of models/ as `validate` writes it{}", options.as,
                                 options.as == "c" ? ", or a scenario, whose machine or observer becomes C" : ""));
  refuse_options_of_units(options);
  if (options.of == "observer")
    throw InputError("--of observer requires the scenario that the observer was fitted with, and --as c or --fmu");
  const bool is_of_axis = options.as == "siemens" || options.as == "heidenhain" || options.as == "fanuc";
  if (!is_of_axis && !options.axis.empty())
    throw InputError(fmt::format("--as {} corrects no axis; leave --axis out", options.as));
  if (options.as != "siemens" && options.axis_moves == "against_dk")
    throw InputError(
        fmt::format("--axis-moves is for --as siemens, whose sign differs from machine to machine; leave it "
                    "out of --as {}",
                    options.as));
  if (is_of_axis && options.axis.empty())
    throw InputError(fmt::format("--as {} requires --axis, the letter of the axis that is corrected", options.as));
  const output::ControlAxis axis{options.axis.empty() ? 'Z' : options.axis[0], options.axis_moves == "against_dk"};
  const std::string& model = options.models.front();
  std::string name = fs::path(model).stem().string();
  std::vector<compensation::ControlFile> files;
  const auto made_of = [&](const std::string& what) { return fmt::format("Driftwright {}, {}", kVersion, what); };
  if (options.models.size() > 1) {
    const OverTravel travel = over_travel(options.models);
    name = travel.screw + "_over_travel";
    files = travel_files(travel.places, options.as, name, axis, made_of(fmt::format("{} places", travel.places.size())));
  } else {
    files = formula_files(formula_in(output::read_predictor(model), model), options.as, name, axis,
                          made_of(fs::path(model).filename().string()));
  }
  CommonOptions common;
  common.scenario = model;
  common.out = options.out;
  output::ResultsFolder folder = open_results(common, name + "_" + options.as);
  for (const compensation::ControlFile& f : files) folder.write_text(f.name, f.text);
  if (needs_control_files(options.as)) {
    for (const compensation::ControlFile& f : compensation::control_files()) folder.write_text(f.name, f.text);
  }
  folder.commit();
  show_files(folder);
}

void write_plain_c(const ExportOptions& options, const output::FmuOrder& order) {
  CommonOptions common;
  common.scenario = options.scenario;
  common.out = options.out;
  output::ResultsFolder folder = open_results(common, order.model.name + "_c");
  for (const output::FmuEntry& entry : output::plain_c_files(order, folder.made_by()))
    folder.write_text(entry.path, entry.bytes);
  folder.commit();
  show_files(folder);
}

}  // namespace

void export_model(const ExportOptions& options) {
  if (options.fmu != options.as.empty())
    throw InputError(
        "export: one format is required: --fmu for a functional mock-up unit (FMI), or --as for a control or a PLC");
  if (options.scenario.empty() && !options.fmu) return export_formula(options);
  if (options.scenario.empty()) throw InputError("export --fmu requires a scenario");
  if (!options.fmu && options.as != "c")
    throw InputError(
        fmt::format("--as {} takes a formula of models/ (--model, without a scenario); a scenario's machine or observer is "
                    "exported --as c",
                    options.as));
  refuse_options_of_axes(options);
  if (!options.fmu) refuse_options_of_units(options);
  const bool of_observer = options.of == "observer";
  if (options.models.size() > 1)
    throw InputError("several --model are places of one axis, without a scenario; an observer is one file");
  const std::string file_of_model = options.models.empty() ? "" : options.models.front();
  if (of_observer == file_of_model.empty())
    throw InputError(of_observer
                         ? "--of observer requires --model FILE, an observer as `validate` writes it (models/observer.json)"
                         : "--model names the file of an observer; it requires --of observer");
  scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  (void)scenarios::require_machine(scenario, "export");
  output::require_exportable(scenario);
  const fs::path target = options.fmu ? target_of(options, scenario.name) : fs::path();
  const output::Provenance made_by{kVersion, options.scenario};

  Progress progress;
  const Cyclogram cyclogram = reference_cyclogram(scenario);
  output::FmuOrder order{.version = options.fmi == 2 ? output::FmiVersion::k2 : output::FmiVersion::k3,
                         .interfaces = {.model_exchange = options.type != "cs", .co_simulation = options.type != "me"}};
  scenario.solver.model = scenarios::ModelKind::kReduced;
  if (of_observer) {
    const output::PredictorFile file = output::read_predictor(file_of_model);
    const compensation::Observer& observer = observer_in(file, file_of_model);
    const compensation::DeployedPredictor& d = file.predictor;
    order.model = output::observer_fmu(
        scenario, observer,
        d.residual ? std::optional(compensation::probe_process_of(*d.residual, d.probe, d.from_start)) : std::nullopt);
    order.step_s = scenario.solver.output_interval_s = observer.state().settings.period_s;
    const studies::Prediction prediction =
        studies::predict_drift(scenario, cyclogram, {.model = "reduced"}, progress.listener(), "export");
    add_observer_reference(order, observer, scenario, prediction.record, cyclogram);
  } else {
    const scenarios::Model model = scenarios::open_model(scenario, {}, progress.listener(), false);
    order.model = output::machine_fmu(scenario, *model.reduced());
    order.step_s = scenario.solver.output_interval_s;
    const studies::Prediction prediction =
        studies::predict_drift(scenario, cyclogram, {.model = "reduced"}, progress.listener(), "export");
    add_machine_reference(order, scenario, prediction.record, cyclogram, !options.fmu);
  }
  order.model.duration_s = cyclogram.duration_s();
  if (!options.fmu) {
    progress.end();
    return write_plain_c(options, order);
  }
  const std::vector<output::FmuEntry> entries = output::fmu_entries(order, made_by);
  write_whole(target, [&](const fs::path& partial) { output::write_zip(partial, entries); });
  progress.end();
  fmt::print("{}: FMI {}.0, {}, {}\n{}\n", shown_path(fs::absolute(target)), options.fmi,
             options.type == "both" ? "model exchange and co-simulation"
             : options.type == "me" ? "model exchange"
                                    : "co-simulation",
             order.model.name, order.model.description);
  for (const output::FmuVariable& v : output::variables_of(order.model)) {
    if (v.causality == "input" && v.max)
      fmt::print("  {} from {:g} to {:g} {}\n", v.name, v.min.value_or(0.0), *v.max, v.unit);
  }
}

}  // namespace driftwright::app
