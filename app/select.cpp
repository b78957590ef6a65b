#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/results.hpp"
#include "compensation/predictors/drift_model.hpp"
#include "compensation/predictors/regression_quality.hpp"
#include "compensation/sensors/ranking_stability.hpp"
#include "compensation/sensors/sensor_selection.hpp"
#include "output/json_text.hpp"
#include "studies/record_study.hpp"
#include "studies/validation_study.hpp"

namespace driftwright::app {
namespace {

using namespace compensation;
using Json = nlohmann::ordered_json;

Json grade(const std::optional<double>& g) {
  return g ? Json(*g) : Json(nullptr);
}

const char* word(Image image) {
  return image == Image::kInitialValue ? "initial value" : image == Image::kMeanValue ? "mean value" : "range";
}

/// The ranking by every image and of rises: what the choice of image does to it.
Json other_images(const std::vector<Record>& records, const std::string& target, const std::vector<std::string>& candidates,
                  int n) {
  Json j = Json::array();
  for (const Quantity quantity : {Quantity::kAsRecorded, Quantity::kRise}) {
    for (const Image image : {Image::kInitialValue, Image::kMeanValue, Image::kRange}) {
      Json row = {{"image", word(image)}, {"quantity", quantity == Quantity::kRise ? "rise" : "as recorded"}};
      try {
        row["best"] = best(rank_channels(records, target, candidates, {.image = image, .quantity = quantity}), n);
      } catch (const InputError& e) {
        row["not_defined"] = e.what();
      }
      j.push_back(std::move(row));
    }
  }
  return j;
}

struct Chosen {
  std::string selector;
  Selection selection;
  std::string failure;
};

}  // namespace

void select(const RecordOptions& options) {
  const scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  const scenarios::Study& settings = scenarios::require_study(scenario, "select");
  const studies::StudyRecords read = studies::read_records(scenario, options);
  const std::vector<Record> training = studies::own_records(read.train);
  const std::vector<std::string> all = studies::candidate_sensors(settings, training.front()),
                                 candidates = studies::usable_sensors(training, all);
  std::vector<std::string> warnings = studies::sensor_warnings(studies::whole_records(read.train, settings.target), all);
  warnings.insert(warnings.begin(), read.notes.begin(), read.notes.end());
  std::vector<Record> records;
  for (const ObservedRun& run : read.train)
    records.push_back(own_rows(scored_readings(run, settings.target, settings.count_from_start), run.n_before));
  const GreyOptions how{.image = settings.image,
                        .quantity = settings.count_from_start ? Quantity::kRise : Quantity::kAsRecorded};
  const int n = settings.sensors_to_choose;
  const Ranking ranking = rank_channels(records, settings.target, candidates, how);
  const RankingStability stability = ranking_stability(records, settings.target, candidates, how, n);
  std::vector<Chosen> chosen;
  for (const Selector& selector : selectors(how)) {
    chosen.push_back({selector.name, {}, {}});
    try {
      chosen.back().selection = selector.select(records, candidates, settings.target, n);
    } catch (const InputError& e) {
      chosen.back().failure = e.what();
    }
  }

  output::ResultsFolder folder = open_results(options, scenario.name);
  Json j = {{"program", "driftwright"},
            {"version", folder.made_by().version},
            {"scenario", folder.made_by().scenario},
            {"target", settings.target},
            {"records", options.train},
            {"n_samples", ranking.n_samples},
            {"image", word(ranking.image)},
            {"image_reason", ranking.reason},
            {"n_resamples", stability.n_resamples}};
  std::string csv = "rank,channel,grade_1,absolute_grade_1,slope_grade_1,lowest_rank,highest_rank,share_chosen_1\n", shown;
  for (std::size_t i = 0; i < ranking.channels.size(); ++i) {
    const RankedChannel& c = ranking.channels[i];
    const auto s = std::find_if(stability.channels.begin(), stability.channels.end(),
                                [&](const RankedStability& r) { return r.name == c.name; });
    const bool has = c.grade && s != stability.channels.end();
    csv += has ? fmt::format("{},{},{:.6f},{:.6f},{:.6f},{:.0f},{:.0f},{:.3f}\n", i + 1, c.name, *c.grade, *c.absolute,
                             *c.slope, s->lowest_rank, s->highest_rank, s->share_chosen)
               : fmt::format("{},{},,,,,,\n", i + 1, c.name);
    Json entry = {{"name", c.name},
                  {"grade", grade(c.grade)},
                  {"absolute_grade", grade(c.absolute)},
                  {"slope_grade", grade(c.slope)},
                  {"reversed", c.reversed}};
    if (has) {
      entry["rank_90_percent"] = {s->lowest_rank, s->highest_rank};
      entry["share_chosen"] = s->share_chosen;
    } else {
      entry["note"] = c.note;
    }
    j["channels"].push_back(std::move(entry));
    shown += has ? fmt::format("  {:2}  {:<16} {:.6f}   {:.3f}   {:.3f}   {:2.0f} to {:2.0f}   {:3.0f} %{}\n", i + 1, c.name,
                               *c.grade, *c.absolute, *c.slope, s->lowest_rank, s->highest_rank, 100.0 * s->share_chosen,
                               static_cast<int>(i) < n ? "  chosen" : "")
                 : fmt::format("  {:2}  {:<16} {}\n", i + 1, c.name, c.note);
  }
  for (const auto& [rho, names] : stability.by_rho) j["best_by_rho"].push_back({{"rho", rho}, {"best", names}});
  j["undecided"] = Json::array();
  for (const auto& [a, b] : stability.undecided) j["undecided"].push_back({a, b});
  j["best_by_image"] = other_images(records, settings.target, candidates, n);
  std::string selected;
  for (const Chosen& c : chosen) {
    if (!c.failure.empty()) {
      j["selectors"].push_back({{"name", c.selector}, {"not_possible", c.failure}});
      selected += fmt::format("  {:<12} not possible: {}\n", c.selector, c.failure);
      continue;
    }
    const Regression fit = fit_regression(records, c.selection.sensors, settings.target);
    const RegressionQuality q = regression_quality(records, fit);
    double worst = 1.0;
    for (double v : q.variance_inflation) worst = std::max(worst, v);
    j["selectors"].push_back({{"name", c.selector},
                              {"sensors", c.selection.sensors},
                              {"reason", c.selection.reason},
                              {"regression",
                               {{"intercept", fit.intercept},
                                {"coefficients", fit.coefficients},
                                {"standard_errors", q.standard_error},
                                {"variance_inflation", q.variance_inflation},
                                {"r_squared", q.r_squared},
                                {"durbin_watson", q.durbin_watson},
                                {"condition_number", fit.condition_number}}}});
    selected +=
        fmt::format("  {:<12} {:<40} R2 {:.4f}, largest variance inflation {:.0f}, Durbin-Watson {:.2f}\n", c.selector,
                    fmt::format("{}", fmt::join(c.selection.sensors, ", ")), q.r_squared, worst, q.durbin_watson);
  }
  j["warnings"] = warnings;
  folder.write_text("ranking.csv", csv);
  folder.write_text("summary.json", output::json_text(j));
  folder.commit();

  fmt::print(
      "grey relational grades against {}, {} samples; {}\n        channel          Deng       absolute slope   rank (90 %)  "
      "chosen in\n{}",
      settings.target, ranking.n_samples, ranking.reason, shown);
  for (const auto& [a, b] : stability.undecided) {
    const auto rank =
        std::find_if(ranking.channels.begin(), ranking.channels.end(), [&](const RankedChannel& c) { return c.name == a; }) -
        ranking.channels.begin();
    if (rank < n) fmt::print("  {} or {} first: these data do not decide\n", a, b);  // the rest is in summary.json
  }
  fmt::print("chosen by\n{}", selected);
  for (const std::string& warning : warnings) fmt::print("warning: {}\n", warning);
  fmt::print("written to {}\n", shown_path(folder.target()));
}

}  // namespace driftwright::app
