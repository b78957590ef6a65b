#include "findings/diagnosis_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "findings/diagnosis_answer.hpp"
#include "findings/diagnosis_words.hpp"

namespace driftwright::findings {
namespace {

using output::Datum;
using output::Section;
using output::Table;
using output::Text;
using output::Value;

constexpr output::Digits kNumbersDigits = output::significant(3);

/// A number of the scenario with the line of its effect.
std::string number_name(const diagnosis::Estimate& e) {
  return e.line > 0 ? fmt::format("{}, line {}", e.name, e.line) : e.name;
}

const char* limit_words(diagnosis::HeatWander::Limit limit) {
  using Limit = diagnosis::HeatWander::Limit;
  return limit == Limit::kAtMost ? "at most" : limit == Limit::kAtLeast ? "at least" : "about";
}

/// What could be learned beside the file, and the command that does so.
void add_remainder(Section& section, const studies::Remainder& remainder, const std::string& file) {
  if (!remainder.why_not.empty()) {
    add(section, Text{fmt::format("Nothing was learned beside {}: {}", file, remainder.why_not)});
    return;
  }
  Table table{.key = "remainder",
              .title = fmt::format("What could be learned beside {}", file),
              .caption = fmt::format(
                  "Root mean squares on rows that were kept out of what was learned, of each kind in turn (runs or eighths, "
                  "speeds, the end, the beginning, the warmest and the coldest rows). {} was fitted to these rows, too. "
                  "Regression: on drive and ambient after lags. `driftwright identify --prior {}` with the same records "
                  "writes what is learned, and says what it follows.",
                  file, file),
              .columns = {{.key = "name", .title = "channel"},
                          {.key = "unit", .title = "unit"},
                          {.key = "rmse_file", .title = file, .digits = kNumbersDigits},
                          {.key = "rmse_with_remainder", .title = "with what is learned", .digits = kNumbersDigits},
                          {.key = "rmse_regression", .title = "regression", .digits = kNumbersDigits},
                          {.key = "noise_floor", .title = "noise floor", .digits = kNumbersDigits},
                          {.key = "learned", .title = "learned"}},
              .detail = true};
  for (const studies::RemainderGain& g : remainder.channels)
    table.rows.push_back(
        {g.name, g.unit, g.rmse_file, g.rmse_with_remainder, g.rmse_regression, g.noise, g.is_learned ? "yes" : "no"});
  add(section, std::move(table));
}

}  // namespace

Section unexplained_section(const diagnosis::Diagnosis& d) {
  const diagnosis::Unexplained& u = *d.unexplained;
  Section section{.key = "unexplained", .title = "What is left and is more than noise"};
  const auto put = [&](const char* key, Datum datum) { add(section, Value{.key = key, .datum = std::move(datum)}); };
  put("rms", u.channels.front().rms);
  put("unit", u.channels.front().unit);
  put("where", u.channels.front().name);
  Table table{.key = "channels",
              .caption = "The smooth part of what is left, in standard deviations of what noise would have of it.",
              .columns = {{.key = "name", .title = "channel"},
                          {.key = "rms", .title = "rms", .digits = kNumbersDigits},
                          {.key = "unit", .title = "unit"},
                          {.key = "sigmas", .title = "beyond noise [sigmas]"}}};
  for (const auto& c : u.channels) table.rows.push_back({c.name, c.rms, c.unit, c.times_noise});
  add(section, std::move(table));
  if (u.fails_held_out) put("fails_held_out", true);
  if (u.statement) {
    put("statement", static_cast<std::int64_t>(*u.statement));
    put("statement_in_words", diagnosis::words(d.statements.stated[*u.statement].says));
  }
  return section;
}

Section wander_section(const diagnosis::HeatWander& wander) {
  Section section{.key = "process_noise", .title = "Where the model errs", .detail = true};
  add(section,
      Text{fmt::format("Heat that comes and goes in its bodies, alike for {} {:.0f} min{}, would explain what the first "
                       "search left. Causes are weighed beside this process noise.",
                       limit_words(wander.limit), wander.time_s / 60.0,
                       wander.limit == diagnosis::HeatWander::Limit::kNone ? "" : ", an end of the times that were tried")});
  add(section, Value{.key = "stays_alike_min", .datum = wander.time_s / 60.0});
  using Limit = diagnosis::HeatWander::Limit;
  if (wander.limit != Limit::kNone)
    add(section, Value{.key = wander.limit == Limit::kAtMost ? "at_most" : "at_least", .datum = true});
  Table table{
      .key = "bodies",
      .columns = {{.key = "where", .title = "body"},
                  {.key = "standard_deviation_W", .title = "heat, 1 sigma", .unit = "W", .digits = output::significant(2)},
                  {.key = "share", .title = "share of what it does to the readings", .digits = output::percent(0)}}};
  for (const auto& b : wander.bodies) table.rows.push_back({b.body.name, b.sd_W, b.share});
  add(section, std::move(table));
  return section;
}

Section gain_section(const diagnosis::Diagnosis& d, const std::string& file, const studies::Remainder* remainder) {
  Section section{.key = "gain", .title = fmt::format("What {} gains: measured minus simulated", file)};
  add(section, Value{.key = "holdout", .words = "held out:", .datum = d.holdout});
  Table table{.key = "channels",
              .caption =
                  "Root mean squares and peaks on rows that were kept out of the fit. Noise floor: the scatter of the "
                  "readings alone.",
              .columns = {{.key = "name", .title = "channel"}, {.key = "unit", .title = "unit"}}};
  Table full{.title = "The same with other models on these rows, and over all rows",
             .caption =
                 "Regression: ridge on memories of speed, ambient and whatever else drives, which knows nothing of the "
                 "machine; then with readings of thermometers too. Named causes: these alone beside the scenario's numbers. "
                 "Extended is no worse than as "
                 "written by choice: where it was worse on these rows, nothing is written; how much rows weigh in a "
                 "calibration was chosen by them. The file: what the written scenario gives over the whole of all records, "
                 "to which its numbers were fitted.",
             .columns = {{.title = "channel"}, {.key = "unit", .title = "unit"}},
             .detail = true};
  const std::set<std::string> of_first_table = {"rmse_before", "rmse_after", "noise_floor", "peak_before", "peak_after"};
  for (const auto& [key, title] : {std::pair{"rmse_before", "as written"},
                                   {"rmse_calibrated", "scatter alone"},
                                   {"rmse_named", "named causes"},
                                   {"rmse_after", "extended"},
                                   {"rmse_regression_drive", "regression"},
                                   {"rmse_regression_readings", "with thermometers"},
                                   {"noise_floor", "noise floor"},
                                   {"peak_before", "peak before"},
                                   {"peak_after", "peak after"},
                                   {"rmse_all_before", "all rows, as written"},
                                   {"rmse_written", "all rows, the file"}}) {
    table.columns.push_back({.key = key, .title = of_first_table.contains(key) ? title : "", .digits = kNumbersDigits});
    full.columns.push_back({.title = title, .digits = kNumbersDigits});
  }
  for (const auto& g : d.gain)
    table.rows.push_back({g.name, g.unit, g.rmse_before, g.rmse_calibrated, g.rmse_named, g.rmse_after, g.rmse_of_drive,
                          g.rmse_of_readings, g.noise_floor, g.peak_before, g.peak_after, g.rmse_all_before,
                          g.rmse_written});
  full.rows = table.rows;
  add(section, std::move(table));
  add(section, std::move(full));
  add(section, Text{shares_of_gain_text(d)});
  for (const auto& [key, over_noise] : {std::pair{"over_noise.as_written", d.misses.as_written},
                                        {"over_noise.calibrated", d.misses.calibrated},
                                        {"over_noise.named", d.misses.named},
                                        {"over_noise.extended", d.misses.extended}})
    add(section, Value{.key = key, .datum = over_noise});
  const bool numbers_stay =
      std::any_of(d.calibrated.begin(), d.calibrated.end(), [](const auto& e) { return !e.is_written; });
  if (numbers_stay && d.written.keeps_numbers && !d.written.causes_alone)
    add(section, Text{"The file leaves the scenario's own numbers as they were (--causes-only): only \"the file, all rows\" "
                      "shows the effect of that; on kept-out rows they are as fitted."});
  if (const std::string taken_up = diagnosis::taken_up_text(d); !taken_up.empty())
    add(section, Text{.words = taken_up, .key = "taken_up"});
  if (const std::string better = better_regression_text(d); !better.empty()) add(section, Text{better});
  if (remainder) add_remainder(section, *remainder, file);
  return section;
}

Section data_section(const diagnosis::Diagnosis& d) {
  Section section;
  Table table{.key = "data",
              .title = "The data themselves",
              .columns = {{.key = "channel", .title = "channel"},
                          {.key = "what", .title = "finding"},
                          {.key = "left_out", .title = "left out"}}};
  for (const auto& f : d.data) table.rows.push_back({f.channel, f.what, f.leaves_out});
  add(section, std::move(table));
  return section;
}

Table moved_most(const diagnosis::Diagnosis& d) {
  constexpr std::size_t kMost = 6;
  std::vector<const diagnosis::Estimate*> list;
  for (const diagnosis::Estimate& e : d.calibrated) list.push_back(&e);
  std::stable_sort(list.begin(), list.end(),
                   [](const auto* a, const auto* b) { return std::abs(a->deviation) > std::abs(b->deviation); });
  if (list.size() > kMost) list.resize(kMost);
  Table table{.title = fmt::format("The numbers that moved most, of {}", d.calibrated.size()),
              .caption = "In standard deviations of what is known of them; beyond 3.5 a number is in doubt.",
              .columns = {{.title = "number"},
                          {.title = "fitted", .digits = output::significant(4)},
                          {.title = "95 % interval"},
                          {.key = "unit", .title = "unit"},
                          {.title = "moved [sigmas]", .digits = output::signed_decimals(2)}}};
  for (const auto* e : list)
    table.rows.push_back({number_name(*e), e->value, diagnosis::interval_text(*e), e->unit, e->deviation});
  return table;
}

Section numbers_section(const diagnosis::Diagnosis& d) {
  Section section{.title = "The scenario's own numbers", .detail = true};
  Table table{
      .key = "calibrated",
      .caption =
          "The uncertain ones as fitted. Moved: from what the scenario says, in standard deviations of what is known of "
          "it: the scenario's `known_to`, else 10 %, exponents 3 %, the ambient 0.3 K. What is not in the file was fitted "
          "and "
          "left "
          "as the scenario has it.",
      .columns = {{.key = "name", .title = "number"},
                  {.key = "value", .title = "fitted", .digits = output::significant(4)},
                  {.title = "95 % interval"},
                  {.key = "unit", .title = "unit"},
                  {.title = "line"},
                  {.title = "in the file"},
                  {.title = "known to"},
                  {.key = "sigmas_of_prior", .title = "moved [sigmas]", .digits = output::signed_decimals(2)},
                  {.key = "ci95"},
                  {.key = "known_to"},
                  {.key = "known_to_unit"},
                  {.key = "written"}}};
  for (const diagnosis::Estimate& e : d.calibrated) {
    table.rows.push_back({e.name, e.value, diagnosis::interval_text(e), e.unit,
                          e.line > 0 ? output::Datum(static_cast<std::int64_t>(e.line)) : output::Datum(),
                          e.is_written ? "yes" : "no", known_to_text(e), e.deviation, std::vector<double>{e.low, e.high},
                          e.known_to, e.is_share ? "of its logarithm" : e.unit, e.is_written});
  }
  add(section, std::move(table));
  return section;
}

}  // namespace driftwright::findings
