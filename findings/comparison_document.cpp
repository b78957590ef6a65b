#include "findings/comparison_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "findings/run_section.hpp"

namespace driftwright::findings {
namespace {

constexpr std::size_t kMostComparisonPlots = 12;

/// Displacements, tilts, temperatures, then the rest; within each kind the largest difference first.
std::vector<const studies::ChannelDifference*> in_order(const studies::RecordComparison& comparison) {
  const auto rank = [](const std::string& unit) { return unit == "um" ? 0 : unit == "urad" ? 1 : unit == "degC" ? 2 : 3; };
  std::vector<const studies::ChannelDifference*> list;
  for (const studies::ChannelDifference& d : comparison.channels) list.push_back(&d);
  std::stable_sort(list.begin(), list.end(), [&](const auto* a, const auto* b) {
    if (rank(a->unit) != rank(b->unit)) return rank(a->unit) < rank(b->unit);
    return a->n_rows > 0 && b->n_rows > 0 && std::abs(a->largest) > std::abs(b->largest);
  });
  return list;
}

}  // namespace

output::Document document_of(const studies::RecordComparison& comparison, const output::Provenance& made_by) {
  const std::string &first = comparison.first.source, &second = comparison.second_at_rows.source;
  output::Document document{.made_by = made_by, .title = fmt::format("{} beside {}", second, first)};
  output::Section& body = document.body;
  add(body, output::Value{.key = "first", .words = "first", .datum = first});
  add(body, output::Value{.key = "second", .words = "second", .datum = second});
  output::Table table{.key = "channels",
                      .title = "Second minus first",
                      .caption = "At the rows of the first record that both reach; the second is linear between its own.",
                      .columns = {{.key = "name", .title = "channel"},
                                  {.key = "unit", .title = "unit"},
                                  {.key = "rms", .title = "RMS", .digits = output::significant(3)},
                                  {.key = "largest", .title = "largest", .digits = output::significant(3)},
                                  {.key = "largest_at_min", .title = "at", .unit = "min", .digits = output::decimals(0)},
                                  {.key = "at_end", .title = "at the end", .digits = output::significant(3)},
                                  {.key = "range_of_first", .title = "range of the first", .digits = output::significant(3)},
                                  {.key = "n_rows", .title = "rows"}}};
  const bool has_band = comparison.first_band || comparison.second_band;
  if (has_band) table.columns.push_back({.key = "within_band", .title = "within the band", .digits = output::percent(0)});
  const auto list = in_order(comparison);
  for (const auto* d : list) {
    table.rows.push_back({d->name, d->unit, d->rms, d->largest, d->largest_at_s / 60.0, d->at_end, d->range, d->n_rows});
    if (has_band) table.rows.back().emplace_back(d->within_band);
  }
  add(body, std::move(table));
  for (const auto* band : {&comparison.first_band, &comparison.second_band}) {
    if (*band) add(body, output::Text{.words = (*band)->words});
  }
  add(body, output::Value{.key = "only_in_first", .datum = comparison.only_first});
  add(body, output::Value{.key = "only_in_second", .datum = comparison.only_second});
  std::vector<std::string> notes;
  if (!comparison.only_first.empty())
    notes.push_back(fmt::format("only in the first: {}", fmt::join(comparison.only_first, ", ")));
  if (!comparison.only_second.empty())
    notes.push_back(fmt::format("only in the second: {}", fmt::join(comparison.only_second, ", ")));
  add(body, output::Notes{.sort = "note", .lines = notes});
  for (std::size_t i = 0; i < std::min(kMostComparisonPlots, list.size()); ++i) {
    const std::string header = list[i]->name + "_" + list[i]->unit;
    const std::string unit = output::shown_unit(list[i]->unit);
    output::Plot plot{
        .title = list[i]->name,
        .x_label = "time [min]",
        .y_label = fmt::format("{} [{}]", list[i]->name, unit),
        .series = {{.label = first, .x = minutes(comparison.first), .y = comparison.first.at(header).values, .width = 3.0},
                   {.label = second,
                    .x = minutes(comparison.second_at_rows),
                    .y = comparison.second_at_rows.at(header).values,
                    .style = output::Series::Style::kDashed}},
        .half_width = true};
    add_interval(plot.series[0], comparison.first_band ? &*comparison.first_band : nullptr, list[i]->name);
    add_interval(plot.series[1], comparison.second_band ? &*comparison.second_band : nullptr, list[i]->name);
    add(body, std::move(plot));
  }
  return document;
}

}  // namespace driftwright::findings
