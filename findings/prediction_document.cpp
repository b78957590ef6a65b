#include "findings/prediction_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "findings/iso230_3_section.hpp"
#include "findings/named_value.hpp"
#include "findings/run_section.hpp"

namespace driftwright::findings {
namespace {

/// Peak and end of each displacement and tilt, with their intervals if there is a band.
output::Table channels_table(const Record& record, const RecordBand* band) {
  output::Table table{.key = "channels",
                      .columns = {{.key = "name", .title = "channel"},
                                  {.key = "unit", .title = "unit"},
                                  {.key = "peak", .title = "peak"},
                                  {.key = "peak_at_min", .title = "at", .unit = "min", .digits = output::decimals(0)},
                                  {.key = "at_end", .title = "at the end"}}};
  const bool has_limits = band && !band->limits.channels.empty();
  if (has_limits) {
    table.columns.push_back({.key = "peak_ci95", .title = "95 % of the peak"});
    table.columns.push_back({.key = "at_end_ci95", .title = "95 % at the end"});
  }
  for (const Channel& channel : record.channels) {
    if (channel.unit != "um" && channel.unit != "urad") continue;
    const auto peak = std::max_element(channel.values.begin(), channel.values.end(),
                                       [](double a, double b) { return std::abs(a) < std::abs(b); });
    const double peak_s = record.time_s[static_cast<std::size_t>(peak - channel.values.begin())];
    table.rows.push_back({channel.name, channel.unit, *peak, peak_s / 60.0, channel.values.back()});
    if (!has_limits) continue;
    for (const std::ptrdiff_t row : {peak - channel.values.begin(), std::ssize(channel.values) - 1}) {
      const auto i = static_cast<std::size_t>(row);
      const Channel* low = band->low(channel.name);
      table.rows.back().emplace_back(
          low ? output::Datum(std::vector<double>{low->values[i], band->high(channel.name)->values[i]}) : output::Datum());
    }
  }
  return table;
}

}  // namespace

output::Table start_checks_table(const std::vector<studies::StartCheck>& checks) {
  output::Table table{
      .key = "start_checks",
      .title = "Change over the record before",
      .columns = {{.key = "name", .title = "channel"},
                  {.key = "unit", .title = "unit"},
                  {.key = "recorded_change", .title = "recorded", .digits = output::signed_decimals(1)},
                  {.key = "modelled_change", .title = "in the model", .digits = output::signed_decimals(1)}}};
  for (const studies::StartCheck& c : checks) table.rows.push_back({c.channel, c.unit, c.recorded, c.modelled});
  return table;
}

output::Document document_of(const studies::Prediction& prediction, const scenarios::Scenario& scenario,
                             const Cyclogram& cyclogram, const std::string& asked, const output::Provenance& made_by) {
  const std::string& before = prediction.started_from;
  output::Document document{
      .made_by = made_by,
      .title = fmt::format("{}: predicted drift of {}", scenario.name, cyclogram.name),
      .subtitle = fmt::format("predicted by the {}{}", prediction.predicted_by, before.empty() ? "" : "; after " + before)};
  output::Section& body = document.body;
  add(body, output::Value{.key = "cyclogram", .datum = asked});
  add(body, named_value("duration_min", "duration", cyclogram.duration_s() / 60.0, "min", output::decimals(0)));
  add(body, output::Value{.key = "predicted_by", .datum = prediction.predicted_by});
  add(body, output::Value{.key = "started_from", .datum = before.empty() ? output::Datum() : output::Datum(before)});
  add(body, start_checks_table(prediction.start_checks));
  const RecordBand* band = prediction.band ? &*prediction.band : nullptr;
  add(body, channels_table(prediction.record, band));
  add_channel_plots(body, prediction.record, cyclogram, band);
  body.sections.push_back(iso230_3_section(studies::iso_figures(prediction)));
  return document;
}

}  // namespace driftwright::findings
