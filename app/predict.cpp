#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/prediction.hpp"
#include "app/verbs.hpp"
#include "base/mapped_record.hpp"
#include "scenarios/recorded_run.hpp"

namespace driftwright::app {
namespace {

/// A cyclogram of the scenario, or what drove the machine in a record.
Cyclogram find_cyclogram(const scenarios::Scenario& scenario, const std::string& name_or_file) {
  const bool is_known = std::any_of(scenario.cyclograms.begin(), scenario.cyclograms.end(),
                                    [&](const Cyclogram& c) { return c.name == name_or_file; });
  if (is_known || (!name_or_file.ends_with(".csv") && !std::filesystem::exists(name_or_file)))
    return scenario.cyclogram(name_or_file);
  const ReadRecord read = read_record(name_or_file, scenario.columns);
  for (const std::string& note : read.notes) fmt::print("note: {}\n", note);
  const scenarios::RecordedRun run = scenarios::run_of(read.record, nullptr, {}, scenarios::Reading::kStrict);
  for (const scenarios::DataFinding& f : run.findings) {
    if (f.channel == "speed") fmt::print("note: {}\n", f.what);  // the hall is the scenario's
  }
  return run.cyclogram;
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
