#include "findings/cause_section.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/rivals.hpp"
#include "findings/cause_words.hpp"
#include "findings/diagnosis_words.hpp"

namespace driftwright::findings {
namespace {

using diagnosis::StatedQuantity;
using output::Section, output::Table, output::Text;

constexpr std::size_t kMostCauses = 4;        // with a section of their own; tables have all
constexpr std::size_t kMostAlternatives = 3;  // in a sentence

/// The instruments that a cause is about; none if it acts on the machine.
std::vector<std::string> instruments_of(const diagnosis::Diagnosis& d, std::size_t cause) {
  const std::optional<StatedQuantity> quantity = quantity_of_cause(d, cause);
  if (quantity != StatedQuantity::kReading && quantity != StatedQuantity::kDisplacement) return {};
  std::vector<std::string> names;
  std::string rest = d.causes[cause].where;
  for (std::size_t end = rest.find(','); end != std::string::npos; end = rest.find(',')) {
    names.push_back(rest.substr(0, end));
    rest.erase(0, end + 1);
  }
  names.push_back(rest);
  return names;
}

Text sentence(std::string words) {
  return {.words = std::move(words), .detail = true};  // the terminal has the answer and the tables
}

Section one_cause(const diagnosis::Diagnosis& d, std::size_t i) {
  const diagnosis::Cause& c = d.causes[i];
  const std::optional<StatedQuantity> quantity = quantity_of_cause(d, i);
  Section section{.title =
                      fmt::format("{}. {} ({})", i + 1, difference_text(quantity, c.where), diagnosis::word(c.standing))};
  add(section, sentence(cause_sentence(d, i)));
  add(section, sentence(look_text(quantity, c.where)));
  return section;
}

void add_certainty(Section& section, const diagnosis::Diagnosis& d, std::size_t i) {
  const diagnosis::Cause& c = d.causes[i];
  add(section, sentence(sure_sentence(d, i)));
  const std::string others = alternatives_text(c, kMostAlternatives);
  if (!others.empty())
    add(section,
        sentence(fmt::format("What else it could be: {}. These records cannot distinguish {}{}.", others,
                             c.alternatives.size() == 1 ? "the two" : "them", d.experiment ? "; the test below can" : "")));
  else if (!is_moved_number(d, i) && c.doubt.empty())
    add(section, sentence("What else it could be: nothing else in the catalogue explains these records nearly as well."));
}

/// Measured, simulated without this cause, simulated with it; nothing if that was not simulated.
void add_figure(Section& section, const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d, std::size_t i) {
  const diagnosis::Prediction& with = d.search.fit.prediction;
  if (i >= d.without_cause.size() || with.size() != m.runs.size()) return;
  const std::optional<ShownChannel> channel = clearest_channel(m, d, d.without_cause[i], &with, instruments_of(d, i));
  if (!channel) return;
  add(section, channel_figure(m, *channel, fmt::format("Cause {}: {}", i + 1, channel_words(m, *channel)),
                              {{"simulated without this cause, all else mended", &d.without_cause[i]},
                               {"simulated with this cause mended too", &with}}));
}

/// The statistics of one cause.
Section one_cause_statistics(const diagnosis::Diagnosis& d, std::size_t i) {
  const diagnosis::Cause& c = d.causes[i];
  Section section{.title = fmt::format("Cause {}, {}: {}", i + 1, diagnosis::word(c.standing), diagnosis::cause_name(c))};
  if (!is_moved_number(d, i) && d.ended_at.empty())
    add(section,
        Text{fmt::format("Kept-out rows are {:.1f} nats {} likely with it than without it, all numbers fitted anew.",
                         std::abs(c.kept_out_nats), c.kept_out_nats < 0.0 ? "less" : "more")});
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
    table.rows.push_back(
        {x.effect, x.where, x.law, diagnosis::parameters_text(x), x.log_evidence_gain, std::round(100.0 * x.share)});
  };
  add_row(c);
  for (const diagnosis::Cause& a : c.alternatives) add_row(a);
  add(section, std::move(table));
  return section;
}

}  // namespace

std::size_t lead_cause(const diagnosis::Diagnosis& d) {
  const auto lead = std::max_element(d.causes.begin(), d.causes.end(),
                                     [](const auto& a, const auto& b) { return a.standing < b.standing; });
  return static_cast<std::size_t>(lead - d.causes.begin());
}

const diagnosis::Prediction* with_causes(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d) {
  for (const diagnosis::Prediction* readings : {&d.search.fit.prediction, &d.extended}) {
    if (readings->size() == m.runs.size()) return readings;
  }
  return nullptr;
}

std::string with_causes_text(const diagnosis::Diagnosis& d) {
  if (d.causes.empty()) return "simulated with its numbers fitted";
  return d.causes.size() == 1 ? "simulated with the cause" : "simulated with the causes";
}

std::optional<ShownChannel> channel_of_lead(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d) {
  const diagnosis::Prediction* after = with_causes(m, d);
  return after ? clearest_channel(m, d, d.as_written, after, instruments_of(d, lead_cause(d))) : std::nullopt;
}

std::string alternatives_text(const diagnosis::Cause& cause, std::size_t most) {
  std::vector<std::string> list;
  for (const diagnosis::Cause& a : cause.alternatives) {
    if (list.size() < most) list.push_back(fmt::format("{} ({:.0f} %)", diagnosis::cause_name(a), 100.0 * a.share));
  }
  if (list.empty()) return "";
  const std::size_t n_more = cause.alternatives.size() - list.size();
  return fmt::format("{}{}", fmt::join(list, ", "),
                     n_more > 0 ? fmt::format(" and {}", counted(n_more, "other", "others")) : "");
}

Section causes_section(const studies::MeasuredTwin& m, const diagnosis::Diagnosis& d) {
  Section section{.title = d.causes.size() == 1 ? "The cause" : "The causes, one by one"};
  const std::size_t n_shown = std::min(kMostCauses, d.causes.size());
  for (std::size_t i = 0; i < n_shown; ++i) {
    Section cause = one_cause(d, i);
    if (d.causes.size() > 1) add_figure(cause, m, d, i);
    add_certainty(cause, d, i);
    section.sections.push_back(std::move(cause));
  }
  if (n_shown < d.causes.size())
    section.sections.push_back(
        {.blocks = {sentence(
             fmt::format("{} in the table below.", counted(d.causes.size() - n_shown, "more cause is", "more are")))}});
  return section;
}

Section cause_statistics(const diagnosis::Diagnosis& d) {
  Section section{.title = d.causes.empty() ? "" : "Statistics of the causes", .detail = true};
  for (std::size_t i = 0; i < d.causes.size(); ++i) section.sections.push_back(one_cause_statistics(d, i));
  return section;
}

}  // namespace driftwright::findings
