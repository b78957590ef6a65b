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
  put(item, "law", c.law);
  output::Table parameters{.key = "parameters",
                           .columns = {{.key = "name"}, {.key = "value"}, {.key = "unit"}, {.key = "ci95"}}};
  for (const diagnosis::Estimate& p : c.parameters)
    parameters.rows.push_back({p.name, p.value, p.unit, std::vector<double>{p.low, p.high}});
  add(item, std::move(parameters));
  if (!c.doubt.empty()) put(item, "doubt", c.doubt);
  put(item, "written", c.is_written);
  if (!c.is_written) put(item, "why_not_written", c.why_not_written);
  if (c.n_searched > 0) {
    put(item, "found_again.searches", c.n_searched);
    put(item, "found_again.found", c.n_again);
  }
  put(item, "kept_out_nats", c.kept_out_nats);
  put(item, "chance", c.chance);
  put(item, "odds.share", c.share);
  put(item, "odds.kind", c.odds.kind);
  put(item, "odds.place", c.odds.place);
  put(item, "log_evidence_gain", c.log_evidence_gain);
  add_causes_data(item, c.alternatives, "alternatives");
  return item;
}

void put_shape(Section& item, const diagnosis::Waveform& w, double scale) {
  using diagnosis::Shape;
  const bool is_heat = w.of == diagnosis::Waveform::Of::kHeat;
  put(item, "shape.class", diagnosis::word(w.shape.shape));
  put(item, "shape.size", scale * w.shape.size);
  put(item, "shape.unit", !w.to.empty() ? "W/K" : is_heat ? "W" : w.unit == "rad" ? "urad" : "um");
  put(item, "shape.standard_deviation", scale * w.shape.size_sd);
  put(item, "shape.explained", w.shape.explained);
  if (w.shape.shape == Shape::kStep || w.shape.shape == Shape::kDecay) put(item, "shape.time_min", w.shape.time_s / 60.0);
  if (w.shape.shape == Shape::kDecay) put(item, "shape.time_constant_min", w.shape.time_constant_s / 60.0);
  if (w.shape.shape == Shape::kPeriodic) put(item, "shape.period_min", w.shape.period_s / 60.0);
  if (w.shape.shape == Shape::kProportional) put(item, "shape.follows", w.shape.follows);
  if (w.shape.shape == Shape::kWindows) {
    std::vector<std::vector<double>> windows_min;
    for (const auto& [begin_s, end_s] : w.shape.windows_s) windows_min.push_back({begin_s / 60.0, end_s / 60.0});
    put(item, "shape.windows_min", windows_min);
  }
}

Section waveform_item(const diagnosis::Waveform& w) {
  const bool is_heat = w.of == diagnosis::Waveform::Of::kHeat;
  const double scale = is_heat ? 1.0 : 1e6;
  Section item{.key = "waveforms", .item = output::Item{"record", w.run}};
  put(item, "of", is_heat ? "heat" : "growth");
  put(item, "where", effects::where_in_files(w.where));
  if (!w.to.empty()) put(item, "to", effects::where_in_files(w.to));
  if (is_heat) {
    put(item, "log_likelihood_gain", w.log_likelihood_gain);
    put(item, "explained", w.explained);
  }
  put_shape(item, w, scale);
  std::vector<double> time_min, value;
  for (std::size_t i = 0; i < w.time_s.size(); ++i) {
    time_min.push_back(w.time_s[i] / 60.0);
    value.push_back(w.to.empty() ? scale * w.value[i] : w.conductance_W_K[i]);
  }
  put(item, "time_min", time_min);
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

void add_waveforms_data(Section& section, const diagnosis::Diagnosis& d) {
  std::size_t n = 0;
  for (const diagnosis::Waveform& w : d.waveforms) {
    if (w.shape.shape == diagnosis::Shape::kNothing) continue;
    section.sections.push_back(waveform_item(w));
    ++n;
  }
  if (n == 0) add(section, no_items("waveforms"));
}

Section compared_data(const std::vector<diagnosis::MeasuredRun>& runs) {
  const Compared compared = compared_of(runs);
  Section section{.key = "compared"};
  put(section, "channels", compared.n);
  put(section, "of", compared.of);
  if (compared.left_out.empty()) add(section, no_items("left_out"));
  for (const auto& [name, why] : compared.left_out) {
    Section item{.key = "left_out", .item = output::Item{"name", name}};
    put(item, "why", why);
    section.sections.push_back(std::move(item));
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
    section.sections.push_back(std::move(item));
  }
}

Section search_data(const diagnosis::Diagnosis& d) {
  Section section;
  put(section, "complete", d.ended_at.empty());
  put(section, "weighed_by_model_error", d.weighed_by_model_error);
  put(section, "n_candidates", d.n_candidates);
  // evidence that the best candidate has where nothing is wrong: at one machine in two, in a hundred, in ten thousand
  put(section, "chance.median", d.search.chance.gain_at(0.5));
  put(section, "chance.one_in_100", d.search.chance.gain_at(0.01));
  put(section, "chance.one_in_10000", d.search.chance.gain_at(1e-4));
  put(section, "chance.simulations", d.search.chance.n_simulated);
  // and the bars in force, which chance is no lower than, with the share of faultless machines at which it reaches them
  const diagnosis::Bars& bars = d.search.bars;
  if (bars.suspected.empty()) return section;
  put(section, "bars.set_by", d.search.chance.n_simulated > 0 ? "simulation" : "formula");
  put(section, "bars.suspected_nats", bars.suspected);
  put(section, "bars.named_nats", bars.named);
  put(section, "bars.named_beside_nats", bars.named_beside);
  put(section, "bars.named_timed_nats", bars.named_timed);
  put(section, "bars.chance_of_suspected", d.search.chance.share_above(bars.suspected.front()));
  put(section, "bars.chance_of_named", d.search.chance.share_above(bars.named));
  return section;
}

}  // namespace driftwright::findings
