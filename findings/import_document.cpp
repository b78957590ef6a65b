#include "findings/import_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/median.hpp"
#include "base/usual_step.hpp"
#include "findings/named_value.hpp"
#include "findings/run_section.hpp"

namespace driftwright::findings {
namespace {

constexpr std::size_t kMostImportedCurves = 10;  // in one plot

output::Table channels_table(const studies::LoggerImport& import) {
  output::Table table{.key = "channels",
                      .title = "Channels of the record",
                      .columns = {{.key = "channel", .title = "channel"},
                                  {.key = "unit", .title = "unit"},
                                  {.key = "column", .title = "in the file"},
                                  {.key = "written_unit", .title = "written in"},
                                  {.key = "first", .title = "first", .digits = output::significant(4)},
                                  {.key = "least", .title = "least", .digits = output::significant(4)},
                                  {.key = "greatest", .title = "greatest", .digits = output::significant(4)},
                                  {.key = "missing_rows", .title = "rows missing"}}};
  const Record& record = import.read.record;
  for (std::size_t c = 0; c < record.channels.size(); ++c) {
    const Channel& channel = record.channels[c];
    const MappedChannel& mapped = import.map.channels[c];
    double first = std::nan(""), least = std::nan(""), greatest = std::nan("");
    std::size_t n_missing = 0;
    for (double value : channel.values) {
      if (std::isnan(value)) {
        ++n_missing;
        continue;
      }
      if (std::isnan(first)) first = least = greatest = value;
      least = std::min(least, value);
      greatest = std::max(greatest, value);
    }
    table.rows.push_back({channel.name, output::shown_unit(channel.unit), mapped.column.words(), mapped.written_unit, first,
                          least, greatest, n_missing});
  }
  return table;
}

/// Channels of one unit over time, some in each plot.
void add_plots(output::Section& body, const Record& record) {
  std::vector<std::string> units;
  for (const Channel& c : record.channels) {
    if (std::find(units.begin(), units.end(), c.unit) == units.end()) units.push_back(c.unit);
  }
  for (const std::string& unit : units) {
    output::Plot plot{.title = unit == "degC"  ? "Temperatures"
                               : unit == "um"  ? "Displacements"
                               : unit == "rpm" ? "Speed"
                                               : "Channels in " + output::shown_unit(unit),
                      .x_label = "time [min]",
                      .y_label = output::shown_unit(unit)};
    const auto flush = [&] {
      if (!plot.series.empty()) add(body, plot);
      plot.series.clear();
    };
    for (const Channel& c : record.channels) {
      if (c.unit != unit) continue;
      plot.series.push_back({.label = c.name, .x = minutes(record), .y = c.values});
      if (plot.series.size() == kMostImportedCurves) flush();
    }
    flush();
  }
}

}  // namespace

output::Document document_of(const studies::LoggerImport& import, const output::Provenance& made_by) {
  const Record& record = import.read.record;
  output::Document document{.made_by = made_by, .title = record.source + ": as it was read"};
  output::Section& body = document.body;
  add(body, named_value("read_by", "read by",
                        import.read_by.empty() ? std::string("a guess from the file itself")
                                               : fmt::format("the columns of {}", import.read_by)));
  add(body, output::Value{.key = "rows", .words = "rows", .datum = record.n_samples()});
  if (import.read.n_without_reading > 0)
    add(body, named_value("rows_without_reading", "rows without a reading, left out", import.read.n_without_reading));
  const double length_s = record.time_s.back() - record.time_s.front();
  add(body, named_value("duration_min", "from the first row to the last", length_s / 60.0, "min"));
  const std::vector<double> steps_s = row_steps_s(record.time_s);
  add(body, named_value("usual_step_s", "from row to row, usually", upper_median(steps_s), "s", output::significant(4)));
  add(body, named_value("longest_step_s", "at most", *std::max_element(steps_s.begin(), steps_s.end()), "s",
                        output::significant(4)));
  add(body, output::Notes{.key = "how", .lines = words(import.map)});
  add(body, channels_table(import));
  add(body, output::Notes{.key = "guesses", .sort = "guess", .lines = import.guesses});
  add(body, output::Notes{.key = "notes", .sort = "note", .lines = import.read.notes});
  add(body, output::Preformatted{.title = "For scenarios that read files of this logger: the key `columns`",
                                 .text = yaml_text(import.map)});
  add_plots(body, record);
  return document;
}

}  // namespace driftwright::findings
