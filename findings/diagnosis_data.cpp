#include "findings/diagnosis_data.hpp"

#include "effects/where_in_files.hpp"
#include "findings/diagnosis_words.hpp"

namespace driftwright::findings {
namespace {

using output::Datum;
using output::Section;
using output::Value;

void put(Section& section, const std::string& key, Datum datum) {
  add(section, Value{.key = key, .datum = std::move(datum)});
}

Section cause_item(const diagnosis::Cause& c, const std::string& key) {
  Section item{.key = key, .item = output::Item{"effect", c.effect}};
  put(item, "standing", diagnosis::word(c.standing));
  put(item, "where", effects::where_in_files(c.where));
  if (!c.own.empty()) put(item, "own", c.own);
  put(item, "law", c.law);
  output::Table parameters{.key = "parameters",
                           .columns = {{.key = "name"}, {.key = "value"}, {.key = "unit"}, {.key = "ci95"}}};
  for (const diagnosis::Estimate& p : c.parameters)
    parameters.rows.push_back({p.name, p.value, p.unit, std::vector<double>{p.low, p.high}});
  add(item, std::move(parameters));
  if (!c.doubt.empty()) put(item, "doubt", c.doubt);
  put(item, "written", c.is_written);
  if (!c.is_written) put(item, "why_not_written", c.why_not_written);
  put(item, "kept_out_nats", c.kept_out_nats);
  put(item, "probability", c.probability);
  put(item, "odds.share", c.share);
  put(item, "odds.kind", c.odds.kind);
  put(item, "odds.place", c.odds.place);
  put(item, "log_evidence_gain", c.log_evidence_gain);
  add_causes_data(item, c.alternatives, "alternatives");
  return item;
}

Section course_item(const diagnosis::StatedCourse& c, double scale) {
  Section item{.key = "course", .item = output::Item{"record", c.record}};
  std::vector<double> edge_min, value;
  for (double t_s : c.edge_s) edge_min.push_back(t_s / 60.0);
  for (double v : c.value) value.push_back(scale * v);
  put(item, "edge_min", edge_min);
  put(item, "value", value);
  return item;
}

}  // namespace

output::Value no_items(const std::string& key) {
  return {.key = key, .datum = std::vector<std::string>{}};
}

void add_causes_data(Section& section, const std::vector<diagnosis::Cause>& causes, const std::string& key) {
  if (causes.empty()) add(section, no_items(key));
  for (const diagnosis::Cause& c : causes) section.sections.push_back(cause_item(c, key));
}

Section compared_data(const std::vector<diagnosis::MeasuredRun>& runs) {
  const Compared compared = compared_of(runs);
  Section section{.key = "compared"};
  put(section, "channels", compared.n);
  put(section, "of", compared.of);
  if (compared.n == compared.of) add(section, no_items("left_out"));
  for (const auto* list : {&compared.left_out, &compared.doubted}) {
    for (const auto& [name, why] : *list) {
      Section item{.key = "left_out", .item = output::Item{"name", name}};
      put(item, "why", why);
      section.sections.push_back(std::move(item));
    }
  }
  return section;
}

void add_statements_data(Section& section, const diagnosis::Diagnosis& d) {
  put(section, "probability_nothing_wrong", d.statements.nothing);
  if (d.statements.stated.empty()) add(section, no_items("statements"));
  for (const diagnosis::Stated& s : d.statements.stated) {
    const auto [unit, scale] = shown_unit(s);
    Section item{.key = "statements", .item = output::Item{"quantity", diagnosis::word(s.says.quantity)}};
    put(item, "place", s.says.place);
    if (!s.says.at.empty()) put(item, "at", s.says.at);
    put(item, "follows", s.says.follows);
    put(item, "law", s.says.law);
    std::vector<std::string> records;
    for (std::size_t r = 0; r < s.says.in_run.size(); ++r) {
      if (s.says.in_run[r]) records.push_back(s.says.record[r]);
    }
    put(item, "records", records);
    put(item, "size", scale * s.size);
    put(item, "unit", unit);
    put(item, "ci95", std::vector<double>{scale * s.low, scale * s.high});
    put(item, "probability", s.probability);
    put(item, "p_quantity", s.p_quantity);
    put(item, "p_place", s.p_place);
    put(item, "p_follows", s.p_follows);
    put(item, "log_evidence", s.log_evidence);
    if (s.course.empty()) add(item, no_items("course"));
    for (const diagnosis::StatedCourse& c : s.course) item.sections.push_back(course_item(c, scale));
    section.sections.push_back(std::move(item));
  }
}

Section search_data(const diagnosis::Diagnosis& d) {
  Section section;
  put(section, "complete", d.ended_at.empty());
  put(section, "weighed_by_model_error", d.weighed_by_model_error);
  put(section, "n_candidates", d.n_candidates);
  return section;
}

}  // namespace driftwright::findings
