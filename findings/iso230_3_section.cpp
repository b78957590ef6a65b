#include "findings/iso230_3_section.hpp"

#include <cmath>

#include "findings/named_value.hpp"

namespace driftwright::findings {
namespace {

using compensation::Iso230Channel, compensation::Iso230Figures;
using output::Column, output::Datum, output::Table;

constexpr const char* kTest = "ISO 230-3, thermal distortion by rotating spindle";
constexpr const char* kRanges =
    "Ranges d are maximum minus minimum; the value at t counts from the start of the test. The last column includes the "
    "time at rest after t.";

const std::vector<Column>& figure_columns() {
  static const std::vector<Column> kColumns = {
      {.key = "name", .title = "X"},
      {.key = "unit", .title = "unit"},
      {.key = "range_first_60_min", .title = "d(X),60: first 60 min"},
      {.key = "range_running_period", .title = "d(X),t: running period"},
      {.key = "at_end_of_running_period", .title = "X at t", .digits = output::signed_decimals(1)},
      {.key = "range_whole_record", .title = "range of the whole record"}};
  return kColumns;
}

std::vector<Datum> figures_of(const Iso230Channel& c) {
  std::vector<Datum> row = {
      c.name, c.unit, c.range_first_60_min, c.range_running, c.at_end_of_running, c.range_whole_record};
  if (c.unit == "mm") {
    for (std::size_t k = 2; k < row.size(); ++k) row[k].digits = k == 4 ? output::signed_decimals(4) : output::decimals(4);
  }
  return row;
}

}  // namespace

output::Section iso230_3_section(const Iso230Figures& figures) {
  output::Section section{.key = "iso_230_3", .title = kTest};
  if (!figures.not_available.empty()) {
    add(section, output::Value{.key = "not_available", .words = "not available:", .datum = figures.not_available});
    return section;
  }
  add(section, named_value("spindle_running_period_min", "spindle running period t", figures.running_period_s / 60.0, "min",
                           output::significant(4)));
  Table table{.key = "channels", .caption = kRanges, .columns = figure_columns()};
  for (const Iso230Channel& c : figures.channels) table.rows.push_back(figures_of(c));
  add(section, std::move(table));
  return section;
}

Table iso230_3_table(const std::vector<Iso230Run>& runs) {
  Table table{
      .key = "iso_230_3",
      .title = std::string(kTest) + ", without correction",
      .caption = std::string("t is the spindle running period. ") + kRanges,
      .columns = {{.key = "run", .title = "run"},
                  {.key = "spindle_running_period_min", .title = "t", .unit = "min", .digits = output::significant(4)}},
      .detail = true};
  table.columns.insert(table.columns.end(), figure_columns().begin(), figure_columns().end());
  table.columns.push_back({.key = "not_available", .title = "not available"});
  for (const Iso230Run& r : runs) {
    if (!r.figures.not_available.empty()) {
      table.rows.push_back({r.run, {}, {}, {}, {}, {}, {}, {}, r.figures.not_available});
      continue;
    }
    for (const Iso230Channel& c : r.figures.channels) {
      std::vector<Datum> row = {r.run, r.figures.running_period_s / 60.0};
      for (Datum& figure : figures_of(c)) row.push_back(std::move(figure));
      row.emplace_back("");
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

std::vector<output::Section> iso230_3_items(const std::vector<Iso230Run>& runs) {
  std::vector<output::Section> items;
  for (const Iso230Run& r : runs) {
    items.push_back(iso230_3_section(r.figures));
    items.back().title = r.run;
    items.back().item = {"run", r.run};
  }
  return items;
}

}  // namespace driftwright::findings
