#include "findings/correction_document.hpp"

#include <fmt/format.h>

#include "findings/iso230_3_section.hpp"
#include "findings/named_value.hpp"

namespace driftwright::findings {
namespace {

using output::Value;
using studies::CorrectionStudy;

/// Sentences about what verdict and margin of a live predictor do not cover for a plan; none if nothing is planned.
std::vector<std::string> reservations(const CorrectionStudy& study, const std::string& verdict, double tolerance_um) {
  std::vector<std::string> sentences;
  if (!study.margin_um) return sentences;
  const auto& d = study.predictor;
  if (!verdict.empty())
    sentences.push_back(
        fmt::format("The verdict '{}' is of '{}' as it follows readings live; the plan, made before the run, was not judged "
                    "by `validate`.",
                    verdict, d.name));
  sentences.push_back(
      d.interval_um
          ? fmt::format(
                "The plan keeps a margin of {:.2f} µm: the error of the live predictor on training runs (half of its "
                "95 % interval{}), not that of a prediction ahead.",
                *study.margin_um, *d.interval_um > 0.5 * tolerance_um ? ", cut to half of the tolerance" : "")
          : "The plan keeps no margin, for the predictor has no interval.");
  return sentences;
}

output::Plot plot_of(const CorrectionStudy& study, double tolerance_um) {
  std::vector<double> t_min;
  for (double t_s : judged_rows(study, study.time_s)) t_min.push_back(t_s / 60.0);
  const std::string& target = study.predictor.target;
  output::Plot plot{
      .title = target,
      .x_label = "time [min]",
      .y_label = target + " [µm]",
      .series = {{.label = "without correction", .x = t_min, .y = judged_rows(study, study.drift_um), .width = 3.0},
                 {.label = "predicted", .x = t_min, .y = judged_rows(study, study.predicted_um)},
                 {.label = "left", .x = t_min, .y = judged_rows(study, study.left_um)}},
      .bands = {{.label = "tolerance", .low = -tolerance_um, .high = tolerance_um}}};
  if (study.probed) plot.series.push_back({.label = "left with probings", .x = t_min, .y = study.probed->left_um});
  return plot;
}

}  // namespace

output::Document document_of(const CorrectionStudy& study, const scenarios::Scenario& scenario, const CorrectionAsked& asked,
                             const output::Provenance& made_by) {
  const std::string &target = study.predictor.target, &by = study.predictor.name;
  const double tolerance_um = scenario.study->tolerance_um, before_um = study.before.peak_abs,
               left_um = study.after.peak_abs;
  output::Document document{
      .made_by = made_by,
      .title = fmt::format("{}: {} corrected {}", scenario.name, target,
                           asked.through == "none" ? "without an actuator" : "through the " + asked.through),
      .subtitle = fmt::format("{} by {}", study.run, by)};
  output::Section& body = document.body;
  add(body, output::Verdict{.key = "verdict",
                            .kind = left_um <= tolerance_um ? output::Verdict::Kind::kGood : output::Verdict::Kind::kBad,
                            .title = fmt::format("{:.1f} µm of {:.1f} µm are left", left_um, before_um),
                            .text = fmt::format("{}; tolerance {:g} µm.", by, tolerance_um)});
  add(body, Value{.key = "model", .datum = asked.model});
  add(body, Value{.key = "judged", .words = asked.verdict.empty() ? "" : "judged by `validate`", .datum = asked.verdict});
  add(body, Value{.key = "predictor", .datum = by});
  add(body, Value{.key = "through", .datum = asked.through});
  add(body, Value{.key = "cyclogram", .datum = study.run});
  add(body, Value{.key = "channel", .words = "displacement", .datum = target});
  add(body, Value{.key = "peak_before_um", .words = "peak without correction", .datum = before_um, .unit = "um"});
  add(body, Value{.key = "peak_left_um", .words = "peak left", .datum = left_um, .unit = "um"});
  add(body, named_value("removed_percent", "removed", 100.0 * (1.0 - left_um / before_um), "percent", output::decimals(0)));
  for (const auto& [key, words, score] : {std::tuple{"rms_before_um", "RMS without correction", &study.before},
                                          std::tuple{"rms_left_um", "RMS left", &study.after}})
    add(body, Value{.key = key, .words = words, .datum = score->rmse, .unit = "um", .digits = output::decimals(2)});
  if (study.probed) {
    add(body, Value{.key = "rms_probed_um",
                    .words = "RMS left with probings",
                    .datum = study.probed->left.rmse,
                    .unit = "um",
                    .digits = output::decimals(2)});
    add(body, Value{.key = "peak_probed_um",
                    .words = "peak left with probings",
                    .datum = study.probed->left.peak_abs,
                    .unit = "um"});
    add(body, Value{.key = "n_probings", .words = "probings", .datum = study.probed->n_probings});
    add(body, Value{.key = "n_refused_probings", .words = "refused probings", .datum = study.probed->n_refused});
  }
  if (study.margin_um) {
    add(body, named_value("margin_um", "margin of the plan", *study.margin_um, "um", output::decimals(2)));
    add(body, Value{.key = "judged_as", .datum = "live"});
  }
  add(body, plot_of(study, tolerance_um));
  add(body, output::Notes{.lines = reservations(study, asked.verdict, tolerance_um)});
  add(body, output::Notes{.key = "notes", .sort = "note", .lines = study.notes});
  body.sections.push_back(iso230_3_section(study.iso));
  return document;
}

}  // namespace driftwright::findings
