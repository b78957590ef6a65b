#include "findings/iso230_3_section.hpp"

#include <cmath>
#include <stdexcept>

#include "findings/named_value.hpp"

namespace driftwright::findings {
namespace {

using compensation::Iso230Channel, compensation::Iso230Figures, compensation::Iso230Test;
using output::Column, output::Datum, output::Table;

std::string title_of(const Iso230Figures& f) {
  switch (f.test) {
    case Iso230Test::kSpindle:
      return "ISO 230-3, thermal distortion by rotating spindle";
    case Iso230Test::kLinearAxis:
      return "ISO 230-3, thermal distortion by moving linear axes";
    case Iso230Test::kAmbient:
      return "ISO 230-3, environmental temperature variation error (ETVE)";
  }
  throw std::logic_error("a test of ISO 230-3 without a title");
}

/// Word for programs.
const char* word_of(Iso230Test test) {
  return test == Iso230Test::kSpindle ? "rotating_spindle" : test == Iso230Test::kLinearAxis ? "linear_axes" : "environment";
}

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
  output::Section section{.key = "iso_230_3", .title = title_of(figures)};
  if (!figures.not_available.empty()) {
    add(section, output::Value{.key = "not_available", .words = "not available:", .datum = figures.not_available});
    return section;
  }
  const bool is_spindle = figures.test == Iso230Test::kSpindle, is_axis = figures.test == Iso230Test::kLinearAxis;
  add(section, output::Value{.key = "test", .datum = word_of(figures.test)});
  if (is_axis) add(section, named_value("axes", "axes that move", figures.axes));
  add(section, named_value(is_spindle ? "spindle_running_period_min"
                           : is_axis  ? "axis_running_period_min"
                                      : "duration_min",
                           is_spindle ? "spindle running period t"
                           : is_axis  ? "axis running period t"
                                      : "duration",
                           figures.running_period_s / 60.0, "min", output::significant(4)));
  Table table{.key = "channels", .caption = kRanges, .columns = figure_columns()};
  for (const Iso230Channel& c : figures.channels) table.rows.push_back(figures_of(c));
  add(section, std::move(table));
  return section;
}

Table iso230_3_table(const std::vector<Iso230Run>& runs) {
  Table table{
      .key = "iso_230_3",
      .title = "Figures of ISO 230-3, without correction",
      .caption =
          std::string("t is the period in which the spindle turns, or axes move. A run in which nothing moves is a test of "
                      "the ambient, whose figure (ETVE) is the range of the whole record. ") +
          kRanges,
      .columns = {{.key = "run", .title = "run"},
                  {.key = "test", .title = "test"},
                  {.key = "running_period_min", .title = "t", .unit = "min", .digits = output::significant(4)}},
      .detail = true};
  table.columns.insert(table.columns.end(), figure_columns().begin(), figure_columns().end());
  table.columns.push_back({.key = "not_available", .title = "not available"});
  for (const Iso230Run& r : runs) {
    if (!r.figures.not_available.empty()) {
      table.rows.push_back({r.run, {}, {}, {}, {}, {}, {}, {}, {}, r.figures.not_available});
      continue;
    }
    for (const Iso230Channel& c : r.figures.channels) {
      std::vector<Datum> row = {r.run, word_of(r.figures.test), r.figures.running_period_s / 60.0};
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
