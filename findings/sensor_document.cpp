#include "findings/sensor_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace driftwright::findings {
namespace {

using namespace compensation;
using output::Datum, output::Table;
using studies::ChosenSensors, studies::SensorStudy;

const char* word(Image image) {
  return image == Image::kInitialValue ? "initial value" : image == Image::kMeanValue ? "mean value" : "range";
}

Table ranking_table(const SensorStudy& study) {
  Table table{
      .key = "channels",
      .title = "Grey relational grades",
      .caption =
          "Of each candidate against the target by Deng, with the absolute grade (Liu) and the slope grade (Dang) of the "
          "same images; ranks and how often a sensor is among the best over resamples of the records.",
      .columns = {{.key = "rank", .title = "rank"},
                  {.key = "name", .title = "channel"},
                  {.key = "grade", .title = "Deng", .digits = output::decimals(6)},
                  {.key = "absolute_grade", .title = "absolute", .digits = output::decimals(3)},
                  {.key = "slope_grade", .title = "slope", .digits = output::decimals(3)},
                  {.key = "reversed", .title = ""},
                  {.key = "rank_90_percent", .title = "rank (90 %)", .digits = output::decimals(0)},
                  {.key = "share_chosen", .title = "chosen in", .digits = output::percent(0)},
                  {.key = "note", .title = "note"}},
      .file = "ranking.csv"};
  for (std::size_t i = 0; i < study.ranking.channels.size(); ++i) {
    const RankedChannel& c = study.ranking.channels[i];
    const auto& stable = study.stability.channels;
    const auto s = std::find_if(stable.begin(), stable.end(), [&](const RankedStability& r) { return r.name == c.name; });
    std::vector<Datum> row = {i + 1, c.name, c.grade, c.absolute, c.slope, c.reversed};
    if (c.grade && s != stable.end())
      row.insert(row.end(), {std::vector<double>{s->lowest_rank, s->highest_rank}, s->share_chosen,
                             static_cast<int>(i) < study.n_to_choose ? "chosen" : ""});
    else
      row.insert(row.end(), {Datum(), Datum(), c.note});
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table selectors_table(const std::vector<ChosenSensors>& chosen) {
  Table table{
      .key = "selectors",
      .title = "Sensors chosen by",
      .caption =
          "With the regression that each choice leads to: R², the largest variance inflation and the Durbin-Watson figure "
          "of "
          "its residuals.",
      .columns = {
          {.key = "name", .title = "selector"},
          {.key = "sensors", .title = "sensors"},
          {.key = "r_squared", .title = "R²", .digits = output::decimals(4)},
          {.key = "largest_variance_inflation", .title = "largest variance inflation", .digits = output::decimals(0)},
          {.key = "durbin_watson", .title = "Durbin-Watson", .digits = output::decimals(2)},
          {.key = "condition_number", .title = "condition number", .digits = output::significant(3)},
          {.key = "reason", .title = ""},
          {.key = "not_possible", .title = ""}}};
  for (const ChosenSensors& c : chosen) {
    if (!c.not_possible.empty()) {
      table.rows.push_back({c.selector, std::vector<std::string>{}, {}, {}, {}, {}, "", c.not_possible});
      continue;
    }
    double worst = 1.0;
    for (double v : c.quality.variance_inflation) worst = std::max(worst, v);
    table.rows.push_back({c.selector, c.selection.sensors, c.quality.r_squared, worst, c.quality.durbin_watson,
                          c.regression.condition_number, c.selection.reason, ""});
  }
  return table;
}

Table coefficients_table(const std::vector<ChosenSensors>& chosen) {
  Table table{.key = "regressions",
              .title = "The regressions",
              .caption = "Coefficients with their standard errors (for white residuals) and variance inflations.",
              .columns = {{.key = "selector", .title = "selector"},
                          {.key = "sensor", .title = "sensor"},
                          {.key = "coefficient", .title = "coefficient", .digits = output::significant(5)},
                          {.key = "standard_error", .title = "standard error", .digits = output::significant(3)},
                          {.key = "variance_inflation", .title = "variance inflation", .digits = output::significant(3)}},
              .detail = true};
  for (const ChosenSensors& c : chosen) {
    if (!c.not_possible.empty()) continue;
    table.rows.push_back({c.selector, "(intercept)", c.regression.intercept, {}, {}});
    for (std::size_t i = 0; i < c.regression.inputs.size(); ++i)
      table.rows.push_back({c.selector, c.regression.inputs[i], c.regression.coefficients[i], c.quality.standard_error[i],
                            c.quality.variance_inflation[i]});
  }
  return table;
}

Table images_table(const SensorStudy& study) {
  Table table{.key = "best_by_image",
              .title = "Best sensors by the choice of image",
              .columns = {{.key = "image", .title = "image"},
                          {.key = "quantity", .title = "quantity"},
                          {.key = "best", .title = "best"},
                          {.key = "not_defined", .title = "not defined"}},
              .detail = true};
  for (const studies::OtherRanking& o : study.others)
    table.rows.push_back(
        {word(o.image), o.quantity == compensation::Quantity::kRise ? "rise" : "as recorded", o.best, o.not_defined});
  return table;
}

Table rho_table(const SensorStudy& study) {
  Table table{.key = "best_by_rho",
              .title = "Best sensors by the distinguishing coefficient",
              .columns = {{.key = "rho", .title = "ρ"}, {.key = "best", .title = "best"}},
              .detail = true};
  for (const auto& [rho, names] : study.stability.by_rho) table.rows.push_back({rho, names});
  return table;
}

/// Neighbours that the data do not distinguish; those among the chosen are also shown on the terminal.
void add_undecided(output::Section& body, const SensorStudy& study) {
  const auto& channels = study.ranking.channels;
  std::vector<std::string> sentences;
  Table table{.key = "undecided",
              .title = "Which of two comes first these data do not decide",
              .columns = {{.key = "first", .title = "sensor"}, {.key = "second", .title = "or"}},
              .detail = true};
  for (const auto& [a, b] : study.stability.undecided) {
    table.rows.push_back({a, b});
    const auto rank = std::find_if(channels.begin(), channels.end(), [&](const RankedChannel& c) { return c.name == a; }) -
                      channels.begin();
    if (rank < study.n_to_choose) sentences.push_back(fmt::format("{} or {} first: these data do not decide", a, b));
  }
  add(body, output::Notes{.lines = sentences});
  add(body, std::move(table));
}

}  // namespace

output::Document document_of(const SensorStudy& study, const std::string& scenario_name,
                             const std::vector<std::string>& records, const output::Provenance& made_by) {
  const Ranking& ranking = study.ranking;
  output::Document document{.made_by = made_by,
                            .title = fmt::format("{}: temperature sensors ranked against {}", scenario_name, study.target),
                            .subtitle = fmt::format("{} samples; {}", ranking.n_samples, ranking.reason)};
  output::Section& body = document.body;
  add(body, output::Value{.key = "target", .datum = study.target});
  add(body, output::Value{.key = "records", .datum = records});
  add(body, output::Value{.key = "n_samples", .datum = ranking.n_samples});
  add(body, output::Value{.key = "image", .datum = word(ranking.image)});
  add(body, output::Value{.key = "image_reason", .datum = ranking.reason});
  add(body, output::Value{.key = "n_resamples", .datum = study.stability.n_resamples});
  add(body, ranking_table(study));
  add_undecided(body, study);
  add(body, selectors_table(study.chosen));
  std::vector<std::string> failures;
  for (const ChosenSensors& c : study.chosen) {
    if (!c.not_possible.empty()) failures.push_back(fmt::format("{} not possible: {}", c.selector, c.not_possible));
  }
  add(body, output::Notes{.lines = failures});
  add(body, coefficients_table(study.chosen));
  add(body, images_table(study));
  add(body, rho_table(study));
  add(body, output::Notes{.key = "warnings", .sort = "warning", .lines = study.warnings});
  return document;
}

}  // namespace driftwright::findings
