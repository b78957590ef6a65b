#include <fmt/format.h>

#include "app/results.hpp"
#include "findings/plausibility.hpp"
#include "findings/prediction_document.hpp"
#include "scenarios/reader/unusual.hpp"

namespace driftwright::app {

void predict(const PredictOptions& options) {
  const scenarios::Scenario scenario = read_scenario(options, Told::kInDocument);
  (void)scenarios::require_machine(scenario, "predict");
  const Cyclogram cyclogram = studies::named_cyclogram(scenario, options.cyclogram);
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
  const studies::Prediction prediction = studies::predict_drift(
      scenario, cyclogram,
      {.start = options.start, .after_pause = options.after_pause, .model = options.model, .with_band = true},
      progress.listener(), "predict");
  const std::string after = prediction.started_from.empty() ? "" : " after " + prediction.started_from;
  folder.write_text("record.csv",
                    record_csv(prediction.record,
                               provenance_lines(folder.made_by(), fmt::format("{}{}, predicted by the {}", options.cyclogram,
                                                                              after, prediction.predicted_by))));
  if (prediction.band && !prediction.band->limits.channels.empty())
    folder.write_text("record_band.csv", band_csv(*prediction.band, folder.made_by()));
  output::Document document = findings::document_of(prediction, scenario, cyclogram, options.cyclogram, folder.made_by());
  findings::add_plausibility(document.body, scenario, scenarios::unusual_values(prediction.record));
  finish(document, folder, progress, options);
}

}  // namespace driftwright::app
