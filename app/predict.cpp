#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/results.hpp"
#include "app/verbs.hpp"
#include "compensation/modal_predictor.hpp"

namespace driftwright::app {
namespace {

/// The sections of a record's channel `speed`, which holds from each row to the next.
Cyclogram cyclogram_of(const Record& record) {
  const Channel& speed = record.at("speed");
  Cyclogram cyclogram{.name = record.source, .sections = {}};
  if (record.time_s.front() != 0.0) {
    throw InputError(
        fmt::format("{}: a cyclogram starts at time 0, this one at {:g} s", record.source, record.time_s.front()));
  }
  for (std::size_t i = 0; i + 1 < record.n_samples(); ++i) {
    if (!(speed.values[i] >= 0.0)) {
      throw InputError(fmt::format("{}: speed_rpm is missing or negative at {:g} s", record.source, record.time_s[i]));
    }
    const double duration_s = record.time_s[i + 1] - record.time_s[i];
    if (!cyclogram.sections.empty() && cyclogram.sections.back().drive.speed_rpm == speed.values[i]) {
      cyclogram.sections.back().duration_s += duration_s;
    } else {
      cyclogram.sections.push_back({duration_s, {.speed_rpm = speed.values[i]}});
    }
  }
  return cyclogram;
}

Cyclogram find_cyclogram(const scenarios::Scenario& scenario, const std::string& name_or_file) {
  return name_or_file.ends_with(".csv") ? cyclogram_of(read_record_csv(name_or_file)) : scenario.cyclogram(name_or_file);
}

}  // namespace

void predict(const PredictOptions& options) {
  const scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  const scenarios::MachineModel& model = require_machine(scenario, "predict");
  const Cyclogram cyclogram = find_cyclogram(scenario, options.cyclogram);
  scenarios::check_cyclogram(scenario, cyclogram);
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress;
  const scenarios::Machine machine = build_machine(model, progress);
  progress.begin("computing thermal modes");
  const int n_modes = scenario.study ? scenario.study->thermal_modes : scenarios::Study{}.thermal_modes;
  const compensation::ModalPredictor predictor = compensation::make_modal_predictor(machine.system, n_modes);
  const std::vector<double> times_s = scenarios::output_times_s(cyclogram, scenario.solver.output_interval_s);
  const Record record = scenarios::to_record(predictor.predict(cyclogram, model.hall, times_s), machine.system.outputs,
                                             cyclogram, model.reference_K);
  folder.write_text("record.csv",
                    record_csv(record, provenance_lines(folder.made_by(), fmt::format("predicted by {} thermal modes for {}",
                                                                                      n_modes, options.cyclogram))));
  folder.commit();
  progress.end();
  fmt::print("{}, {:.0f} min, predicted by {} thermal modes and the steady responses\n", options.cyclogram,
             cyclogram.duration_s() / 60.0, n_modes);
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
