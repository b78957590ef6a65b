#include "findings/frame_document.hpp"

#include <fmt/format.h>

namespace driftwright::findings {

output::Document document_of(const studies::FrameStudy& study, const scenarios::Scenario& scenario, const std::string& model,
                             const output::Provenance& made_by) {
  output::Document document{.made_by = made_by,
                            .title = fmt::format("{}: the table's frame driven by {}", scenario.name, model),
                            .subtitle = study.predictor};
  output::Section& body = document.body;
  add(body, output::Value{.key = "model", .datum = model});
  add(body, output::Value{.key = "predictor", .datum = study.predictor});
  add(body, output::Value{.key = "through", .datum = "frame"});
  add(body, output::Text{.words = studies::instrument_words(*scenario.table), .detail = true});
  output::Table table{
      .key = "corrections",
      .title = fmt::format("Largest errors anywhere on the table in {:g} h", scenario.table->judge_until_s / 3600.0),
      .caption = "Median of five repetitions (other noise, another wrong model).",
      .columns = {{.key = "name", .title = "correction"},
                  {.key = "x_um", .title = "X", .unit = "um"},
                  {.key = "y_um", .title = "Y", .unit = "um"},
                  {.key = "z_um", .title = "Z", .unit = "um"},
                  {.key = "position_um", .title = "position", .unit = "um"},
                  {.key = "removed_percent", .title = "removed", .unit = "percent", .digits = output::decimals(0)}}};
  output::Plot plot{.title = "Largest position error on the table", .x_label = "time [h]", .y_label = "error [µm]"};
  std::vector<double> t_h;
  for (double t_s : study.time_s) t_h.push_back(t_s / 3600.0);
  for (const studies::TableStrategy& row : study.corrections) {
    const double removed = 100.0 * (1.0 - row.peak.position_m / study.corrections.front().peak.position_m);
    table.rows.push_back(
        {row.name, 1e6 * row.peak.x_m, 1e6 * row.peak.y_m, 1e6 * row.peak.z_m, 1e6 * row.peak.position_m, removed});
    plot.series.push_back({.label = row.name, .x = t_h, .y = row.course_um});
  }
  add(body, std::move(table));
  add(body, std::move(plot));
  return document;
}

}  // namespace driftwright::findings
