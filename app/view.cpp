#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "app/picked_machine.hpp"
#include "app/results.hpp"
#include "app/twin_network.hpp"
#include "app/verbs.hpp"
#include "base/delimited_text.hpp"
#include "base/file_bytes.hpp"
#include "base/file_name.hpp"
#include "base/version.hpp"
#include "findings/machine_section.hpp"
#include "mesh/unnamed_geometry.hpp"
#include "output/twin/twin_page.hpp"
#include "studies/prediction.hpp"
#include "studies/sensor_regressions.hpp"

namespace driftwright::app {
namespace {

namespace fs = std::filesystem;
using scenarios::Scenario;

fs::path target_of(const ViewOptions& options, const std::string& name) {
  const fs::path target = options.out.empty() ? fs::path("results") / (name + ".html") : fs::path(options.out);
  if (target.extension() != ".html")
    throw InputError(fmt::format("-o '{}': a page is one file; a name that ends with .html is required", target.string()));
  if (fs::is_directory(target)) throw InputError(fmt::format("-o '{}' is a folder; a file is required", target.string()));
  std::error_code failed;
  if (target.has_parent_path()) fs::create_directories(target.parent_path(), failed);
  if (failed) throw InputError(fmt::format("-o '{}': {}", target.string(), failed.message()));
  return target;
}

const Cyclogram& first_cyclogram(const ViewOptions& options, const Scenario& scenario) {
  if (!options.cyclogram.empty()) return scenario.cyclogram(options.cyclogram);
  return scenario.study ? scenario.cyclogram(scenario.study->judge) : scenario.cyclograms.front();
}

/// The correction of the page: regressions on the study's thermometers, fitted on its training cyclograms as `run` fits
/// them; without a study the model itself, one row late.
output::TwinCorrection correction_of(const Scenario& scenario, const scenarios::Model& model, const Listener& listener) {
  if (!scenario.study) {
    return {.name = "this model, one row late",
            .words = fmt::format("The correction is what this model said {:g} s before, zeroed at the start: the scenario "
                                 "has no `study` that says "
                                 "which predictor corrects.",
                                 scenario.solver.output_interval_s)};
  }
  const scenarios::Study& study = *scenario.study;
  std::vector<const Cyclogram*> cyclograms;
  for (const std::string& name : study.train) cyclograms.push_back(&scenario.cyclogram(name));
  std::vector<Record> training;
  for (scenarios::SimulatedRun& run : scenarios::simulate_cyclograms(scenario, model, cyclograms, listener))
    training.push_back(std::move(run.record));
  std::vector<std::string> displacements;
  for (const auto& d : scenario.machine->displacements) displacements.push_back(d.name);
  studies::SensorRegressions fitted = studies::fit_on_best_sensors(std::move(training), study, displacements);
  const std::string sensors = fmt::format("{}", fmt::join(fitted.regressions.front().inputs, ", "));
  return {.name = "regression",
          .words = fmt::format(
              "The correction is the regression on {} that `driftwright run` fits on {}, from readings rounded to "
              "{:g} K, in steps of {:g} µm of the encoder.",
              sensors, fmt::join(study.train, ", "), study.sensor_resolution_K, study.encoder_period_um),
          .formulas = std::move(fitted.regressions),
          .resolution_K = study.sensor_resolution_K,
          .period_um = study.encoder_period_um};
}

void write_page(const fs::path& target, const std::string& text) {
  write_whole(target, [&](const fs::path& partial) { write_bytes(partial, text); });
}

void print_page(const fs::path& target, const std::string& text, const std::string& subtitle) {
  fmt::print("{}: {:.1f} MB, opens in any browser with WebGL 2, offline\n{}\n", shown_path(fs::absolute(target)),
             1e-6 * static_cast<double>(text.size()), subtitle);
}

/// Writes the page for picking. @throws InputError  for a machine without a mesh
void view_to_pick(const ViewOptions& options) {
  const bool is_file = mesh::is_geometry_file(options.scenario);
  if (!is_file && !options.units.empty())
    throw InputError(
        "--units is allowed only with a mesh file; a scenario says the unit of its mesh itself (`machine: units`)");
  if (is_file && !fs::is_regular_file(options.scenario))  // before the folder of -o is made
    throw InputError(fmt::format("there is no file '{}'", options.scenario));
  Progress progress;
  PickedMachine machine;
  if (!is_file) machine = scenario_to_pick(options.scenario);
  const std::string name = is_file ? clean_name(fs::path(options.scenario).stem().string()) : machine.page.name;
  const fs::path target = target_of(options, file_name(name, "") + "_pick");
  progress.begin("meshing");
  if (is_file)
    machine = file_to_pick(options.scenario, options.units);
  else
    machine.mesh = scenarios::build_mesh(machine.recipe);
  machine.page.name = name;
  machine.page.mesh = &machine.mesh;
  machine.page.notes.insert(machine.page.notes.end(), machine.mesh.notes.begin(), machine.mesh.notes.end());
  progress.begin("writing the page");
  const std::string text = output::pick_html(machine.page, {kVersion, clean_name(options.scenario)});
  write_page(target, text);
  progress.end();
  print_page(target, text, machine.page.subtitle);
}

}  // namespace

void view(const ViewOptions& options) {
  if (options.pick) return view_to_pick(options);
  if (mesh::is_geometry_file(options.scenario))
    throw InputError(
        fmt::format("'{}' is a mesh or a drawing, and a machine that runs needs a scenario; `driftwright view "
                    "--pick {}` shows it for picking, and `driftwright init` writes a scenario of it",
                    clean_name(options.scenario), clean_name(options.scenario)));
  Scenario scenario = scenarios::read_scenario(options.scenario);
  const scenarios::MachineModel& machine = scenarios::require_machine(scenario, "view");
  const Cyclogram first = first_cyclogram(options, scenario);
  const fs::path target = target_of(options, scenario.name);
  const bool is_lumped = std::holds_alternative<scenarios::LumpedMachine>(machine.mesh);
  scenario.solver.model = is_lumped ? studies::predicting_model(scenario) : scenarios::ModelKind::kReduced;
  if (scenario.solver.fields_format == FieldsFormat::kNone) scenario.solver.fields_format = FieldsFormat::kVtu;

  Progress progress;
  const scenarios::Model model = scenarios::open_model(scenario, {}, progress.listener(), true);
  output::TwinPage page{.name = scenario.name,
                        .cyclograms = scenario.cyclograms,
                        .first = first.name,
                        .interval_s = scenario.solver.output_interval_s};
  if (is_lumped) {
    output::LumpedSystem lumped = output::lumped_system(machine);
    page.model = output::twin_model(scenario, lumped.system, lumped.start);
    page.network = network_of(model.balance, std::move(lumped.node_temperature));
    const std::size_t n = model.balance.nodes.size();
    page.subtitle = fmt::format("Twin of a machine of {} lumped node{}.", n, n == 1 ? "" : "s");
  } else {
    page.model = output::twin_model(scenario, model.reduced()->system, model.reduced()->start);
    page.surface = output::twin_surface(*model.reduced());
    page.marks = findings::marks_of(machine);
    page.subtitle = fmt::format("Twin of a machine tool: {}.", model.words());
  }
  const studies::Prediction prediction =
      studies::predict_drift(output::as_the_page_has_it(scenario), first, {.with_band = true}, progress.listener(), "view");
  page.check = prediction.record;
  page.band = prediction.band;
  page.check_by = fmt::format("`driftwright predict` ({})", prediction.predicted_by);
  page.correction = correction_of(scenario, model, progress.listener());
  if (scenario.study) {
    page.target = scenario.study->target;
    page.tolerance_um = scenario.study->tolerance_um;
  }
  progress.listener().begin("writing the page");
  const std::string text = output::twin_html(page, {kVersion, clean_name(options.scenario)});
  write_page(target, text);
  progress.end();
  print_page(target, text, page.subtitle);
  for (const std::string& note : page.model.notes) fmt::print("left out: {}\n", note);
}

}  // namespace driftwright::app
