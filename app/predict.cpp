#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/prediction.hpp"
#include "app/verbs.hpp"
#include "scenarios/read_cyclogram.hpp"

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
  const Prediction prediction = predict_drift(scenario, cyclogram, progress, "predict");
  const Record& record = prediction.record;
  folder.write_text("record.csv", record_csv(record, provenance_lines(folder.made_by(),
                                                                      fmt::format("predicted by {} thermal modes for {}",
                                                                                  prediction.n_modes, options.cyclogram))));
  folder.commit();
  progress.end();
  fmt::print("{}, {:.0f} min, predicted by {} thermal modes and the steady responses\n{}", options.cyclogram,
             cyclogram.duration_s() / 60.0, prediction.n_modes, prediction_note(prediction));
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
