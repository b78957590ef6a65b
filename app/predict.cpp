#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/results.hpp"
#include "app/verbs.hpp"
#include "compensation/modal_predictor.hpp"
#include "scenarios/as_recorded.hpp"
#include "scenarios/read_cyclogram.hpp"
#include "scenarios/ways_out.hpp"

namespace driftwright::app {
namespace {

Cyclogram find_cyclogram(const scenarios::Scenario& scenario, const std::string& name_or_file) {
  if (name_or_file.ends_with(".csv")) return scenarios::cyclogram_of(read_record_csv(name_or_file));
  return scenario.cyclogram(name_or_file);
}

}  // namespace

void predict(const PredictOptions& options) {
  const scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  const scenarios::MachineModel& model = require_machine(scenario, "predict");
  const Cyclogram cyclogram = find_cyclogram(scenario, options.cyclogram);
  scenarios::check_cyclogram(scenario, cyclogram);
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress;
  const Model machine = open_model(scenario, {&cyclogram}, progress, false);
  if (const scenarios::Machine* full = machine.full()) {
    scenarios::require_ways_out(full->placed.mesh, full->placed.balance, model.where);
  }
  progress.begin("computing thermal modes");
  const scenarios::FeltRun felt = scenarios::felt_run(model, cyclogram);
  const int most_modes = scenario.study ? scenario.study->thermal_modes : scenarios::Study{}.thermal_modes;
  const compensation::ModalPredictor predictor =
      modal_predictors(scenario, machine, most_modes, mean_drive({&felt.cyclogram})).completed;
  const std::size_t n_modes = predictor.time_constant_s.size();  // a machine of few nodes has fewer
  const std::vector<double> times_s = scenarios::output_times_s(cyclogram, scenario.solver.output_interval_s);
  const Record record =
      scenarios::as_recorded(model, predictor.predict(felt.cyclogram, felt.hall, times_s), machine.outputs(), cyclogram);
  folder.write_text("record.csv",
                    record_csv(record, provenance_lines(folder.made_by(), fmt::format("predicted by {} thermal modes for {}",
                                                                                      n_modes, options.cyclogram))));
  folder.commit();
  progress.end();
  fmt::print("{}, {:.0f} min, predicted by {} thermal modes and the steady responses\n", options.cyclogram,
             cyclogram.duration_s() / 60.0, n_modes);
  if (!machine.is_linear()) {
    fmt::print(
        "  radiation, films, friction and properties that change with temperature stay as they are in the steady state of "
        "the mean drive; `simulate` follows them\n");
  }
  for (const auto& d : model.displacements) {
    const std::vector<double>& values = record.at(d.name).values;
    const auto peak =
        std::max_element(values.begin(), values.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    fmt::print("  {:<12} peak {:7.1f} um at {:.0f} min, {:7.1f} um at the end\n", d.name, *peak,
               record.time_s[static_cast<std::size_t>(peak - values.begin())] / 60.0, values.back());
  }
  fmt::print("written to {}\n", shown_path(folder.target() / "record.csv"));
}

}  // namespace driftwright::app
