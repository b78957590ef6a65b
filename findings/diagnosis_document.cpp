#include "findings/diagnosis_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "diagnosis/naming.hpp"
#include "effects/where_in_files.hpp"
#include "findings/cause_section.hpp"
#include "findings/cause_words.hpp"
#include "findings/diagnosis_answer.hpp"
#include "findings/diagnosis_data.hpp"
#include "findings/diagnosis_numbers.hpp"
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

/// All causes, one row each.
Table causes_table(const diagnosis::Diagnosis& d) {
  constexpr std::size_t kMostBeside = 1;
  Table table{.title = "Causes",
              .columns = {{.title = "cause"},
                          {.title = "standing"},
                          {.title = "probability", .digits = output::percent(0)},
                          {.title = "numbers (95 % interval)"},
                          {.title = "or"}}};
  for (std::size_t i = 0; i < d.causes.size(); ++i) {
    const diagnosis::Cause& c = d.causes[i];
    table.rows.push_back({diagnosis::cause_name(c), diagnosis::word(c.standing),
                          is_moved_number(d, i) ? Datum() : Datum(c.probability), diagnosis::parameters_text(c),
                          alternatives_text(c, kMostBeside)});
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
    const bool has_place = s.says.quantity != diagnosis::StatedQuantity::kAmbient;
    Plot plot{.title = fmt::format("{}{}, if it alone is wrong", diagnosis::word(s.says.quantity),
                                   has_place ? fmt::format(" at {}", fmt::join(s.says.place, " and ")) : ""),
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

/// The cause that names a statement and is more than suspected; null if there is none.
const diagnosis::Cause* name_of(const diagnosis::Stated& s, const std::vector<diagnosis::Cause>& causes) {
  const auto named = std::find_if(causes.begin(), causes.end(), [&](const diagnosis::Cause& c) {
    return c.standing != diagnosis::Standing::kSuspected && diagnosis::says(s.says, c.effect, c.where);
  });
  return named == causes.end() ? nullptr : &*named;
}

/// What the scenario lacks, in the words of the statements' grammar. @param least  probability of a row
Table statements_table(const diagnosis::Diagnosis& d, double least) {
  Table table{
      .caption =
          "Each row is a quantity that may be wrong at a place; its probability is the sum over all courses that it may "
          "follow there. Course and size are those of the cause that names it; where none does, those of the likeliest "
          "course by linear theory, with its share in brackets, which need not be in the catalogue.",
      .columns = {{.title = "what"},
                  {.title = "course"},
                  {.title = "size (95 % interval)"},
                  {.title = "records"},
                  {.title = "probability", .digits = output::percent(0)}}};
  for (const diagnosis::Stated& s : d.statements.stated) {
    if (s.probability < least) continue;
    const diagnosis::Cause* name = name_of(s, d.causes);
    std::string course = name ? name->law : diagnosis::course_words(s.says);
    if (!name && !course.empty()) course += fmt::format(" ({:.0f} %)", 100.0 * s.p_follows);
    table.rows.push_back({diagnosis::subject_words(s.says), course, name ? diagnosis::parameters_text(*name) : size_text(s),
                          diagnosis::records_text(s.says), s.probability});
  }
  table.rows.push_back(
      {"nothing is missing (judged on its own; the rows need not add to 100 %)", "", "", "", d.statements.nothing});
  return table;
}

/// The probable statements.
Section statements_section(const diagnosis::Diagnosis& d) {
  constexpr double kLeast = 0.05;  // less likely ones are in the folded list
  Section section{.title = "What is missing, and how sure that is"};
  add(section, statements_table(d, kLeast));
  if (d.causes.empty() && d.ended_at.empty() && d.statements.nothing < 0.5)
    add(section, Text{"No law of the catalogue, fitted in full, is confirmed as a cause: the statements come from linear "
                      "theory alone."});
  return section;
}

/// All statements, folded.
Section all_statements(const diagnosis::Diagnosis& d) {
  Section section{.title = fmt::format("All that might be missing: {}",
                                       counted(d.statements.stated.size(), "possibility", "possibilities")),
                  .detail = true};
  add(section, statements_table(d, 0.0));
  return section;
}

/// Causes that were found and are not in the written file, one sentence a reason.
void add_beside_causes(Section& body, const diagnosis::Diagnosis& d) {
  std::vector<std::pair<std::string, std::vector<std::string>>> by_reason;  // in the order of the causes
  for (const diagnosis::Cause& c : d.causes) {
    if (c.is_written) continue;
    auto known =
        std::find_if(by_reason.begin(), by_reason.end(), [&](const auto& r) { return r.first == c.why_not_written; });
    if (known == by_reason.end()) known = by_reason.insert(by_reason.end(), {c.why_not_written, {}});
    known->second.push_back(diagnosis::cause_name(c));
  }
  for (const auto& [why, causes] : by_reason)
    add(body, Text{fmt::format("{} {} not written into extended.yaml: {}.", fmt::join(causes, ", "),
                               causes.size() == 1 ? "is" : "are", why)});
}

Section experiment_section(const diagnosis::Experiment& e) {
  Section section{.key = "discriminating_experiment", .title = "The test that would distinguish them"};
  add(section, Text{.words = e.why, .key = "why"});
  add(section,
      Text{fmt::format("Cyclogram {}: {}. Its record is expected to remove {:.0f} % of what is uncertain of quantity, "
                       "place and course.",
                       e.cyclogram.name, sections_text(e.cyclogram),
                       100.0 * (e.by_sensor ? e.extra_sensor->decides : e.decides))});
  add(section, Value{.key = "proposes", .datum = e.by_sensor ? "extra_sensor" : "cyclogram"});
  add(section, Value{.key = "decides", .datum = e.decides});
  add(section, Value{.key = "simulated.records", .datum = e.n_simulated});
  add(section, Value{.key = "simulated.told", .datum = e.n_told});
  if (e.extra_sensor) {
    add(section,
        Text{fmt::format("{} a further thermometer on {}: {:.0f} %; the explanations differ there by up to {:.2g} K.",
                         e.by_sensor ? "With" : "At most, with", e.extra_sensor->region, 100.0 * e.extra_sensor->decides,
                         e.extra_sensor->difference_K)});
    add(section, Value{.key = "extra_sensor.region", .datum = e.extra_sensor->region});
    add(section, Value{.key = "extra_sensor.difference_K", .datum = e.extra_sensor->difference_K});
    add(section, Value{.key = "extra_sensor.decides", .datum = e.extra_sensor->decides});
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

/// @param key  of the JSON object that describes what was written
Section written_section(const DiagnosisFindings& found, const std::string& key) {
  Section section{.key = key};
  add(section,
      output::Notes{.key = "not_written", .sort = "NOT WRITTEN to " + found.file, .lines = found.extended.not_written});
  add(section, Value{.key = "written", .datum = found.extended.written});
  return section;
}

/// The changes of the scenario's text, folded.
Section difference_section(const DiagnosisFindings& found) {
  Section section{.title = "What was written: " + found.file, .detail = true};
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
          .subtitle =
              fmt::format("measured: {}; {}", fmt::join(names, ", "), compared_clause(compared_of(found.measured.runs)))};
}

/// What was compared and the numbers that both documents have. @param verdict  whether to show the word of the verdict
Section common_numbers(const DiagnosisFindings& found, bool verdict) {
  const diagnosis::Diagnosis& d = found.diagnosis;
  const Compared compared = compared_of(found.measured.runs);
  Section section;
  if (verdict) add(section, Value{.words = "verdict", .datum = diagnosis::word(d.verdict)});
  add(section,
      Value{.words = "compared",
            .datum = compared.n == compared.of
                         ? fmt::format("all of {}", counted(static_cast<std::size_t>(compared.n), "channel", "channels"))
                         : compared_text(compared)});
  if (const std::string one_mesh = studies::one_mesh_text(found.measured); !one_mesh.empty())
    add(section, output::Notes{.sort = "note", .lines = {one_mesh}});
  return section;
}

/// What is left, the data, and the gain.
void add_judgement(Section& numbers, const DiagnosisFindings& found) {
  const diagnosis::Diagnosis& d = found.diagnosis;
  numbers.sections.push_back(compared_data(found.measured.runs));
  numbers.sections.push_back(d.unexplained ? unexplained_section(d) : Section{.blocks = {Value{.key = "unexplained"}}});
  numbers.sections.push_back(data_section(d));
  numbers.sections.push_back(gain_section(d, found.file, found.remainder));
}

/// What only an expert needs, folded: every channel of every record, ISO 230-3.
/// @param after  name of Diagnosis::extended
void add_evidence(Section& experts, const DiagnosisFindings& found, const std::string& after) {
  const diagnosis::Diagnosis& d = found.diagnosis;
  experts.sections.push_back(d.wander ? wander_section(*d.wander) : Section{.blocks = {Value{.key = "process_noise"}}});
  for (Section& record : residual_sections(found.measured, d, after)) experts.sections.push_back(std::move(record));
  const std::vector<Iso230Run> iso = measured_iso230_3(found.measured);
  Table figures = iso230_3_table(iso);
  figures.key.clear();  // programs use the items
  for (output::Column& column : figures.columns) {
    if (column.key != "unit") column.key.clear();
  }
  experts.sections.push_back({.blocks = {std::move(figures)}});
  for (Section& item : iso230_3_items(iso)) experts.sections.push_back(for_programs(std::move(item)));
  experts.sections.push_back(search_data(d));
  experts.sections.push_back(difference_section(found));
}

/// The figure at the top of the page.
Section picture_section(const DiagnosisFindings& found, const std::optional<ShownChannel>& shown,
                        const diagnosis::Prediction* after, const std::string& words) {
  Section section;
  if (!shown) return section;
  std::vector<ShownCurve> curves = {{"simulated with the scenario as it is", &found.diagnosis.as_written}};
  if (after) curves.push_back({words, after});
  add(section,
      channel_figure(found.measured, *shown, channel_words(found.measured, *shown) + ": measured and simulated", curves));
  return section;
}

}  // namespace

output::Document diagnosis_document(const DiagnosisFindings& found, const output::Provenance& made_by) {
  const diagnosis::Diagnosis& d = found.diagnosis;
  const studies::MeasuredTwin& m = found.measured;
  const Compared compared = compared_of(m.runs);
  output::Document document = begin("diagnosis", found, made_by);
  Section& body = document.body;
  add(body, answer_of(d, compared, said_first_text(m, compared)));
  add(body, Value{.key = "verdict", .datum = diagnosis::word(d.verdict)});
  add(body, Value{.key = "reason", .datum = d.reason});

  const diagnosis::Prediction* after = with_causes(m, d);
  const std::optional<ShownChannel> shown =
      d.causes.empty() ? clearest_channel(m, d, d.as_written, nullptr) : channel_of_lead(m, d);
  body.sections.push_back(picture_section(found, shown, after, with_causes_text(d)));
  body.sections.push_back(output::next_section(next_steps(m, d, compared, made_by)));
  if (!d.causes.empty()) body.sections.push_back(causes_section(m, d));
  if (d.experiment)
    body.sections.push_back(experiment_section(*d.experiment));
  else
    add(body, Value{.key = "discriminating_experiment"});

  Section numbers{.title = "The numbers"};
  numbers.sections.push_back(common_numbers(found, true));
  numbers.sections.push_back({.blocks = {causes_table(d)}});
  add_beside_causes(numbers.sections.back(), d);
  const bool has_statements = !std::isnan(d.statements.nothing);
  if (has_statements) numbers.sections.push_back(statements_section(d));
  add_statements_data(body, d);
  add_causes_data(body, d.causes);
  add_judgement(numbers, found);
  numbers.sections.push_back(written_section(found, "extended"));
  body.sections.push_back(std::move(numbers));

  Section experts{.title = "For experts"};
  Section reason{.title = "The reason, as diagnosis.json has it", .detail = true};
  add(reason, Text{d.reason});
  experts.sections.push_back(std::move(reason));
  experts.sections.push_back(cause_statistics(d));
  if (has_statements) {
    experts.sections.push_back(all_statements(d));
    experts.sections.push_back(courses_section(d));
  }
  add_evidence(experts, found, "extended");
  experts.sections.push_back(numbers_section(d));
  body.sections.push_back(std::move(experts));
  return document;
}

output::Document calibration_document(const DiagnosisFindings& found, const output::Provenance& made_by) {
  const diagnosis::Diagnosis& d = found.diagnosis;
  const studies::MeasuredTwin& m = found.measured;
  output::Document document = begin("calibration", found, made_by);
  Section& body = document.body;
  const std::string warning = diagnosis::calibration_warning(d);
  add(body, calibration_answer(d, warning, said_first_text(m, compared_of(m.runs))));
  add(body, Value{.key = "warning", .datum = warning});
  add(body, Value{.key = "verdict", .datum = diagnosis::word(d.verdict)});
  add(body, Value{.key = "reason", .datum = d.reason});
  add(body, Value{.key = "discriminating_experiment"});

  const diagnosis::Prediction* after = d.written.keeps_numbers ? &d.extended : nullptr;
  body.sections.push_back(
      picture_section(found, clearest_channel(m, d, d.as_written, after), after, "simulated with its numbers fitted"));
  body.sections.push_back(output::next_section(steps_after_calibration(m, d, warning, made_by)));
  add_causes_data(body, d.causes);

  Section numbers{.title = "The numbers"};
  numbers.sections.push_back(common_numbers(found, false));
  if (!warning.empty()) add(numbers.sections.back(), Text{"Why: " + warning});
  add(numbers.sections.back(), moved_most(d));
  add_judgement(numbers, found);
  if (!warning.empty() && !d.statements.stated.empty()) numbers.sections.push_back(statements_section(d));
  numbers.sections.push_back(written_section(found, "calibrated_scenario"));
  body.sections.push_back(std::move(numbers));

  Section experts{.title = "For experts"};
  experts.sections.push_back(numbers_section(d));
  add_evidence(experts, found, "calibrated");
  body.sections.push_back(std::move(experts));
  return document;
}

}  // namespace driftwright::findings
