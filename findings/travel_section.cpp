#include "findings/travel_section.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "findings/strategy_cases.hpp"
#include "findings/strategy_section.hpp"

namespace driftwright::findings {
namespace {

using compensation::LeftAlong, compensation::StrategyMatrix, compensation::Travel, compensation::TravelStrategy;
using output::Section, output::Table;

/// "0, 400 and 800 mm".
std::string positions_text(const std::vector<double>& at_m) {
  std::vector<std::string> mm;
  for (double m : at_m) mm.push_back(fmt::format("{:.6g}", 1e3 * m));
  const std::string last = mm.back();
  mm.pop_back();
  return mm.empty() ? last + " mm" : fmt::format("{} and {} mm", fmt::join(mm, ", "), last);
}

std::vector<double> judged_positions_m(const Travel& t) {
  std::vector<double> at_m;
  for (const auto& p : t.places) at_m.push_back(p.at_m);
  return at_m;
}

/// The place whose correction, used everywhere, leaves least.
std::size_t best_alone(const TravelStrategy& s) {
  const auto less = [](const LeftAlong& a, const LeftAlong& b) { return a.worst_um < b.worst_um; };
  return static_cast<std::size_t>(std::min_element(s.alone.begin(), s.alone.end(), less) - s.alone.begin());
}

std::string answer_text(const Travel& t, const TravelStrategy& s, const StrategyMatrix& m) {
  const std::size_t best = best_alone(s);
  const double none_um = t.uncorrected.worst_um;
  return fmt::format(
      "Corrections for {}, straight between them, leave at most {:.1f} µm ({:.0f} % of {:.1f} µm without correction): at "
      "{:.6g} "
      "mm on {}. One correction for the whole travel leaves {:.1f} µm at best, the one for {:.6g} mm. Judged at {}. The "
      "tolerance "
      "is {:g} µm.",
      positions_text(t.corrected_m), s.along.worst_um, 100.0 * s.along.worst_um / none_um, none_um,
      1e3 * t.places[s.along.place].at_m, run_name(m.runs[s.along.run]), s.alone[best].worst_um, 1e3 * t.corrected_m[best],
      positions_text(judged_positions_m(t)), m.settings.tolerance_um);
}

Table left_table(const Travel& t, const std::vector<compensation::JudgedRunOfMachine>& runs) {
  Table table{.key = "left",
              .title = "Largest error anywhere on the travel",
              .caption =
                  "Over all rows of all judged runs, with all sensors intact. A correction for one place is used "
                  "everywhere. Of the strategies that are not chosen only the corrections for all places are listed.",
              .columns = {{.key = "strategy", .title = "strategy"},
                          {.key = "corrected", .title = "corrected for"},
                          {.key = "peak_um", .title = "largest error", .unit = "um"},
                          {.key = "share_percent", .title = "of none", .unit = "%", .digits = output::decimals(0)},
                          {.key = "position_mm", .title = "at", .unit = "mm", .digits = output::significant(6)},
                          {.key = "run", .title = "on"}}};
  const auto row = [&](const std::string& strategy, const std::string& corrected, const LeftAlong& left) {
    table.rows.push_back({strategy, corrected, left.worst_um, 100.0 * left.worst_um / t.uncorrected.worst_um,
                          1e3 * t.places[left.place].at_m, run_name(runs[left.run])});
  };
  row(compensation::kNoCorrection, "", t.uncorrected);
  for (std::size_t s = 0; s < t.strategies.size(); ++s) {
    const TravelStrategy& strategy = t.strategies[s];
    for (std::size_t k = 0; t.chosen == s && k < strategy.alone.size(); ++k)
      row(strategy.name, positions_text({t.corrected_m[k]}), strategy.alone[k]);
    row(strategy.name, positions_text(t.corrected_m), strategy.along);
  }
  return table;
}

output::Plot peaks_plot(const Travel& t, const TravelStrategy& s, double tolerance_um) {
  std::vector<double> x_mm;
  for (const auto& p : t.places) x_mm.push_back(1e3 * p.at_m);
  output::Plot plot{.title = "Largest error over the travel: " + s.name,
                    .x_label = "position [mm]",
                    .y_label = "largest error [µm]",
                    .series = {{.label = "no correction", .x = x_mm, .y = t.uncorrected.peak_um, .width = 3.0}},
                    .bands = {{.label = "tolerance", .low = 0.0, .high = tolerance_um}}};
  for (std::size_t k = 0; k < s.alone.size(); ++k)
    plot.series.push_back({.label = positions_text({t.corrected_m[k]}) + " alone",
                           .x = x_mm,
                           .y = s.alone[k].peak_um,
                           .style = output::Series::Style::kDashed});
  plot.series.push_back({.label = "all of them, straight between", .x = x_mm, .y = s.along.peak_um, .width = 3.0});
  return plot;
}

/// The command that writes the files of a strategy for a control.
std::string export_step(const studies::JudgedTravel& judged, const TravelStrategy& s, const output::Provenance& made_by) {
  std::string models;
  for (const StrategyMatrix& m : judged.places) {
    for (const auto& strategy : m.strategies) {
      if (strategy.fitted.name == s.name) models += " --model " + output::path_in_results(made_by, model_file(m, strategy));
    }
  }
  return fmt::format(
      "`driftwright export{} --as linuxcnc` writes one file for the whole travel, of '{}'; --as siemens, st and c "
      "do so, too (docs/how-to/controls.md).",
      models, s.name);
}

}  // namespace

Section travel_section(const studies::JudgedTravel& judged, const output::Provenance& made_by) {
  const Travel& t = judged.travel;
  const StrategyMatrix& first = judged.places.front();
  const double tolerance_um = first.settings.tolerance_um;
  Section section{.key = "travel", .title = "Along the travel of " + first.settings.strategies.place->screw};
  if (t.chosen) {
    const TravelStrategy& s = t.strategies[*t.chosen];
    const bool is_kept = s.along.worst_um <= tolerance_um;
    add(section, output::Value{.key = "chosen", .datum = s.name});
    add(section, output::Value{.key = "why_chosen", .datum = t.why_chosen});
    add(section, output::Verdict{.kind = is_kept ? output::Verdict::Kind::kGood : output::Verdict::Kind::kBad,
                                 .title = fmt::format("{} the tolerance over the whole travel: {}",
                                                      is_kept ? "Keeps" : "Does not keep", s.name),
                                 .text = answer_text(t, s, first)});
    add(section, peaks_plot(t, s, tolerance_um));
  }
  add(section, output::Value{.key = "tolerance_um", .datum = tolerance_um});
  add(section, left_table(t, first.runs));
  if (t.chosen_formula)
    section.sections.push_back(
        output::next_section({export_step(judged, t.strategies[*t.chosen_formula], made_by),
                              "The verdicts of each place, with failed sensors, are in the sections that follow."}));
  return section;
}

}  // namespace driftwright::findings
