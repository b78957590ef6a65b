#include "app/iso230_3_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace driftwright::app {
namespace {

using compensation::Iso230Channel;
using compensation::Iso230Figures;

std::string number(double value, const std::string& unit) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, unit == "mm" ? 4 : 1);
}

std::string signed_number(double value, const std::string& unit) {
  return std::isnan(value) ? "-" : fmt::format("{:+.{}f}", value, unit == "mm" ? 4 : 1);
}

}  // namespace

std::string iso230_3_text(const Iso230Figures& figures) {
  if (!figures.not_available.empty()) return fmt::format("  ISO 230-3: not available: {}\n", figures.not_available);
  const double t_min = figures.running_period_s / 60.0;
  std::string text = fmt::format(
      "  ISO 230-3, rotating spindle, running period t = {:.4g} min: ranges d,60 in the first 60 min and d,t until t, value "
      "at t\n",
      t_min);
  for (const Iso230Channel& c : figures.channels) {
    text += fmt::format("    {:<16} d,60 {:>7} {}   d,t {:>7} {}   at t {:>8} {}\n", c.name,
                        number(c.range_first_60_min, c.unit), c.unit, number(c.range_running, c.unit), c.unit,
                        signed_number(c.at_end_of_running, c.unit), c.unit);
  }
  return text;
}

nlohmann::ordered_json iso230_3_json(const Iso230Figures& figures) {
  using Json = nlohmann::ordered_json;
  if (!figures.not_available.empty()) return {{"not_available", figures.not_available}};
  Json channels = Json::array();
  for (const Iso230Channel& c : figures.channels) {
    channels.push_back({{"name", c.name},
                        {"unit", c.unit},
                        {"range_first_60_min", c.range_first_60_min},
                        {"range_running_period", c.range_running},
                        {"at_end_of_running_period", c.at_end_of_running},
                        {"range_whole_record", c.range_whole_record}});
  }
  return {{"spindle_running_period_min", figures.running_period_s / 60.0}, {"channels", channels}};
}

output::ReportBlock iso230_3_block(const Iso230Figures& figures) {
  if (!figures.not_available.empty())
    return output::Paragraph{
        fmt::format("Thermal distortion by rotating spindle (ISO 230-3): not available: {}.", figures.not_available)};
  output::Table table{
      .caption = fmt::format(
          "Thermal distortion by rotating spindle (ISO 230-3), spindle running period t = {:.4g} min. Ranges d are "
          "maximum minus minimum; the value at t counts from the start of the test. The last column has the time "
          "at rest behind t in it, too.",
          figures.running_period_s / 60.0),
      .headers = {"X", "unit", "d(X),60: first 60 min", "d(X),t: running period", "X at t", "range of the whole record"},
      .rows = {}};
  for (const Iso230Channel& c : figures.channels) {
    table.rows.push_back({c.name, c.unit, number(c.range_first_60_min, c.unit), number(c.range_running, c.unit),
                          signed_number(c.at_end_of_running, c.unit), number(c.range_whole_record, c.unit)});
  }
  return table;
}

nlohmann::ordered_json iso230_3_json(const std::vector<Iso230Run>& runs) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Iso230Run& r : runs) {
    nlohmann::ordered_json entry = {{"run", r.run}};
    entry.update(iso230_3_json(r.figures));
    list.push_back(std::move(entry));
  }
  return list;
}

output::ReportBlock iso230_3_block(const std::vector<Iso230Run>& runs) {
  output::Table table{
      .caption =
          "Thermal distortion by rotating spindle (ISO 230-3), without correction: t is the spindle running period. Ranges "
          "d are maximum minus minimum; the value at t counts from the start of the run. The last column has the time at "
          "rest behind t in it, too.",
      .headers = {"run", "t [min]", "X", "unit", "d(X),60: first 60 min", "d(X),t: running period", "X at t",
                  "range of the whole run"},
      .rows = {}};
  for (const Iso230Run& r : runs) {
    if (!r.figures.not_available.empty())
      table.rows.push_back({r.run, "", "not available: " + r.figures.not_available, "", "", "", "", ""});
    for (const Iso230Channel& c : r.figures.channels) {
      const bool is_first = &c == &r.figures.channels.front();
      table.rows.push_back({is_first ? r.run : "", is_first ? fmt::format("{:.4g}", r.figures.running_period_s / 60.0) : "",
                            c.name, c.unit, number(c.range_first_60_min, c.unit), number(c.range_running, c.unit),
                            signed_number(c.at_end_of_running, c.unit), number(c.range_whole_record, c.unit)});
    }
  }
  return table;
}

}  // namespace driftwright::app
