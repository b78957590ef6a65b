#include "findings/diagnosis_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "effects/where_in_files.hpp"
#include "findings/diagnosis_data.hpp"
#include "findings/diagnosis_words.hpp"
#include "findings/measured_iso230_3.hpp"
#include "findings/residual_sections.hpp"

namespace driftwright::findings {
namespace {

using output::Bars;
using output::Datum;
using output::Plot;
using output::Section;
using output::Table;
using output::Text;
using output::Value;

constexpr output::Digits kThree = output::significant(3);

/// @param compared  if at most half of the channels were compared, no verdict is shown as good
output::Verdict verdict_box(const diagnosis::Diagnosis& d, const Compared& compared) {
  using diagnosis::Verdict;
  using Kind = output::Verdict::Kind;
  const bool is_of_few = 2 * compared.n <= compared.of;
  const Kind kind = d.verdict == Verdict::kConsistent    ? is_of_few ? Kind::kNeutral : Kind::kGood
                    : d.verdict == Verdict::kUnexplained ? Kind::kBad
                                                         : Kind::kNeutral;
  static const std::map<Verdict, const char*> titles = {{Verdict::kConsistent, "Consistent with the scenario"},
                                                        {Verdict::kSuspected, "A cause is suspected"},
                                                        {Verdict::kNamed, "Causes named"},
                                                        {Verdict::kAmbiguous, "Ambiguous: several causes would do"},
                                                        {Verdict::kUnexplained, "Something is left unexplained"},
                                                        {Verdict::kInsufficientData, "Too few data for a verdict"}};
  std::string text = compared_text(compared);
  if (!text.empty()) text += " ";
  return {.key = "", .kind = kind, .title = titles.at(d.verdict), .text = text + d.reason};
}

Table causes_table(const diagnosis::Diagnosis& d) {
  Table table{
      .title = "Causes",
      .caption =
          "Gain: logarithm of how much more probable the data are with it than without, after the price of having looked "
          "for it among all candidates. Listed under a cause: what it cannot be distinguished from: claims that hold more "
          "than a "
          "tenth of the odds with "
          "others of their kind, or of its own kind at other places.",
      .columns = {{.title = "effect"},
                  {.title = "standing"},
                  {.title = "gain", .unit = "nats"},
                  {.title = "numbers (95 % interval)"}}};
  for (const diagnosis::Cause& c : d.causes) {
    table.rows.push_back(
        {fmt::format("{} at {}", c.effect, c.where), diagnosis::word(c.standing), c.log_evidence_gain, parameters_text(c)});
    for (const diagnosis::Cause& a : c.alternatives)
      table.rows.push_back({fmt::format("or {} at {}", a.effect, a.where), "", a.log_evidence_gain, parameters_text(a)});
  }
  return table;
}

/// The missing quantity over time that the records require, at the places of the likeliest statements.
Section courses_section(const diagnosis::Diagnosis& d) {
  constexpr std::size_t kMost = 4;
  Section section{.title = "What is missing over time, whatever it follows", .detail = true};
  for (const diagnosis::Stated& s : d.statements.stated) {
    if (section.blocks.size() == kMost) break;
    if (s.course.empty()) continue;
    const auto [unit, scale] = shown_unit(s);
    Plot plot{.title = fmt::format("{} at {}, if it alone is wrong", diagnosis::word(s.says.quantity),
                                   fmt::join(s.says.place, " and ")),
              .x_label = "time [min]",
              .y_label = fmt::format("{} [{}]", diagnosis::word(s.says.quantity), unit),
              .series = {}};
    for (const diagnosis::StatedCourse& c : s.course) {
      output::Series series{.label = c.record, .x = {}, .y = {}, .style = output::Series::Style::kSteps};
      for (double t_s : c.edge_s) series.x.push_back(t_s / 60.0);
      for (double v : c.value) series.y.push_back(scale * v);
      series.y.push_back(series.y.back());
      plot.series.push_back(std::move(series));
    }
    add(section, std::move(plot));
  }
  return section;
}

/// What the scenario lacks, in the words of the statements' grammar.
Section statements_section(const diagnosis::Diagnosis& d) {
  constexpr std::size_t kMost = 5;
  Section section{.title = "What is missing, and how sure that is"};
  Table table{.caption =
                  "Each row is a quantity that may be wrong at a place, by the evidence of all that it might follow, "
                  "everything else marginalised. It need not "
                  "be in the catalogue. Sizes are of linear theory.",
              .columns = {{.title = "what"},
                          {.title = "size (95 % interval)"},
                          {.title = "records"},
                          {.title = "probability", .digits = output::percent(0)}}};
  for (const diagnosis::Stated& s : d.statements.stated) {
    if (table.rows.size() == kMost) break;
    table.rows.push_back({diagnosis::words(s.says), size_text(s), diagnosis::records_text(s.says), s.probability});
  }
  table.rows.push_back({"nothing", "", "", d.statements.nothing});
  add(section, std::move(table));
  if (d.causes.empty() && d.ended_at.empty() && d.statements.nothing < 0.5)
    add(section, Text{"No law of the catalogue, fitted in full, is confirmed as a cause: the statements come from linear "
                      "theory alone."});
  return section;
}

/// Causes that were found and are not in the written file, with the reason.
void add_beside_causes(Section& body, const diagnosis::Diagnosis& d) {
  for (const diagnosis::Cause& c : d.causes) {
    if (!c.is_written)
      add(body, Text{fmt::format("{} at {} is not written into extended.yaml: {}.", c.effect, c.where, c.why_not_written)});
  }
}

/// The text about one cause in addition to its numbers.
Section cause_section(const diagnosis::Diagnosis& d, std::size_t i) {
  const diagnosis::Cause& c = d.causes[i];
  Section section{.title = fmt::format("Cause {}, {}: {} at {}", i + 1, diagnosis::word(c.standing), c.effect, c.where),
                  .detail = true};
  if (!c.doubt.empty() || !c.is_written)
    add(section, Text{fmt::format("{}{}", c.doubt.empty() ? "" : "Only suspected, since " + c.doubt + ". ",
                                  c.is_written ? "" : "It is not written into extended.yaml: " + c.why_not_written + ".")});
  const bool is_moved = i >= d.search.findings.size();
  if (!is_moved && d.ended_at.empty())
    add(section,
        Text{fmt::format("Kept-out rows are {:.1f} nats {} likely with it than without it, all numbers fitted anew.",
                         std::abs(c.kept_out_nats), c.kept_out_nats < 0.0 ? "less" : "more")});
  if (c.n_searched > 0)
    add(section,
        Text{fmt::format("The search was made again {} without a part of the rows; it found this effect at this place {}.",
                         c.n_searched == 1 ? "once" : fmt::format("{} times", c.n_searched),
                         c.n_again == 0              ? "in none of them"
                         : c.n_again == c.n_searched ? "each time"
                                                     : fmt::format("{} of them", c.n_again))});
  Table table{
      .title =
          c.alternatives.empty()
              ? "Nine tenths of the odds are with this effect at this place; those in the row are of this law of it alone"
          : c.odds.kind < diagnosis::kSure
              ? fmt::format("The data cannot distinguish it from the others; its kind has {:.0f} % of the odds",
                            100.0 * c.odds.kind)
              : fmt::format("Its kind has {:.0f} % of the odds; the data do not show where it is", 100.0 * c.odds.kind),
      .columns = {{.title = "effect"},
                  {.title = "where"},
                  {.title = "law"},
                  {.title = "numbers (95 % interval)"},
                  {.title = "gain", .unit = "nats"},
                  {.title = "odds", .unit = "%"}}};
  const auto add_row = [&](const diagnosis::Cause& x) {
    table.rows.push_back({x.effect, x.where, x.law, parameters_text(x), x.log_evidence_gain, std::round(100.0 * x.share)});
  };
  add_row(c);
  for (const diagnosis::Cause& a : c.alternatives) add_row(a);
  add(section, std::move(table));
  return section;
}

Section experiment_section(const diagnosis::Experiment& e) {
  Section section{.key = "discriminating_experiment", .title = "Experiment that would distinguish them"};
  add(section, Text{.words = e.why, .key = "why"});
  add(section,
      Text{fmt::format("Cyclogram {}: {}. Any two of the explanations would then differ by {:.1f} sigmas or more, what is "
                       "not known of their numbers taken off.",
                       e.cyclogram.name, sections_text(e.cyclogram), e.discrimination)});
  add(section, Value{.key = "proposes", .datum = e.by_sensor ? "extra_sensor" : "cyclogram"});
  add(section, Value{.key = "discrimination", .datum = e.discrimination});
  add(section, Value{.key = "simulated.records", .datum = e.n_simulated});
  add(section, Value{.key = "simulated.told", .datum = e.n_told});
  if (e.extra_sensor) {
    add(section, Text{fmt::format("{} a further thermometer on {}: {:.1f} sigmas; they differ there by up to {:.2g} K.",
                                  e.by_sensor ? "With" : "Better with", e.extra_sensor->region,
                                  e.extra_sensor->discrimination, e.extra_sensor->difference_K)});
    add(section, Value{.key = "extra_sensor.region", .datum = e.extra_sensor->region});
    add(section, Value{.key = "extra_sensor.difference_K", .datum = e.extra_sensor->difference_K});
    add(section, Value{.key = "extra_sensor.discrimination", .datum = e.extra_sensor->discrimination});
  }
  Section cyclogram{.key = "cyclogram"};
  add(cyclogram, Value{.key = "name", .datum = e.cyclogram.name});
  Table sections{.key = "sections", .columns = {{.key = "duration_min"}, {.key = "speed_rpm"}}};
  std::vector<std::size_t> axes;  // axes that move
  for (std::size_t a = 0; a < 3; ++a) {
    for (const auto& s : e.cyclogram.sections) {
      if (s.drive.feed_m_s[a] > 0.0 && (axes.empty() || axes.back() != a)) axes.push_back(a);
    }
  }
  for (std::size_t a : axes) sections.columns.push_back({.key = std::string("feed_") + "xyz"[a] + "_mm_min"});
  for (const auto& s : e.cyclogram.sections) {
    std::vector<Datum> row = {s.duration_s / 60.0, s.drive.speed_rpm};
    for (std::size_t a : axes) row.emplace_back(60e3 * s.drive.feed_m_s[a]);
    sections.rows.push_back(std::move(row));
  }
  add(cyclogram, std::move(sections));
  section.sections.push_back(std::move(cyclogram));
  return section;
}

Section unexplained_section(const diagnosis::Diagnosis& d) {
  const diagnosis::Unexplained& u = *d.unexplained;
  Section section{.key = "unexplained", .title = "What no candidate explains, more than noise"};
  const auto put = [&](const char* key, Datum datum) { add(section, Value{.key = key, .datum = std::move(datum)}); };
  put("rms", u.channels.front().rms);
  put("unit", u.channels.front().unit);
  put("where", u.channels.front().name);
  Table table{.key = "channels",
              .caption = "The smooth part of what is left, in standard deviations of what noise would have of it.",
              .columns = {{.key = "name", .title = "channel"},
                          {.key = "rms", .title = "rms", .digits = kThree},
                          {.key = "unit", .title = "unit"},
                          {.key = "sigmas", .title = "beyond noise [sigmas]"}}};
  for (const auto& c : u.channels) table.rows.push_back({c.name, c.rms, c.unit, c.times_noise});
  add(section, std::move(table));
  if (u.fails_held_out) put("fails_held_out", true);
  if (u.ambient_off_K > 0.0) put("ambient_off_K", u.ambient_off_K);
  if (u.statement) {
    put("statement", static_cast<std::int64_t>(*u.statement));
    put("statement_in_words", diagnosis::words(d.statements.stated[*u.statement].says));
  }
  return section;
}

const char* words(diagnosis::HeatWander::Limit limit) {
  using Limit = diagnosis::HeatWander::Limit;
  return limit == Limit::kAtMost ? "at most" : limit == Limit::kAtLeast ? "at least" : "about";
}

Section wander_section(const diagnosis::HeatWander& wander) {
  Section section{.key = "process_noise", .title = "Where the model errs"};
  add(section,
      Text{fmt::format("Heat that comes and goes in its bodies, alike for {} {:.0f} min{}, would explain what the first "
                       "search left. Causes are weighed beside this process noise.",
                       words(wander.limit), wander.time_s / 60.0,
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

Section gain_section(const diagnosis::Diagnosis& d) {
  Section section{.key = "gain", .title = "What mending it gains: measured minus simulated, root mean square and peak"};
  add(section, Value{.key = "holdout", .words = "held out:", .datum = d.holdout});
  Table table{
      .key = "channels",
      .caption =
          "Noise floor: the scatter of the readings alone. Regression: ridge on memories of speed, ambient and "
          "whatever else drives, which knows nothing of the machine; then with readings of thermometers too. Named causes: "
          "these alone beside the scenario's numbers; found: what the searches without these rows found, whatever of it is "
          "written. Extended is no worse than as written by choice: where it was worse on these rows, nothing is written; "
          "how much rows weigh in a calibration was chosen by them. "
          "The "
          "file: what the written scenario gives over the whole of all records, to which its numbers were fitted.",
      .columns = {{.key = "name", .title = "channel"}, {.key = "unit", .title = "unit"}}};
  for (const auto& [key, title] : {std::pair{"rmse_before", "as written"},
                                   {"rmse_calibrated", "scatter alone"},
                                   {"rmse_named", "named causes"},
                                   {"rmse_after", "extended"},
                                   {"rmse_found", "found"},
                                   {"rmse_regression_drive", "regression"},
                                   {"rmse_regression_readings", "with thermometers"},
                                   {"noise_floor", "noise floor"},
                                   {"peak_before", "peak before"},
                                   {"peak_after", "peak after"},
                                   {"rmse_all_before", "all rows, as written"},
                                   {"rmse_written", "all rows, the file"}})
    table.columns.push_back({.key = key, .title = title, .digits = kThree});
  for (const auto& g : d.gain)
    table.rows.push_back({g.name, g.unit, g.rmse_before, g.rmse_calibrated, g.rmse_named, g.rmse_after, g.rmse_found,
                          g.rmse_of_drive, g.rmse_of_readings, g.noise_floor, g.peak_before, g.peak_after, g.rmse_all_before,
                          g.rmse_written});
  add(section, std::move(table));
  add(section, Text{shares_of_gain_text(d)});
  for (const auto& [key, over_noise] : {std::pair{"over_noise.as_written", d.misses.as_written},
                                        {"over_noise.calibrated", d.misses.calibrated},
                                        {"over_noise.named", d.misses.named},
                                        {"over_noise.extended", d.misses.extended},
                                        {"over_noise.found", d.misses.found}})
    add(section, Value{.key = key, .datum = over_noise});
  const bool numbers_stay =
      std::any_of(d.calibrated.begin(), d.calibrated.end(), [](const auto& e) { return !e.is_written; });
  if (numbers_stay && d.written.keeps_numbers && !d.written.causes_alone)
    add(section, Text{"The file leaves the scenario's own numbers as they were (--causes-only): only \"the file, all rows\" "
                      "shows the effect of that; on kept-out rows they are as fitted."});
  if (const std::string taken_up = taken_up_text(d); !taken_up.empty())
    add(section, Text{.words = taken_up, .key = "taken_up"});
  if (const std::string better = better_regression_text(d); !better.empty()) add(section, Text{better});
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

/// @param detail  not on the terminal
Section numbers_section(const diagnosis::Diagnosis& d, bool detail) {
  Section section{.title = "The scenario's own numbers", .detail = detail};
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
                  {.title = "in the file"},
                  {.title = "known to"},
                  {.key = "sigmas_of_prior", .title = "moved [sigmas]", .digits = output::signed_decimals(2)},
                  {.key = "ci95"},
                  {.key = "known_to"},
                  {.key = "known_to_unit"},
                  {.key = "written"}}};
  for (const diagnosis::Estimate& e : d.calibrated) {
    table.rows.push_back({e.name, e.value, interval_text(e), e.unit, e.is_written ? "yes" : "no", known_to_text(e),
                          e.deviation, std::vector<double>{e.low, e.high}, e.known_to,
                          e.is_share ? "of its logarithm" : e.unit, e.is_written});
  }
  add(section, std::move(table));
  return section;
}

/// @param key  of the JSON object that describes what was written
Section written_section(const DiagnosisFindings& found, const std::string& key) {
  Section section{.key = key, .title = "What was written: " + found.file};
  add(section,
      output::Notes{.key = "not_written", .sort = "NOT WRITTEN to " + found.file, .lines = found.extended.not_written});
  add(section, Value{.key = "written", .datum = found.extended.written});
  add(section, output::Preformatted{.text = !found.extended.not_written.empty() ? "Nothing."
                                            : found.difference.empty()          ? "No difference to the scenario."
                                                                                : found.difference});
  return section;
}

/// The section without its parts for people.
Section for_programs(Section section) {
  section.title.clear();
  for (output::Block& block : section.blocks) {
    if (auto* value = std::get_if<Value>(&block)) value->words.clear();
    if (auto* table = std::get_if<Table>(&block)) {
      for (output::Column& column : table->columns) column.title.clear();
    }
  }
  return section;
}

output::Document begin(const std::string& what, const DiagnosisFindings& found, const output::Provenance& made_by) {
  std::vector<std::string> names;
  for (const auto& run : found.measured.runs) names.push_back(run.path);
  return {.made_by = made_by,
          .title = found.measured.scenario.name + ": " + what,
          .subtitle = fmt::format("measured: {}", fmt::join(names, ", "))};
}

/// The common part of both documents, after their own findings. @param after  name of Diagnosis::extended
void add_evidence(Section& body, const DiagnosisFindings& found, const std::string& after) {
  const diagnosis::Diagnosis& d = found.diagnosis;
  body.sections.push_back(compared_data(found.measured.runs));
  if (d.unexplained)
    body.sections.push_back(unexplained_section(d));
  else
    add(body, Value{.key = "unexplained"});
  if (d.wander)
    body.sections.push_back(wander_section(*d.wander));
  else
    add(body, Value{.key = "process_noise"});
  body.sections.push_back(data_section(d));
  body.sections.push_back(gain_section(d));
  for (Section& record : residual_sections(found.measured, d, after)) body.sections.push_back(std::move(record));
  const std::vector<Iso230Run> iso = measured_iso230_3(found.measured);
  Table figures = iso230_3_table(iso);
  figures.key.clear();  // programs use the items
  for (output::Column& column : figures.columns) {
    if (column.key != "unit") column.key.clear();
  }
  body.sections.push_back({.blocks = {std::move(figures)}});
  for (Section& item : iso230_3_items(iso)) body.sections.push_back(for_programs(std::move(item)));
  body.sections.push_back(search_data(d));
  if (const std::string one_mesh = studies::one_mesh_text(found.measured); !one_mesh.empty())
    add(body, output::Notes{.sort = "note", .lines = {one_mesh}});
}

}  // namespace

output::Document diagnosis_document(const DiagnosisFindings& found, const output::Provenance& made_by) {
  const diagnosis::Diagnosis& d = found.diagnosis;
  output::Document document = begin("diagnosis", found, made_by);
  Section& body = document.body;
  add(body, verdict_box(d, compared_of(found.measured.runs)));
  add(body, Value{.key = "verdict", .words = "verdict", .datum = diagnosis::word(d.verdict)});
  add(body, Value{.key = "reason", .datum = d.reason});
  if (!std::isnan(d.statements.nothing)) {
    body.sections.push_back(statements_section(d));
    body.sections.push_back(courses_section(d));
  }
  add_statements_data(body, d);
  add(body, causes_table(d));
  add_beside_causes(body, d);
  for (std::size_t i = 0; i < d.causes.size(); ++i) body.sections.push_back(cause_section(d, i));
  add_causes_data(body, d.causes);
  if (d.experiment)
    body.sections.push_back(experiment_section(*d.experiment));
  else
    add(body, Value{.key = "discriminating_experiment"});
  add_evidence(body, found, "extended");
  body.sections.push_back(numbers_section(d, true));
  body.sections.push_back(written_section(found, "extended"));
  return document;
}

output::Document calibration_document(const DiagnosisFindings& found, const output::Provenance& made_by) {
  const diagnosis::Diagnosis& d = found.diagnosis;
  output::Document document = begin("calibration", found, made_by);
  Section& body = document.body;
  const std::string warning = calibration_warning(d);
  const bool fits = warning.empty();
  add(body, output::Verdict{.key = "",
                            .kind = fits ? output::Verdict::Kind::kGood : output::Verdict::Kind::kBad,
                            .title = fits ? "The scenario's numbers explain the measurement"
                                          : "The numbers alone do not explain the measurement",
                            .text = warning});
  add(body, Value{.key = "warning", .datum = warning});
  add(body, Value{.key = "verdict", .datum = diagnosis::word(d.verdict)});
  add(body, Value{.key = "reason", .datum = d.reason});
  add_causes_data(body, d.causes);
  add(body, Value{.key = "discriminating_experiment"});
  body.sections.push_back(numbers_section(d, false));
  add_evidence(body, found, "calibrated");
  if (!fits && !d.statements.stated.empty()) body.sections.push_back(statements_section(d));
  body.sections.push_back(written_section(found, "calibrated_scenario"));
  return document;
}

}  // namespace driftwright::findings
